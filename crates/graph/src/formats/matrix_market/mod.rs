//! Matrix Market exchange format: sparse (`coordinate`) and full (`array`) matrices as text.
//!
//! ```text
//! %%MatrixMarket matrix coordinate real symmetric
//! % comments
//! 3 3 2          rows, columns, entries that follow
//! 2 1 0.5        row, column (from 1), value; no value where the field is `pattern`
//! 3 2 1.5
//! ```
//!
//! An `array` states rows and columns only and lists its values column by column; a symmetric one
//! from the diagonal down.
//!
//! Source: Boisvert, Pozo & Remington, "The Matrix Market exchange formats: initial design",
//! NISTIR 5935 (1996).

mod error;
mod words;

use std::io::Read;

pub use self::error::MatrixMarketError;
use self::words::{Field, words};
use super::format::{Choice, Format};
use super::matrix::{Layout, MatrixBuilder, as_index};
use super::plain::{Plain, plain};
use super::text::{Lines, TextError, quoted};
use crate::RawNetwork;

/// Matrix Market.
pub const FORMAT: Format = Format {
    name: "matrix_market",
    summary: "Matrix Market, coordinate or array",
    endings: &["mtx"],
    lists_links: true,
    choices: &[Choice::Block, Choice::Rows],
    read: |source, options| Ok(read(source, &options.layout)?),
};

/// Reads a network from a Matrix Market file; the module describes the format.
///
/// A `symmetric` matrix gives an undirected network and may list either triangle, each entry once;
/// a `general` one is directed. Nodes are labelled "1", "2", … by their rows. Entries of zero are
/// no links.
///
/// # Errors
/// [`MatrixMarketError`], naming the first line at fault.
pub fn read(source: impl Read, layout: &Layout) -> Result<RawNetwork, MatrixMarketError> {
    let mut lines = Lines::new(source);
    let header = match lines.next_line()? {
        Some((_, text)) => Header::parse(text)?,
        None => return Err(MatrixMarketError::NoHeader { found: String::new() }),
    };
    let mut file = File { lines, header };
    let size = file.size()?;
    let mut builder = MatrixBuilder::new(size.rows, size.columns, layout)?;
    match header.is_sparse {
        true => file.read_coordinates(&size, &mut builder)?,
        false => file.read_array(&size, &mut builder)?,
    }
    file.expect_end(size.entries)?;
    Ok(builder.finish(!header.is_symmetric)?)
}

#[derive(Clone, Copy)]
struct Header {
    is_sparse: bool,
    field: Field,
    is_symmetric: bool,
}

/// Numbers of the line that follows the comments.
struct Size {
    rows: u64,
    columns: u64,
    entries: u64,
}

impl Header {
    fn parse(text: &str) -> Result<Self, MatrixMarketError> {
        let words: Vec<String> = text.split_whitespace().map(str::to_ascii_lowercase).collect();
        let [banner, object, format, field, symmetry] = words.as_slice() else {
            return Err(MatrixMarketError::NoHeader { found: quoted(text) });
        };
        if banner != "%%matrixmarket" {
            return Err(MatrixMarketError::NoHeader { found: quoted(text) });
        }
        choose(object, "`matrix`", &[("matrix", ())])?;
        let formats = [("coordinate", true), ("array", false)];
        let is_sparse = choose(format, "`coordinate` or `array`", &formats)?;
        let fields = [
            ("real", Field::Real),
            ("double", Field::Real),
            ("integer", Field::Integer),
            ("unsigned-integer", Field::Integer),
            ("pattern", Field::Pattern),
        ];
        let known = if is_sparse { &fields[..] } else { &fields[..4] };
        let names = match is_sparse {
            true => "`real`, `integer` or `pattern`",
            false => "`real` or `integer`, as values of an array",
        };
        let field = choose(field, names, known)?;
        let symmetries = [("symmetric", true), ("general", false)];
        let is_symmetric = choose(symmetry, "`general` or `symmetric`", &symmetries)?;
        Ok(Self { is_sparse, field, is_symmetric })
    }
}

fn choose<T: Copy>(
    word: &str,
    expected: &'static str,
    known: &[(&str, T)],
) -> Result<T, MatrixMarketError> {
    match known.iter().find(|(name, _)| *name == word) {
        Some(&(_, meaning)) => Ok(meaning),
        None => Err(MatrixMarketError::BadHeader { expected, found: quoted(word) }),
    }
}

/// The part of a file after its header.
struct File<R> {
    lines: Lines<R>,
    header: Header,
}

