//! Why a full matrix could not be read.

use thiserror::Error;

use crate::formats::matrix::MatrixError;
use crate::formats::text::TextError;

/// Why a full matrix could not be read. Lines and columns of text count from 1.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum DenseError {
    /// The source failed, or is not text.
    #[error(transparent)]
    Text(#[from] TextError),
    /// No line but comments and blank ones, or nothing but labels.
    #[error("expected at least one row of numbers, found none in {lines} lines")]
    Empty {
        /// Number of lines read.
        lines: usize,
    },
    /// A value that is not a finite number.
    #[error("line {line}, column {column}: expected a finite number, found `{found}`")]
    BadNumber {
        /// The line.
        line: usize,
        /// Where the value begins.
        column: usize,
        /// How the value begins.
        found: String,
    },
    /// A row longer or shorter than the first.
    #[error("line {line}: expected {expected} values as in line {first_line}, found {found}")]
    RaggedRow {
        /// The line.
        line: usize,
        /// Number of values in the first row.
        expected: usize,
        /// The line of the first row.
        first_line: usize,
        /// Number of values in this one.
        found: usize,
    },
    /// A quote that is not closed on its line, or has text straight after it.
    #[error("line {line}, column {column}: expected {expected}")]
    BadQuote {
        /// The line.
        line: usize,
        /// Where the quote opens, or the text after it begins.
        column: usize,
        /// What should have stood there.
        expected: &'static str,
    },
    /// A first line whose labels do not match the values below it.
    #[error(
        "line {line}: expected {values} labels, or {} with one for the labels of rows, found \
         {labels}", values + 1
    )]
    WrongLabelCount {
        /// The line of the labels.
        line: usize,
        /// Number of labels.
        labels: usize,
        /// Number of values in the row below.
        values: usize,
    },
    /// A row whose label is not that of the column of the same number.
    #[error("line {line}: expected the row of `{expected}`, found that of `{found}`")]
    WrongRowLabel {
        /// The line.
        line: usize,
        /// How the label of the column begins.
        expected: String,
        /// How the label of the row begins.
        found: String,
    },
    /// The matrix is not a network.
    #[error(transparent)]
    Matrix(#[from] MatrixError),
}
