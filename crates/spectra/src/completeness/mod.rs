//! Whether modes are all there are above the last of them: by inertia, or by a randomised test.

pub(crate) mod claim;
mod guards;
mod inertia;
mod randomised_test;

use graph::SymmetricForm;

use crate::completeness::claim::{Claim, Outcome};
use crate::completeness::guards::Guards;
use crate::completeness::randomised_test::{Probe, Probed};
use crate::error::SpectraError;
use crate::factorisation::symbolic::{DENSE_SPEED, Symbolic};
use crate::matrix::product::Links;
use crate::progress::{Advance, Progress};
use crate::vectors::basis::Basis;
use crate::vectors::block::Block;
use crate::vectors::random::Random;
use crate::verification::Verification;

/// Products that a factorisation may be worth whatever the solve took.
const FREE_PRODUCTS: usize = 2000;
/// Products that probing may take whatever the solve took.
const FREE_PROBING: usize = 20_000;

/// With less than this completeness is unproven.
const LEAST_CONFIDENCE: f64 = 0.99;

/// Verifies modes of one matrix.
pub(crate) struct Verifier<'a> {
    pub w: &'a SymmetricForm<'a>,
    pub symbolic: Option<&'a Symbolic<'a>>,
    pub links: &'a Links<'a>,
    /// At most the smallest eigenvalue.
    pub low: f64,
    /// Eigenvalues closer than this are equal.
    pub grouping: f64,
    /// Asked by probes whether to go on; a factorisation cannot be stopped on the way.
    pub progress: Progress<'a>,
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
        let n_modes = claim.n_modes;
        let send = |guards: &Guards, spent: usize, random: &mut Random| {
            let probe = Probe {
                low: self.low,
                expected: guards.next.max(self.low),
                limit: limit - guards.perturbation,
                top: claim.top,
                max_products: affordable.saturating_sub(spent),
                probes,
            };
            let products = claim.products_spent + spent;
            let advance = Advance { products, converged: n_modes, wanted: n_modes };
            let asked = advance.asked(self.progress);
            probe.send(self.links, (basis, n_modes + guards.count), random, &asked)
        };
        let is_missing = |theta| theta > claim.wanted.missing_from(claim.last, self.grouping);
        let is_open =
            |probed: &Probed| probed.confidence < LEAST_CONFIDENCE && !is_missing(probed.theta);
        let guards = Guards::new(claim, limit);
        let mut probed = send(&guards, 0, random)?;
        if guards.count > 0 && is_open(&probed) {
            let spent = probed.products;
            probed = send(&Guards::none(claim), spent, random)?;
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
