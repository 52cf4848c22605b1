//! Why a MATLAB file could not be read.

use std::io;

use thiserror::Error;

use crate::formats::matrix::MatrixError;

/// Why a MAT-file could not be read. Offsets count bytes from the beginning of the file, or,
/// within [`MatlabError::InVariable`] of a compressed one, of what it unpacks to.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MatlabError {
    /// The source itself failed, or compressed content is damaged.
    #[error("reading failed: {0}")]
    Io(#[from] io::Error),
    /// The file does not begin as a MAT-file of level 5 does.
    #[error("expected a MAT-file of level 5, found {found}")]
    NotLevel5 {
        /// What the beginning looks like, and how to convert it.
        found: &'static str,
    },
    /// The data end early.
    #[error("byte {offset}: expected {expected}, found the end of the data")]
    Truncated {
        /// Where the data end.
        offset: u64,
        /// What should have stood there.
        expected: &'static str,
    },
    /// An element of another type, or longer than can be.
    #[error(
        "byte {offset}: expected {expected}, found an element of type {kind} with {length} bytes"
    )]
    UnexpectedElement {
        /// Where the element begins.
        offset: u64,
        /// What should have stood there.
        expected: &'static str,
        /// Its type.
        kind: u32,
        /// Its length in bytes.
        length: u64,
    },
    /// An element within its tag that would be longer than the tag.
    #[error("byte {offset}: expected at most 4 bytes within a tag, found {length}")]
    BadSmallElement {
        /// Where the element begins.
        offset: u64,
        /// The length stated.
        length: u64,
    },
    /// Not as many numbers as the size of the matrix calls for.
    #[error("byte {offset}: expected {expected} numbers for {what}, found {found}")]
    WrongCount {
        /// Where the element begins.
        offset: u64,
        /// What the numbers are.
        what: &'static str,
        /// How many there should be.
        expected: u64,
        /// How many there are.
        found: u64,
    },
    /// A sparse matrix whose indices are not those of a matrix.
    #[error("{what} {position}: expected a number from {from} to {to}, found {value}")]
    BadIndex {
        /// What the number is.
        what: &'static str,
        /// Its position from 0.
        position: usize,
        /// Least value that it may have.
        from: u32,
        /// Largest value that it may have.
        to: u32,
        /// Its value.
        value: f64,
    },
    /// More numbers than a sparse matrix may have.
    #[error(
        "byte {offset}: found {found} {what}; expected {most} at most in a file of this length"
    )]
    TooLong {
        /// Where the element begins.
        offset: u64,
        /// What the numbers are.
        what: &'static str,
        /// How many there are.
        found: u64,
        /// Most numbers that would be kept.
        most: u64,
    },
    /// A file without the variable asked for.
    #[error("expected a variable called `{wanted}`; the file holds: {found}")]
    NoVariable {
        /// The variable asked for.
        wanted: String,
        /// The names of its variables.
        found: String,
    },
    /// A file that does not say which of its matrices is meant, or has none.
    #[error("expected the name of one matrix of numbers; the file holds: {found}")]
    Ambiguous {
        /// The names of its matrices.
        found: String,
    },
    /// A variable that is no matrix of real numbers.
    #[error("expected `{name}` to be a matrix of real numbers, found {found}")]
    NotNumbers {
        /// The name of the variable.
        name: String,
        /// What it is.
        found: &'static str,
    },
    /// A variable of other than two dimensions.
    #[error("expected `{name}` to have two dimensions, found {dimensions:?}")]
    NotMatrix {
        /// The name of the variable.
        name: String,
        /// Its dimensions.
        dimensions: Vec<u32>,
    },
    /// A variable could not be read.
    #[error("the variable at byte {offset}: {error}")]
    InVariable {
        /// Where its element begins in the file.
        offset: u64,
        /// What is wrong with it.
        error: Box<MatlabError>,
    },
    /// The matrix is not a network.
    #[error(transparent)]
    Matrix(#[from] MatrixError),
}
