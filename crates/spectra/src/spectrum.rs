//! The spectrum of W: eigenvalues descending, eigenvectors, residuals and eigenspaces.

use std::ops::Range;

/// How a spectrum was computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Solver {
    /// All modes by a dense symmetric solver.
    Dense,
    /// Leading modes by ARPACK's implicitly restarted Lanczos method.
    Arpack,
    /// Leading modes by long Lanczos sequences and blocks that pass a Chebyshev filter.
    Chebyshev,
    /// Leading modes by the same block method with directions (μ − S)⁻¹ u from a sparse factorisation.
    ShiftInvert,
}

/// How it was made sure that no eigenvalue above those returned is missing.
///
/// "Above" means above the last eigenvalue of the spectrum, copies of it included, or above the
/// cutoff where one was asked for.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Verification {
    /// All eigenvalues were computed.
    Dense,
    /// A sparse factorisation S − c·1 = L D Lᵀ just below the last eigenvalue returned, or at the
    /// cutoff, has as many positive pivots as there are modes (Sylvester's law of inertia); its
    /// rounding errors, bounded after the fact, move no eigenvalue across c.
    Inertia {
        /// Eigenvalues above c, all of them returned.
        count: usize,
    },
    /// Random vectors, filtered on the complement of the modes, showed nothing above.
    Probed {
        /// How many vectors.
        probes: usize,
        /// 1 less a bound on the probability that these vectors miss an eigenvalue that is there.
        confidence: f64,
    },
}

/// Leading modes of a coupling matrix.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
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
    /// 1e-10 max_i |w_ii| and ten times the largest residual allowed. Those so close to 0 are told
    /// apart on their own scale instead, and from the zero modes, one for each component.
    pub tolerance: f64,
    /// Where all modes with λ_k above a cutoff were asked for, that cutoff: whatever was not computed
    /// lies below it.
    pub cutoff: Option<f64>,
    /// Which solver found them.
    pub solver: Solver,
    /// Matrix–vector products spent on finding the modes (0 for the dense solver); a solution of a
    /// factorised system counts as one.
    pub products: usize,
    /// How it was made sure that none is missing.
    pub verification: Verification,
}

impl Spectrum {
    /// How far eigenvalue λ_k, counted from 0, may be off. An eigenvalue lies within the residual of it.
    /// Those within [`Self::tolerance`] of 0 are Rayleigh quotients found by differences, and off by
    /// r²/gap only, r the residual and gap the distance to all others (Parlett, The Symmetric Eigenvalue
    /// Problem (1980), Sec. 11.7).
    pub fn error(&self, k: usize) -> f64 {
        let (lambda, residual) = (self.eigenvalues[k], self.residuals[k]);
        let is_slow = |lambda: &f64| lambda.abs() <= self.tolerance;
        match self.eigenvalues.iter().find(|lambda| !is_slow(lambda)) {
            Some(next) if is_slow(&lambda) => residual.min(residual * residual / next.abs()),
            _ => residual,
        }
    }
}
