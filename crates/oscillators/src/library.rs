//! The library: one file of `library/` an oscillator, found when this is built.

use std::sync::LazyLock;

use equations::nearest;
use indexmap::IndexMap;
use serde::Deserialize;

use crate::{Behaviour, Entry, Equations, NoSuchOscillator, Published};

/// Names and texts of the files.
const FILES: &[(&str, &str)] = &include!(concat!(env!("OUT_DIR"), "/library.rs"));

static LIBRARY: LazyLock<Vec<Entry>> =
    LazyLock::new(|| FILES.iter().map(|(name, text)| read(name, text)).collect());

/// Every oscillator there is, by name.
pub fn library() -> &'static [Entry] {
    &LIBRARY
}

/// The oscillator of a name.
///
/// # Errors
/// [`NoSuchOscillator`] with the nearest name.
pub fn find(name: &str) -> Result<&'static Entry, NoSuchOscillator> {
    library().iter().find(|entry| entry.name == name).ok_or_else(|| {
        let known: Vec<&str> = library().iter().map(|entry| entry.name).collect();
        let nearest = nearest(name, known.iter().copied());
        NoSuchOscillator { name: name.to_owned(), nearest, known }
    })
}

/// What a file says. The keys of [`Equations`] stand beside the others.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    title: String,
    source: String,
    note: Option<String>,
    behaviour: Behaviour,
    step: f64,
    flow: Option<IndexMap<String, String>>,
    map: Option<IndexMap<String, String>>,
    #[serde(rename = "where", default)]
    subexpressions: IndexMap<String, String>,
    #[serde(default)]
    parameters: IndexMap<String, f64>,
    start: IndexMap<String, [f64; 2]>,
    #[serde(default)]
    published: Vec<Published>,
}

/// Reads a file of ours: one with a mistake fails every test of the library.
fn read(name: &'static str, text: &str) -> Entry {
    let written: Written =
        toml::from_str(text).unwrap_or_else(|error| panic!("library/{name}.toml: {error}"));
    let Written { title, source, note, behaviour, step, published, .. } = written;
    let Written { flow, map, subexpressions, parameters, start, .. } = written;
    let equations = Equations { flow, map, subexpressions, parameters, start };
    if let Err(error) = equations.dynamics() {
        panic!("library/{name}.toml: {error}");
    }
    Entry { name, title, source, note, behaviour, step, equations, published }
}
