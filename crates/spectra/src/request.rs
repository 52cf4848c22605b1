//! What is asked for.

use crate::solvers::Solver;

/// How many modes, counted from the largest eigenvalue down.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub enum Modes {
    /// All N.
    All,
    /// At least this many; more where the last eigenspace would be cut.
    Leading(usize),
    /// All with λ_k > cutoff, a negative number, and at most [`Request::max_modes`]. An eigenvalue
    /// within [`crate::Spectrum::tolerance`] of the cutoff counts as equal to it, and so is left out
    /// unless it belongs to an eigenspace that begins above.
    Above(f64),
}

/// A request for the leading modes of a coupling matrix.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Request {
    /// How many modes.
    pub modes: Modes,
    /// By which solver. Without one the dense solver takes networks of few nodes and requests for more
    /// than half of all modes (see [`crate::DENSE_NODES`]); shift-invert those whose sparse factorisation
    /// is cheap; elsewhere ARPACK up to [`crate::ARPACK_NODES`], and Chebyshev filters beyond.
    pub solver: Option<Solver>,
    /// Largest residual ‖S u − λ u‖ of a converged mode, relative to max_i |w_ii|; from 1e-13 to
    /// 1e-3. The dense solver is as accurate as it is, whatever the tolerance.
    pub tolerance: f64,
    /// Most matrix–vector products an iterative solver may spend; ARPACK gives up when the next
    /// restart might need more. A Rayleigh–Ritz step on what ARPACK found comes on top, with one
    /// product a mode.
    pub max_products: usize,
    /// Most modes an iterative solver may add beyond [`Modes::Leading`] to complete the last
    /// eigenspace.
    pub max_extra: usize,
    /// Most modes that [`Modes::Above`] may return.
    pub max_modes: usize,
    /// Seed of the random vectors.
    pub seed: u64,
}

impl Default for Request {
    fn default() -> Self {
        Self {
            modes: Modes::All,
            solver: None,
            tolerance: 1e-12,
            max_products: 200_000,
            max_extra: 100,
            max_modes: 1000,
            seed: 1,
        }
    }
}
