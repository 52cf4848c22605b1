//! Lanczos' three-term recurrence, without reorthogonalisation.
//!
//! β_k x_{k+1} = W x_k − α_k x_k − β_{k−1} x_{k−1}, in node space, on W = D^{-1/2} S D^{1/2}, where an
//! unweighted network needs no weights; with q = D^{1/2} x, ⟨q, q'⟩ = Σ_i d_i x_i x'_i. A step looks at
//! three vectors, however many there have been. Orthogonality to the others is lost only in the
//! directions of Ritz vectors that have converged (Paige, Linear Algebra Appl. 34, 235 (1980)).

use rayon::prelude::*;

use crate::error::SpectraError;
use crate::matrix::product::{Links, Step, weighted_sum};
use crate::vectors::basis::Basis;
use crate::vectors::block::{Block, ROWS};
use crate::vectors::small_eigen::{Eigen, tridiagonal_eigen};

/// A β that is smaller, relatively, is rounding.
const NOISE: f64 = 1e-14;

/// A sequence of Lanczos vectors, of which the last two are at hand.
pub(crate) struct Lanczos<'a> {
    links: &'a Links<'a>,
    /// d.
    weights: Vec<f64>,
    before: Block,
    now: Block,
    /// A β up to this is rounding.
    noise: f64,
    /// α_1, …, α_k.
    diagonal: Vec<f64>,
    /// β_1, …, β_k.
    beside: Vec<f64>,
}

impl<'a> Lanczos<'a> {
    /// A sequence that starts from the direction of a vector, in the coordinates of S.
    ///
    /// - `scale`: max_i |w_ii|.
    pub fn from(mut start: Block, links: &'a Links<'a>, scale: f64) -> Self {
        let norm = start.norms()[0];
        assert!(norm > 0.0, "a sequence from a vector of norm zero");
        start.scale_nodes(|_| 1.0 / norm);
        let weights = links.scale().par_iter().map(|scale| 1.0 / (scale * scale)).collect();
        let before = Block::zeros(start.n_rows(), 1);
        let now = links.to_node_space(start);
        let (diagonal, beside) = (Vec::new(), Vec::new());
        Self { links, weights, before, now, noise: NOISE * scale, diagonal, beside }
    }

    /// Steps done.
    pub fn steps(&self) -> usize {
        self.diagonal.len()
    }

    /// β of the last step: how far the vectors so far are from spanning an invariant space.
    pub fn last_beta(&self) -> f64 {
        self.beside.last().copied().unwrap_or(0.0)
    }

    /// The newest vector, in node space, and its norm: x_k is their ratio.
    pub fn newest(&self) -> (&Block, f64) {
        (&self.now, self.norm(0))
    }

    /// The norm in which x_{k−back} is stored: that of its making.
    fn norm(&self, back: usize) -> f64 {
        self.steps().checked_sub(1 + back).map_or(1.0, |k| self.beside[k])
    }

    /// One product; false when β_k is rounding, and there is no next vector.
    pub fn step(&mut self) -> bool {
        let (norm, norm_before) = (self.norm(0), self.norm(1));
        let previous = -self.last_beta() / norm_before;
        let step = Step { product: 1.0 / norm, same: 0.0, previous };
        let (now, before) = (&self.now, &mut self.before);
        let alpha = self.links.advance_and_weigh(now, before, step, &self.weights) / norm;
        let beta = self.subtract(alpha / norm);
        self.diagonal.push(alpha);
        self.beside.push(beta);
        std::mem::swap(&mut self.before, &mut self.now);
        beta > self.noise
    }

    /// y − factor · x, where y is in the place of x_{k−1}; returns its norm.
    fn subtract(&mut self, factor: f64) -> f64 {
        let chunks = self.before.data_mut().par_chunks_mut(ROWS);
        let others = self.now.data().par_chunks(ROWS).zip(self.weights.par_chunks(ROWS));
        let partial = |(y, (x, d)): (&mut [f64], (&[f64], &[f64]))| -> f64 {
            y.iter_mut().zip(x).for_each(|(y, x)| *y -= factor * x);
            weighted_sum(d, y, y)
        };
        let partials: Vec<f64> = chunks.zip(others).map(partial).collect();
        partials.iter().sum::<f64>().sqrt()
    }

    /// Projects vectors out of the last two.
    pub fn project_out(&mut self, vectors: &Basis) {
        for block in [&mut self.before, &mut self.now] {
            self.links.clean(block, |block| vectors.project_out(block));
        }
    }

    /// Ritz pairs of the steps so far.
    pub fn ritz(&self) -> Result<Eigen, SpectraError> {
        tridiagonal_eigen(&self.diagonal, &self.beside[..self.steps() - 1])
    }
}
