//! NumPy arrays: `.npy` files and `.npz` archives of them, with scipy's sparse matrices.
//!
//! An `.npy` file is a header and the elements as they lie in memory, row by row or (Fortran
//! order) column by column. An `.npz` is a zip archive of such files, `NAME.npy` each.
//! `scipy.sparse.save_npz` writes one that holds `format`, `shape`, `data` and the indices.
//!
//! Source: NumPy Enhancement Proposal 1, "A simple file format for NumPy arrays" (2007).

mod arrays;
mod error;
mod header;
mod sparse;

use std::io::{Read, Seek};

use self::arrays::{Array, Arrays};
pub use self::error::NumpyError;
use super::archive::listed;
use super::format::{Choice, Format};
use super::matrix::{Layout, MatrixBuilder, as_index};
use crate::RawNetwork;

/// Single arrays.
pub const NPY: Format = Format {
    name: "npy",
    summary: "A NumPy array, `.npy`",
    endings: &["npy"],
    lists_links: false,
    choices: &[Choice::Block, Choice::Rows],
    read: |source, options| Ok(read_npy(source, &options.layout)?),
};

/// Archives of arrays.
pub const NPZ: Format = Format {
    name: "npz",
    summary: "An archive of NumPy arrays or of one SciPy sparse matrix, `.npz`",
    endings: &["npz"],
    lists_links: false,
    choices: &[Choice::Variable, Choice::Block, Choice::Rows],
    read: |source, options| Ok(read_npz(source, options.variable.as_deref(), &options.layout)?),
};

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
