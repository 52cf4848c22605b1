//! Simulation of a network, `dx_i/dt = F(x_i) + ε Σ_j w_ij H(x_j)`: Fan, Wang & Wang (2023), Eq. (1).
//!
//! What is asked for and what comes out; `run` does it, and the step itself is in [`crate::kernel`].

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::error::{check_times, whole};
use crate::integrators::Method;
use crate::observables::{Errors, Observables};
use crate::statistics::BLOCKS;
use crate::{Coupling, DynamicsError, InstructionSet, NodeDynamics, Series, SparseMatrix};

/// Relative size of kicks of some fifty roundings.
pub const ROUNDING_KICK: f64 = 1e-14;

/// How long to simulate and how often to look. All times in model time units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Schedule {
    /// Step of the integrator (the sampling unit of an adaptive one).
    pub step: f64,
    /// Time left for the initial state to be forgotten.
    pub transient: f64,
    /// Time over which errors are averaged, rounded up to [`BLOCKS`] blocks of whole samples.
    pub average: f64,
    /// Steps from one sample to the next.
    pub stride: u32,
}

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

impl Schedule {
    /// Steps of one replica from its initial state to its end.
    pub fn steps(&self) -> u64 {
        (self.transient_samples() + self.samples()) * u64::from(self.stride)
    }

    /// Samples in the averaging time.
    pub fn samples(&self) -> u64 {
        self.samples_per_block() * BLOCKS as u64
    }

    /// Time between two samples.
    pub fn sampling_interval(&self) -> f64 {
        self.step * f64::from(self.stride)
    }

    pub(crate) fn transient_samples(&self) -> u64 {
        whole(self.transient / self.sampling_interval())
    }

    pub(crate) fn samples_per_block(&self) -> u64 {
        whole((self.average / self.sampling_interval() / BLOCKS as f64).max(1.0))
    }

    pub(crate) fn time_of(&self, sample: u64) -> f64 {
        sample as f64 * self.sampling_interval()
    }

    pub(crate) fn check(&self) -> Result<(), DynamicsError> {
        let times = [("transient", self.transient), ("average", self.average)];
        check_times(self.step, &times, self.average / self.sampling_interval())
    }
}
