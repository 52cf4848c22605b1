//! Data elements of a MAT-file: tags, padding, numbers, and the header of a variable.
//!
//! An element is a tag (type and length in bytes, 32 bits each), its data, and padding to a
//! multiple of eight bytes. Data of four bytes or fewer may share the tag's eight: then the upper
//! half of the first word is the length and the lower half the type.

use std::io::{self, Read};

use super::error::MatlabError;
use crate::formats::binary::{ByteOrder, Interrupted, Number, fill, read_numbers};
use crate::formats::matrix::{MAX_ENTRIES, MatrixError};
use crate::formats::text::quoted;

/// Element type of a variable (miMATRIX).
pub(super) const MATRIX: u32 = 14;
/// Element type of a compressed variable (miCOMPRESSED).
pub(super) const COMPRESSED: u32 = 15;

// Some programs write dimensions without sign and names as UTF-8.
const FLAGS: &[u32] = &[6];
const DIMENSIONS: &[u32] = &[5, 6];
const NAME: &[u32] = &[1, 2, 16];

/// MATLAB allows names of 63 characters.
const MAX_NAME_BYTES: u64 = 256;
const MAX_DIMENSIONS: u64 = 64;

/// A source that knows how far it has been read.
pub(super) struct Bytes<'a> {
    source: &'a mut dyn Read,
    offset: u64,
    pub(super) order: ByteOrder,
    /// Numbers of unknown count that are read at most.
    most_numbers: u64,
}

/// Type and length of an element, and the data that share the tag.
pub(super) struct Tag {
    pub(super) kind: u32,
    pub(super) length: u64,
    small: Option<[u8; 4]>,
}

impl<'a> Bytes<'a> {
    pub(super) fn new(source: &'a mut dyn Read, offset: u64, order: ByteOrder) -> Self {
        Self { source, offset, order, most_numbers: MAX_ENTRIES as u64 }
    }

    /// The same where no more numbers than so many are to be kept.
    pub(super) fn keeping(self, most_numbers: u64) -> Self {
        Self { most_numbers: most_numbers.min(self.most_numbers), ..self }
    }

    /// Bytes before the next one.
    pub(super) fn offset(&self) -> u64 {
        self.offset
    }

    fn fill(&mut self, bytes: &mut [u8], expected: &'static str) -> Result<(), MatlabError> {
        let found = fill(self.source, bytes)?;
        self.offset += found as u64;
        match found == bytes.len() {
            true => Ok(()),
            false => Err(MatlabError::Truncated { offset: self.offset, expected }),
        }
    }

    /// The next element's tag, or none at the end of the source.
    pub(super) fn next_tag(&mut self) -> Result<Option<Tag>, MatlabError> {
        let mut bytes = [0; 8];
        match fill(self.source, &mut bytes)? {
            0 => return Ok(None),
            8 => self.offset += 8,
            found => {
                let offset = self.offset + found as u64;
                return Err(MatlabError::Truncated { offset, expected: "the tag of an element" });
            }
        }
        let [a, b, c, d, e, f, g, h] = bytes;
        let first = self.word([a, b, c, d]);
        Ok(Some(match first >> 16 {
            0 => Tag { kind: first, length: self.word([e, f, g, h]).into(), small: None },
            length => {
                Tag { kind: first & 0xffff, length: length.into(), small: Some([e, f, g, h]) }
            }
        }))
    }

    pub(super) fn word(&self, bytes: [u8; 4]) -> u32 {
        match self.order {
            ByteOrder::Little => u32::from_le_bytes(bytes),
            ByteOrder::Big => u32::from_be_bytes(bytes),
        }
    }

    /// Passes over so many bytes.
    pub(super) fn skip(&mut self, length: u64) -> Result<(), MatlabError> {
        let skipped = io::copy(&mut (&mut *self.source).take(length), &mut io::sink())?;
        self.offset += skipped;
        match skipped == length {
            true => Ok(()),
            false => {
                let expected = "the rest of an element";
                Err(MatlabError::Truncated { offset: self.offset, expected })
            }
        }
    }

    /// What `read` makes of the next `length` bytes; passes over what it leaves of them.
    pub(super) fn within<T>(
        &mut self,
        length: u64,
        read: impl FnOnce(&mut dyn Read) -> Result<T, MatlabError>,
    ) -> Result<T, MatlabError> {
        let mut content = (&mut *self.source).take(length);
        let result = read(&mut content)?;
        let rest = content.limit();
        self.offset += length - rest;
        self.skip(rest)?;
        Ok(result)
    }

    /// The tag of an element that must be there.
    fn tag(&mut self, expected: &'static str) -> Result<Tag, MatlabError> {
        let offset = self.offset;
        match self.next_tag()? {
            None => Err(MatlabError::Truncated { offset, expected }),
            Some(Tag { length, small: Some(_), .. }) if length > 4 => {
                Err(MatlabError::BadSmallElement { offset, length })
            }
            Some(tag) => Ok(tag),
        }
    }

    /// The data of an element of those types, which must be of `limit` bytes at most.
    fn small_data(
        &mut self,
        kinds: &[u32],
        limit: u64,
        expected: &'static str,
    ) -> Result<Vec<u8>, MatlabError> {
        let offset = self.offset;
        let tag = self.tag(expected)?;
        if !kinds.contains(&tag.kind) || tag.length > limit {
            let (kind, length) = (tag.kind, tag.length);
            return Err(MatlabError::UnexpectedElement { offset, expected, kind, length });
        }
        let length = usize::try_from(tag.length).unwrap_or(usize::MAX);
        if let Some(data) = tag.small {
            return Ok(data[..length].to_vec());
        }
        let mut data = vec![0; length];
        self.fill(&mut data, expected)?;
        self.skip(padding(tag.length))?;
        Ok(data)
    }

