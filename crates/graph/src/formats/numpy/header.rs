//! The header of an `.npy` file: a Python dictionary of element type, order and shape.
//!
//! ```text
//! \x93NUMPY 1 0 LENGTH {'descr': '<f8', 'fortran_order': False, 'shape': (3, 3), }
//! ```
//!
//! Source: NumPy Enhancement Proposal 1, "A simple file format for NumPy arrays" (2007), and the
//! format versions 2.0 and 3.0 that followed.

use std::io::Read;

use super::error::NumpyError;
use crate::formats::binary::{ByteOrder, Number, fill};
use crate::formats::text::quoted;

const MAGIC: &[u8; 6] = b"\x93NUMPY";

/// Longest header that is read, in bytes; NumPy itself trusts none beyond.
const MAX_HEADER_BYTES: u32 = 10_000;

/// What an `.npy` file says of its array.
pub(super) struct Header {
    pub(super) element: Element,
    pub(super) order: ByteOrder,
    pub(super) is_fortran: bool,
    pub(super) shape: Vec<u64>,
}

/// What the array holds.
#[derive(Clone, Copy)]
pub(super) enum Element {
    Number(Number),
    /// Bytes of text.
    Text(u64),
}

impl Header {
    pub(super) fn read(source: &mut dyn Read) -> Result<Self, NumpyError> {
        let mut start = [0; 8];
        let found = fill(source, &mut start)?;
        if !start.starts_with(MAGIC) {
            return Err(NumpyError::NotNpy);
        }
        let length = match start[6] {
            _ if found < start.len() => return Err(NumpyError::HeaderCut),
            1 => u32::from(u16::from_le_bytes(exact(source)?)),
            2 | 3 => u32::from_le_bytes(exact(source)?),
            _ => return Err(NumpyError::Version { major: start[6], minor: start[7] }),
        };
        if length > MAX_HEADER_BYTES {
            return Err(NumpyError::HeaderTooLong { length, limit: MAX_HEADER_BYTES });
        }
        let mut text = vec![0; length as usize];
        if fill(source, &mut text)? < text.len() {
            return Err(NumpyError::HeaderCut);
        }
        Dictionary { text: &String::from_utf8_lossy(&text), offset: 0 }.header()
    }
}

fn exact<const N: usize>(source: &mut dyn Read) -> Result<[u8; N], NumpyError> {
    let mut bytes = [0; N];
    match fill(source, &mut bytes)? == N {
        true => Ok(bytes),
        false => Err(NumpyError::HeaderCut),
    }
}

/// The dictionary, read from left to right.
struct Dictionary<'a> {
    text: &'a str,
    offset: usize,
}

impl<'a> Dictionary<'a> {
    fn header(mut self) -> Result<Header, NumpyError> {
        let (mut element, mut is_fortran, mut shape) = (None, None, None);
        self.expect('{')?;
        while !self.take('}') {
            let start = self.offset;
            let key = self.string("a key in quotes or `}`")?;
            self.expect(':')?;
            match key {
                "descr" => element = Some(self.element()?),
                "fortran_order" => is_fortran = Some(self.boolean()?),
                "shape" => shape = Some(self.shape()?),
                _ => {
                    self.offset = start;
                    return Err(self.unexpected("`descr`, `fortran_order` or `shape`"));
                }
            }
            if !self.take(',') {
                self.expect('}')?;
                break;
            }
        }
        if !self.rest().is_empty() {
            return Err(self.unexpected("nothing after the dictionary"));
        }
        let missing = |key| NumpyError::MissingKey { key };
        let (element, order) = element.ok_or_else(|| missing("descr"))?;
        let is_fortran = is_fortran.ok_or_else(|| missing("fortran_order"))?;
        let shape = shape.ok_or_else(|| missing("shape"))?;
        Ok(Header { element, order, is_fortran, shape })
    }

