//! The spectrum of W: eigenvalues descending, eigenvectors, residuals and eigenspaces.

use std::ops::Range;

/// How a spectrum was computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solver {
    /// All modes by a dense symmetric solver.
    Dense,
    /// Leading modes by ARPACK's implicitly restarted Lanczos method.
    Arpack,
}

/// Leading modes of a coupling matrix.
#[derive(Clone, Debug)]
pub struct Spectrum {
    /// λ_1 ≥ λ_2 ≥ …, those computed.
    pub eigenvalues: Vec<f64>,
    /// v_1, v_2, …, one vector of length N a mode, unit 2-norm in node space; within an eigenspace
    /// orthonormal in node space. The component of largest magnitude is positive; where several are
    /// largest within 1e-6 of it, that of the lowest node. Inside an eigenspace the basis is one of
    /// many: only the span has a meaning.
    pub eigenvectors: Vec<Vec<f64>>,
    /// ‖W v_k − λ_k v_k‖ of each mode.
    pub residuals: Vec<f64>,
    /// Runs of equal eigenvalues, as ranges of mode indices (0-based) that cover all modes in order.
    pub eigenspaces: Vec<Range<usize>>,
    /// Neighbouring eigenvalues that differ by at most this are one eigenspace: the larger of
    /// 1e-10 max_i |w_ii| and ten times the largest residual allowed.
    pub tolerance: f64,
    /// Which solver found them.
    pub solver: Solver,
    /// Matrix–vector products spent on finding the modes (0 for the dense solver).
    pub products: usize,
}