impl<R: Read> File<R> {
    /// The next line that is neither blank nor a comment.
    fn next_line(&mut self) -> Result<Option<(usize, &str)>, TextError> {
        self.lines.next_where(|text| !text.trim_start().is_empty() && !text.starts_with('%'))
    }

    fn size(&mut self) -> Result<Size, MatrixMarketError> {
        let header = self.header;
        let (count, expected) = match header.is_sparse {
            true => (3, "the numbers of rows, columns and entries"),
            false => (2, "the numbers of rows and columns"),
        };
        let Some((line, text)) = self.next_line()? else {
            return Err(MatrixMarketError::NoSize { expected, lines: self.lines.n_lines() });
        };
        let words = words(line, text, count, expected)?;
        let (rows, columns) = (words[0].size()?, words[1].size()?);
        if header.is_symmetric && rows != columns {
            return Err(MatrixMarketError::SymmetricNotSquare { line, rows, columns });
        }
        // A count beyond 64 bits saturates: so many nodes are refused before the first value.
        let entries = match (header.is_sparse, header.is_symmetric) {
            (true, _) => words[2].size()?,
            (false, true) => u64::try_from(triangle(rows)).unwrap_or(u64::MAX),
            (false, false) => rows.saturating_mul(columns),
        };
        Ok(Size { rows, columns, entries })
    }

    fn read_coordinates(
        &mut self,
        size: &Size,
        builder: &mut MatrixBuilder,
    ) -> Result<(), MatrixMarketError> {
        let header = self.header;
        let (count, expected) = match header.field {
            Field::Pattern => (2, "a row and a column"),
            Field::Real | Field::Integer => (3, "a row, a column and a value"),
        };
        for found in 0..size.entries {
            let Some((line, text)) = self.next_line()? else {
                return Err(self.too_few(size.entries, found));
            };
            let (row, column, value) = match plain_entry(text, header.field, size) {
                Some(entry) => entry,
                None => {
                    let words = words(line, text, count, expected)?;
                    let (row, column) = (words[0].index(size.rows)?, words[1].index(size.columns)?);
                    let value = match header.field {
                        Field::Pattern => 1.0,
                        field => words[2].value(field, builder.takes(row, column))?,
                    };
                    (row, column, value)
                }
            };
            builder.add(row, column, value)?;
            if header.is_symmetric && row != column {
                builder.add(column, row, value)?;
            }
        }
        Ok(())
    }

    fn read_array(
        &mut self,
        size: &Size,
        builder: &mut MatrixBuilder,
    ) -> Result<(), MatrixMarketError> {
        let header = self.header;
        let mut found = 0;
        for column in 0..size.columns {
            let first_row = if header.is_symmetric { column } else { 0 };
            for row in first_row..size.rows {
                let Some((line, text)) = self.next_line()? else {
                    return Err(self.too_few(size.entries, found));
                };
                let words = words(line, text, 1, "one value")?;
                let (row, column) = (as_index(row), as_index(column));
                let value = words[0].value(header.field, builder.takes(row, column))?;
                builder.add(row, column, value)?;
                if header.is_symmetric && row != column {
                    builder.add(column, row, value)?;
                }
                found += 1;
            }
        }
        Ok(())
    }

    fn too_few(&self, expected: u64, found: u64) -> MatrixMarketError {
        MatrixMarketError::TooFewEntries { expected, found, lines: self.lines.n_lines() }
    }

    fn expect_end(&mut self, expected: u64) -> Result<(), MatrixMarketError> {
        match self.next_line()? {
            None => Ok(()),
            Some((line, text)) => {
                let found = quoted(text);
                Err(MatrixMarketError::TooManyEntries { line, expected, found })
            }
        }
    }
}

/// The entry of a line of the commonest form, in which nothing is wrong: row and column from 0.
fn plain_entry(text: &str, field: Field, size: &Size) -> Option<(usize, usize, f64)> {
    let Plain { first, second, value } = plain(text, false)?;
    let is_within = (1..=size.rows).contains(&first) && (1..=size.columns).contains(&second);
    let value = match (field, value) {
        (Field::Pattern, None) => 1.0,
        (Field::Real, Some(value)) => value.parse().ok().filter(|value: &f64| value.is_finite())?,
        _ => return None,
    };
    is_within.then(|| (as_index(first - 1), as_index(second - 1), value))
}

/// Entries of a symmetric matrix on and below its diagonal.
fn triangle(rows: u64) -> u128 {
    u128::from(rows) * (u128::from(rows) + 1) / 2
}
