//! Any bytes as an edge list: read or refused, never a panic.
#![no_main]

use graph::formats::edge_list;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|file: &[u8]| drop(edge_list::read(file)));
