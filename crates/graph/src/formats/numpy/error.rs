//! Why an array could not be read.

use std::io;

use thiserror::Error;

use crate::formats::archive::ArchiveError;
use crate::formats::matrix::MatrixError;

/// Why a NumPy file could not be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum NumpyError {
    /// The source itself failed, or its packed content is damaged.
    #[error("reading failed: {0}")]
    Io(#[from] io::Error),
    /// The archive of an `.npz` could not be read.
    #[error(transparent)]
    Archive(#[from] ArchiveError),
    /// The file does not begin as an `.npy` does.
    #[error("expected an .npy file, which begins with the byte 0x93 and `NUMPY`")]
    NotNpy,
    /// The file ends within its header.
    #[error("the file ends within its header")]
    HeaderCut,
    /// A version of the format that is not known.
    #[error("expected version 1, 2 or 3 of the .npy format, found {major}.{minor}")]
    Version {
        /// Its first number.
        major: u8,
        /// Its second number.
        minor: u8,
    },
    /// A header that no plain array has.
    #[error("the header has {length} bytes; expected {limit} at most")]
    HeaderTooLong {
        /// Its length in bytes.
        length: u32,
        /// The longest that is read.
        limit: u32,
    },
    /// Something in the dictionary that does not belong there.
    #[error("header, byte {offset}: expected {expected}, found `{found}`")]
    BadHeader {
        /// Bytes of the dictionary before it.
        offset: usize,
        /// What should have stood there.
        expected: &'static str,
        /// What does.
        found: String,
    },
    /// A dictionary without one of its keys.
    #[error("the header lacks the key `{key}`")]
    MissingKey {
        /// The key.
        key: &'static str,
    },
    /// Elements that are no real numbers.
    #[error("expected elements that are booleans, integers or real numbers, found {found}")]
    UnsupportedType {
        /// The type found.
        found: String,
    },
    /// An array that is not of the shape that it should have.
    #[error("expected an array of {expected} dimensions, found the shape {shape:?}")]
    WrongDimensions {
        /// Number of dimensions expected.
        expected: usize,
        /// The shape found.
        shape: Vec<u64>,
    },
    /// Fewer bytes than the shape needs.
    #[error("expected {expected} bytes of elements, found {found}")]
    Truncated {
        /// Bytes that the shape needs.
        expected: u128,
        /// Bytes found.
        found: u64,
    },
    /// Bytes after the last element.
    #[error("expected the end of the file after {expected} bytes of elements, found more")]
    TrailingBytes {
        /// Bytes that the shape needs.
        expected: u128,
    },
    /// Longer than any index or value list of a network that is read.
    #[error("the array has {length} elements; expected {most} at most in a file of this length")]
    TooLong {
        /// Number of elements.
        length: u64,
        /// Most elements that would be kept.
        most: u64,
    },
    /// An archive that does not say which of its arrays is meant.
    #[error("expected the name of one array, since the archive holds: {found}")]
    Ambiguous {
        /// The names of its arrays.
        found: String,
    },
    /// An archive without the array asked for.
    #[error("expected an array called `{wanted}`; the archive holds: {found}")]
    NoArray {
        /// The array asked for.
        wanted: String,
        /// The names of its arrays.
        found: String,
    },
    /// An array of an archive could not be read.
    #[error("array `{name}`: {error}")]
    InArray {
        /// Its name.
        name: String,
        /// What is wrong with it.
        error: Box<NumpyError>,
    },
    /// A sparse matrix stored in a way that is not read.
    #[error("expected a sparse matrix in the format csr, csc or coo, found `{found}`")]
    SparseFormat {
        /// The format found.
        found: String,
    },
    /// Arrays of a sparse matrix whose lengths do not match.
    #[error("expected `{array}` of the sparse matrix to have {expected} elements, found {found}")]
    SparseLength {
        /// Name of the array.
        array: &'static str,
        /// Number of elements that the others call for.
        expected: u64,
        /// Number of elements found.
        found: u64,
    },
    /// An element that is no index, or pointers that do not ascend.
    #[error(
        "element {position} of `{array}`: expected a whole number from {from} to {to}, found {value}"
    )]
    BadIndex {
        /// Name of the array.
        array: &'static str,
        /// Position of the element from 0.
        position: usize,
        /// Least value that it may have.
        from: u64,
        /// Largest value that it may have.
        to: u64,
        /// Its value.
        value: f64,
    },
    /// The matrix is not a network.
    #[error(transparent)]
    Matrix(#[from] MatrixError),
}
