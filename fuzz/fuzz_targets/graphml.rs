//! Any bytes as a GraphML file, with and without the attributes of the fixtures: read or refused, never a panic.
#![no_main]

use graph::formats::graphml::{Attributes, read};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|file: &[u8]| {
    drop(read(file, &Attributes::default()));
    let attributes = Attributes {
        weight: Some("strength".into()),
        label: Some("full".into()),
        group: Some("area".into()),
        position: ["x", "y", "z"].map(String::from).to_vec(),
    };
    drop(read(file, &attributes));
});
