//! Numbers in memory from the start of a cache line on, so that no vector straddles two lines.

use std::ops::{Deref, DerefMut};

/// Bytes of a cache line, and of the longest vectors.
const LINE: usize = 64;

/// A fixed number of numbers, at first all zero.
pub(crate) struct Aligned {
    numbers: Vec<f64>,
    start: usize,
    length: usize,
}

impl Aligned {
    pub(crate) fn zeros(length: usize) -> Self {
        let room = LINE / size_of::<f64>();
        let numbers = vec![0.0; length + room];
        // Where the allocator's address cannot be known the numbers lie as they come.
        let start = numbers.as_ptr().align_offset(LINE).min(room);
        Self { numbers, start, length }
    }
}

impl Deref for Aligned {
    type Target = [f64];

    #[inline(always)]
    fn deref(&self) -> &[f64] {
        &self.numbers[self.start..self.start + self.length]
    }
}

impl DerefMut for Aligned {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.numbers[self.start..self.start + self.length]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_begin_on_a_cache_line() {
        for length in [1, 7, 16, 1000] {
            let aligned = Aligned::zeros(length);
            assert_eq!(aligned.as_ptr().addr() % LINE, 0);
            assert_eq!(&aligned[..], &vec![0.0; length][..]);
        }
    }
}
