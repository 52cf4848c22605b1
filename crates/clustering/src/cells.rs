//! Rows of components in an order of their own, in which the rows of a cell lie side by side: a cell
//! is halved in place, so that what is near in space is near in memory.

use std::ops::Range;

use crate::metric::Metric;

/// Most rows that are looked at to choose a cut.
const SAMPLE: usize = 128;

/// Rows of components under a metric, shape (N, metric.width()), all finite.
#[derive(Clone, Copy)]
pub(crate) struct Points<'a> {
    pub(crate) rows: &'a [f64],
    pub(crate) metric: &'a Metric,
}

impl<'a> Points<'a> {
    pub(crate) fn row(&self, node: usize) -> &'a [f64] {
        let width = self.metric.width();
        &self.rows[node * width..][..width]
    }
}

/// Copies of the rows of some nodes, in places 0, 1, ….
pub(crate) struct Rows {
    width: usize,
    /// The node in each place.
    nodes: Vec<u32>,
    /// Shape (places, width).
    values: Vec<f64>,
}

impl Rows {
    /// None yet.
    pub(crate) fn new(width: usize) -> Self {
        Self { width, nodes: Vec::new(), values: Vec::new() }
    }

    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Forgets all, for so many rows.
    pub(crate) fn restart(&mut self, n_rows: usize) {
        self.nodes.clear();
        self.values.clear();
        self.nodes.reserve(n_rows);
        self.values.reserve(n_rows * self.width);
    }

    pub(crate) fn push(&mut self, node: u32, row: &[f64]) {
        self.nodes.push(node);
        self.values.extend_from_slice(row);
    }

    pub(crate) fn node(&self, place: usize) -> u32 {
        self.nodes[place]
    }

    /// The nodes in some places.
    pub(crate) fn nodes(&self, places: Range<usize>) -> &[u32] {
        &self.nodes[places]
    }

    pub(crate) fn row(&self, place: usize) -> &[f64] {
        &self.values[place * self.width..][..self.width]
    }

    /// The rows in some places one by one.
    pub(crate) fn rows(&self, places: Range<usize>) -> impl Iterator<Item = &[f64]> {
        self.values[places.start * self.width..places.end * self.width].chunks_exact(self.width)
    }

    /// The box around the rows in some places, at least one.
    pub(crate) fn bounds(&self, places: Range<usize>) -> Bounds {
        let mut bounds = Bounds::of_row(self.row(places.start));
        self.rows(places).for_each(|row| bounds.include(row));
        bounds
    }

    /// Reorders the places in a box so that rows below a cut across one column come first; where the
    /// others begin. Equal rows are halved anyhow.
    pub(crate) fn halve(&mut self, places: Range<usize>, column: usize, bounds: &Bounds) -> usize {
        let (low, high) = (bounds.low[column], bounds.high[column]);
        if low == high {
            return places.start + places.len() / 2;
        }
        let some = self.rows(places.clone()).step_by(places.len().div_ceil(SAMPLE));
        let cut = cut(some.map(|row| row[column]).collect(), low, high);
        let Range { mut start, mut end } = places;
        while start < end {
            if self.row(start)[column] < cut {
                start += 1;
            } else {
                end -= 1;
                if self.row(end)[column] < cut {
                    self.swap(start, end);
                    start += 1;
                }
            }
        }
        start
    }

    /// Swaps the rows in two places, the first before the second.
    fn swap(&mut self, a: usize, b: usize) {
        self.nodes.swap(a, b);
        let (head, tail) = self.values.split_at_mut(b * self.width);
        head[a * self.width..][..self.width].swap_with_slice(&mut tail[..self.width]);
    }
}

/// Where to cut numbers between `low` and `high`, different from one another, of which these are
/// some: in the widest gap of the middle half of them, which passes between clumps, or, where these
/// are all equal, beside them. Some numbers are below the cut and some are not.
fn cut(mut some: Vec<f64>, low: f64, high: f64) -> f64 {
    some.sort_unstable_by(f64::total_cmp);
    let n = some.len();
    let gaps = some[n / 4..].windows(2).take(n.div_ceil(2));
    let widest = gaps.max_by(|x, y| (x[1] - x[0]).total_cmp(&(y[1] - y[0])));
    if let Some(&[a, b]) = widest
        && a < b
    {
        let middle = a + (b - a) / 2.0;
        return if middle > a { middle } else { b };
    }
    let median = some[n / 2];
    let above = some.partition_point(|&x| x <= median);
    some.get(above).copied().unwrap_or(if median > low { median } else { high })
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

    /// The column along which it is longest.
    pub(crate) fn longest_side(&self) -> usize {
        let sides = self.low.iter().zip(&self.high).map(|(low, high)| high - low).enumerate();
        sides.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(column, _)| column)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cut_passes_between_clumps_and_beside_equal_numbers() {
        assert_eq!(cut(vec![0.0, 0.1, 0.2, 5.2, 5.3, 5.4, 5.5, 5.6], 0.0, 5.6), 2.7);
        assert_eq!(cut(vec![1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 7.0], 1.0, 7.0), 7.0);
        assert_eq!(cut(vec![0.0, 7.0, 7.0, 7.0, 7.0, 7.0], 0.0, 7.0), 7.0);
        assert_eq!(cut(vec![3.0; 4], 3.0, 4.0), 4.0);
        let next = 1.0f64.next_up();
        assert_eq!(cut(vec![1.0, next], 1.0, next), next);
    }

    #[test]
    fn halves_of_a_cell_are_the_rows_on_either_side_of_the_cut() {
        let mut rows = Rows::new(2);
        let component = |node: u32| f64::from((node * 7) % 10);
        (0..10).for_each(|node| rows.push(node, &[component(node), 1.0]));
        let bounds = rows.bounds(0..10);
        let middle = rows.halve(0..10, 0, &bounds);
        assert!((2..=8).contains(&middle));
        let largest = (0..middle).map(|place| rows.row(place)[0]).fold(0.0, f64::max);
        assert!((middle..10).all(|place| rows.row(place)[0] > largest));
        assert!((0..10).all(|place| rows.row(place)[0] == component(rows.node(place))));
        assert_eq!(rows.halve(0..10, 1, &bounds), 5, "equal rows are halved anyhow");
    }
}