    fn element(&mut self) -> Result<(Element, ByteOrder), NumpyError> {
        if self.rest().starts_with('[') {
            return Err(NumpyError::UnsupportedType { found: "a structure".to_owned() });
        }
        let descr = self.string("an element type in quotes")?;
        parse_element(descr)
            .ok_or_else(|| NumpyError::UnsupportedType { found: format!("`{}`", quoted(descr)) })
    }

    fn boolean(&mut self) -> Result<bool, NumpyError> {
        let rest = self.rest();
        for (word, value) in [("True", true), ("False", false)] {
            if rest.starts_with(word) {
                self.offset += word.len();
                return Ok(value);
            }
        }
        Err(self.unexpected("`True` or `False`"))
    }

    fn shape(&mut self) -> Result<Vec<u64>, NumpyError> {
        self.expect('(')?;
        let mut shape = Vec::new();
        while !self.take(')') {
            shape.push(self.whole_number()?);
            if !self.take(',') {
                self.expect(')')?;
                break;
            }
        }
        Ok(shape)
    }

    fn whole_number(&mut self) -> Result<u64, NumpyError> {
        let rest = self.rest();
        let length = rest.bytes().take_while(u8::is_ascii_digit).count();
        let Ok(number) = rest[..length].parse() else {
            return Err(self.unexpected("a whole number"));
        };
        self.offset += length;
        // Python 2 wrote its long integers so.
        self.take('L');
        Ok(number)
    }

    fn string(&mut self, expected: &'static str) -> Result<&'a str, NumpyError> {
        let rest = self.rest();
        let Some(quote) = rest.chars().next().filter(|c| matches!(c, '\'' | '"')) else {
            return Err(self.unexpected(expected));
        };
        let Some(length) = rest[1..].find(quote) else {
            return Err(self.unexpected("a closing quote"));
        };
        self.offset += length + 2;
        Ok(&rest[1..=length])
    }

    fn expect(&mut self, c: char) -> Result<(), NumpyError> {
        let expected = match c {
            '{' => "`{`",
            '}' => "`,` or `}`",
            ':' => "`:`",
            '(' => "`(`",
            _ => "`,` or `)`",
        };
        if self.take(c) { Ok(()) } else { Err(self.unexpected(expected)) }
    }

    fn take(&mut self, c: char) -> bool {
        let is_next = self.rest().starts_with(c);
        self.offset += if is_next { c.len_utf8() } else { 0 };
        is_next
    }

    /// What follows, without blanks before it.
    fn rest(&mut self) -> &'a str {
        let rest = &self.text[self.offset..];
        let trimmed = rest.trim_start();
        self.offset += rest.len() - trimmed.len();
        trimmed
    }

    fn unexpected(&mut self, expected: &'static str) -> NumpyError {
        let found = quoted(self.rest());
        NumpyError::BadHeader { offset: self.offset, expected, found }
    }
}

fn parse_element(descr: &str) -> Option<(Element, ByteOrder)> {
    let (order, rest) = match descr.split_at_checked(1)? {
        ("<" | "|", rest) => (ByteOrder::Little, rest),
        (">", rest) => (ByteOrder::Big, rest),
        ("=", rest) if cfg!(target_endian = "big") => (ByteOrder::Big, rest),
        ("=", rest) => (ByteOrder::Little, rest),
        _ => return None,
    };
    let number = match rest {
        "b1" => Number::Bool,
        "i1" => Number::I8,
        "i2" => Number::I16,
        "i4" => Number::I32,
        "i8" => Number::I64,
        "u1" => Number::U8,
        "u2" => Number::U16,
        "u4" => Number::U32,
        "u8" => Number::U64,
        "f2" => Number::F16,
        "f4" => Number::F32,
        "f8" => Number::F64,
        _ => return Some((Element::Text(rest.strip_prefix('S')?.parse().ok()?), order)),
    };
    Some((Element::Number(number), order))
}
