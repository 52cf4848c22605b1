//! The values of one line of a Matrix Market file, each with its place for the message it may need.

use std::str::FromStr;

use super::error::MatrixMarketError;
use crate::formats::matrix::as_index;
use crate::formats::text::quoted;

/// What the entries of a matrix are.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Field {
    Real,
    Integer,
    Pattern,
}

/// A value of a line.
#[derive(Clone, Copy, Default)]
pub(super) struct Word<'a> {
    line: usize,
    text: &'a str,
    offset: usize,
    word: &'a str,
}

/// The values of a line, of which there must be `count`, three at most.
pub(super) fn words<'a>(
    line: usize,
    text: &'a str,
    count: usize,
    expected: &'static str,
) -> Result<[Word<'a>; 3], MatrixMarketError> {
    let mut words = [Word::default(); 3];
    let mut found = 0;
    for word in text.split_whitespace() {
        let offset = word.as_ptr().addr() - text.as_ptr().addr();
        if let Some(place) = words.get_mut(found) {
            *place = Word { line, text, offset, word };
        }
        found += 1;
    }
    match found == count {
        true => Ok(words),
        false => Err(MatrixMarketError::WrongCount { line, expected, found }),
    }
}

impl Word<'_> {
    pub(super) fn size(&self) -> Result<u64, MatrixMarketError> {
        self.parse("a whole number")
    }

    /// An index from 0, written from 1.
    pub(super) fn index(&self, size: u64) -> Result<usize, MatrixMarketError> {
        let found: u64 = self.parse("an index")?;
        if (1..=size).contains(&found) {
            return Ok(as_index(found - 1));
        }
        let (line, column) = (self.line, self.column());
        Err(MatrixMarketError::IndexOutOfRange { line, column, size, found })
    }

    /// A value; it must be finite where the network will hold it.
    pub(super) fn value(&self, field: Field, is_taken: bool) -> Result<f64, MatrixMarketError> {
        if field == Field::Integer {
            // Whole numbers beyond 2^53 round as they do in every program that computes with them.
            return Ok(self.parse::<i128>("a whole number")? as f64);
        }
        let expected = "a finite number";
        let value: f64 = self.parse(expected)?;
        match value.is_finite() || !is_taken {
            true => Ok(value),
            false => Err(self.bad_number(expected)),
        }
    }

    fn parse<T: FromStr>(&self, expected: &'static str) -> Result<T, MatrixMarketError> {
        self.word.parse().map_err(|_| self.bad_number(expected))
    }

    fn bad_number(&self, expected: &'static str) -> MatrixMarketError {
        let (line, column, found) = (self.line, self.column(), quoted(self.word));
        MatrixMarketError::BadNumber { line, column, expected, found }
    }

    /// Where the value begins, in characters from 1.
    fn column(&self) -> usize {
        self.text[..self.offset].chars().count() + 1
    }
}
