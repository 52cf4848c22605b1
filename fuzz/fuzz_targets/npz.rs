//! Any bytes as an archive of NumPy arrays, by name and without: read or refused, never a panic.
#![no_main]

use std::io::Cursor;

use graph::formats::{Layout, numpy};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|file: &[u8]| {
    drop(numpy::read_npz(Cursor::new(file), None, &Layout::default()));
    drop(numpy::read_npz(Cursor::new(file), Some("structural"), &Layout::default()));
});
