//! Leading modes by a block Davidson method: Rayleigh–Ritz on a basis that grows by amplified Ritz
//! vectors.
//!
//! From the basis V, V ᵀ S V = Q Θ Qᵀ gives Ritz vectors V q. The first of them that have not
//! converged are amplified in the wanted directions, by a Chebyshev filter (Zhou & Saad, SIAM J.
//! Matrix Anal. Appl. 29, 954 (2007)) or by (μ − S)⁻¹ (the span is then that of a block Lanczos
//! method on the inverse), made orthogonal to V, and added; when V is full it is cut down to its
//! leading Ritz vectors, unless it is a basis of all space. Blocks find up to four copies of an eigenvalue at once and further ones
//! through the probes at the end, which enter the same basis: no copy is handed over as missing
//! before [`crate::verification`] has been satisfied.
//!
//! The search starts from the kernel of S, which is known.

use faer::{Mat, MatRef};
use graph::CouplingMatrix;

use crate::basis::Eigenpairs;
use crate::block::{Basis, Block};
use crate::completeness::Found;
use crate::dense::symmetric_eigen;
use crate::expansion::{Amplifier, Situation};
use crate::kernel::{components, kernel};
use crate::probing::FIRST_PROBES;
use crate::product::multiply_block;
use crate::progress::{Advance, Progress};
use crate::random::Random;
use crate::request::Plan;
use crate::verification::{Claim, Verifier};
use crate::{SpectraError, Verification};

/// Most vectors added at once.
const WIDTH: usize = 4;
/// Fewest: products with two vectors cost little more than with one, and find pairs.
const NARROWEST: usize = 2;
/// Blocks that fit into the basis beyond the vectors kept at a restart.
const FRESH_BLOCKS: usize = 10;

/// Ritz values, descending, and their coordinates in the basis.
struct Ritz {
    values: Vec<f64>,
    coordinates: Mat<f64>,
}

impl Ritz {
    fn columns(&self, first: usize, count: usize) -> MatRef<'_, f64> {
        self.coordinates.as_ref().subcols(first, count)
    }
}

/// The state of a search.
pub(crate) struct Search<'a> {
    w: &'a CouplingMatrix,
    plan: &'a Plan,
    progress: Progress<'a>,
    basis: Basis,
    /// Rows of the lower triangle of Vᵀ S V.
    projected: Vec<Vec<f64>>,
    /// Eigenvalues of the leading Ritz vectors that have converged.
    settled: Vec<f64>,
    random: Random,
    products: usize,
    /// Random vectors of the next verification: more each time that one has found something.
    probes: usize,
}

/// What a look at the leading Ritz vectors found.
struct Front {
    /// |S u − θ u| of the first Ritz vector that has not converged; none when all have.
    residual: Option<f64>,
}

impl<'a> Search<'a> {
    /// A search that knows the kernel of S.
    pub fn new(
        w: &'a CouplingMatrix,
        plan: &'a Plan,
        random: Random,
        products: usize,
        progress: Progress<'a>,
    ) -> Result<Self, SpectraError> {
        let components = components(w);
        plan.wanted.check(&vec![0.0; components.count], plan.grouping)?;
        let mut basis = Basis::empty(w.n_nodes());
        for vector in kernel(w, &components) {
            basis.push(&vector);
        }
        let projected = (0..basis.len()).map(|k| vec![0.0; k + 1]).collect();
        let settled = vec![0.0; basis.len()];
        let probes = FIRST_PROBES;
        Ok(Self { w, plan, progress, basis, projected, settled, random, products, probes })
    }

