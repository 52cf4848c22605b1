//! Leading modes by a block Lanczos method on (μ − S)⁻¹, μ slightly above 0, with all vectors kept
//! orthogonal.
//!
//! Let the basis V be orthogonal to the null space of S, and (μ − S)⁻¹ V = V H + Q B with Q orthogonal to
//! V. An eigenpair H y = ν y has the residual Q B y, the eigenvalue λ = μ − 1/ν of S belongs to it,
//! and the vector
//!
//! ```text
//! û = (μ − S)⁻¹ V y / ν = V y + Q B y / ν        has        (S − λ) û = −Q B y / ν²
//! ```
//!
//! (Ericsson & Ruhe, Math. Comp. 35, 1251 (1980)). Where λ is close to 0, and ν large, these vectors
//! converge in half of the steps that V y would take. A last Rayleigh–Ritz step on S makes modes of
//! them. When V is full it is cut down to its leading Ritz vectors (Wu & Simon, SIAM J. Matrix Anal.
//! Appl. 22, 602 (2000)). Copies of an eigenvalue beyond the width of a block are found from random
//! vectors that enter when [`crate::completeness`] knows of them.

use faer::Mat;
use graph::SymmetricForm;

use crate::completeness::Verifier;
use crate::completeness::claim::Claim;
use crate::error::SpectraError;
use crate::factorisation::inverse::Inverse;
use crate::factorisation::symbolic::Symbolic;
use crate::found::Found;
use crate::matrix::null_space::NullSpace;
use crate::plan::Plan;
use crate::progress::{Advance, Progress};
use crate::solvers::shift_invert_lanczos::ritz::Modes;
use crate::vectors::basis::Basis;
use crate::vectors::block::Block;
use crate::vectors::projection::Projection;
use crate::vectors::random::Random;
use crate::vectors::small_eigen::Eigen;
use crate::verification::Verification;

/// Vectors that the inverse multiplies at once, at first: pairs of equal eigenvalues are frequent.
const WIDTH: usize = 2;
/// Random vectors that enter when eigenvalues are missing.
const ADDED: usize = 4;
/// Ritz vectors kept at a restart beside those wanted.
const SPARE: usize = 8;
/// Vectors that fit into the basis beyond those kept.
const FRESH: usize = 48;
/// Blocks less independent than this are made orthonormal vector by vector.
const INDEPENDENT: f64 = 1e-3;
/// Residuals expected must be smaller than the bound by this factor.
const STRICTNESS: f64 = 0.25;

/// The state of a search.
pub(crate) struct Search<'a> {
    w: &'a SymmetricForm<'a>,
    plan: &'a Plan,
    inverse: Inverse<'a>,
    progress: Progress<'a>,
    random: Random,
    products: usize,
    /// The eigenvectors that are locked, then V, in the order of elimination.
    basis: Basis,
    /// Eigenvalues of those locked: of the null space of S, and of others as accurate as they must be.
    locked: Vec<f64>,
    /// H.
    projected: Projection,
    /// Q; none when the basis is one of all space.
    next: Option<Block>,
    /// B.
    coupling: Mat<f64>,
    /// Vectors at the end of V that it couples to Q.
    coupled: usize,
    strictness: f64,
    /// Leading eigenvalues that have converged.
    n_settled: usize,
    /// How many eigenvalues a count has shown to be there.
    at_least: usize,
    /// Verifications so far.
    tries: u32,
}

/// Ritz values of the inverse, descending, their residuals, and their coordinates in V.
struct Ritz {
    nu: Vec<f64>,
    residuals: Vec<f64>,
    coordinates: Mat<f64>,
}

