//! Leading modes by a block Davidson method: Rayleigh–Ritz on a basis that grows by amplified Ritz
//! vectors.
//!
//! The search starts from the null space of S, which is known. Long Lanczos sequences, which cost the fewest
//! products, find one copy of each eigenvalue ([`LongSequence`]). Blocks find several: the first
//! Ritz vectors that have not converged are amplified by a Chebyshev filter (Zhou & Saad, SIAM J. Matrix
//! Anal. Appl. 29, 954 (2007)), made orthogonal to the basis, and added; when it is full it is cut down
//! to its leading Ritz vectors. Probes that find a copy missing at the end enter the same basis: no
//! modes are handed over before [`crate::completeness`] has been satisfied.

use faer::Mat;
use graph::SymmetricForm;

use crate::completeness::Verifier;
use crate::completeness::claim::Claim;
use crate::error::SpectraError;
use crate::found::{Eigenpairs, Found};
use crate::matrix::null_space::NullSpace;
use crate::matrix::product::Links;
use crate::plan::Plan;
use crate::progress::{Advance, Progress};
use crate::solvers::chebyshev_davidson::amplifier::{Amplifier, Situation};
use crate::solvers::chebyshev_davidson::long_sequence::LongSequence;
use crate::solvers::chebyshev_davidson::search_space::Projected;
use crate::solvers::chebyshev_davidson::stagnation::Stagnation;
use crate::vectors::basis::Basis;
use crate::vectors::block::Block;
use crate::vectors::random::Random;
use crate::vectors::small_eigen::Eigen;
use crate::verification::Verification;

/// Most vectors added at once.
const WIDTH: usize = 4;
/// Fewest: products with two vectors cost little more than with one, and find pairs.
const NARROWEST: usize = 2;
/// Blocks that fit into the basis beyond the vectors kept at a restart.
const FRESH_BLOCKS: usize = 10;

/// The state of a search.
pub(crate) struct Search<'a> {
    w: &'a SymmetricForm<'a>,
    links: &'a Links<'a>,
    plan: &'a Plan,
    progress: Progress<'a>,
    space: Projected,
    /// Eigenvalues of the leading Ritz vectors that have converged.
    settled: Vec<f64>,
    random: Random,
    products: usize,
    /// Verifications so far.
    tries: u32,
}

/// What a look at the leading Ritz vectors found.
struct Front {
    /// |S u − θ u| of the first Ritz vector that has not converged; none when all have.
    residual: Option<f64>,
}

impl<'a> Search<'a> {
    /// A search that knows the null space of S.
    pub fn new(
        (w, links): (&'a SymmetricForm<'a>, &'a Links<'a>),
        plan: &'a Plan,
        random: Random,
        products: usize,
        progress: Progress<'a>,
    ) -> Result<Self, SpectraError> {
        let null_space = NullSpace::of(w);
        plan.wanted.check(&vec![0.0; null_space.dimension()], plan.grouping)?;
        let mut basis = Basis::empty(w.n_nodes());
        for vector in null_space.vectors() {
            basis.push(&vector);
        }
        let settled = vec![0.0; basis.len()];
        let space = Projected::null_space(basis);
        Ok(Self { w, links, plan, progress, space, settled, random, products, tries: 0 })
    }

    /// Solves until nothing is missing.
    pub fn run(
        mut self,
        amplifier: &Amplifier<'_>,
        verifier: &Verifier<'_>,
    ) -> Result<(Found, Verification), SpectraError> {
        let most_steps = LongSequence::most_steps(self.w.n_nodes());
        let mut stagnation = Stagnation::default();
        if most_steps.is_none() {
            self.extend(None)?;
        }
        loop {
            let mut ritz = self.space.ritz()?;
            if self.space.basis.len() == self.w.n_nodes() {
                return self.everything(ritz);
            }
            let front = self.settle(&ritz)?;
            let due = stagnation.sequence_is_due(
                self.settled.len(),
                front.residual,
                self.plan.residual_bound,
            );
            self.plan.wanted.check(&self.settled, self.plan.grouping)?;
            self.advance(&ritz).tell(self.progress)?;
            if let Some(n_modes) = self.complete(&ritz, &front)
                && self.all_converged(&ritz, n_modes)?
            {
                let n_vectors = ritz.values.len();
                ritz = self.space.rotate(ritz, n_vectors);
                match self.verify(&ritz, &front, n_modes, verifier)? {
                    Ok(verification) => return Ok((self.hand_over(&ritz, n_modes), verification)),
                    Err(block) => self.extend(block)?,
                }
                stagnation.continue_in_blocks();
                continue;
            }
            let kept = self.kept(&ritz).min(ritz.values.len());
            let full = self.space.basis.len() + WIDTH > kept + FRESH_BLOCKS * WIDTH + kept / 2;
            let most_steps = most_steps.filter(|_| due);
            if full || most_steps.is_some() {
                ritz = self.space.rotate(ritz, kept);
            }
            if let Some(most_steps) = most_steps {
                self.extend_by_sequence(&ritz, amplifier, most_steps)?;
            } else {
                let amplified = self.amplified(&ritz, amplifier)?;
                self.extend(amplified)?;
            }
        }
    }

