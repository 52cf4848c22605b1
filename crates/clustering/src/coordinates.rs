//! Coordinates that bound the distance of two rows from both sides.
//!
//! Let y be the components scaled by the factors of their blocks, y_c = f_b x_c. For the distance
//! δ = Σ_b f_b ‖x_b‖₂ of B blocks,
//!
//! ```text
//! max_c |y_c|  ≤  δ  =  Σ_b ‖y_b‖₂.
//! ```
//!
//! In a cloud, where a threshold is short against everything, sums of all components with all signs of
//! a Hadamard matrix bound it better from below: with y padded with zeros to a power of two M, p = H y,
//! H_jk = ±1, Hᵀ H = M 1, and blocks of at most d columns,
//!
//! ```text
//! max_j |p_j| / √d  ≤  δ  ≤  √(B / M) ‖p‖₂
//! ```
//!
//! by the triangle inequality, |Σ_{c∈b} ±y_c| ≤ √d ‖y_b‖₂, and by Cauchy and Schwarz. As the sums
//! spread √m times as wide as the components do, a threshold leaves fewer other rows next to one.
//!
//! Source: J. J. Sylvester, Phil. Mag. 34, 461 (1867).

use crate::cells::{Bounds, Points};
use crate::metric::{Block, Metric};

/// The square of a number below this may be zero in floating point.
const SQUARE_VANISHES: f64 = 1e-150;

/// Most pairs of rows that are looked at to tell a cloud from clumps.
const SAMPLE: usize = 4096;
/// Of so many pairs one is within the threshold in clumps, which are linked as a whole.
const RARE: usize = 1024;

/// Coordinates y or p, and what a threshold says of them.
pub(crate) struct Coordinates {
    /// The factor of every column.
    factors: Vec<f64>,
    /// How many there are.
    order: usize,
    /// By how much those of rows within the threshold differ at most.
    pub(crate) reach: f64,
    /// Whether they are the p.
    is_signed: bool,
    /// The distance itself in the y, ‖p‖₂ in the p.
    metric: Metric,
    /// Rows in a box whose diagonal in this metric is at most so long are within the threshold of one
    /// another.
    diagonal: f64,
}

impl Coordinates {
    /// For the distances of some of these points, all rounding included.
    pub(crate) fn new<'n>(
        points: Points,
        nodes: impl Iterator<Item = &'n u32>,
        threshold: f64,
    ) -> Self {
        let is_signed = points.metric.blocks.len() > 1 && is_cloud(points, threshold);
        Self::of_kind(is_signed, points, nodes, threshold)
    }

    /// The p, or the y.
    fn of_kind<'n>(
        is_signed: bool,
        points: Points,
        nodes: impl Iterator<Item = &'n u32>,
        threshold: f64,
    ) -> Self {
        let blocks = &points.metric.blocks;
        let width = points.metric.width();
        let factors: Vec<f64> =
            blocks.iter().flat_map(|b| b.columns.clone().map(|_| b.factor)).collect();
        let order = if is_signed { width.next_power_of_two() } else { width };
        // What bounds differences in a coordinate, and the diagonal, in units of the distance.
        let (along, across, metric) = if is_signed {
            let widest = blocks.iter().map(|b| b.columns.len()).max().unwrap_or(1);
            let across = (blocks.len() as f64 / order as f64).sqrt();
            ((widest as f64).sqrt(), across, Metric::euclidean(order))
        } else {
            let scaled = blocks.iter().map(|b| Block { columns: b.columns.clone(), factor: 1.0 });
            (1.0, 1.0, Metric { blocks: scaled.collect() })
        };
        let size = |row: &[f64]| row.iter().zip(&factors).map(|(x, f)| f * x.abs()).sum();
        let largest = nodes.map(|&node| size(points.row(node as usize))).fold(0.0, f64::max);
        let relative = (order + 8) as f64 * f64::EPSILON;
        let rounding = relative * largest;
        let reach = (threshold * (1.0 + relative) + rounding) * along + SQUARE_VANISHES;
        let diagonal = (threshold - rounding) / across * (1.0 - relative);
        Self { factors, order, reach, is_signed, metric, diagonal }
    }

    /// How many coordinates there are.
    pub(crate) fn order(&self) -> usize {
        self.order
    }

    /// Writes those of a row; the p by a fast Walsh–Hadamard transform.
    pub(crate) fn write(&self, row: &[f64], p: &mut [f64]) {
        p.fill(0.0);
        p.iter_mut().zip(row).zip(&self.factors).for_each(|((p, x), factor)| *p = factor * x);
        let mut half = if self.is_signed { 1 } else { p.len() };
        while half < p.len() {
            for pair in p.chunks_exact_mut(2 * half) {
                let (first, second) = pair.split_at_mut(half);
                for (a, b) in first.iter_mut().zip(second) {
                    (*a, *b) = (*a + *b, *a - *b);
                }
            }
            half *= 2;
        }
    }

    /// Whether rows in two boxes may be within the threshold.
    pub(crate) fn may_meet(&self, a: &Bounds, b: &Bounds) -> bool {
        self.is_within_reach(|c| (b.low[c] - a.high[c]).max(a.low[c] - b.high[c]))
    }

    /// Whether a row may be within the threshold of one in a box.
    #[inline(always)]
    pub(crate) fn may_be_near(&self, row: &[f64], bounds: &Bounds) -> bool {
        let (low, high) = (&bounds.low[..row.len()], &bounds.high[..row.len()]);
        self.is_within_reach(|c| (low[c] - row[c]).max(row[c] - high[c]))
    }

    /// Whether two rows may be within the threshold of one another.
    #[inline(always)]
    pub(crate) fn may_be_linked(&self, a: &[f64], b: &[f64]) -> bool {
        self.is_within_reach(|c| (a[c] - b[c]).abs())
    }

    /// Whether rows that are so far apart in each coordinate may be within the threshold.
    #[inline(always)]
    fn is_within_reach(&self, gap: impl Fn(usize) -> f64) -> bool {
        if self.is_signed {
            (0..self.order).all(|c| gap(c) <= self.reach)
        } else {
            self.metric.norm_up_to(self.reach, |c| gap(c).max(0.0)) <= self.reach
        }
    }

    /// Whether all rows in a box are within the threshold of one another.
    pub(crate) fn are_linked(&self, bounds: &Bounds) -> bool {
        let side = |c: usize| bounds.high[c] - bounds.low[c];
        self.metric.norm_up_to(self.diagonal, side) <= self.diagonal
    }

    /// The coordinate in which the least of two boxes is within reach of the other, and which share of
    /// the narrower box is so there.
    pub(crate) fn narrowest_overlap(&self, a: &Bounds, b: &Bounds) -> (usize, f64) {
        let share = |c: usize| {
            let overlap = a.high[c].min(b.high[c]) - a.low[c].max(b.low[c]);
            let narrower = (a.high[c] - a.low[c]).min(b.high[c] - b.low[c]);
            (overlap + 2.0 * self.reach) / narrower
        };
        let shares = (0..self.order).map(|c| (c, share(c)));
        shares.min_by(|x, y| x.1.total_cmp(&y.1)).expect("rows have columns")
    }
}

