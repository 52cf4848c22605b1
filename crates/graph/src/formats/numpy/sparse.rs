//! Sparse matrices as `scipy.sparse.save_npz` writes them.
//!
//! `csr`: the entries of row i are `indices[k]`, `data[k]` for `indptr[i]` ≤ k < `indptr[i + 1]`;
//! `csc` the same by columns; `coo`: entry k stands in row `row[k]`, column `col[k]`.

use std::io::{Read, Seek};

use super::arrays::{Array, Arrays};
use super::error::NumpyError;
use super::header::{Element, Header};
use crate::RawNetwork;
use crate::formats::binary::fill;
use crate::formats::matrix::{Layout, MatrixBuilder, MatrixError, as_index};
use crate::formats::text::quoted;

/// Longest name of a format that is read.
const MAX_FORMAT_BYTES: u64 = 16;

pub(super) fn read<R: Read + Seek>(
    arrays: &mut Arrays<R>,
    layout: &Layout,
) -> Result<RawNetwork, NumpyError> {
    let format = arrays.read("format", format_name)?;
    // Data of other formats, such as bsr, need not even be a vector.
    if !["csr", "csc", "coo"].contains(&format.as_str()) {
        return Err(NumpyError::SparseFormat { found: quoted(&format) });
    }
    let shape = vector(arrays, "shape")?;
    let &[rows, columns] = shape.as_slice() else {
        let found = shape.len() as u64;
        return Err(NumpyError::SparseLength { array: "shape", expected: 2, found });
    };
    let size = |position, value| whole_number("shape", position, value, 0, u64::from(u32::MAX));
    let (rows, columns) = (size(0, rows)?, size(1, columns)?);
    let mut builder = MatrixBuilder::new(rows, columns, layout)?;
    let data = vector(arrays, "data")?;
    let mut add = |row: u64, column: u64, value: f64| -> Result<(), MatrixError> {
        builder.add(as_index(row), as_index(column), value)
    };
    match format.as_str() {
        "csr" => compressed(arrays, &data, rows, columns, add)?,
        "csc" => compressed(arrays, &data, columns, rows, |j, i, value| add(i, j, value))?,
        _ => coordinates(arrays, &data, rows, columns, add)?,
    }
    Ok(builder.finish(true)?)
}

/// The text of the array that names the format.
fn format_name(source: &mut dyn Read) -> Result<String, NumpyError> {
    let header = Header::read(source)?;
    let length = match header.element {
        Element::Text(length) if length <= MAX_FORMAT_BYTES => length,
        _ => return Err(NumpyError::UnsupportedType { found: "a format that is no text".into() }),
    };
    if !header.shape.is_empty() {
        return Err(NumpyError::WrongDimensions { expected: 0, shape: header.shape });
    }
    let mut text = vec![0; as_index(length)];
    let found = fill(source, &mut text)?;
    if found < text.len() {
        return Err(NumpyError::Truncated { expected: u128::from(length), found: found as u64 });
    }
    Ok(String::from_utf8_lossy(&text).trim_end_matches('\0').to_owned())
}

/// Entries by rows, or by columns with the roles exchanged.
fn compressed<R: Read + Seek>(
    arrays: &mut Arrays<R>,
    data: &[f64],
    n_outer: u64,
    n_inner: u64,
    mut add: impl FnMut(u64, u64, f64) -> Result<(), MatrixError>,
) -> Result<(), NumpyError> {
    let indices = vector(arrays, "indices")?;
    let pointers = vector(arrays, "indptr")?;
    expect_length("indices", data.len() as u64, indices.len())?;
    expect_length("indptr", n_outer + 1, pointers.len())?;
    let n_entries = data.len() as u64;
    let mut start = whole_number("indptr", 0, pointers[0], 0, 0)?;
    for (outer, &pointer) in (0..n_outer).zip(&pointers[1..]) {
        let position = as_index(outer) + 1;
        // The last pointer must reach the end, or entries would be left out.
        let least = if outer + 1 == n_outer { n_entries } else { start };
        let end = whole_number("indptr", position, pointer, least, n_entries)?;
        for k in as_index(start)..as_index(end) {
            let inner = index("indices", k, indices[k], n_inner)?;
            add(outer, inner, data[k])?;
        }
        start = end;
    }
    Ok(())
}

fn coordinates<R: Read + Seek>(
    arrays: &mut Arrays<R>,
    data: &[f64],
    rows: u64,
    columns: u64,
    mut add: impl FnMut(u64, u64, f64) -> Result<(), MatrixError>,
) -> Result<(), NumpyError> {
    let (row, column) = (vector(arrays, "row")?, vector(arrays, "col")?);
    expect_length("row", data.len() as u64, row.len())?;
    expect_length("col", data.len() as u64, column.len())?;
    for (k, &value) in data.iter().enumerate() {
        add(index("row", k, row[k], rows)?, index("col", k, column[k], columns)?, value)?;
    }
    Ok(())
}

fn vector<R: Read + Seek>(arrays: &mut Arrays<R>, name: &str) -> Result<Vec<f64>, NumpyError> {
    let most = arrays.most_kept();
    arrays.read(name, |source| Array::open(source)?.vector(most))
}

fn expect_length(array: &'static str, expected: u64, found: usize) -> Result<(), NumpyError> {
    let found = found as u64;
    if found == expected {
        return Ok(());
    }
    Err(NumpyError::SparseLength { array, expected, found })
}

fn index(array: &'static str, position: usize, value: f64, size: u64) -> Result<u64, NumpyError> {
    whole_number(array, position, value, 0, size.saturating_sub(1))
}

/// The whole number that a double below 2^53 holds exactly.
fn whole_number(
    array: &'static str,
    position: usize,
    value: f64,
    from: u64,
    to: u64,
) -> Result<u64, NumpyError> {
    let number = value as u64;
    if number as f64 == value && (from..=to).contains(&number) {
        return Ok(number);
    }
    Err(NumpyError::BadIndex { array, position, from, to, value })
}
