//! How far the reading of a file has come.

use std::io::{Read, Seek, SeekFrom};

use user::Progress;

/// A source that reports the bytes taken from it.
pub struct Watched<'a, R> {
    pub source: R,
    pub progress: Progress<'a>,
}

impl<R: Read> Read for Watched<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let n_bytes = self.source.read(buffer)?;
        let _ = (self.progress)(n_bytes as u64);
        Ok(n_bytes)
    }
}

impl<R: Seek> Seek for Watched<'_, R> {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.source.seek(to)
    }
}