    /// Solves until nothing is missing.
    pub fn run(
        mut self,
        amplifier: &Amplifier<'_>,
        verifier: &Verifier<'_>,
    ) -> Result<(Found, Verification), SpectraError> {
        let mut addition = None;
        loop {
            self.extend(addition.take())?;
            let mut ritz = self.ritz()?;
            if self.basis.len() == self.w.n_nodes() {
                return self.everything(&ritz);
            }
            let front = self.settle(&ritz)?;
            self.plan.wanted.check(&self.settled, self.plan.grouping)?;
            self.report(&ritz);
            if let Some(n_modes) = self.complete(&ritz, &front)
                && self.all_converged(&ritz, n_modes)?
            {
                self.rotate(&ritz, ritz.values.len());
                ritz = self.rotated(&ritz);
                match self.verify(&ritz, &front, n_modes, verifier)? {
                    Ok(verification) => return Ok((self.hand_over(&ritz, n_modes), verification)),
                    Err(block) => addition = block,
                }
            } else {
                let kept = self.kept(&ritz);
                if self.basis.len() + WIDTH > kept + FRESH_BLOCKS * WIDTH + kept / 2 {
                    self.rotate(&ritz, kept.min(ritz.values.len()));
                    ritz = self.rotated(&ritz);
                }
                addition = self.amplified(&ritz, amplifier)?;
            }
        }
    }

    /// The modes when the basis is one of all space, and every Ritz vector an eigenvector.
    fn everything(mut self, ritz: &Ritz) -> Result<(Found, Verification), SpectraError> {
        self.plan.wanted.check(&ritz.values, self.plan.grouping)?;
        let n_modes =
            self.plan.wanted.complete(&ritz.values, f64::NEG_INFINITY, self.plan.grouping);
        let n_modes = n_modes.expect("all modes are complete");
        self.rotate(ritz, n_modes);
        Ok((self.hand_over(ritz, n_modes), Verification::Dense))
    }

    /// The next block: the first Ritz vectors that have not converged, amplified.
    fn amplified(
        &mut self,
        ritz: &Ritz,
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
        let block = self.basis.combine(ritz.columns(first, width));
        self.spend(amplifier.products(&situation) * width)?;
        Ok(Some(amplifier.apply(block, &situation)))
    }

    /// Vectors to work on: as many as are missing, within bounds.
    fn width(&self, ritz: &Ritz) -> usize {
        let known = self.plan.wanted.known(&ritz.values, self.plan.grouping);
        known.saturating_sub(self.settled.len()).clamp(NARROWEST, WIDTH)
    }

    /// Adds a block to the basis; a random one where there is none, or nothing new in it.
    fn extend(&mut self, block: Option<Block>) -> Result<(), SpectraError> {
        let n_rows = self.basis.n_rows();
        let missing = n_rows - self.basis.len();
        if missing == 0 {
            return Ok(());
        }
        let new = block.map_or(Ok(None), |block| self.basis.orthonormalise(block))?;
        let random = &mut self.random;
        let new = new.map_or_else(
            || self.basis.orthonormalise(random.block(n_rows, WIDTH.min(missing))),
            |block| Ok(Some(block)),
        )?;
        let block = new.ok_or_else(|| self.unproven())?;
        self.spend(block.width())?;
        let image = multiply_block(self.w.symmetric(), &block);
        let before = self.basis.len();
        self.basis.append(&block);
        let overlaps = self.basis.overlaps(&image);
        for v in 0..block.width() {
            let inside = |k: usize| 0.5 * (overlaps[(k, v)] + overlaps[(before + v, k - before)]);
            let row = (0..=before + v)
                .map(|k| if k < before { overlaps[(k, v)] } else { inside(k) })
                .collect();
            self.projected.push(row);
        }
        Ok(())
    }

    fn ritz(&self) -> Result<Ritz, SpectraError> {
        let n_vectors = self.basis.len();
        let pairs = symmetric_eigen(n_vectors, |i, j| self.projected[i][j])?;
        let coordinates = Mat::from_fn(n_vectors, n_vectors, |i, k| pairs.vectors[k][i]);
        Ok(Ritz { values: pairs.values, coordinates })
    }

