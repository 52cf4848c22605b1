//! The distance of two rows of components, ‖x‖ = Σ_b f_b ‖x_b‖₂ over blocks of columns (one block an
//! eigenspace).

use std::ops::Range;

/// Blocks of neighbouring columns, which cover all of them, and their factors.
#[derive(Clone, Debug)]
pub(crate) struct Metric {
    pub(crate) blocks: Vec<Block>,
}

/// One eigenspace.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    pub(crate) columns: Range<usize>,
    /// f_b > 0.
    pub(crate) factor: f64,
}

impl Metric {
    /// ‖x‖₂ over all columns.
    pub(crate) fn euclidean(width: usize) -> Self {
        Self { blocks: vec![Block { columns: 0..width, factor: 1.0 }] }
    }

    /// Number of columns.
    pub(crate) fn width(&self) -> usize {
        self.blocks.last().map_or(0, |block| block.columns.end)
    }

    /// ‖x‖ of the |x_c| given if that is at most `limit`, otherwise some value between `limit` and
    /// ‖x‖.
    #[inline(always)]
    pub(crate) fn norm_up_to(&self, limit: f64, magnitude: impl Fn(usize) -> f64) -> f64 {
        let mut sum = 0.0;
        for block in &self.blocks {
            sum += block.factor * block.norm(&magnitude);
            if sum > limit {
                break;
            }
        }
        sum
    }

    /// The distance of two rows if it is at most `limit`, otherwise some value between `limit` and
    /// the distance.
    #[inline(always)]
    pub(crate) fn distance_up_to(&self, limit: f64, a: &[f64], b: &[f64]) -> f64 {
        self.norm_up_to(limit, |column| (a[column] - b[column]).abs())
    }
}

impl Block {
    /// ‖x_b‖₂ of the |x_c| given.
    #[inline(always)]
    pub(crate) fn norm(&self, magnitude: impl Fn(usize) -> f64) -> f64 {
        if self.columns.len() == 1 {
            return magnitude(self.columns.start);
        }
        let square = |column| {
            let x = magnitude(column);
            x * x
        };
        self.columns.clone().map(square).sum::<f64>().sqrt()
    }
}
