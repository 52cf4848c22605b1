//! What all matrix formats share: which rows and columns are taken, which way they point, how
//! large a matrix may be, and the [`RawNetwork`] that comes of it.
//!
//! `a_ij ≠ 0` when node j drives node i, so a file whose rows are the driven nodes is taken as it
//! stands and one whose rows are the driving nodes is transposed.

use std::ops::Range;

use thiserror::Error;

use crate::{GraphError, RawNetwork};

/// Most non-zero entries that a matrix reader keeps; a full matrix of 11,585 nodes has as many.
pub const MAX_ENTRIES: usize = 1 << 27;

/// Most nodes that a sparse matrix may have beyond two for each of its entries.
///
/// A header can claim any number of nodes in ten bytes; this keeps memory in proportion to what
/// the file holds.
pub const MAX_SPARE_NODES: usize = 1_000_000;

/// Which nodes the rows of a matrix file are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rows {
    /// Row i, column j: the strength with which j drives i.
    #[default]
    Driven,
    /// Row i, column j: the strength with which i drives j.
    Driving,
}

/// Which part of a matrix is read, and which way it points.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    /// Which nodes the rows are.
    pub rows: Rows,
    /// Rows and columns to take, counted from 0, the end excluded; none takes all of a square
    /// matrix. Nodes keep the labels that they have in the whole matrix.
    pub block: Option<Range<usize>>,
}

impl Layout {
    /// The rows and columns to take of a matrix of this size, which must have them all.
    pub(super) fn check_shape(&self, rows: u64, columns: u64) -> Result<Range<usize>, MatrixError> {
        if rows == 0 && columns == 0 {
            return Err(MatrixError::Empty);
        }
        let n_nodes = rows.min(columns);
        let Some(size) = u32::try_from(n_nodes).ok().and_then(|n| usize::try_from(n).ok()) else {
            return Err(MatrixError::TooManyNodes { n_nodes });
        };
        match self.block.clone() {
            None if rows != columns => Err(MatrixError::NotSquare { rows, columns }),
            None => Ok(0..size),
            Some(block) if !block.is_empty() && block.end <= size => Ok(block),
            Some(Range { start, end }) => Err(MatrixError::BadBlock { start, end, rows, columns }),
        }
    }
}

/// Why a matrix is not a network. Rows and columns count from 1.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum MatrixError {
    /// Rows and columns are not the same nodes.
    #[error("expected as many rows as columns, found {rows} rows and {columns} columns")]
    NotSquare {
        /// Number of rows.
        rows: u64,
        /// Number of columns.
        columns: u64,
    },
    /// A block that is empty or reaches beyond the matrix.
    #[error(
        "expected a block of one row or more within {rows} rows and {columns} columns, found rows \
         {} to {end}", start.saturating_add(1)
    )]
    BadBlock {
        /// First row and column of the block, from 0.
        start: usize,
        /// The row and column after its last, from 0.
        end: usize,
        /// Number of rows.
        rows: u64,
        /// Number of columns.
        columns: u64,
    },
    /// No rows and no columns.
    #[error("expected a matrix of one row or more, found none")]
    Empty,
    /// More nodes than 32-bit indices can number.
    #[error("{n_nodes} nodes are more than the {} that can be numbered", u32::MAX)]
    TooManyNodes {
        /// Number of rows and columns.
        n_nodes: u64,
    },
    /// An entry that is not finite.
    #[error("row {row}, column {column}: expected a finite number, found {value}")]
    NotFinite {
        /// The row.
        row: usize,
        /// The column.
        column: usize,
        /// The entry.
        value: f64,
    },
    /// A sparse entry beyond the matrix.
    #[error("an entry stands in row {row}, column {column} of a matrix of {size} rows and columns")]
    EntryOutside {
        /// The row.
        row: u64,
        /// The column.
        column: u64,
        /// Number of rows and columns.
        size: u64,
    },
    /// More than [`MAX_ENTRIES`].
    #[error("the matrix has more than {MAX_ENTRIES} non-zero entries")]
    TooManyEntries,
    /// A size that so few entries do not explain.
    #[error(
        "{n_nodes} nodes with {n_entries} non-zero entries: more than {MAX_SPARE_NODES} would be \
         isolated"
    )]
    MostlyIsolated {
        /// Number of nodes.
        n_nodes: usize,
        /// Number of entries.
        n_entries: usize,
    },
    /// What [`RawNetwork::new`] refuses beyond the above.
    #[error(transparent)]
    Network(#[from] GraphError),
}

