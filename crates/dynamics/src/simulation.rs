//! Simulation of a network, `dx_i/dt = F(x_i) + ε Σ_j w_ij H(x_j)`: Fan, Wang & Wang (2023), Eq. (1).
//!
//! What is asked for and what comes out; `run` does it, and the step itself is in [`crate::kernel`].

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::integrators::Method;
use crate::observables::{Errors, Observables};
use crate::{Coupling, InstructionSet, NodeDynamics, Schedule, Series, SparseMatrix};

/// Relative size of kicks of some fifty roundings.
pub const ROUNDING_KICK: f64 = 1e-14;

/// One run of the network: a coupling strength and the seed of its initial state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Replica {
    /// Uniform coupling strength ε.
    pub epsilon: f64,
    /// Seed of the initial state; the same seed gives the same state at every ε.
    pub seed: u64,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Outcome {
    /// It stayed bounded: its time-averaged errors.
    Completed(Errors),
    /// A component left the ball of radius [`crate::ESCAPE_RADIUS`], seen at this model time.
    Escaped {
        /// Model time of the sample at which it was seen.
        time: f64,
    },
    /// The adaptive integrator gave up, as where the equations are stiff.
    Failed {
        /// Model time at which it did.
        time: f64,
        /// Why.
        reason: String,
    },
}

/// A replica with its outcome.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// What was run.
    pub replica: Replica,
    /// How it ended.
    pub outcome: Outcome,
}

/// Everything that the replicas of a simulation share.
#[derive(Clone, Debug)]
pub struct Simulation<'a> {
    /// Dynamics F of the isolated node.
    pub dynamics: Arc<dyn NodeDynamics>,
    /// Coupling function H.
    pub coupling: Coupling,
    /// Coupling matrix W, shape (N, N).
    pub matrix: &'a SparseMatrix,
    /// Integrator.
    pub method: Method,
    /// Times.
    pub schedule: Schedule,
    /// What to average.
    pub observables: Observables,
    /// States to hand out on the way, if any; outcomes do not depend on it.
    pub series: Option<Series>,
    /// Relative size of the random kicks that keep states from being equal to the last bit; 0 for
    /// none. [`ROUNDING_KICK`] is what nothing but rounding would notice.
    pub kick: f64,
    /// Vector instructions to use, of those that this processor has; results do not depend on them.
    pub instruction_set: InstructionSet,
}
