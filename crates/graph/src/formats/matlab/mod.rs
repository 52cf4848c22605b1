//! MATLAB's MAT-files of level 5 (`save -v6` and `save -v7`): full and sparse matrices.
//!
//! A header of 128 bytes, then one element a variable, which level 7 compresses with zlib. A full
//! matrix lists its values column by column, stored as any type that holds them. A sparse one lists
//! row indices (from 0), the place where each column begins in them, and values.
//!
//! Source: The MathWorks, "MAT-File Format" (R2024b), chapter 1, level 5.

mod element;
mod error;

use std::io::{self, Read};

use self::element::{Bytes, COMPRESSED, Class, MATRIX, Tag, Variable};
pub use self::error::MatlabError;
use super::archive::{Limited, MAX_UNPACKED_BYTES, listed, most_kept};
use super::binary::{ByteOrder, fill};
use super::format::{Choice, Format};
use super::matrix::{Layout, MatrixBuilder, as_index};
use super::text::quoted;
use crate::RawNetwork;
use flate2::read::ZlibDecoder;

/// MATLAB's files of level 5.
pub const FORMAT: Format = Format {
    name: "matlab",
    summary: "A MATLAB file of level 5, `.mat`",
    endings: &["mat"],
    lists_links: false,
    choices: &[Choice::Variable, Choice::Block, Choice::Rows],
    read: |source, options| Ok(read(source, options.variable.as_deref(), &options.layout)?),
};

const HEADER_BYTES: u64 = 128;

/// Most names of variables that are kept to be listed in an error.
const MAX_NAMES: usize = 1000;

/// Most numbers of one part of a compressed sparse matrix; larger ones can be saved uncompressed.
const MAX_UNPACKED_NUMBERS: u64 = 1 << 25;

/// Reads a network from the matrix called `variable`, or, without a name, from the only matrix of
/// numbers with more than one row and column.
///
/// The network is directed until preparation makes it symmetric. Nodes are labelled "1", "2", … by
/// their rows. Other variables are passed over.
///
/// # Errors
/// [`MatlabError`]; [`MatlabError::InVariable`] where a variable is at fault.
pub fn read(
    mut source: impl Read,
    variable: Option<&str>,
    layout: &Layout,
) -> Result<RawNetwork, MatlabError> {
    let order = byte_order(&mut source)?;
    let mut bytes = Bytes::new(&mut source, HEADER_BYTES, order);
    let mut search = Search { variable, layout, names: Vec::new(), matrix: None };
    loop {
        let offset = bytes.offset();
        let Some(tag) = bytes.next_tag()? else { return search.result() };
        if tag.kind != MATRIX && tag.kind != COMPRESSED {
            let (expected, kind, length) = ("a variable", tag.kind, tag.length);
            return Err(MatlabError::UnexpectedElement { offset, expected, kind, length });
        }
        bytes.within(tag.length, |content| {
            let found = match tag.kind {
                COMPRESSED => search.unpack(content, tag.length, order),
                _ => search.look_at(&mut Bytes::new(content, offset + 8, order)),
            };
            found.map_err(|error| MatlabError::InVariable { offset, error: Box::new(error) })
        })?;
        if variable.is_some() && search.matrix.is_some() {
            return search.result();
        }
    }
}

/// Reads the header, of which only the last four bytes matter.
fn byte_order(source: &mut impl Read) -> Result<ByteOrder, MatlabError> {
    let mut header = [0; HEADER_BYTES as usize];
    let length = fill(source, &mut header)?;
    let found = match &header {
        _ if length < header.len() => "a file of fewer than 128 bytes",
        [.., 0x00, 0x01, b'I', b'M'] => return Ok(ByteOrder::Little),
        [.., 0x01, 0x00, b'M', b'I'] => return Ok(ByteOrder::Big),
        [.., 0x00, 0x02, b'I', b'M'] => "level 7.3 (HDF5); `save -v7` writes level 5",
        _ if header[..4].contains(&0) => "level 4, or another format; `save -v7` writes level 5",
        _ => "another format",
    };
    Err(MatlabError::NotLevel5 { found })
}

/// Looks for the matrix and remembers what else there is.
struct Search<'a> {
    variable: Option<&'a str>,
    layout: &'a Layout,
    /// All variables, or, without a name to look for, all that could be meant.
    names: Vec<String>,
    matrix: Option<RawNetwork>,
}

