//! Chebyshev filters: T_d(t(W)) X, with t the line that takes [a, c] to [−1, 1].
//!
//! |T_d| ≤ 1 on the unwanted part [a, c] of the spectrum, while above c it grows as ½ e^{d arcosh t}:
//! T_{d+1} = 2 t T_d − T_{d−1}. The filter runs in node space, on W = D^{-1/2} S D^{1/2}, where an
//! unweighted network needs no weights; p(S) = D^{1/2} p(W) D^{-1/2}.
//!
//! Source: Y. Zhou, Y. Saad, M. L. Tiago & J. R. Chelikowsky, J. Comput. Phys. 219, 172 (2006).

use graph::CouplingMatrix;

use crate::block::Block;
use crate::product::{Links, Step};

/// The unwanted part [a, c] of the spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval {
    /// a, at most the smallest eigenvalue.
    pub low: f64,
    /// c, below the eigenvalues wanted.
    pub high: f64,
}

impl Interval {
    fn centre(&self) -> f64 {
        0.5 * (self.low + self.high)
    }

    fn half_width(&self) -> f64 {
        0.5 * (self.high - self.low)
    }

    /// By which factor one more degree amplifies an eigenvalue, as a logarithm: arcosh t(λ), 0 inside.
    pub fn growth(&self, lambda: f64) -> f64 {
        let above = ((lambda - self.high) / self.half_width()).max(0.0);
        (above + (above * (above + 2.0)).sqrt()).ln_1p()
    }

    /// ln T_d(t(λ)) for λ ≥ c.
    pub fn log_gain(&self, degree: usize, lambda: f64) -> f64 {
        let exponent = degree as f64 * self.growth(lambda);
        // cosh x = ½ eˣ (1 + e^{−2x})
        exponent + (0.5 * (1.0 + (-2.0 * exponent).exp())).ln()
    }
}

/// A matrix ready to be filtered by.
pub(crate) struct Filter<'a> {
    links: Links<'a>,
    scale: &'a [f64],
}

impl<'a> Filter<'a> {
    /// Filters by the symmetric form S of a coupling matrix.
    pub fn new(w: &'a CouplingMatrix) -> Self {
        Self { links: Links::new(w), scale: w.scale() }
    }

    /// T_d(t(S)) X, with d ≥ 1 products for each vector.
    pub fn apply(&self, x: Block, degree: usize, unwanted: Interval) -> Block {
        self.apply_between(x, degree, unwanted, degree, |_| ())
    }

    /// T_d(t(S)) X where both vectors of the recurrence are cleaned, in the coordinates of S, every
    /// `stretch` degrees: a filter amplifies what rounding leaves of eigenvectors projected out.
    pub fn apply_between(
        &self,
        mut x: Block,
        degree: usize,
        unwanted: Interval,
        stretch: usize,
        clean: impl Fn(&mut Block),
    ) -> Block {
        assert!(degree > 0, "a filter of degree 0");
        let (centre, half_width) = (unwanted.centre(), unwanted.half_width());
        x.scale_nodes(|i| self.scale[i]);
        let first = Step { product: 1.0 / half_width, same: -centre / half_width, previous: 0.0 };
        let next = Step { product: 2.0 * first.product, same: 2.0 * first.same, previous: -1.0 };
        let mut before = x;
        let mut now = Block::zeros(before.n_rows(), before.width());
        self.links.advance(&before, &mut now, first);
        for done in 1..degree {
            self.links.advance(&now, &mut before, next);
            std::mem::swap(&mut before, &mut now);
            if done % stretch == 0 {
                for block in [&mut before, &mut now] {
                    block.scale_nodes(|i| 1.0 / self.scale[i]);
                    clean(block);
                    block.scale_nodes(|i| self.scale[i]);
                }
            }
        }
        now.scale_nodes(|i| 1.0 / self.scale[i]);
        now
    }
}
