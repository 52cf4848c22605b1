//! A long Lanczos sequence from one vector.
//!
//! Near the edge of a bulk eigenvalues lie so close that methods which restart spend several times the
//! products of one sequence of k steps, whose span holds every polynomial of degree below k.
//! Eigenvectors known before are projected out every few steps (selective orthogonalisation; Parlett &
//! Scott, Math. Comput. 33, 217 (1979)). Those that converge on the way come back as copies after a
//! while. Since one vector knows one direction of each eigenspace, equal Ritz values are copies, and a
//! Ritz vector that has nothing of the first vector is one in the making (Cullum & Willoughby, J.
//! Comput. Phys. 44, 329 (1981)).

use faer::Mat;

use crate::error::SpectraError;
use crate::matrix::product::Links;
use crate::progress::Asked;
use crate::recurrences::lanczos::Lanczos;
use crate::vectors::basis::Basis;
use crate::vectors::block::Block;
use crate::vectors::small_eigen::Eigen;

/// Numbers that all vectors of a sequence may hold: 1 GiB.
const MOST_NUMBERS: usize = 1 << 27;
/// A sequence that would have to be shorter is not begun.
const FEWEST_STEPS: usize = 100;
/// Steps before the first look at Ritz values.
const FIRST_LOOK: usize = 60;
/// By which factor the next look may be later.
const NEXT_LOOK: (f64, f64) = (1.01, 1.3);
/// By how much sooner residuals fall than at the pace so far.
const PACE_GROWS: f64 = 0.9;
/// Ritz vectors handed over beyond those asked for: they serve verification.
const GUARDS: usize = 8;
/// A Ritz pair with so small a residual, relatively, is about to come back.
const RETURNING: f64 = 1e-14;
/// How many times as many steps may still be needed when one is.
const MOST_AHEAD: f64 = 2.0;
/// A Ritz vector with so small a part of the first vector is not one of the matrix.
const SPURIOUS: f64 = 1e-8;
/// By how much smaller than asked for residuals are to be: to the next step they are estimates.
const STRICTLY: f64 = 0.45;

/// A sequence to be run.
pub(crate) struct LongSequence<'a> {
    pub links: &'a Links<'a>,
    /// Eigenvectors that are known.
    pub known: &'a Basis,
    /// Steps after which they are projected out again.
    pub stretch: usize,
    /// The residual that is asked for.
    pub residual_bound: f64,
    /// Eigenvalues closer than this are equal.
    pub grouping: f64,
    /// The largest |w_ii|.
    pub scale: f64,
}

/// Leading Ritz pairs of a sequence.
struct Ritz {
    /// How many are asked for.
    needed: usize,
    residuals: Vec<f64>,
    /// Coordinates in the sequence, one column a pair.
    coordinates: Mat<f64>,
}

