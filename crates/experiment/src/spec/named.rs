//! Choices whose names stand in a list of another crate.

use std::fmt;

use serde::Deserializer;
use serde::de::{Error, Visitor};

/// Reads the name of one of them; another name is answered with those that are known.
pub(super) fn by_name<'de, D: Deserializer<'de>, T>(
    deserializer: D,
    known: &'static [&'static str],
    of_name: impl Fn(&str) -> Option<T>,
) -> Result<T, D::Error> {
    struct ByName<F>(F, &'static [&'static str]);
    impl<T, F: Fn(&str) -> Option<T>> Visitor<'_> for ByName<F> {
        type Value = T;
        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("a name in quotes")
        }
        fn visit_str<E: Error>(self, name: &str) -> Result<T, E> {
            (self.0)(name).ok_or_else(|| E::unknown_variant(name, self.1))
        }
    }
    deserializer.deserialize_str(ByName(of_name, known))
}
