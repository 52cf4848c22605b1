//! Any bytes as a Matrix Market file: read or refused, never a panic.
#![no_main]

use graph::formats::{Layout, matrix_market};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|file: &[u8]| {
    drop(matrix_market::read(file, &Layout::default()));
    drop(matrix_market::read(file, &Layout { block: Some(1..3), ..Layout::default() }));
});
