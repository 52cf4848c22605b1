//! The coupling matrix as the sums that a step makes: Σ_j w_ij x_j for every node i.
//!
//! - rows with weights of their own: w_ii x_i comes after Σ_{j≠i} w_ij x_j
//! - when the weights within each row are equal (unweighted links): w_i Σ_{j≠i} x_j, then w_ii x_i.
//!   Sums of the same signals that several rows have are then made once, see [`crate::shared_sums`].
//!
//! Terms are added in ascending order of their number. All this depends on the matrix alone: it is
//! one fixed definition, whatever the number of lanes.

use crate::shared_sums::share;

/// Sparse matrix in compressed-row form with 32-bit column indices.
pub type SparseMatrix = sprs::CsMatI<f64, u32, usize>;

/// The rows of a coupling matrix, taken apart.
pub(crate) struct Links {
    /// The row of each node.
    pub(crate) rows: Vec<Row>,
    /// The two terms of each shared sum: numbers below N are nodes, N + k is shared sum k.
    pub(crate) shared: Vec<[u32; 2]>,
    /// Whether terms have weights of their own.
    pub(crate) weighted: bool,
}

/// The row of a node i.
pub(crate) struct Row {
    /// w_ii.
    pub(crate) own: f64,
    /// Factor of the sum of the terms: the weight that they share, or 1.
    pub(crate) common: f64,
    /// Number, as in [`Links::shared`], and weight of each term.
    pub(crate) terms: Vec<(u32, f64)>,
}

impl Links {
    pub(crate) fn new(matrix: &SparseMatrix) -> Self {
        let mut rows: Vec<Row> = (0..matrix.rows()).map(|node| Row::new(matrix, node)).collect();
        let weighted = !rows.iter().all(Row::has_equal_weights);
        if weighted {
            return Self { rows, shared: Vec::new(), weighted };
        }
        let mut numbers: Vec<Vec<u32>> = rows.iter().map(Row::numbers).collect();
        let shared = share(&mut numbers);
        for (row, numbers) in rows.iter_mut().zip(numbers) {
            row.common = row.terms.first().map_or(1.0, |&(_, weight)| weight);
            row.terms = numbers.into_iter().map(|number| (number, 1.0)).collect();
        }
        Self { rows, shared, weighted }
    }

    pub(crate) fn n_nodes(&self) -> usize {
        self.rows.len()
    }

    /// About the time that an evaluation takes of a single replica, in nanoseconds.
    pub(crate) fn work(&self) -> f64 {
        let terms = self.rows.iter().map(|row| row.terms.len()).sum();
        work(terms, self.n_nodes())
    }
}

/// About the time that so many terms and the equations of so many nodes take, in nanoseconds: measured on
/// networks of 90 and 989 nodes, and rounded.
pub(crate) fn work(terms: usize, nodes: usize) -> f64 {
    0.35 * terms as f64 + 4.0 * nodes as f64
}

impl Row {
    fn new(matrix: &SparseMatrix, node: usize) -> Self {
        let row = matrix.outer_view(node).expect("the matrix has a row for every node");
        let entries = row.indices().iter().copied().zip(row.data().iter().copied());
        let (own, terms): (Vec<_>, Vec<_>) =
            entries.partition(|&(column, _)| column as usize == node);
        Self { own: own.first().map_or(0.0, |&(_, weight)| weight), common: 1.0, terms }
    }

    fn has_equal_weights(&self) -> bool {
        self.terms.iter().all(|&(_, weight)| weight == self.terms[0].1)
    }

    fn numbers(&self) -> Vec<u32> {
        self.terms.iter().map(|&(number, _)| number).collect()
    }
}