    /// Finds out how many of the leading Ritz vectors have converged.
    fn settle(&mut self, ritz: &Ritz) -> Result<Front, SpectraError> {
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
        ritz: &Ritz,
        first: usize,
        count: usize,
    ) -> Result<Vec<f64>, SpectraError> {
        self.spend(count)?;
        let block = self.basis.combine(ritz.columns(first, count));
        let mut image = multiply_block(self.w.symmetric(), &block);
        let minus: Vec<f64> = ritz.values[first..first + count].iter().map(|t| -t).collect();
        image.add_scaled(&block, &minus);
        Ok(image.norms())
    }

    /// How many modes to hand over, as soon as they have converged and the next one lies apart.
    fn complete(&self, ritz: &Ritz, front: &Front) -> Option<usize> {
        let complete = |values, next| self.plan.wanted.complete(values, next, self.plan.grouping);
        // The last one settled bounds what follows more tightly than one that has not converged.
        let without_last = || {
            let (&last, before) = self.settled.split_last()?;
            complete(before, last)
        };
        complete(&self.settled, self.next(ritz, front)).or_else(without_last).filter(|&n| n > 0)
    }

    /// The most that the first Ritz value that has not converged stands for.
    fn next(&self, ritz: &Ritz, front: &Front) -> f64 {
        front.residual.map_or(f64::NEG_INFINITY, |r| ritz.values[self.settled.len()] + r)
    }

    /// Looks at the residuals of all modes once more: those found first may have moved since.
    fn all_converged(&mut self, ritz: &Ritz, n_modes: usize) -> Result<bool, SpectraError> {
        let mut first = 0;
        while first < n_modes {
            let count = 8.min(n_modes - first);
            let residuals = self.residuals(ritz, first, count)?;
            let bound = self.plan.residual_bound;
            if let Some(k) = residuals.iter().position(|&r| r > bound) {
                self.settled.truncate(first + k);
                return Ok(false);
            }
            first += count;
        }
        Ok(true)
    }

    /// The verification, or a block that shows, or may show, that something is missing.
    fn verify(
        &mut self,
        ritz: &Ritz,
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
            probes: self.probes,
        };
        let outcome = verifier.verify(&claim, &self.basis, &mut self.random)?;
        self.products += outcome.products;
        self.probes = (2 * self.probes).min(Block::WIDEST);
        Ok(match outcome.verification {
            Some(verification) => Ok(verification),
            None => Err(outcome.block),
        })
    }

    /// Replaces the basis by its leading Ritz vectors.
    fn rotate(&mut self, ritz: &Ritz, kept: usize) {
        self.basis.transform(ritz.columns(0, kept));
        self.projected = (0..kept)
            .map(|k| {
                let mut row = vec![0.0; k + 1];
                row[k] = ritz.values[k];
                row
            })
            .collect();
    }

    /// The Ritz pairs after [`Self::rotate`].
    fn rotated(&self, ritz: &Ritz) -> Ritz {
        let kept = self.basis.len();
        Ritz { values: ritz.values[..kept].to_vec(), coordinates: Mat::identity(kept, kept) }
    }

    /// Vectors that survive a restart.
    fn kept(&self, ritz: &Ritz) -> usize {
        let known = self.plan.wanted.known(&ritz.values, self.plan.grouping);
        known.max(self.settled.len()) + 2 * WIDTH
    }

    fn spend(&mut self, products: usize) -> Result<(), SpectraError> {
        if self.products + products > self.plan.max_products {
            return Err(self.unproven());
        }
        self.products += products;
        Ok(())
    }

    fn unproven(&self) -> SpectraError {
        self.plan.exhausted(self.settled.len(), self.products)
    }

    fn report(&self, ritz: &Ritz) {
        (self.progress)(Advance {
            products: self.products,
            converged: self.settled.len(),
            wanted: self.plan.wanted.known(&ritz.values, self.plan.grouping),
        });
    }

    /// The leading vectors of a basis that consists of Ritz vectors.
    fn hand_over(self, ritz: &Ritz, n_modes: usize) -> Found {
        let vectors = (0..n_modes).map(|k| self.basis.vector(k)).collect();
        let values = ritz.values[..n_modes].to_vec();
        Found { pairs: Eigenpairs { values, vectors }, products: self.products }
    }
}