impl<'a> Search<'a> {
    /// A search that knows the null space of S.
    pub fn new(
        w: &'a SymmetricForm<'a>,
        plan: &'a Plan,
        (symbolic, shift): (&'a Symbolic<'a>, f64),
        mut random: Random,
        progress: Progress<'a>,
    ) -> Result<Self, SpectraError> {
        let null_space = NullSpace::of(w);
        plan.wanted.check(&vec![0.0; null_space.dimension()], plan.grouping)?;
        let width = WIDTH.min(w.n_nodes() - null_space.dimension());
        let mut start = || (width > 0).then(|| random.block(w.n_nodes(), width));
        let (inverse, (null_vectors, start)) =
            rayon::join(|| Inverse::new(symbolic, shift), || (null_space.vectors(), start()));
        let inverse = inverse.ok_or(SpectraError::NotPositiveDefinite { shift })?;
        let mut basis = Basis::empty(w.n_nodes());
        for vector in null_vectors {
            basis.append(&inverse.to_elimination(&Block::from_nodes(1, vector)));
        }
        let mut search = Self {
            w,
            plan,
            inverse,
            progress,
            random,
            products: 0,
            locked: vec![0.0; basis.len()],
            basis,
            projected: Projection::default(),
            next: None,
            coupling: Mat::new(),
            coupled: 0,
            strictness: STRICTNESS,
            n_settled: 0,
            at_least: 0,
            tries: 0,
        };
        if let Some(start) = &start {
            search.enter(start)?;
        }
        Ok(search)
    }

    /// Solves until nothing is missing.
    pub fn run(mut self, verifier: &Verifier<'_>) -> Result<(Found, Verification), SpectraError> {
        loop {
            if let Some(block) = self.next.take() {
                self.extend(&block)?;
            }
            let ritz = self.ritz()?;
            let (settled, next) = self.settled(&ritz);
            self.n_settled = settled.len();
            self.plan.wanted.check(&settled, self.plan.grouping)?;
            let (products, converged) = (self.products, self.n_settled);
            let advance = Advance { products, converged, wanted: self.known(&ritz) };
            advance.tell(self.progress)?;
            let is_all = self.next.is_none();
            let enough = is_all || settled.len() >= self.at_least;
            if let Some(n_modes) = self.complete(&settled, next).filter(|_| enough) {
                let next = settled.get(n_modes).copied().unwrap_or(next);
                let modes = self.modes(&ritz, settled.len())?;
                if let Some(found) = self.verified(modes, n_modes, next, verifier)? {
                    return Ok(found);
                }
            } else {
                self.restart(&ritz);
            }
        }
    }

    /// Multiplies Q, which enters the basis, and finds the next one.
    fn extend(&mut self, block: &Block) -> Result<(), SpectraError> {
        self.spend(block.width())?;
        let mut image = block.clone();
        self.inverse.apply(&mut image);
        let (before, width) = (self.projected.len(), block.width());
        // A block couples to those from which it came, and to itself.
        let first = before - self.coupled;
        self.basis.append(block);
        let coupled = self.locked.len() + first..self.basis.len();
        let overlaps = self.basis.overlaps_in(coupled.clone(), &image);
        self.projected.append(first, overlaps.as_ref());
        self.coupled = width;
        let mut rest = image.clone();
        self.basis.subtract(coupled, &mut rest, overlaps.as_ref());
        let next = if rest.independence()? > INDEPENDENT {
            self.basis.orthonormalise(rest)?
        } else {
            // Nothing of the rest may be left out as dependent: it would be missing from Q B.
            self.basis.orthonormalise_one_by_one(&rest)?
        };
        let Some(next) = next else {
            return self.enter_random(WIDTH);
        };
        let b = next.overlaps(&image);
        self.coupling = Mat::from_fn(next.width(), before + width, |i, k| {
            if k < before { 0.0 } else { b[(i, k - before)] }
        });
        self.next = Some(next);
        Ok(())
    }

    /// Random vectors in the place of Q, or beside it.
    fn enter_random(&mut self, width: usize) -> Result<(), SpectraError> {
        let n_rows = self.basis.n_rows();
        let present = self.next.as_ref().map_or(0, Block::width);
        let width = width.min(n_rows - self.basis.len() - present);
        if width == 0 {
            return Ok(());
        }
        let random = self.random.block(n_rows, width);
        self.enter(&random)
    }

    /// Vectors in the place of Q, or beside it.
    fn enter(&mut self, new: &Block) -> Result<(), SpectraError> {
        let both = self.next.as_ref().map_or_else(|| new.clone(), |next| next.beside(new));
        let before = self.coupling.clone();
        let Some(both) = self.basis.orthonormalise(both)? else {
            return Err(self.exhausted());
        };
        // Q B in the coordinates of the new Q.
        self.coupling = match &self.next {
            Some(next) => both.overlaps(next) * before,
            None => Mat::zeros(both.width(), self.projected.len()),
        };
        self.next = Some(both);
        Ok(())
    }