impl Search<'_> {
    /// A variable that is compressed as a whole.
    fn unpack(
        &mut self,
        packed: &mut dyn Read,
        packed_bytes: u64,
        order: ByteOrder,
    ) -> Result<(), MatlabError> {
        let mut content = Limited::new(ZlibDecoder::new(packed), MAX_UNPACKED_BYTES);
        let expected = "a variable within the compressed element";
        let length = match Bytes::new(&mut content, 0, order).next_tag()? {
            Some(tag) if tag.kind == MATRIX => tag.length,
            Some(Tag { kind, length, .. }) => {
                return Err(MatlabError::UnexpectedElement { offset: 0, expected, kind, length });
            }
            None => return Err(MatlabError::Truncated { offset: 0, expected }),
        };
        let had_matrix = self.matrix.is_some();
        let mut unpacked = content.by_ref().take(length);
        // The length of the packed element is a claim as well.
        let most = most_kept(packed_bytes).min(MAX_UNPACKED_NUMBERS);
        self.look_at(&mut Bytes::new(&mut unpacked, 8, order).keeping(most))?;
        // The checksum stands at the end; what is not wanted need not be unpacked so far.
        if self.matrix.is_some() != had_matrix {
            io::copy(&mut content, &mut io::sink())?;
        }
        Ok(())
    }

    /// Reads the variable if it is meant.
    fn look_at(&mut self, bytes: &mut Bytes<'_>) -> Result<(), MatlabError> {
        let variable = Variable::read(bytes)?;
        let is_meant = match self.variable {
            Some(wanted) => wanted == variable.name,
            None => {
                !matches!(variable.class, Class::Other(_))
                    && variable.dimensions.len() == 2
                    && variable.dimensions.iter().all(|&n| n > 1)
            }
        };
        if (is_meant || self.variable.is_some()) && self.names.len() < MAX_NAMES {
            self.names.push(variable.name.clone());
        }
        // A second one that could be meant need not be read to be in the way of the first.
        if is_meant && self.matrix.is_none() {
            self.matrix = Some(read_matrix(&variable, bytes, self.layout)?);
        }
        Ok(())
    }

    fn result(self) -> Result<RawNetwork, MatlabError> {
        let found = listed(&self.names);
        match (self.matrix, self.variable) {
            (Some(matrix), Some(_)) => Ok(matrix),
            (Some(matrix), None) if self.names.len() == 1 => Ok(matrix),
            (None, Some(wanted)) => Err(MatlabError::NoVariable { wanted: quoted(wanted), found }),
            (_, None) => Err(MatlabError::Ambiguous { found }),
        }
    }
}

fn read_matrix(
    variable: &Variable,
    bytes: &mut Bytes<'_>,
    layout: &Layout,
) -> Result<RawNetwork, MatlabError> {
    let not_numbers = |found| MatlabError::NotNumbers { name: quoted(&variable.name), found };
    if let Class::Other(found) = variable.class {
        return Err(not_numbers(found));
    }
    if variable.is_complex {
        return Err(not_numbers("complex numbers"));
    }
    let (rows, columns) = variable.shape()?;
    let mut builder = MatrixBuilder::new(rows.into(), columns.into(), layout)?;
    match variable.class {
        Class::Sparse => read_sparse(rows, columns, bytes, &mut builder)?,
        _ => {
            let rows = u64::from(rows);
            let count = Some(rows * u64::from(columns));
            bytes.numbers(count, "the matrix", |position, value| match value {
                // Most elements are zero, and the division is dear.
                0.0 => Ok(()),
                _ => builder.add(as_index(position % rows), as_index(position / rows), value),
            })?;
        }
    }
    Ok(builder.finish(true)?)
}

/// Column j holds the entries k with `starts[j]` ≤ k < `starts[j + 1]`, each in row `indices[k]`.
///
/// There may be room for more indices and values than there are entries.
fn read_sparse(
    rows: u32,
    columns: u32,
    bytes: &mut Bytes<'_>,
    builder: &mut MatrixBuilder,
) -> Result<(), MatlabError> {
    let indices = vector(bytes, None, "row indices")?;
    let starts = vector(bytes, Some(u64::from(columns) + 1), "starts of columns")?;
    let values = vector(bytes, None, "values")?;
    let room = indices.len().min(values.len());
    let room = u32::try_from(room).expect("no more than MAX_ENTRIES have been read");
    let mut start = whole_number("start of column", 0, starts[0], 0, 0)?;
    for column in 0..as_index(columns.into()) {
        let end = whole_number("start of column", column + 1, starts[column + 1], start, room)?;
        for k in as_index(start.into())..as_index(end.into()) {
            let row = whole_number("row index", k, indices[k], 0, rows.saturating_sub(1))?;
            builder.add(as_index(row.into()), column, values[k])?;
        }
        start = end;
    }
    Ok(())
}

/// No capacity is reserved: the count is only a claim until the numbers are there.
fn vector(
    bytes: &mut Bytes<'_>,
    count: Option<u64>,
    expected: &'static str,
) -> Result<Vec<f64>, MatlabError> {
    let mut numbers = Vec::new();
    bytes.check_kept(count.unwrap_or(0), expected)?;
    bytes.numbers(count, expected, |_, number| {
        numbers.push(number);
        Ok(())
    })?;
    Ok(numbers)
}

fn whole_number(
    what: &'static str,
    position: usize,
    value: f64,
    from: u32,
    to: u32,
) -> Result<u32, MatlabError> {
    let number = value as u32;
    if f64::from(number) == value && (from..=to).contains(&number) {
        return Ok(number);
    }
    Err(MatlabError::BadIndex { what, position, from, to, value })
}
