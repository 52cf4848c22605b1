//! Any bytes as a full matrix of text: read or refused, never a panic.
#![no_main]

use graph::formats::{Layout, dense};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|file: &[u8]| {
    drop(dense::read(file, &Layout::default()));
    drop(dense::read(file, &Layout { block: Some(1..3), ..Layout::default() }));
});
