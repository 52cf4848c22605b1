//! The distance of two rows of components, ‖x‖ = Σ_b f_b ‖x_b‖₂ over blocks of columns (one block an
//! eigenspace), and its least and largest value over two boxes.
//!
//! All three come from one sum over |x_c|. Every step of it (difference, square, sum, root, product
//! with a positive factor) rounds monotonically, so that a box never promises more than the rounded
//! distances of its rows keep: bounds need no room for rounding.

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
    fn norm_up_to(&self, limit: f64, magnitude: impl Fn(usize) -> f64) -> f64 {
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

    /// A lower bound on the distance of any row in one box and any in the other; beyond `limit`
    /// only known to be so.
    #[inline(always)]
    pub(crate) fn gap_up_to(&self, limit: f64, a: Bounds, b: Bounds) -> f64 {
        let gap = |c: usize| (b.low[c] - a.high[c]).max(a.low[c] - b.high[c]).max(0.0);
        self.norm_up_to(limit, gap)
    }

    /// An upper bound on the distance of two rows in the box.
    pub(crate) fn diameter_up_to(&self, limit: f64, bounds: Bounds) -> f64 {
        self.norm_up_to(limit, |column| bounds.high[column] - bounds.low[column])
    }

    /// The column along which a box is longest, as the distance has it.
    pub(crate) fn longest_side(&self, bounds: Bounds) -> usize {
        let side = |block: &Block, c: usize| block.factor * (bounds.high[c] - bounds.low[c]);
        let sides =
            self.blocks.iter().flat_map(|b| b.columns.clone().map(move |c| (c, side(b, c))));
        sides.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(column, _)| column)
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

/// A box around rows: the least and the largest component in each column.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds<'a> {
    pub(crate) low: &'a [f64],
    pub(crate) high: &'a [f64],
}
