//! Whether modes are all there are above the last of them: by inertia, or by probing.

use graph::CouplingMatrix;

use crate::block::{Basis, Block};
use crate::chebyshev::Filter;
use crate::factorisation::DENSE_SPEED;
use crate::factorisation::Symbolic;
use crate::inertia;
use crate::probing::{Probe, Probed};
use crate::random::Random;
use crate::wanted::Wanted;
use crate::{SpectraError, Verification};

/// Products that verifying may take whatever the solve took.
const FREE_PRODUCTS: usize = 2000;

/// With less than this, and no products left, completeness is unproven.
const LEAST_CONFIDENCE: f64 = 0.99;

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
    /// Random vectors to probe with.
    pub probes: usize,
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

/// Verifies modes of one matrix.
pub(crate) struct Verifier<'a> {
    pub w: &'a CouplingMatrix,
    pub symbolic: Option<&'a Symbolic<'a>>,
    pub filter: &'a Filter<'a>,
    /// At most the smallest eigenvalue.
    pub low: f64,
    /// Eigenvalues closer than this are equal.
    pub grouping: f64,
}

impl Verifier<'_> {
    /// By inertia where there is a factorisation that is accurate enough, by probing otherwise.
    pub fn verify(
        &self,
        claim: &Claim,
        basis: &Basis,
        random: &mut Random,
    ) -> Result<Outcome, SpectraError> {
        if claim.n_modes == self.w.n_nodes() {
            let verification = Some(Verification::Dense);
            return Ok(Outcome { verification, block: None, products: 0, above: None });
        }
        match self.by_inertia(claim) {
            Some(outcome) => Ok(outcome),
            None => self.by_probing(claim, basis, random),
        }
    }

    /// Counts between the last mode and the next; none where the count is not certain.
    fn by_inertia(&self, claim: &Claim) -> Option<Outcome> {
        let affordable = FREE_PRODUCTS.max(claim.products_spent) * self.w.symmetric().nnz();
        let symbolic = self.symbolic.filter(|s| s.operations <= DENSE_SPEED * affordable as f64)?;
        let limit = claim.wanted.limit(claim.last, self.grouping);
        let next = claim.next.max(self.low - self.grouping);
        // Halfway, or nearer to the modes when a pivot happens to be zero or small.
        [0.5, 0.37, 0.71].into_iter().find_map(|share| {
            let c = limit - share * (limit - next);
            let count = inertia::count_above(symbolic, c)?;
            if count.above >= claim.n_modes && count.uncertainty < limit - c {
                let verification = (count.above == claim.n_modes)
                    .then_some(Verification::Inertia { count: count.above });
                let above = Some(count.above);
                return Some(Outcome { verification, block: None, products: 0, above });
            }
            None
        })
    }

    fn by_probing(
        &self,
        claim: &Claim,
        basis: &Basis,
        random: &mut Random,
    ) -> Result<Outcome, SpectraError> {
        let affordable = claim.products_left.min(FREE_PRODUCTS.max(claim.products_spent));
        let limit = claim.wanted.limit(claim.last, self.grouping);
        let guards = Guards::new(claim, limit);
        let probe = Probe {
            low: self.low,
            expected: guards.next.max(self.low),
            limit: limit - guards.perturbation,
            top: claim.top,
            max_products: affordable,
            probes: claim.probes,
        };
        let deflated = (basis, claim.n_modes + guards.count);
        let Probed { block, theta, confidence, products, probes } =
            probe.send(self.w, self.filter, deflated, random)?;
        if confidence < LEAST_CONFIDENCE && products + probes > claim.products_left {
            let requested = claim.wanted.at_least();
            let products = claim.products_spent + products;
            return Err(SpectraError::CompletenessUnproven { requested, products });
        }
        let found_more = theta > claim.wanted.missing_from(claim.last, self.grouping);
        let verification = (!found_more).then_some(Verification::Probed { probes, confidence });
        Ok(Outcome { verification, block, products, above: None })
    }
}

/// Approximate eigenvectors below the modes that probes need not see: the gap that decides how long
/// probing takes is then that to the eigenvalues behind them.
///
/// With G the modes and guards, Θ their Ritz values and R = S G − G Θ, which is orthogonal to G, S
/// differs from the block-diagonal G Θ Gᵀ + (1 − G Gᵀ) S (1 − G Gᵀ) by R Gᵀ + G Rᵀ, whose norm is
/// ‖R‖. So if the second block has no eigenvalue from limit − ‖R‖ on, S has as many eigenvalues from
/// there on as Θ (Weyl).
struct Guards {
    count: usize,
    /// ‖R‖, at most.
    perturbation: f64,
    /// The largest eigenvalue expected behind the guards.
    next: f64,
}

impl Guards {
    /// As many as perturb by no more than a tenth of the gap below the modes.
    fn new(claim: &Claim, limit: f64) -> Self {
        let mut guards = Self { count: 0, perturbation: 0.0, next: claim.next };
        let Some(&(first, _)) = claim.beyond.first() else {
            return guards;
        };
        let allowed = 0.1 * (limit - first);
        let mut squares = 0.0;
        for (k, &(theta, residual)) in claim.beyond.iter().enumerate() {
            squares += residual * residual;
            if squares.sqrt() > allowed {
                guards.next = theta;
                break;
            }
            let next = claim.beyond.get(k + 1).map_or(theta, |&(next, _)| next);
            guards = Self { count: k + 1, perturbation: squares.sqrt(), next };
        }
        guards
    }
}
