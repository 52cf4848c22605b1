//! NumPy arrays: `.npy` files and `.npz` archives of them, with scipy's sparse matrices.
//!
//! An `.npy` file is a header and the elements as they lie in memory, row by row or (Fortran
//! order) column by column. An `.npz` is a zip archive of such files, `NAME.npy` each.
//! `scipy.sparse.save_npz` writes one that holds `format`, `shape`, `data` and the indices.
//!
//! Source: NumPy Enhancement Proposal 1, "A simple file format for NumPy arrays" (2007).

mod header;
mod sparse;

use std::io::{self, Read, Seek};

use thiserror::Error;

use self::header::{Element, Header};
use super::archive::{Archive, MAX_UNPACKED_BYTES, listed, most_kept};
use super::binary::{Interrupted, Number, fill, read_numbers};
use super::matrix::MatrixBuilder;
use super::text::quoted;
use super::{ArchiveError, Layout, MAX_ENTRIES, MatrixError};
use crate::RawNetwork;

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

/// Reads a network from a square `.npy` array of booleans, integers or real numbers.
///
/// The network is directed until preparation makes it symmetric; nodes are labelled "1", "2", ….
/// Keeps the non-zero elements only.
///
/// # Errors
/// [`NumpyError`].
pub fn read_npy(mut source: impl Read, layout: &Layout) -> Result<RawNetwork, NumpyError> {
    let array = Array::open(&mut source)?;
    let &[rows, columns] = array.header.shape.as_slice() else {
        return Err(array.wrong_dimensions(2));
    };
    let mut builder = MatrixBuilder::new(rows, columns, layout)?;
    let is_fortran = array.header.is_fortran;
    // Positions are below rows × columns, which are both above zero and fit as indices.
    array.read(|position, value| {
        // Most elements are zero, and the division is dear.
        if value == 0.0 {
            return Ok(());
        }
        let (row, column) = match is_fortran {
            true => (position % rows, position / rows),
            false => (position / columns, position % columns),
        };
        builder.add(as_index(row), as_index(column), value)
    })?;
    Ok(builder.finish(true)?)
}

/// Reads a network from an `.npz` archive: its array called `name`, or, without a name, its only
/// array or the sparse matrix that it holds (scipy's csr, csc or coo).
///
/// # Errors
/// [`NumpyError`]; [`NumpyError::InArray`] where one array of several is at fault.
pub fn read_npz(
    source: impl Read + Seek,
    name: Option<&str>,
    layout: &Layout,
) -> Result<RawNetwork, NumpyError> {
    let mut archive = Arrays::open(source)?;
    match name {
        Some(name) => archive.read(name, |source| read_npy(source, layout)),
        None if archive.is_sparse_matrix() => sparse::read(&mut archive, layout),
        None => match archive.names.as_slice() {
            [only] => {
                let only = only.clone();
                archive.read(&only, |source| read_npy(source, layout))
            }
            names => Err(NumpyError::Ambiguous { found: listed(names) }),
        },
    }
}

/// The arrays of an `.npz`, by name.
struct Arrays<R> {
    archive: Archive<R>,
    names: Vec<String>,
    places: Vec<usize>,
}

impl<R: Read + Seek> Arrays<R> {
    fn open(source: R) -> Result<Self, NumpyError> {
        let archive = Archive::new(source)?;
        let arrays = archive.names().iter().enumerate();
        let (places, names) = arrays
            .filter_map(|(place, name)| Some((place, name.strip_suffix(".npy")?.to_owned())))
            .unzip();
        Ok(Self { archive, names, places })
    }

    /// Elements that are kept of one array, at most.
    fn most_kept(&self) -> u64 {
        most_kept(self.archive.packed_bytes()).min(MAX_ENTRIES as u64)
    }

    fn is_sparse_matrix(&self) -> bool {
        ["format", "shape", "data"].iter().all(|&name| self.names.iter().any(|n| n == name))
    }

    /// What `read` makes of the array; an error names it.
    fn read<T>(
        &mut self,
        name: &str,
        read: impl FnOnce(&mut dyn Read) -> Result<T, NumpyError>,
    ) -> Result<T, NumpyError> {
        let Some(place) = self.names.iter().position(|n| n == name) else {
            let (wanted, found) = (quoted(name), listed(&self.names));
            return Err(NumpyError::NoArray { wanted, found });
        };
        let mut content = self.archive.open(self.places[place], MAX_UNPACKED_BYTES)?;
        read(&mut content)
            .map_err(|error| NumpyError::InArray { name: quoted(name), error: Box::new(error) })
    }
}

/// An array whose header has been read.
struct Array<'a> {
    header: Header,
    number: Number,
    source: &'a mut dyn Read,
}

impl<'a> Array<'a> {
    /// An array of numbers.
    fn open(source: &'a mut dyn Read) -> Result<Self, NumpyError> {
        let header = Header::read(source)?;
        match header.element {
            Element::Number(number) => Ok(Self { header, number, source }),
            Element::Text(_) => Err(NumpyError::UnsupportedType { found: "text".to_owned() }),
        }
    }

    fn wrong_dimensions(self, expected: usize) -> NumpyError {
        NumpyError::WrongDimensions { expected, shape: self.header.shape }
    }

    /// Hands every element and its position in the file to `take`, and expects the file's end.
    fn read(self, take: impl FnMut(u64, f64) -> Result<(), MatrixError>) -> Result<(), NumpyError> {
        let n_elements = self.header.shape.iter().map(|&n| u128::from(n)).product::<u128>();
        let expected = n_elements * self.number.width() as u128;
        // More elements than 64 bits count cannot be there: the file ends before.
        let count = u64::try_from(n_elements).unwrap_or(u64::MAX);
        let order = self.header.order;
        read_numbers(self.source, count, self.number, order, take).map_err(|stop| match stop {
            Interrupted::Short(found) => NumpyError::Truncated { expected, found },
            Interrupted::Io(error) => NumpyError::Io(error),
            Interrupted::Refused(error) => NumpyError::Matrix(error),
        })?;
        match fill(self.source, &mut [0])? {
            0 => Ok(()),
            _ => Err(NumpyError::TrailingBytes { expected }),
        }
    }

    /// All elements of an array of one dimension.
    fn vector(self, most: u64) -> Result<Vec<f64>, NumpyError> {
        let &[length] = self.header.shape.as_slice() else {
            return Err(self.wrong_dimensions(1));
        };
        if length > most {
            return Err(NumpyError::TooLong { length, most });
        }
        // No capacity is reserved: the length is only a claim until the elements are there.
        let mut elements = Vec::new();
        self.read(|_, value| {
            elements.push(value);
            Ok(())
        })?;
        Ok(elements)
    }
}

fn as_index(index: u64) -> usize {
    usize::try_from(index).unwrap_or(usize::MAX)
}
