//! What a solver claims when it has found all modes wanted, and what its verification comes to.

use crate::plan::wanted::Wanted;
use crate::vectors::block::Block;
use crate::verification::Verification;

/// Random vectors of the first probing.
const FIRST_PROBES: usize = 2;

/// What is to be verified.
pub(crate) struct Claim {
    /// Number of modes, the first vectors of the basis.
    pub n_modes: usize,
    /// The last eigenvalue among them.
    pub last: f64,
    /// Which modes were wanted.
    pub wanted: Wanted,
    /// The largest eigenvalue of the complement, as far as known.
    pub next: f64,
    /// The largest eigenvalue.
    pub top: f64,
    /// The Ritz values of the vectors that follow the modes in the basis, which then consists of
    /// Ritz vectors, and their residuals.
    pub beyond: Vec<(f64, f64)>,
    /// Products that may still be spent.
    pub products_left: usize,
    /// Products that the modes took.
    pub products_spent: usize,
    /// Verifications before this one, none of which was final.
    pub tries: u32,
}

impl Claim {
    /// Random vectors to probe with: more each time.
    pub fn probes(&self) -> usize {
        (FIRST_PROBES << self.tries.min(8)).min(Block::WIDEST)
    }
}

/// What a verification came to.
pub(crate) struct Outcome {
    /// None when modes are missing.
    pub verification: Option<Verification>,
    /// Orthonormal vectors that belong to the search when modes are missing.
    pub block: Option<Block>,
    /// Products spent.
    pub products: usize,
    /// How many eigenvalues exceed a number between the last mode and the next, where that was counted.
    pub above: Option<usize>,
}