/// Takes the entries of a matrix one by one and makes a network of those within the block.
pub(super) struct MatrixBuilder {
    rows: Rows,
    block: Range<usize>,
    entries: Vec<(u32, u32, f64)>,
}

impl MatrixBuilder {
    /// For a matrix of a size that its header states; nothing is allocated for it yet.
    pub(super) fn new(rows: u64, columns: u64, layout: &Layout) -> Result<Self, MatrixError> {
        let block = layout.check_shape(rows, columns)?;
        Ok(Self { rows: layout.rows, block, entries: Vec::new() })
    }

    /// Whether row and column, from 0, are within the block.
    pub(super) fn takes(&self, row: usize, column: usize) -> bool {
        self.block.contains(&row) && self.block.contains(&column)
    }

    /// The rows and columns that are taken, from 0.
    pub(super) fn block(&self) -> Range<usize> {
        self.block.clone()
    }

    /// Adds an entry; row and column count from 0 in the whole matrix.
    pub(super) fn add(&mut self, row: usize, column: usize, value: f64) -> Result<(), MatrixError> {
        if value == 0.0 || !self.takes(row, column) {
            return Ok(());
        }
        if !value.is_finite() {
            return Err(MatrixError::NotFinite { row: row + 1, column: column + 1, value });
        }
        if self.entries.len() == MAX_ENTRIES {
            return Err(MatrixError::TooManyEntries);
        }
        // The size of the matrix has been checked: its nodes are numbered in 32 bits.
        let (row, column) = ((row - self.block.start) as u32, (column - self.block.start) as u32);
        self.entries.push(match self.rows {
            Rows::Driven => (row, column, value),
            Rows::Driving => (column, row, value),
        });
        Ok(())
    }

    /// The network, its nodes labelled by their row numbers in the whole matrix, from 1.
    pub(super) fn finish(self, directed: bool) -> Result<RawNetwork, MatrixError> {
        let (n_nodes, n_entries) = (self.block.len(), self.entries.len());
        if n_nodes > n_entries.saturating_mul(2).saturating_add(MAX_SPARE_NODES) {
            return Err(MatrixError::MostlyIsolated { n_nodes, n_entries });
        }
        let labels = self.block.clone().map(|node| (node + 1).to_string()).collect();
        self.network(labels, directed)
    }

    /// The same with the labels of all rows of the whole matrix, in order.
    pub(super) fn finish_labelled(
        self,
        mut labels: Vec<String>,
        directed: bool,
    ) -> Result<RawNetwork, MatrixError> {
        labels.truncate(self.block.end);
        labels.drain(..self.block.start);
        assert_eq!(labels.len(), self.block.len(), "labels against rows of the block");
        self.network(labels, directed)
    }

    fn network(self, labels: Vec<String>, directed: bool) -> Result<RawNetwork, MatrixError> {
        // An error names rows and columns as they are in the file.
        let as_in_file = |error| match (self.rows, error) {
            (Rows::Driving, GraphError::DuplicateEntry { row, column }) => {
                GraphError::DuplicateEntry { row: column, column: row }
            }
            (_, error) => error,
        };
        Ok(RawNetwork::of_checked(labels, &self.entries, directed).map_err(as_in_file)?)
    }
}

/// A number of a file as an index: what does not fit into memory has been refused, or ends before.
pub(crate) fn as_index(number: u64) -> usize {
    usize::try_from(number).unwrap_or(usize::MAX)
}
