//! Bounds below which nodes count as together.

use std::fmt;

use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

/// A distance or an error below which nodes count as together.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Bound {
    /// `{ of_largest = … }`: a fraction of the largest over all pairs at the same ε.
    OfLargest(f64),
    /// A number, in the units of what it bounds.
    #[serde(untagged)]
    Fixed(f64),
}

impl Bound {
    /// The bound as a number, given the largest over all pairs.
    pub fn value(self, largest: impl FnOnce() -> f64) -> f64 {
        match self {
            Self::Fixed(value) => value,
            Self::OfLargest(fraction) => fraction * largest(),
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OfLargest {
    of_largest: f64,
}

impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fixed(value) => write!(f, "{value}"),
            Self::OfLargest(fraction) => write!(f, "{fraction} of the largest"),
        }
    }
}

impl<'de> Deserialize<'de> for Bound {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumberOrFraction;
        impl<'de> Visitor<'de> for NumberOrFraction {
            type Value = Bound;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number or { of_largest = … }")
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<Bound, E> {
                Ok(Bound::Fixed(value as f64))
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<Bound, E> {
                Ok(Bound::Fixed(value))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Bound, A::Error> {
                OfLargest::deserialize(MapAccessDeserializer::new(map))
                    .map(|OfLargest { of_largest }| Bound::OfLargest(of_largest))
            }
        }
        deserializer.deserialize_any(NumberOrFraction)
    }
}