    fn ritz(&self) -> Result<Ritz, SpectraError> {
        let Eigen { values: nu, vectors: coordinates } = self.projected.eigen()?;
        let residuals = match self.next {
            Some(_) => {
                let rest = &self.coupling * &coordinates;
                rest.col_iter().map(|column| column.norm_l2()).collect()
            }
            None => vec![0.0; nu.len()],
        };
        Ok(Ritz { nu, residuals, coordinates })
    }

    /// The eigenvalue of S that belongs to one of the inverse.
    fn lambda(&self, nu: f64) -> f64 {
        self.inverse.shift() - 1.0 / nu
    }

    /// The leading eigenvalues that have converged, and what the first that has not may be at most.
    fn settled(&self, ritz: &Ritz) -> (Vec<f64>, f64) {
        let bound = self.strictness * self.plan.residual_bound;
        let mut settled = self.locked.clone();
        for (&nu, &residual) in ritz.nu.iter().zip(&ritz.residuals) {
            if residual > bound * nu * nu {
                settled.sort_by(|a, b| b.total_cmp(a));
                return (settled, self.lambda(nu + residual));
            }
            settled.push(self.lambda(nu));
        }
        settled.sort_by(|a, b| b.total_cmp(a));
        let next = if self.next.is_some() { settled[settled.len() - 1] } else { f64::NEG_INFINITY };
        (settled, next)
    }

    /// How many modes to hand over, as soon as they have converged and the next one lies apart.
    fn complete(&self, settled: &[f64], next: f64) -> Option<usize> {
        self.plan.wanted.complete_of_found(settled, next, self.plan.grouping)
    }

    /// The modes of S in the span of those locked and of the first vectors û.
    fn modes(&mut self, ritz: &Ritz, n_vectors: usize) -> Result<Modes, SpectraError> {
        let n_locked = self.locked.len();
        let mut modes = Basis::empty(self.basis.n_rows());
        for range in Block::ranges(n_locked) {
            modes.append(&self.inverse.to_nodes(&self.basis.block(range)));
        }
        let coordinates = self.improved(ritz, n_vectors - n_locked);
        let present = self.basis.len();
        if let Some(next) = &self.next {
            self.basis.append(next);
        }
        for range in Block::ranges(n_vectors - n_locked) {
            let block = self.basis.combine(coordinates.as_ref().subcols(range.start, range.len()));
            if let Some(block) = modes.orthonormalise(self.inverse.to_nodes(&block))? {
                modes.append(&block);
            }
        }
        self.basis.truncate(present);
        self.spend(modes.len())?;
        Modes::in_span(self.w, modes)
    }

    /// The coordinates of the first vectors û in those locked, V and Q.
    fn improved(&self, ritz: &Ritz, count: usize) -> Mat<f64> {
        let (first, last) = (self.locked.len(), self.basis.len());
        let y = ritz.coordinates.as_ref().subcols(0, count);
        let n_next = self.next.as_ref().map_or(0, Block::width);
        let rest = if n_next > 0 { &self.coupling * y } else { Mat::new() };
        let coordinate = |i: usize, k: usize| match i.checked_sub(last) {
            Some(q) => rest[(q, k)] / ritz.nu[k],
            None => i.checked_sub(first).map_or(0.0, |i| y[(i, k)]),
        };
        Mat::from_fn(last + n_next, count, coordinate)
    }

