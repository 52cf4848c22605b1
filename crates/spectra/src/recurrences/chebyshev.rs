//! Chebyshev filters: T_d(t(W)) X, with t the line that takes [a, c] to [−1, 1].
//!
//! |T_d| ≤ 1 on the unwanted part [a, c] of the spectrum, while above c it grows as ½ e^{d arcosh t}:
//! T_{d+1} = 2 t T_d − T_{d−1}. The filter runs in node space, on W = D^{-1/2} S D^{1/2}, where an
//! unweighted network needs no weights; p(S) = D^{1/2} p(W) D^{-1/2}.
//!
//! Source: Y. Zhou, Y. Saad, M. L. Tiago & J. R. Chelikowsky, J. Comput. Phys. 219, 172 (2006).

use crate::error::SpectraError;
use crate::matrix::product::{Links, Step};
use crate::progress::Asked;
use crate::vectors::block::Block;

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

    /// Degrees after which what rounding left of the eigenvalue `top`, projected out, has to be
    /// projected out again: when it has been amplified by `gain`.
    pub fn stretch(&self, top: f64, gain: f64) -> usize {
        (gain.ln() / self.growth(top)).clamp(1.0, 1e6) as usize
    }

    /// ln T_d(t(λ)) for λ ≥ c.
    pub fn log_gain(&self, degree: usize, lambda: f64) -> f64 {
        let exponent = degree as f64 * self.growth(lambda);
        // cosh x = ½ eˣ (1 + e^{−2x})
        exponent + (0.5 * (1.0 + (-2.0 * exponent).exp())).ln()
    }
}

/// T_d(t(S)) X, with d ≥ 1 products for each vector, unless it is stopped on the way.
pub(crate) fn filter(
    links: &Links<'_>,
    x: Block,
    degree: usize,
    unwanted: Interval,
    asked: Asked<'_>,
) -> Result<Block, SpectraError> {
    filter_between(links, x, (degree, degree), unwanted, |_| (), asked)
}

/// T_d(t(S)) X where both vectors of the recurrence are cleaned, in the coordinates of S, every
/// `stretch` degrees: a filter amplifies what rounding leaves of eigenvectors projected out.
pub(crate) fn filter_between(
    links: &Links<'_>,
    x: Block,
    (degree, stretch): (usize, usize),
    unwanted: Interval,
    clean: impl Fn(&mut Block),
    asked: Asked<'_>,
) -> Result<Block, SpectraError> {
    assert!(degree > 0, "a filter of degree 0");
    let (centre, half_width) = (unwanted.centre(), unwanted.half_width());
    let first = Step { product: 1.0 / half_width, same: -centre / half_width, previous: 0.0 };
    let next = Step { product: 2.0 * first.product, same: 2.0 * first.same, previous: -1.0 };
    let mut before = links.to_node_space(x);
    let mut now = Block::zeros(before.n_rows(), before.width());
    links.advance(&before, &mut now, first);
    for done in 1..degree {
        asked(done * now.width())?;
        links.advance(&now, &mut before, next);
        std::mem::swap(&mut before, &mut now);
        if done % stretch == 0 {
            for block in [&mut before, &mut now] {
                links.clean(block, &clean);
            }
        }
    }
    Ok(links.to_symmetric(now))
}
