//! Any bytes as a NumPy array: read or refused, never a panic.
#![no_main]

use graph::formats::{Layout, numpy};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|file: &[u8]| {
    drop(numpy::read_npy(file, &Layout::default()));
    drop(numpy::read_npy(file, &Layout { block: Some(1..3), ..Layout::default() }));
});
