//! The distance of two rows of components, ‖x‖ = Σ_b f_b ‖x_b‖₂ over blocks of columns (one block an
//! eigenspace), and its least and largest value over two boxes.
//!
//! All three come from one sum over |x_c|. Every step of it (difference, square, sum, root, product
//! with a positive factor) rounds monotonically, so that a box never promises more than the rounded
//! distances of its rows keep: bounds need no room for rounding.

use std::ops::Range;

/// The square of a number below this may be zero in floating point.
const SQUARE_VANISHES: f64 = 1e-150;

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
    pub(crate) fn gap_up_to(&self, limit: f64, a: &Bounds, b: &Bounds) -> f64 {
        let gap = |c: usize| (b.low[c] - a.high[c]).max(a.low[c] - b.high[c]).max(0.0);
        self.norm_up_to(limit, gap)
    }

    /// The same of one row and any in a box.
    #[inline(always)]
    pub(crate) fn gap_to_row_up_to(&self, limit: f64, row: &[f64], bounds: &Bounds) -> f64 {
        let (low, high) = (&bounds.low[..row.len()], &bounds.high[..row.len()]);
        self.norm_up_to(limit, |c| (low[c] - row[c]).max(row[c] - high[c]).max(0.0))
    }

    /// How much rows within `limit` of one another may differ in a column: somewhat more than they
    /// do, for rounding.
    pub(crate) fn reach(&self, limit: f64, column: usize) -> f64 {
        let block = self.blocks.iter().find(|block| block.columns.contains(&column));
        let factor = block.expect("blocks cover all columns").factor;
        limit / factor * (1.0 + 8.0 * f64::EPSILON) + SQUARE_VANISHES
    }

    /// The column in which the least of two boxes is within `limit` of the other, and which share of
    /// the narrower box is so there.
    pub(crate) fn narrowest_overlap(&self, limit: f64, a: &Bounds, b: &Bounds) -> (usize, f64) {
        let share = |factor: f64, c: usize| {
            let overlap = a.high[c].min(b.high[c]) - a.low[c].max(b.low[c]);
            let narrower = (a.high[c] - a.low[c]).min(b.high[c] - b.low[c]);
            (overlap + 2.0 * limit / factor) / narrower
        };
        let shares = self.columns().map(|(factor, c)| (c, share(factor, c)));
        shares.min_by(|x, y| x.1.total_cmp(&y.1)).expect("rows have columns")
    }

    /// An upper bound on the distance of two rows in the box.
    pub(crate) fn diameter_up_to(&self, limit: f64, bounds: &Bounds) -> f64 {
        self.norm_up_to(limit, |column| bounds.high[column] - bounds.low[column])
    }

    /// Every column after the factor of its block.
    fn columns(&self) -> impl Iterator<Item = (f64, usize)> {
        self.blocks.iter().flat_map(|block| block.columns.clone().map(|c| (block.factor, c)))
    }

    /// The column along which a box is longest, as the distance has it.
    pub(crate) fn longest_side(&self, bounds: &Bounds) -> usize {
        let side = |factor: f64, c: usize| factor * (bounds.high[c] - bounds.low[c]);
        let sides = self.columns().map(|(factor, c)| (c, side(factor, c)));
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
#[derive(Clone, Debug)]
pub(crate) struct Bounds {
    pub(crate) low: Vec<f64>,
    pub(crate) high: Vec<f64>,
}

impl Bounds {
    pub(crate) fn of_row(row: &[f64]) -> Self {
        Self { low: row.to_vec(), high: row.to_vec() }
    }

    pub(crate) fn include(&mut self, row: &[f64]) {
        for ((low, high), &x) in self.low.iter_mut().zip(&mut self.high).zip(row) {
            *low = if x < *low { x } else { *low };
            *high = if x > *high { x } else { *high };
        }
    }
}
