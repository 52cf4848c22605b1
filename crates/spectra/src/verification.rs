//! Whether modes are all there are above the last of them: by inertia, or by probing.

use graph::CouplingMatrix;

use crate::block::Block;
use crate::factorisation::DENSE_SPEED;
use crate::factorisation::Symbolic;
use crate::inertia;
use crate::orthonormal::Basis;
use crate::probing::{Probe, Probed};
use crate::product::Links;
use crate::random::Random;
use crate::wanted::Wanted;
use crate::{SpectraError, Verification};

/// Products that a factorisation may be worth whatever the solve took.
const FREE_PRODUCTS: usize = 2000;
/// Products that probing may take whatever the solve took.
const FREE_PROBING: usize = 20_000;

/// Random vectors of the first probing.
const FIRST_PROBES: usize = 2;

/// By how much δ exceeds the least that it may be.
const STRICTLY: f64 = 1.01;

/// The largest residual of a guard, as a share of its distance to the limit.
const CONVERGED: f64 = 0.4;

/// With less than this completeness is unproven.
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
    /// Verifications before this one, none of which was final.
    pub tries: u32,
}

impl Claim {
    /// Random vectors to probe with: more each time.
    fn probes(&self) -> usize {
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

/// Verifies modes of one matrix.
pub(crate) struct Verifier<'a> {
    pub w: &'a CouplingMatrix,
    pub symbolic: Option<&'a Symbolic<'a>>,
    pub links: &'a Links<'a>,
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
            Some(count) if count == claim.n_modes => {
                let verification = Some(Verification::Inertia { count });
                Ok(Outcome { verification, block: None, products: 0, above: Some(count) })
            }
            // Probes find what the count says is missing.
            Some(count) => {
                let probes = (count - claim.n_modes).min(Block::WIDEST);
                let outcome = self.by_probing(claim, probes, basis, random)?;
                Ok(Outcome { verification: None, above: Some(count), ..outcome })
            }
            None => self.by_probing(claim, claim.probes(), basis, random),
        }
    }

    /// Counts between the last mode and the next; none where the count is not certain.
    fn by_inertia(&self, claim: &Claim) -> Option<usize> {
        let affordable = FREE_PRODUCTS.max(claim.products_spent) * self.w.symmetric().nnz();
        let symbolic = self.symbolic.filter(|s| s.operations <= DENSE_SPEED * affordable as f64)?;
        let limit = claim.wanted.limit(claim.last, self.grouping);
        let next = claim.next.max(self.low - self.grouping);
        // Halfway, or nearer to the modes when a pivot happens to be zero or small.
        [0.5, 0.37, 0.71].into_iter().find_map(|share| {
            let c = limit - share * (limit - next);
            let count = inertia::count_above(symbolic, c)?;
            let certain = count.above >= claim.n_modes && count.uncertainty < limit - c;
            certain.then_some(count.above)
        })
    }

    /// With guards first; where what the probes show lies between what is asked of them and what would
    /// be a missing mode, without.
    fn by_probing(
        &self,
        claim: &Claim,
        probes: usize,
        basis: &Basis,
        random: &mut Random,
    ) -> Result<Outcome, SpectraError> {
        let limit = claim.wanted.limit(claim.last, self.grouping);
        let affordable = claim.products_left.min(FREE_PROBING.max(claim.products_spent));
        let send = |guards: &Guards, max_products: usize, random: &mut Random| {
            let probe = Probe {
                low: self.low,
                expected: guards.next.max(self.low),
                limit: limit - guards.perturbation,
                top: claim.top,
                max_products,
                probes,
            };
            probe.send(self.links, (basis, claim.n_modes + guards.count), random)
        };
        let is_missing = |theta| theta > claim.wanted.missing_from(claim.last, self.grouping);
        let is_open =
            |probed: &Probed| probed.confidence < LEAST_CONFIDENCE && !is_missing(probed.theta);
        let guards = Guards::new(claim, limit);
        let mut probed = send(&guards, affordable, random)?;
        if guards.count > 0 && is_open(&probed) {
            let spent = probed.products;
            probed = send(&Guards::none(claim), affordable.saturating_sub(spent), random)?;
            probed.products += spent;
        }
        if is_open(&probed) && (probed.block.is_none() || claim.probes() == Block::WIDEST) {
            return Err(SpectraError::CompletenessUnproven {
                requested: claim.wanted.at_least(),
                products: claim.products_spent + probed.products,
            });
        }
        let is_proven = !is_open(&probed) && !is_missing(probed.theta);
        let Probed { block, confidence, products, probes, .. } = probed;
        // What is neither proven nor missing lies next to the limit: more vectors there settle it.
        let verification = is_proven.then_some(Verification::Probed { probes, confidence });
        Ok(Outcome { verification, block, products, above: None })
    }
}

/// Approximate eigenvectors below the modes that probes need not see: the gap that decides how long
/// probing takes is then that to the eigenvalues behind them.
///
/// Let G be modes and guards, Θ their Ritz values, R = S G − G Θ, which is orthogonal to G, and B the
/// rest of S, (1 − G Gᵀ) S (1 − G Gᵀ). If all eigenvalues of B lie below Λ − δ, S − Λ has as many
/// that are not negative as its Schur complement Θ − Λ + Rᵀ (Λ − B)⁻¹ R (Haynsworth, Linear Algebra
/// Appl. 1, 73 (1968)), whose last term is at most Rᵀ R / δ. On the guards, with Ritz values θ and
/// residuals r, it is negative where Σ ‖r‖² / (Λ − θ) < δ, the trace of a product that must have a norm
/// below 1. Then S has no more eigenvalues from Λ on than there are modes.
struct Guards {
    count: usize,
    /// δ.
    perturbation: f64,
    /// The largest eigenvalue expected behind the guards.
    next: f64,
}

impl Guards {
    fn none(claim: &Claim) -> Self {
        Self { count: 0, perturbation: 0.0, next: claim.next }
    }

    /// As many as leave the widest gap, of those that have converged well enough.
    fn new(claim: &Claim, limit: f64) -> Self {
        let mut best = Self::none(claim);
        let mut sum = 0.0;
        for (k, &(theta, residual)) in claim.beyond.iter().enumerate() {
            if residual > CONVERGED * (limit - theta) {
                break;
            }
            sum += residual * residual / (limit - theta);
            // A Ritz value that has hardly converged says little of what lies behind it.
            let behind = |&(next, residual): &(f64, f64)| f64::min(next + residual, theta);
            let next = claim.beyond.get(k + 1).map_or(theta, behind);
            let guards = Self { count: k + 1, perturbation: STRICTLY * sum, next };
            if guards.gap(limit) > best.gap(limit) {
                best = guards;
            }
        }
        best
    }

    fn gap(&self, limit: f64) -> f64 {
        limit - self.perturbation - self.next
    }
}