    /// The modes, if they are accurate and none is missing; otherwise what is to change is changed.
    fn verified(
        &mut self,
        modes: Modes,
        n_modes: usize,
        next: f64,
        verifier: &Verifier<'_>,
    ) -> Result<Option<(Found, Verification)>, SpectraError> {
        let bound = self.plan.residual_bound;
        let n_accurate = modes.residuals.iter().take_while(|&&r| r <= bound).count();
        if n_accurate < n_modes {
            return self.lock(&modes).map(|()| None);
        }
        let Some(present) = self.next.as_ref().map(Block::width) else {
            // All modes are at hand. H is too rough to tell which are equal, their values are not.
            let all =
                self.plan.wanted.complete(&modes.values, f64::NEG_INFINITY, self.plan.grouping);
            let is_whole = modes.values.len() == self.basis.n_rows();
            return match all.filter(|&n_modes| is_whole && n_modes <= n_accurate) {
                Some(n_modes) => {
                    Ok(Some((modes.first(n_modes, self.products), Verification::Dense)))
                }
                None => self.lock(&modes).map(|()| None),
            };
        };
        let claim = Claim {
            n_modes,
            last: modes.values[n_modes - 1],
            wanted: self.plan.wanted,
            next,
            top: modes.values[0],
            beyond: Vec::new(),
            products_left: self.plan.max_products.saturating_sub(self.products),
            products_spent: self.products,
            tries: self.tries,
        };
        self.tries += 1;
        let outcome = verifier.verify(&claim, &modes.basis, &mut self.random)?;
        self.products += outcome.products;
        if let Some(verification) = outcome.verification {
            return Ok(Some((modes.first(n_modes, self.products), verification)));
        }
        self.at_least = outcome.above.unwrap_or(n_modes + 1);
        self.enter_random(ADDED.min(Block::WIDEST - present))?;
        Ok(None)
    }

    /// Keeps the leading modes that are as accurate as they must be, and starts from the others again.
    ///
    /// Rounding disturbs H by 10⁻¹⁶ of its largest eigenvalue, which may be much for modes far below.
    fn lock(&mut self, modes: &Modes) -> Result<(), SpectraError> {
        let bound = self.plan.residual_bound;
        let n_accurate = modes.residuals.iter().take_while(|&&r| r <= bound).count();
        if n_accurate <= self.locked.len() {
            self.strictness *= 0.1;
            return if self.next.is_some() { Ok(()) } else { Err(self.exhausted()) };
        }
        let vectors = |range| self.inverse.to_elimination(&modes.basis.block(range));
        self.basis = Basis::empty(modes.basis.n_rows());
        Block::ranges(n_accurate).for_each(|range| self.basis.append(&vectors(range)));
        let others = n_accurate..modes.values.len().min(n_accurate + WIDTH);
        let rest = (!others.is_empty()).then(|| vectors(others));
        self.locked = modes.values[..n_accurate].to_vec();
        (self.projected, self.coupled, self.next) = (Projection::default(), 0, None);
        self.next = rest.map_or(Ok(None), |rest| self.basis.orthonormalise(rest))?;
        self.coupling = Mat::zeros(self.next.as_ref().map_or(0, Block::width), 0);
        if self.next.is_none() { self.enter_random(WIDTH) } else { Ok(()) }
    }

    /// Cuts the basis down to its leading Ritz vectors when it is full.
    fn restart(&mut self, ritz: &Ritz) {
        let kept = self.known(ritz).saturating_sub(self.locked.len()) + SPARE;
        if self.projected.len() <= kept + kept / 2 + FRESH {
            return;
        }
        let n_locked = self.locked.len();
        let y = ritz.coordinates.as_ref().subcols(0, kept);
        let rotation = Mat::from_fn(self.basis.len(), n_locked + kept, |i, k| {
            match (i.checked_sub(n_locked), k.checked_sub(n_locked)) {
                (Some(i), Some(k)) => y[(i, k)],
                (None, None) if i == k => 1.0,
                _ => 0.0,
            }
        });
        self.basis.transform(rotation.as_ref());
        self.coupling = &self.coupling * y;
        self.coupled = kept;
        self.projected = Projection::diagonal(&ritz.nu[..kept]);
    }

    /// Modes known to be wanted.
    fn known(&self, ritz: &Ritz) -> usize {
        let values = ritz.nu.iter().map(|&nu| self.lambda(nu));
        let values: Vec<f64> = self.locked.iter().copied().chain(values).collect();
        self.plan.wanted.known(&values, self.plan.grouping)
    }

    fn spend(&mut self, products: usize) -> Result<(), SpectraError> {
        self.plan.spend(&mut self.products, products, self.n_settled)
    }

    fn exhausted(&self) -> SpectraError {
        self.plan.exhausted(self.n_settled, self.products)
    }
}