    /// The modes when the basis is one of all space, and every Ritz vector an eigenvector.
    fn everything(mut self, ritz: Eigen) -> Result<(Found, Verification), SpectraError> {
        self.plan.wanted.check(&ritz.values, self.plan.grouping)?;
        let n_modes =
            self.plan.wanted.complete(&ritz.values, f64::NEG_INFINITY, self.plan.grouping);
        let n_modes = n_modes.expect("all modes are complete");
        let ritz = self.space.rotate(ritz, n_modes);
        Ok((self.hand_over(&ritz, n_modes), Verification::Dense))
    }

    /// The next block: the first Ritz vectors that have not converged, amplified.
    fn amplified(
        &mut self,
        ritz: &Eigen,
        amplifier: &Amplifier<'_>,
    ) -> Result<Option<Block>, SpectraError> {
        let first = self.settled.len();
        let width = self.width(ritz).min(ritz.values.len() - first);
        if width == 0 {
            return Ok(None);
        }
        let situation = Situation {
            top: ritz.values[0],
            guard: ritz.values.get(self.kept(ritz)).copied(),
            cutoff: self.plan.wanted.cutoff(),
        };
        let block = self.space.basis.combine(ritz.columns(first, width));
        let asked = self.advance(ritz).asked(self.progress);
        self.spend(amplifier.products(&situation) * width)?;
        amplifier.apply(block, &situation, &asked).map(Some)
    }

    /// Adds the Ritz vectors of a long sequence that starts from those that have not converged; the
    /// basis consists of Ritz vectors.
    fn extend_by_sequence(
        &mut self,
        ritz: &Eigen,
        amplifier: &Amplifier<'_>,
        most_steps: usize,
    ) -> Result<(), SpectraError> {
        let n_settled = self.settled.len();
        let start = if n_settled < ritz.values.len() {
            let front = |k, _| if k < n_settled { 0.0 } else { 1.0 };
            self.space.basis.combine(Mat::from_fn(ritz.values.len(), 1, front).as_ref())
        } else {
            self.random.block(self.w.n_nodes(), 1)
        };
        let known = self.space.basis.first(n_settled);
        let (settled, plan) = (&self.settled, self.plan);
        let needed = |values: &[f64]| {
            let all: Vec<f64> = settled.iter().chain(values).copied().collect();
            plan.wanted.known(&all, plan.grouping) - n_settled
        };
        let sequence = LongSequence {
            links: self.links,
            known: &known,
            stretch: amplifier.stretch(ritz.values[0], ritz.values.get(n_settled)),
            residual_bound: plan.residual_bound,
            grouping: plan.grouping,
            scale: plan.scale,
        };
        let most_steps = most_steps.min(plan.max_products.saturating_sub(self.products));
        let asked = self.advance(ritz).asked(self.progress);
        let (vectors, products) = sequence.run(start, most_steps, needed, &asked)?;
        self.spend(products)?;
        for block in vectors {
            self.extend(Some(block))?;
        }
        Ok(())
    }

    /// Vectors to work on: as many as are missing, within bounds.
    fn width(&self, ritz: &Eigen) -> usize {
        let known = self.plan.wanted.known(&ritz.values, self.plan.grouping);
        known.saturating_sub(self.settled.len()).clamp(NARROWEST, WIDTH)
    }

    /// Adds a block to the basis; a random one where there is none, or nothing new in it.
    fn extend(&mut self, block: Option<Block>) -> Result<(), SpectraError> {
        let n_rows = self.space.basis.n_rows();
        let missing = n_rows - self.space.basis.len();
        if missing == 0 {
            return Ok(());
        }
        let new = block.map_or(Ok(None), |block| self.space.basis.orthonormalise(block))?;
        let random = &mut self.random;
        let new = new.map_or_else(
            || self.space.basis.orthonormalise(random.block(n_rows, WIDTH.min(missing))),
            |block| Ok(Some(block)),
        )?;
        let block = new.ok_or_else(|| self.unproven())?;
        self.spend(block.width())?;
        let image = self.links.multiply(&block);
        self.space.append(&block, &image);
        Ok(())
    }

