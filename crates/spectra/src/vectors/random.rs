//! Random blocks whose every direction is equally likely: independent normal entries.
//!
//! Source: G. Marsaglia & T. A. Bray, SIAM Review 6, 260 (1964), polar method.

use graph::unit_interval;
use rand_core::Rng;
use rand_pcg::Pcg64;

use crate::vectors::block::Block;

/// Stream of the generator of random blocks.
const BLOCKS: u128 = 0x0b10_c500;

/// A source of random blocks; the same seed gives the same blocks.
pub(crate) struct Random {
    bits: Pcg64,
    spare: Option<f64>,
}

impl Random {
    /// A source of its own for each seed.
    pub fn new(seed: u64) -> Self {
        Self { bits: Pcg64::new(u128::from(seed), BLOCKS), spare: None }
    }

    /// Independent standard normal entries.
    pub fn block(&mut self, n_rows: usize, width: usize) -> Block {
        Block::from_nodes(width, (0..n_rows * width).map(|_| self.normal()).collect())
    }

    fn normal(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        loop {
            let (x, y) = (self.uniform(), self.uniform());
            let square = x * x + y * y;
            if 0.0 < square && square < 1.0 {
                let factor = (-2.0 * square.ln() / square).sqrt();
                self.spare = Some(factor * y);
                return factor * x;
            }
        }
    }

    /// Uniform in [−1, 1).
    fn uniform(&mut self) -> f64 {
        2.0 * unit_interval(self.bits.next_u64()) - 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_have_the_moments_of_a_normal_distribution() {
        let n = 400_000;
        let block = Random::new(7).block(n / 4, 4);
        let moment = |k: i32| block.data().iter().map(|x| x.powi(k)).sum::<f64>() / n as f64;
        for (k, expected, bound) in [(1, 0.0, 0.01), (2, 1.0, 0.01), (3, 0.0, 0.03), (4, 3.0, 0.08)]
        {
            assert!((moment(k) - expected).abs() < bound, "{k}: {}", moment(k));
        }
    }
}