impl LongSequence<'_> {
    /// Steps that a network of so many nodes leaves room for; none where they would be too few.
    pub fn most_steps(n_nodes: usize) -> Option<usize> {
        Some((MOST_NUMBERS / n_nodes).min(n_nodes)).filter(|&steps| steps >= FEWEST_STEPS)
    }

    /// Runs from a vector until as many leading pairs have converged as `needed` asks for, given the
    /// Ritz values, or for `most_steps`. Returns Ritz vectors and the products spent.
    pub fn run(
        &self,
        mut start: Block,
        most_steps: usize,
        needed: impl Fn(&[f64]) -> usize,
        asked: Asked<'_>,
    ) -> Result<(Vec<Block>, usize), SpectraError> {
        self.known.project_out(&mut start);
        let mut vectors = Basis::with_room(start.n_rows(), most_steps);
        let mut norms = Vec::new();
        let mut lanczos = Lanczos::from(start, self.links, self.scale);
        let (mut next_look, mut before) = (FIRST_LOOK, None);
        loop {
            let (vector, norm) = lanczos.newest();
            vectors.append(vector);
            norms.push(norm);
            let last = !lanczos.step() || lanczos.steps() == most_steps;
            asked(lanczos.steps())?;
            if last || lanczos.steps() == next_look {
                let ritz = Ritz::of(&lanczos, self.grouping, &needed)?;
                next_look = ritz.next_look(STRICTLY * self.residual_bound, self.scale, before);
                before = Some((lanczos.steps(), ritz.worst()));
                if last || ritz.converged(STRICTLY * self.residual_bound) || self.is_spent(&ritz) {
                    return Ok((self.combine(vectors, &norms, &ritz), lanczos.steps()));
                }
            }
            if lanczos.steps().is_multiple_of(self.stretch) {
                lanczos.project_out(self.known);
            }
        }
    }

    /// Whether a pair is about to come back, early on the way: as an eigenvector that is known it would
    /// hinder a new sequence no more.
    fn is_spent(&self, ritz: &Ritz) -> bool {
        let returns = ritz.residuals.iter().any(|&r| r <= RETURNING * self.scale);
        returns && ritz.way(STRICTLY * self.residual_bound / self.scale) > MOST_AHEAD
    }

    /// The Ritz vectors, in the coordinates of S.
    fn combine(&self, mut vectors: Basis, norms: &[f64], ritz: &Ritz) -> Vec<Block> {
        let count = ritz.residuals.len();
        let weights = Mat::from_fn(norms.len(), count, |k, j| ritz.coordinates[(k, j)] / norms[k]);
        vectors.transform(weights.as_ref());
        let to_symmetric = |range| self.links.to_symmetric(vectors.block(range));
        Block::ranges(count).map(to_symmetric).collect()
    }
}

impl Ritz {
    /// Those needed and some more.
    fn of(
        lanczos: &Lanczos<'_>,
        grouping: f64,
        needed: impl Fn(&[f64]) -> usize,
    ) -> Result<Self, SpectraError> {
        let steps = lanczos.steps();
        let Eigen { values, vectors } = lanczos.ritz()?;
        let mut first: Vec<usize> = Vec::new();
        for k in (0..steps).filter(|&k| vectors[(0, k)].abs() > SPURIOUS) {
            if first.last().is_none_or(|&j| values[j] - values[k] > grouping) {
                first.push(k);
            }
        }
        let distinct: Vec<f64> = first.iter().map(|&k| values[k]).collect();
        let needed = needed(&distinct).min(distinct.len());
        let count = (needed + GUARDS).min(distinct.len());
        let coordinates = Mat::from_fn(steps, count, |i, k| vectors[(i, first[k])]);
        let residual = |k| lanczos.last_beta() * f64::abs(coordinates[(steps - 1, k)]);
        Ok(Self { needed, residuals: (0..count).map(residual).collect(), coordinates })
    }

    /// Whether all that are needed have converged.
    fn converged(&self, bound: f64) -> bool {
        self.worst() <= bound
    }

    /// The largest residual of those needed.
    fn worst(&self) -> f64 {
        self.residuals[..self.needed].iter().copied().fold(0.0, f64::max)
    }

    /// After how many steps to look again: a little before residuals are below the bound at the pace since
    /// the look before, because the pace grows; half of the way at the pace so far, where they have not
    /// fallen since.
    fn next_look(&self, bound: f64, scale: f64, before: Option<(usize, f64)>) -> usize {
        let (steps, worst) = (self.coordinates.nrows() as f64, self.worst());
        let fallen = before.filter(|&(_, worst_before)| worst_before > worst);
        let ahead = match fallen {
            Some((steps_before, worst_before)) => {
                let pace = (worst_before / worst).ln() / (steps - steps_before as f64);
                PACE_GROWS * (worst / bound).ln() / pace
            }
            None => 0.5 * steps * (self.way(bound / scale) - 1.0),
        };
        (steps + ahead).clamp(NEXT_LOOK.0 * steps, NEXT_LOOK.1 * steps).ceil() as usize
    }

    /// All steps that residuals need to fall to the relative bound, at the pace so far, by those done.
    fn way(&self, bound: f64) -> f64 {
        bound.ln() / self.worst().min(0.5).max(bound).ln()
    }
}
