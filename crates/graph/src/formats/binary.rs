//! Numbers in binary files: their kinds, widths and byte orders, read as a stream in bounded memory.

use std::io::{self, ErrorKind, Read};

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Number {
    Bool,
    I8,
    I16,
    I32,
    I64,
    U8,
    U16,
    U32,
    U64,
    F16,
    F32,
    F64,
}

/// Which byte of a number comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ByteOrder {
    /// The least significant one.
    Little,
    /// The most significant one.
    Big,
}

/// Most bytes that are read at a time; a multiple of every width.
const CHUNK_BYTES: usize = 64 * 1024;

impl Number {
    /// Bytes that one number takes.
    pub(super) fn width(self) -> usize {
        match self {
            Self::Bool | Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 | Self::F16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// The numbers in `bytes`, whole widths of them; 64-bit integers round to the nearest double.
    fn decode(self, bytes: &[u8], order: ByteOrder, numbers: &mut Vec<f64>) {
        numbers.clear();
        match self {
            Self::Bool => each(bytes, order, numbers, |[b]: [u8; 1]| f64::from(u8::from(b != 0))),
            Self::I8 => each(bytes, order, numbers, |b| i8::from_le_bytes(b).into()),
            Self::I16 => each(bytes, order, numbers, |b| i16::from_le_bytes(b).into()),
            Self::I32 => each(bytes, order, numbers, |b| i32::from_le_bytes(b).into()),
            Self::I64 => each(bytes, order, numbers, |b| i64::from_le_bytes(b) as f64),
            Self::U8 => each(bytes, order, numbers, |b| u8::from_le_bytes(b).into()),
            Self::U16 => each(bytes, order, numbers, |b| u16::from_le_bytes(b).into()),
            Self::U32 => each(bytes, order, numbers, |b| u32::from_le_bytes(b).into()),
            Self::U64 => each(bytes, order, numbers, |b| u64::from_le_bytes(b) as f64),
            Self::F16 => each(bytes, order, numbers, |b| half(u16::from_le_bytes(b))),
            Self::F32 => each(bytes, order, numbers, |b| f32::from_le_bytes(b).into()),
            Self::F64 => each(bytes, order, numbers, f64::from_le_bytes),
        }
    }
}

/// Converts numbers of N bytes, which are handed on with the least significant byte first.
fn each<const N: usize>(
    bytes: &[u8],
    order: ByteOrder,
    numbers: &mut Vec<f64>,
    convert: impl Fn([u8; N]) -> f64,
) {
    numbers.extend(bytes.as_chunks().0.iter().map(|&number| {
        let mut number: [u8; N] = number;
        if order == ByteOrder::Big {
            number.reverse();
        }
        convert(number)
    }));
}

/// IEEE 754 binary16: sign, five bits of exponent (bias 15), ten of fraction.
fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let exponent = i32::from(bits >> 10 & 0x1f);
    let fraction = f64::from(bits & 0x3ff) / 1024.0;
    sign * match exponent {
        0 => fraction * 2f64.powi(-14),
        0x1f if fraction == 0.0 => f64::INFINITY,
        0x1f => f64::NAN,
        _ => (1.0 + fraction) * 2f64.powi(exponent - 15),
    }
}

/// Why a run of numbers was not read to its end.
pub(super) enum Interrupted<E> {
    /// The source ended after so many of the bytes expected.
    Short(u64),
    /// The source failed.
    Io(io::Error),
    /// The receiver of a number refused it.
    Refused(E),
}

/// Hands `count` numbers and their positions from 0 to `take`.
pub(super) fn read_numbers<E>(
    source: &mut dyn Read,
    count: u64,
    number: Number,
    order: ByteOrder,
    mut take: impl FnMut(u64, f64) -> Result<(), E>,
) -> Result<(), Interrupted<E>> {
    let width = number.width();
    let mut buffer = vec![0; CHUNK_BYTES];
    let mut numbers = Vec::with_capacity(CHUNK_BYTES / width);
    let mut done = 0;
    while done < count {
        let left = usize::try_from(count - done).unwrap_or(usize::MAX);
        let chunk = &mut buffer[..left.min(CHUNK_BYTES / width) * width];
        let filled = fill(source, chunk).map_err(Interrupted::Io)?;
        number.decode(&chunk[..filled], order, &mut numbers);
        for &value in &numbers {
            take(done, value).map_err(Interrupted::Refused)?;
            done += 1;
        }
        if filled < chunk.len() {
            return Err(Interrupted::Short(done * width as u64 + (filled % width) as u64));
        }
    }
    Ok(())
}

/// Fills the buffer as far as the source goes; how far that was.
pub(super) fn fill(source: &mut dyn Read, buffer: &mut [u8]) -> io::Result<usize> {
    let mut filled = 0;
    while filled < buffer.len() {
        match source.read(&mut buffer[filled..]) {
            Ok(0) => break,
            Ok(n) => filled += n,
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(filled)
}

#[cfg(test)]
mod tests {
    use super::half;

    #[test]
    fn half_precision_follows_its_definition() {
        let known = [(0x3c00, 1.0), (0xc000, -2.0), (0x7bff, 65504.0), (0x0001, 2f64.powi(-24))];
        for (bits, value) in known {
            assert_eq!(half(bits), value, "{bits:#06x}");
        }
        assert_eq!(half(0x7c00), f64::INFINITY);
        assert_eq!(half(0xfc00), f64::NEG_INFINITY);
        assert!(half(0x7e00).is_nan());
        assert_eq!(half(0x8000).to_bits(), (-0.0f64).to_bits());
    }
}