/// Whether hardly any rows are within the threshold of one another, by some pairs.
fn is_cloud(points: Points, threshold: f64) -> bool {
    let n_rows = points.rows.len() / points.metric.width();
    let n_pairs = (n_rows / 8).min(SAMPLE);
    let scattered =
        |k: usize, multiplier: f64| ((k as f64 * multiplier).fract() * n_rows as f64) as usize;
    let is_near = |&k: &usize| {
        // Multiples of the golden and the silver ratio.
        let (i, j) = (scattered(k, 0.618_033_988_749_895), scattered(k, 0.414_213_562_373_095));
        let distance = points.metric.distance_up_to(threshold, points.row(i), points.row(j));
        i != j && distance <= threshold
    };
    (1..=n_pairs).filter(is_near).count() * RARE <= n_pairs
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn coordinates_bound_rounded_distances_from_both_sides(
            blocks in prop::collection::vec((1usize..4, 0.01..2.0), 1..5),
            places in prop::collection::vec(-1.0..1.0, 6 * 12),
            scale in prop::sample::select(vec![1.0, 1e-3, 1e-9, 1e-15]),
            is_signed: bool,
        ) {
            let mut end = 0;
            let block = |&(width, factor): &(usize, f64)| {
                end += width;
                Block { columns: end - width..end, factor }
            };
            let metric = Metric { blocks: blocks.iter().map(block).collect() };
            let width = metric.width();
            // Rows that differ little from one far away, too.
            let rows: Vec<f64> = places.iter().take(6 * width).map(|x| 0.5 + scale * x).collect();
            let points = Points { rows: &rows, metric: &metric };
            let nodes: Vec<u32> = (0..6).collect();
            for (i, j) in (0..6).flat_map(|i| (0..i).map(move |j| (i, j))) {
                let distance = metric.distance_up_to(f64::INFINITY, points.row(i), points.row(j));
                let coordinates = Coordinates::of_kind(is_signed, points, nodes.iter(), distance);
                let mut p = vec![0.0; 2 * coordinates.order()];
                let (a, b) = p.split_at_mut(coordinates.order());
                coordinates.write(points.row(i), a);
                coordinates.write(points.row(j), b);
                let (mut around_a, around_b) = (Bounds::of_row(a), Bounds::of_row(b));
                prop_assert!(coordinates.may_be_linked(a, b) && coordinates.may_be_near(a, &around_b));
                prop_assert!(coordinates.may_meet(&around_a, &around_b));
                around_a.include(b);
                let less = Coordinates::of_kind(is_signed, points, nodes.iter(), distance * (1.0 - 1e-13) - 1e-300);
                prop_assert!(!less.are_linked(&around_a));
            }
        }
    }

    #[test]
    fn a_threshold_reaches_no_farther_than_it_must() {
        // Two rows of four components that differ in one: |p_j| is their distance for all j.
        let metric =
            Metric { blocks: (0..4).map(|c| Block { columns: c..c + 1, factor: 0.25 }).collect() };
        let rows = [0.0, 0.0, 0.0, 0.0, 0.0, 0.8, 0.0, 0.0];
        let points = Points { rows: &rows, metric: &metric };
        let mut p = [0.0; 4];
        for (threshold, expected) in [(0.199, false), (0.2, true)] {
            let coordinates = Coordinates::of_kind(true, points, [0, 1].iter(), threshold);
            coordinates.write(points.row(1), &mut p);
            assert_eq!(p.map(f64::abs), [0.2; 4]);
            assert_eq!(coordinates.may_be_linked(&p, &[0.0; 4]), expected);
        }
    }
}
