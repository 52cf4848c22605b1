//! The spectrum of W: its eigenspaces, and how they were found.

use crate::eigenspace::Eigenspace;
use crate::solvers::Solver;
use crate::verification::Verification;

/// Leading modes of a coupling matrix, eigenspace by eigenspace.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Spectrum {
    /// Those computed, Re λ descending, at least one, none of them cut.
    pub eigenspaces: Vec<Eigenspace>,
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
    /// Number of nodes N.
    pub fn n_nodes(&self) -> usize {
        self.eigenspaces[0].basis[0].len()
    }

    /// Number of modes computed: the dimensions of all eigenspaces.
    pub fn n_modes(&self) -> usize {
        self.eigenspaces.iter().map(|space| space.basis.len()).sum()
    }

    /// Whether all N modes were computed.
    pub fn is_whole(&self) -> bool {
        self.n_modes() == self.n_nodes()
    }

    /// The largest ‖W v − λ v‖ of any mode.
    pub fn largest_residual(&self) -> f64 {
        let residuals = self.eigenspaces.iter().flat_map(|space| &space.residuals);
        residuals.copied().fold(0.0, f64::max)
    }
}
