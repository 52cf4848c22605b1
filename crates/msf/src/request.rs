//! What is asked about Λ(σ).

use std::sync::Arc;

use dynamics::lyapunov::Times;
use dynamics::{Coupling, InstructionSet, NodeDynamics};

use crate::Refinement;

/// An oscillator with the function through which it is coupled.
#[derive(Clone, Debug)]
pub struct Node {
    /// Dynamics F.
    pub dynamics: Arc<dyn NodeDynamics>,
    /// Coupling function H.
    pub coupling: Coupling,
}

/// A grid that begins above 0 is carried on below by so many halvings: a window may lie there.
const HALVINGS: i32 = 8;

/// About how many exponents a look costs for which nobody says where.
const LOOKED: u64 = 80;

/// What to compute.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Request {
    /// Grid of σ ≥ 0, ascending. Without any, what is looked at follows from what is found.
    pub sigma: Vec<f64>,
    /// Times of every exponent.
    pub times: Times,
    /// How well zeros must be known.
    pub refinement: Refinement,
    /// Seed from which all orbits' seeds follow.
    pub seed: u64,
    /// Vector instructions to use; results do not depend on them, and so they are left out where a
    /// request is written down.
    #[serde(skip)]
    pub instruction_set: InstructionSet,
}

impl Request {
    /// The σ that are looked at: the grid, and where that begins above 0 its first σ halved eight
    /// times, ascending.
    pub fn looked_at(&self) -> Vec<f64> {
        let first = self.sigma.first().copied().filter(|&first| first > 0.0);
        let halved = |first: f64| (1..=HALVINGS).rev().map(move |k| first * 0.5f64.powi(k));
        first.into_iter().flat_map(halved).chain(self.sigma.iter().copied()).collect()
    }

    /// Steps of tangent vectors, about: those of the curve and of two zeros, besides those with half the
    /// step or a longer transient.
    pub fn steps(&self) -> u64 {
        let n_points = if self.sigma.is_empty() { LOOKED } else { self.looked_at().len() as u64 };
        (n_points + 16 + 64 + 2 * (8 + 16 + 16)) * self.times.steps()
    }
}
