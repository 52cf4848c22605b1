//! Full matrices as text: one row a line, in the manner of `numpy.savetxt`, spreadsheets and R.
//!
//! ```text
//! # a comment, as is every line that begins with %
//! ,V1,V2,A1          node labels: a first line that is not all numbers
//! V1,0,1.5,0         values separated by blanks, tabs, commas or semicolons
//! V2,1.5,0,2         a label before each row, where the first line has one column fewer or
//! A1,0,2,0           begins with an empty one
//! ```
//!
//! The first line decides the separator: a comma where there is one, else a semicolon, else a tab,
//! else blanks. Blanks beside any separator are passed over. Labels may stand in double quotes.

mod error;

use std::borrow::Cow;
use std::io::Read;

pub use self::error::DenseError;

use super::format::{Choice, Format};
use super::matrix::{Layout, MatrixBuilder};
use super::text::{Lines, quoted};
use crate::RawNetwork;

/// Full matrices as text.
pub const FORMAT: Format = Format {
    name: "dense",
    summary: "A full matrix as text: blanks, tabs, commas or semicolons between numbers",
    endings: &["csv", "dat"],
    lists_links: false,
    choices: &[Choice::Block, Choice::Rows],
    read: |source, options| Ok(read(source, &options.layout)?),
};

/// Longest line of a matrix in bytes: some 600,000 values of 25 characters.
pub const MAX_ROW_BYTES: usize = 16 * 1024 * 1024;

/// Reads a network from a full matrix; the module describes the format.
///
/// The network is directed until preparation makes it symmetric. Nodes are labelled "1", "2", …
/// where the file has no labels. Keeps one row of text at a time.
///
/// # Errors
/// [`DenseError`], naming the first line at fault.
pub fn read(source: impl Read, layout: &Layout) -> Result<RawNetwork, DenseError> {
    let Matrix { builder, labels, .. } = read_matrix(source, layout)?;
    Ok(match labels {
        Some(labels) => builder.finish_labelled(labels, true)?,
        None => builder.finish(true)?,
    })
}

/// A matrix before it has its final labels.
pub(super) struct Matrix {
    pub(super) builder: MatrixBuilder,
    /// Labels of all columns, where the file has them.
    pub(super) labels: Option<Vec<String>>,
    pub(super) n_rows: usize,
}

pub(super) fn read_matrix(source: impl Read, layout: &Layout) -> Result<Matrix, DenseError> {
    let mut lines = Lines::with_limit(source, MAX_ROW_BYTES);
    let mut table: Option<Table<'_>> = None;
    let mut header: Option<Header> = None;
    while let Some((line, text)) = lines.next_where(is_content)? {
        match (&mut table, &header) {
            (Some(table), _) => table.add(line, text)?,
            (None, Some(_)) => table = Some(Table::new(line, text, header.take(), layout)?),
            (None, None) => match Header::parse(line, text)? {
                Some(labels) => header = Some(labels),
                None => table = Some(Table::new(line, text, None, layout)?),
            },
        }
    }
    match table {
        Some(table) => table.finish(),
        None => Err(DenseError::Empty { lines: lines.n_lines() }),
    }
}

fn is_content(line: &str) -> bool {
    let line = line.trim();
    !line.is_empty() && !line.starts_with(['#', '%'])
}

/// The labels of the first line.
struct Header {
    line: usize,
    separator: Separator,
    labels: Vec<String>,
}

impl Header {
    /// The labels, or none where all values are numbers.
    fn parse(line: usize, text: &str) -> Result<Option<Self>, DenseError> {
        let separator = Separator::of(text);
        let mut labels = Vec::new();
        let mut all_numbers = true;
        for value in Values::new(line, text, separator) {
            let value = value?;
            all_numbers &= value.text.parse::<f64>().is_ok();
            labels.push(value.text.into_owned());
        }
        Ok((!all_numbers).then_some(Self { line, separator, labels }))
    }

    /// The labels of the columns, and whether each row begins with one too.
    fn columns(mut self, values: usize) -> Result<(Vec<String>, bool), DenseError> {
        let (line, labels) = (self.line, self.labels.len());
        if labels + 1 == values {
            return Ok((self.labels, true));
        }
        if labels != values {
            let values = values.saturating_sub(1);
            return Err(DenseError::WrongLabelCount { line, labels, values });
        }
        let has_corner = self.labels[0].is_empty();
        if has_corner {
            self.labels.remove(0);
        }
        Ok((self.labels, has_corner))
    }
}

/// Rows of one width.
struct Table<'a> {
    layout: &'a Layout,
    first_line: usize,
    separator: Separator,
    columns: usize,
    labels: Option<Vec<String>>,
    rows_are_labelled: bool,
    rows: usize,
    builder: MatrixBuilder,
}

impl<'a> Table<'a> {
    /// Begins with the first row, whose width decides that of all others.
    fn new(
        line: usize,
        text: &str,
        header: Option<Header>,
        layout: &'a Layout,
    ) -> Result<Self, DenseError> {
        let separator = header.as_ref().map_or_else(|| Separator::of(text), |h| h.separator);
        let mut columns = 0;
        for value in Values::new(line, text, separator) {
            value?;
            columns += 1;
        }
        let (labels, rows_are_labelled) = match header {
            Some(header) => header.columns(columns).map(|(labels, rows)| (Some(labels), rows))?,
            None => (None, false),
        };
        columns -= usize::from(rows_are_labelled);
        let size = columns as u64;
        let builder = MatrixBuilder::new(size, size, layout)?;
        let mut table = Self {
            layout,
            first_line: line,
            separator,
            columns,
            labels,
            rows_are_labelled,
            rows: 0,
            builder,
        };
        table.add(line, text)?;
        Ok(table)
    }

