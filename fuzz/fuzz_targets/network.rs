//! Any bytes as a file of the format that `EIGENSYNC_FORMAT` names, with the choices of the fixtures and
//! without: read or refused, never a panic.
#![no_main]

use std::io::Cursor;
use std::sync::LazyLock;

use graph::formats::{Attributes, Choice, Format, Layout, Options, named};
use libfuzzer_sys::fuzz_target;

static FORMAT: LazyLock<&Format> = LazyLock::new(|| {
    let name = std::env::var("EIGENSYNC_FORMAT").expect("EIGENSYNC_FORMAT names a format");
    named(&name).unwrap_or_else(|| panic!("{name} is no format"))
});

static CHOSEN: LazyLock<Vec<Options>> = LazyLock::new(|| {
    let none = Options::default();
    let mut all = vec![none.clone()];
    if FORMAT.has(Choice::Variable) {
        let named = |name: &str| Options { variable: Some(name.into()), ..none.clone() };
        all.extend(["structural", "sparse"].map(named));
    }
    if FORMAT.has(Choice::Attributes) {
        let attributes = Attributes {
            weight: Some("strength".into()),
            label: Some("full".into()),
            group: Some("area".into()),
            position: ["x", "y", "z"].map(String::from).to_vec(),
        };
        all.push(Options { attributes, ..none.clone() });
    }
    if FORMAT.has(Choice::Block) {
        all.push(Options { layout: Layout { block: Some(1..3), ..Layout::default() }, ..none });
    }
    all
});

fuzz_target!(|file: &[u8]| {
    for options in CHOSEN.iter() {
        drop((FORMAT.read)(&mut Cursor::new(file), options));
    }
});
