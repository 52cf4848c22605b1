//! The list of formats as a whole: names and endings tell each from all others, and the documentation
//! knows them.

use std::collections::HashSet;
use std::io::Cursor;

use graph::formats::{FORMATS, Options, named, of_ending};

use crate::fixture;

#[test]
fn a_format_is_told_by_its_name_and_by_every_ending_of_its_own() {
    let names: HashSet<_> = FORMATS.iter().map(|format| format.name).collect();
    assert_eq!(names.len(), FORMATS.len());
    for format in FORMATS {
        assert_eq!(named(format.name).unwrap().name, format.name);
        for ending in format.endings {
            assert_eq!(of_ending(ending).unwrap().name, format.name, "{ending}");
            assert_eq!(of_ending(&ending.to_uppercase()).unwrap().name, format.name, "{ending}");
        }
        assert!(!format.ending().is_empty(), "{} is written without an ending", format.name);
    }
    assert!(named("excel").is_none() && of_ending("xlsx").is_none());
}

#[test]
fn the_documentation_has_every_format_and_ending() {
    let overview = include_str!("../../../../docs/formats.md");
    let keys = include_str!("../../../../docs/experiments.md");
    for format in FORMATS {
        assert!(keys.contains(&format!("\"{}\"", format.name)), "{}", format.name);
        for ending in format.endings.iter().filter(|ending| !ending.is_empty()) {
            assert!(overview.contains(&format!("`.{ending}`")), "{ending}");
        }
    }
}

#[test]
fn what_the_list_reads_is_what_the_reader_reads_with_its_options() {
    let format = named("npz").unwrap();
    let options = Options { variable: Some("structural".into()), ..Options::default() };
    let network = (format.read)(&mut Cursor::new(fixture!("plain.npz")), &options).unwrap();
    assert_eq!(super::dense(&network), super::SYMMETRIC);
    let error = (format.read)(&mut Cursor::new(fixture!("plain.npz")), &Options::default());
    assert!(error.unwrap_err().to_string().contains("structural"));
}
