//! A k-d tree of cells over rows of components: each cell has the box around its rows and is split at
//! the median of the box's longest side, when it is first asked for its halves.
//!
//! Source: Bentley, Commun. ACM 18, 509 (1975).

use std::ops::Range;

use crate::metric::{Bounds, Metric};

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

/// Cells of nodes, numbered in the order in which they were made.
pub(crate) struct CellTree<'a> {
    points: Points<'a>,
    /// The nodes, those of a cell next to one another.
    order: Vec<u32>,
    cells: Vec<Cell>,
    /// Least and largest components of each cell, shape (cells, 2, width).
    bounds: Vec<f64>,
}

struct Cell {
    /// Places in the order.
    places: Range<usize>,
    /// The first of two cells one after the other.
    children: Option<usize>,
}

impl<'a> CellTree<'a> {
    /// No cells yet, of nodes in an order that is the tree's to change within a cell.
    pub(crate) fn new(points: Points<'a>, order: Vec<u32>) -> Self {
        Self { points, order, cells: Vec::new(), bounds: Vec::new() }
    }

    /// Forgets all cells for one of the nodes in these places, cell 0.
    pub(crate) fn restart(&mut self, places: Range<usize>) {
        self.cells.clear();
        self.bounds.clear();
        self.add(places);
    }

    /// The nodes of a cell, at least one.
    pub(crate) fn nodes(&self, cell: usize) -> &[u32] {
        &self.order[self.cells[cell].places.clone()]
    }

    /// Number of nodes of a cell.
    pub(crate) fn size(&self, cell: usize) -> usize {
        self.cells[cell].places.len()
    }

    /// The halves of a cell, the second after the first, where it has been split.
    pub(crate) fn children(&self, cell: usize) -> Option<usize> {
        self.cells[cell].children
    }

    /// Splits a cell of at least two nodes for the first time; its first half.
    pub(crate) fn split(&mut self, cell: usize) -> usize {
        let places = self.cells[cell].places.clone();
        let column = self.points.metric.longest_side(self.bounds(cell));
        let half = places.len() / 2;
        let nodes = &mut self.order[places.clone()];
        // With the components beside the nodes, for they are far apart in memory.
        let component = |&node: &u32| (self.points.row(node as usize)[column], node);
        let mut along: Vec<(f64, u32)> = nodes.iter().map(component).collect();
        along.select_nth_unstable_by(half, |a, b| a.0.total_cmp(&b.0));
        nodes.iter_mut().zip(along).for_each(|(place, (_, node))| *place = node);
        let middle = places.start + half;
        let first = self.add(places.start..middle);
        self.add(middle..places.end);
        self.cells[cell].children = Some(first);
        first
    }

    /// The box around a cell.
    pub(crate) fn bounds(&self, cell: usize) -> Bounds<'_> {
        let width = self.points.metric.width();
        let (low, high) = self.bounds[2 * cell * width..][..2 * width].split_at(width);
        Bounds { low, high }
    }

    fn add(&mut self, places: Range<usize>) -> usize {
        let start = self.bounds.len();
        let nodes = &self.order[places.clone()];
        let first = self.points.row(nodes[0] as usize);
        self.bounds.extend_from_slice(first);
        self.bounds.extend_from_slice(first);
        let (low, high) = self.bounds[start..].split_at_mut(first.len());
        for &node in &nodes[1..] {
            let row = self.points.row(node as usize);
            for ((low, high), &x) in low.iter_mut().zip(&mut *high).zip(row) {
                *low = if x < *low { x } else { *low };
                *high = if x > *high { x } else { *high };
            }
        }
        self.cells.push(Cell { places, children: None });
        self.cells.len() - 1
    }
}
