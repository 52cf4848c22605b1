//! Any bytes as a MAT-file, by the names of the fixtures and without: read or refused, never a panic.
#![no_main]

use graph::formats::{Layout, matlab};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|file: &[u8]| {
    for variable in [None, Some("structural"), Some("sparse")] {
        drop(matlab::read(file, variable, &Layout::default()));
    }
});
