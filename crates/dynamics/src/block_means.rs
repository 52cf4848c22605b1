//! Running sums of many quantities, block by block, with the mean of the blocks and their spread.
//!
//! Source of the update: B. P. Welford, Technometrics 4, 419 (1962).

use crate::Estimate;
use crate::aligned::Aligned;
use crate::statistics::BLOCKS;

/// Quantities in a row, of which only sums are kept.
pub(crate) struct BlockMeans {
    /// Sum over the block in progress.
    pub(crate) sums: Aligned,
    /// Mean of the finished blocks.
    mean: Aligned,
    /// Sum of squared deviations from it.
    squares: Aligned,
    blocks: u32,
}

impl BlockMeans {
    pub(crate) fn new(length: usize) -> Self {
        let zeros = || Aligned::zeros(length);
        Self { sums: zeros(), mean: zeros(), squares: zeros(), blocks: 0 }
    }

    /// Ends a block, in which each sum has had this many terms.
    #[inline(always)]
    pub(crate) fn close(&mut self, terms: f64) {
        self.blocks += 1;
        let (per_term, per_block) = (1.0 / terms, 1.0 / f64::from(self.blocks));
        let quantities = self.sums.iter_mut().zip(&mut self.mean[..]).zip(&mut self.squares[..]);
        for ((sum, mean), squares) in quantities {
            let value = *sum * per_term;
            let before = value - *mean;
            *mean += before * per_block;
            *squares += before * (value - *mean);
            *sum = 0.0;
        }
    }

    /// What a quantity has come to: its sum, mean and squares.
    pub(crate) fn parts(&self, index: usize) -> [f64; 3] {
        [self.sums[index], self.mean[index], self.squares[index]]
    }

    /// Takes up a quantity where it stood.
    pub(crate) fn put(&mut self, index: usize, [sum, mean, squares]: [f64; 3]) {
        self.sums[index] = sum;
        self.mean[index] = mean;
        self.squares[index] = squares;
    }

    /// Goes on after so many finished blocks.
    pub(crate) fn go_on_after(&mut self, blocks: u32) {
        self.blocks = blocks;
    }

    /// Mean of all blocks with its standard error.
    pub(crate) fn estimate(&self, index: usize) -> Estimate {
        let blocks = BLOCKS as f64;
        Estimate {
            mean: self.mean[index],
            standard_error: (self.squares[index].max(0.0) / (blocks - 1.0) / blocks).sqrt(),
        }
    }
}
