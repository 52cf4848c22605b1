//! Any bytes as a connectivity archive: read or refused, never a panic.
#![no_main]

use std::io::Cursor;

use graph::formats::{Layout, tvb};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|file: &[u8]| drop(tvb::read(Cursor::new(file), &Layout::default())));
