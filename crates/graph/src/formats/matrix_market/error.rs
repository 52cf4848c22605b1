//! Why a Matrix Market file could not be read.

use thiserror::Error;

use crate::formats::matrix::MatrixError;
use crate::formats::text::TextError;

/// Why a Matrix Market file could not be read. Lines and columns of text count from 1.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MatrixMarketError {
    /// The source failed, or is not text.
    #[error(transparent)]
    Text(#[from] TextError),
    /// The first line is not a header.
    #[error("line 1: expected `%%MatrixMarket matrix FORMAT FIELD SYMMETRY`, found `{found}`")]
    NoHeader {
        /// How the line begins.
        found: String,
    },
    /// A word of the header that this reader does not know, or that makes no network.
    #[error("line 1: expected {expected}, found `{found}`")]
    BadHeader {
        /// Which words could stand there.
        expected: &'static str,
        /// What does.
        found: String,
    },
    /// The file ends before the line that gives the size.
    #[error("expected a line with {expected}, found the end of the file after line {lines}")]
    NoSize {
        /// The numbers expected.
        expected: &'static str,
        /// Number of lines read.
        lines: usize,
    },
    /// A line with too few or too many values.
    #[error("line {line}: expected {expected}, found {found} values")]
    WrongCount {
        /// The line.
        line: usize,
        /// The values expected.
        expected: &'static str,
        /// How many there are.
        found: usize,
    },
    /// A value that is no number of the kind that belongs there.
    #[error("line {line}, column {column}: expected {expected}, found `{found}`")]
    BadNumber {
        /// The line.
        line: usize,
        /// Where the value begins.
        column: usize,
        /// What the value should be.
        expected: &'static str,
        /// How the value begins.
        found: String,
    },
    /// An index beyond the size that the file states.
    #[error("line {line}, column {column}: expected an index from 1 to {size}, found {found}")]
    IndexOutOfRange {
        /// The line.
        line: usize,
        /// Where the index begins.
        column: usize,
        /// Number of rows or columns.
        size: u64,
        /// The index.
        found: u64,
    },
    /// A symmetric matrix that is not square.
    #[error("line {line}: a symmetric matrix cannot have {rows} rows and {columns} columns")]
    SymmetricNotSquare {
        /// The line.
        line: usize,
        /// Number of rows.
        rows: u64,
        /// Number of columns.
        columns: u64,
    },
    /// Fewer entries than the size line states.
    #[error("expected {expected} entries, found {found} before the file ends in line {lines}")]
    TooFewEntries {
        /// Number of entries stated.
        expected: u64,
        /// Number of entries found.
        found: u64,
        /// Number of lines read.
        lines: usize,
    },
    /// More entries than the size line states.
    #[error("line {line}: expected the end of the file after {expected} entries, found `{found}`")]
    TooManyEntries {
        /// The first line too many.
        line: usize,
        /// Number of entries stated.
        expected: u64,
        /// How the line begins.
        found: String,
    },
    /// The matrix is not a network.
    #[error(transparent)]
    Matrix(#[from] MatrixError),
}