    fn words(
        &mut self,
        kinds: &[u32],
        limit: u64,
        expected: &'static str,
    ) -> Result<Vec<u32>, MatlabError> {
        let offset = self.offset;
        let data = self.small_data(kinds, 4 * limit, expected)?;
        if data.len() % 4 != 0 {
            let (kind, length) = (kinds[0], data.len() as u64);
            return Err(MatlabError::UnexpectedElement { offset, expected, kind, length });
        }
        Ok(data.chunks_exact(4).map(|w| self.word([w[0], w[1], w[2], w[3]])).collect())
    }

    /// Refuses so many numbers, if they are to be kept and are too many.
    pub(super) fn check_kept(&self, found: u64, what: &'static str) -> Result<(), MatlabError> {
        if found <= self.most_numbers {
            return Ok(());
        }
        Err(MatlabError::TooLong { offset: self.offset, what, found, most: self.most_numbers })
    }

    /// Numbers of any storage type: `count` of them, or, without it, at most as many as are kept.
    pub(super) fn numbers(
        &mut self,
        count: Option<u64>,
        expected: &'static str,
        take: impl FnMut(u64, f64) -> Result<(), MatrixError>,
    ) -> Result<(), MatlabError> {
        let offset = self.offset;
        let tag = self.tag(expected)?;
        let Some(number) = number(tag.kind) else {
            let (kind, length) = (tag.kind, tag.length);
            return Err(MatlabError::UnexpectedElement { offset, expected, kind, length });
        };
        let width = number.width() as u64;
        let (what, found) = (expected, tag.length / width);
        let count = match count {
            None => {
                self.check_kept(found, what)?;
                found
            }
            Some(count) => count,
        };
        if count.checked_mul(width) != Some(tag.length) {
            return Err(MatlabError::WrongCount { offset, what, expected: count, found });
        }
        let result = match tag.small {
            Some(data) => read_numbers(&mut &data[..], count, number, self.order, take),
            None => read_numbers(self.source, count, number, self.order, take),
        };
        result.map_err(|stop| match stop {
            Interrupted::Short(found) => {
                MatlabError::Truncated { offset: self.offset + found, expected }
            }
            Interrupted::Io(error) => MatlabError::Io(error),
            Interrupted::Refused(error) => MatlabError::Matrix(error),
        })?;
        if tag.small.is_none() {
            self.offset += tag.length;
            self.skip(padding(tag.length))?;
        }
        Ok(())
    }
}

/// Bytes after an element's data, up to a multiple of eight.
fn padding(length: u64) -> u64 {
    length.wrapping_neg() % 8
}

/// How numbers of a storage type lie in the file.
fn number(kind: u32) -> Option<Number> {
    Some(match kind {
        1 => Number::I8,
        2 => Number::U8,
        3 => Number::I16,
        4 => Number::U16,
        5 => Number::I32,
        6 => Number::U32,
        7 => Number::F32,
        9 => Number::F64,
        12 => Number::I64,
        13 => Number::U64,
        _ => return None,
    })
}

/// What MATLAB calls the kind of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    /// A full matrix of booleans, integers or real numbers.
    Numbers,
    Sparse,
    Other(&'static str),
}

/// What stands before the numbers of a variable.
pub(super) struct Variable {
    pub(super) name: String,
    pub(super) class: Class,
    pub(super) is_complex: bool,
    pub(super) dimensions: Vec<u32>,
}

impl Variable {
    pub(super) fn read(bytes: &mut Bytes<'_>) -> Result<Self, MatlabError> {
        let offset = bytes.offset();
        let flags = bytes.words(FLAGS, 2, "the flags of a variable")?;
        // The second word is the room of a sparse matrix, which its own elements tell again.
        let &[flags, _] = flags.as_slice() else {
            let (length, expected) = (4 * flags.len() as u64, "the flags of a variable, 8 bytes");
            return Err(MatlabError::UnexpectedElement {
                offset,
                expected,
                kind: FLAGS[0],
                length,
            });
        };
        let class = class(flags & 0xff);
        // An object of a class has other elements than its dimensions from here on.
        if class == Class::Other("an object") {
            let (name, dimensions, is_complex) = (String::new(), Vec::new(), false);
            return Ok(Self { name, class, is_complex, dimensions });
        }
        let dimensions = bytes.words(DIMENSIONS, MAX_DIMENSIONS, "the dimensions of a variable")?;
        let name = bytes.small_data(NAME, MAX_NAME_BYTES, "the name of a variable")?;
        let name = String::from_utf8_lossy(&name).into_owned();
        Ok(Self { name, class, is_complex: flags & 0x800 != 0, dimensions })
    }

    /// Rows and columns of a matrix.
    pub(super) fn shape(&self) -> Result<(u32, u32), MatlabError> {
        match self.dimensions.as_slice() {
            &[rows, columns] => Ok((rows, columns)),
            _ => {
                let (name, dimensions) = (quoted(&self.name), self.dimensions.clone());
                Err(MatlabError::NotMatrix { name, dimensions })
            }
        }
    }
}

fn class(code: u32) -> Class {
    match code {
        1 => Class::Other("a cell array"),
        2 => Class::Other("a structure"),
        4 => Class::Other("text"),
        5 => Class::Sparse,
        6..=15 => Class::Numbers,
        16 => Class::Other("a function"),
        3 | 17 => Class::Other("an object"),
        _ => Class::Other("a variable of unknown class"),
    }
}