    fn add(&mut self, line: usize, text: &str) -> Result<(), DenseError> {
        let mut values = Values::new(line, text, self.separator);
        if self.rows_are_labelled
            && let Some(label) = values.next()
        {
            self.check_row_label(line, &label?.text)?;
        }
        let mut found = 0;
        for value in values {
            let value = value?;
            if found < self.columns {
                let takes = self.builder.takes(self.rows, found);
                self.builder.add(self.rows, found, number(line, text, &value, takes)?)?;
            }
            found += 1;
        }
        if found != self.columns {
            let (expected, first_line) = (self.columns, self.first_line);
            return Err(DenseError::RaggedRow { line, expected, first_line, found });
        }
        self.rows += 1;
        Ok(())
    }

    fn check_row_label(&self, line: usize, label: &str) -> Result<(), DenseError> {
        let expected = self.labels.as_ref().and_then(|labels| labels.get(self.rows));
        match expected {
            Some(expected) if expected != label => {
                let (expected, found) = (quoted(expected), quoted(label));
                Err(DenseError::WrongRowLabel { line, expected, found })
            }
            // A row beyond the last label is refused with the shape of the whole.
            _ => Ok(()),
        }
    }

    fn finish(self) -> Result<Matrix, DenseError> {
        self.layout.check_shape(self.rows as u64, self.columns as u64)?;
        Ok(Matrix { builder: self.builder, labels: self.labels, n_rows: self.rows })
    }
}

/// The number, which must be finite where the network will hold it.
fn number(line: usize, text: &str, value: &Value<'_>, is_taken: bool) -> Result<f64, DenseError> {
    match value.text.parse::<f64>() {
        Ok(number) if number.is_finite() || !is_taken => Ok(number),
        _ => {
            let column = text[..value.offset].chars().count() + 1;
            Err(DenseError::BadNumber { line, column, found: quoted(&value.text) })
        }
    }
}

/// What stands between two values.
#[derive(Clone, Copy)]
enum Separator {
    Blanks,
    One(char),
}

impl Separator {
    fn of(line: &str) -> Self {
        let outside_quotes = || line.split('"').step_by(2);
        let found = [',', ';', '\t'].into_iter().find(|&c| outside_quotes().any(|s| s.contains(c)));
        found.map_or(Self::Blanks, Self::One)
    }

    fn ends(self, c: char) -> bool {
        match self {
            Self::Blanks => c == ' ' || c == '\t',
            Self::One(separator) => c == separator,
        }
    }
}

/// A value of a line and where it begins, in bytes.
struct Value<'a> {
    text: Cow<'a, str>,
    offset: usize,
}

/// The values of a line from left to right; nothing after the first error.
struct Values<'a> {
    line: usize,
    text: &'a str,
    separator: Separator,
    /// Where the next value begins; none after the last.
    next: Option<usize>,
}

impl<'a> Values<'a> {
    fn new(line: usize, text: &'a str, separator: Separator) -> Self {
        // Blanks may end a line of them without another value to follow.
        let text = match separator {
            Separator::Blanks => text.trim_end(),
            Separator::One(_) => text,
        };
        Self { line, text, separator, next: Some(0) }
    }

    /// Where the first character that is not a blank beside a value stands, from `offset` on.
    fn skip_blanks(&self, offset: usize) -> usize {
        let rest = &self.text[offset..];
        let is_padding = |c| match self.separator {
            Separator::One(separator) if separator == c => false,
            _ => c == ' ' || c == '\t',
        };
        offset + rest.len() - rest.trim_start_matches(is_padding).len()
    }

    /// A value without quotes, and where it ends.
    fn bare(&self, offset: usize) -> (Cow<'a, str>, usize) {
        let rest = &self.text[offset..];
        let length = rest.find(|c| self.separator.ends(c)).unwrap_or(rest.len());
        (Cow::Borrowed(rest[..length].trim_end()), offset + length)
    }

    /// A value within quotes, and where what follows its closing quote begins.
    fn quoted(&self, opening: usize) -> Result<(Cow<'a, str>, usize), DenseError> {
        let mut value = String::new();
        let mut offset = opening + 1;
        loop {
            let rest = &self.text[offset..];
            let Some(length) = rest.find('"') else {
                return Err(self.bad_quote(opening, "a closing quote before the end of the line"));
            };
            value.push_str(&rest[..length]);
            offset += length + 1;
            if !self.text[offset..].starts_with('"') {
                break;
            }
            value.push('"');
            offset += 1;
        }
        let end = match self.separator {
            Separator::Blanks => offset,
            Separator::One(_) => self.skip_blanks(offset),
        };
        match self.text[end..].chars().next() {
            Some(c) if !self.separator.ends(c) => {
                Err(self.bad_quote(end, "a separator after the quote"))
            }
            _ => Ok((Cow::Owned(value), end)),
        }
    }

    fn bad_quote(&self, offset: usize, expected: &'static str) -> DenseError {
        let column = self.text[..offset].chars().count() + 1;
        DenseError::BadQuote { line: self.line, column, expected }
    }
}

impl<'a> Iterator for Values<'a> {
    type Item = Result<Value<'a>, DenseError>;

    fn next(&mut self) -> Option<Self::Item> {
        let start = self.next.take()?;
        let offset = self.skip_blanks(start);
        let found = match self.text[offset..].starts_with('"') {
            true => self.quoted(offset),
            false => Ok(self.bare(offset)),
        };
        Some(found.map(|(text, end)| {
            let separator = self.text[end..].chars().next();
            self.next = separator.map(|c| end + c.len_utf8());
            Value { text, offset }
        }))
    }
}
