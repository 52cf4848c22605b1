//! Formats of network files by their names: every one that [`graph::formats`] lists.

use std::ops::Deref;
use std::path::Path;
use std::sync::LazyLock;

use graph::formats::{self, FORMATS};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::named::by_name;

/// A format of networks, which files and options call by its name.
#[derive(Clone, Copy, Debug)]
pub struct Format(pub &'static formats::Format);

static NAMES: LazyLock<Vec<&'static str>> =
    LazyLock::new(|| FORMATS.iter().map(|format| format.name).collect());

impl Format {
    /// The format of files that end so, if there is one.
    pub fn of_ending(path: &Path) -> Option<Self> {
        formats::of_ending(&path.extension().unwrap_or_default().to_string_lossy()).map(Self)
    }
}

impl Deref for Format {
    type Target = formats::Format;

    fn deref(&self) -> &formats::Format {
        self.0
    }
}

impl<'de> Deserialize<'de> for Format {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        by_name(deserializer, &NAMES, |name| formats::named(name).map(Self))
    }
}

impl Serialize for Format {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name)
    }
}

#[cfg(feature = "clap")]
impl clap::ValueEnum for Format {
    fn value_variants<'a>() -> &'a [Self] {
        static ALL: LazyLock<Vec<Format>> =
            LazyLock::new(|| FORMATS.iter().copied().map(Format).collect());
        &ALL
    }

    fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
        Some(clap::builder::PossibleValue::new(self.name).help(self.summary))
    }
}