    /// Finds out how many of the leading Ritz vectors have converged.
    fn settle(&mut self, ritz: &Eigen) -> Result<Front, SpectraError> {
        let moved = |(before, now): (&f64, &f64)| (before - now).abs() > self.plan.residual_bound;
        if let Some(k) = self.settled.iter().zip(&ritz.values).position(moved) {
            self.settled.truncate(k);
        }
        loop {
            let first = self.settled.len();
            let width = self.width(ritz).min(ritz.values.len() - first);
            if width == 0 {
                return Ok(Front { residual: None });
            }
            let residuals = self.residuals(ritz, first, width)?;
            let converged =
                residuals.iter().take_while(|&&r| r <= 0.5 * self.plan.residual_bound).count();
            self.settled.extend(&ritz.values[first..first + converged]);
            if converged < width {
                return Ok(Front { residual: Some(residuals[converged]) });
            }
        }
    }

    /// |S u − θ u| of some Ritz vectors.
    fn residuals(
        &mut self,
        ritz: &Eigen,
        first: usize,
        count: usize,
    ) -> Result<Vec<f64>, SpectraError> {
        self.spend(count)?;
        let block = self.space.basis.combine(ritz.columns(first, count));
        let mut image = self.links.multiply(&block);
        let minus: Vec<f64> = ritz.values[first..first + count].iter().map(|t| -t).collect();
        image.add_scaled(&block, &minus);
        Ok(image.norms())
    }

    /// How many modes to hand over, as soon as they have converged and the next one lies apart.
    fn complete(&self, ritz: &Eigen, front: &Front) -> Option<usize> {
        let next = self.next(ritz, front);
        self.plan.wanted.complete_of_found(&self.settled, next, self.plan.grouping)
    }

    /// The most that the first Ritz value that has not converged stands for.
    fn next(&self, ritz: &Eigen, front: &Front) -> f64 {
        front.residual.map_or(f64::NEG_INFINITY, |r| ritz.values[self.settled.len()] + r)
    }

    /// Looks at the residuals of all modes once more: those found first may have moved since.
    fn all_converged(&mut self, ritz: &Eigen, n_modes: usize) -> Result<bool, SpectraError> {
        for range in Block::ranges(n_modes) {
            let residuals = self.residuals(ritz, range.start, range.len())?;
            let bound = self.plan.residual_bound;
            if let Some(k) = residuals.iter().position(|&r| r > bound) {
                self.settled.truncate(range.start + k);
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// The verification, or a block that shows, or may show, that something is missing.
    fn verify(
        &mut self,
        ritz: &Eigen,
        front: &Front,
        n_modes: usize,
        verifier: &Verifier<'_>,
    ) -> Result<Result<Verification, Option<Block>>, SpectraError> {
        let n_settled = self.settled.len();
        let next = if n_modes < n_settled { self.settled[n_modes] } else { self.next(ritz, front) };
        let last = ritz.values[n_modes - 1];
        let beyond = 2 * Block::WIDEST.min((ritz.values.len() - n_modes) / 2);
        let mut residuals = Vec::new();
        for first in [n_modes, n_modes + beyond / 2].into_iter().filter(|_| beyond > 0) {
            residuals.extend(self.residuals(ritz, first, beyond / 2)?);
        }
        let claim = Claim {
            n_modes,
            last,
            wanted: self.plan.wanted,
            next,
            top: ritz.values[0],
            beyond: ritz.values[n_modes..].iter().copied().zip(residuals).collect(),
            products_left: self.plan.max_products.saturating_sub(self.products),
            products_spent: self.products,
            tries: self.tries,
        };
        self.tries += 1;
        let outcome = verifier.verify(&claim, &self.space.basis, &mut self.random)?;
        self.products += outcome.products;
        Ok(match outcome.verification {
            Some(verification) => Ok(verification),
            None => Err(outcome.block),
        })
    }

    /// Vectors that survive a restart.
    fn kept(&self, ritz: &Eigen) -> usize {
        let known = self.plan.wanted.known(&ritz.values, self.plan.grouping);
        known.max(self.settled.len()) + 2 * WIDTH
    }

    fn spend(&mut self, products: usize) -> Result<(), SpectraError> {
        self.plan.spend(&mut self.products, products, self.settled.len())
    }

    fn unproven(&self) -> SpectraError {
        self.plan.exhausted(self.settled.len(), self.products)
    }

    /// How far it has come.
    fn advance(&self, ritz: &Eigen) -> Advance {
        Advance {
            products: self.products,
            converged: self.settled.len(),
            wanted: self.plan.wanted.known(&ritz.values, self.plan.grouping),
        }
    }

    /// The leading vectors of a basis that consists of Ritz vectors.
    fn hand_over(self, ritz: &Eigen, n_modes: usize) -> Found {
        let vectors = (0..n_modes).map(|k| self.space.basis.vector(k)).collect();
        let values = ritz.values[..n_modes].to_vec();
        Found { pairs: Eigenpairs { values, vectors }, products: self.products }
    }
}
