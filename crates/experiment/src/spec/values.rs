//! Values that can be written in more than one way: node labels, grids, layouts, words or numbers.

use std::fmt;

use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

/// `"circle"`, `"force"`, `"grouped"`, or a list of positions `[x, y]`, one for each node in order.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Layout {
    /// On a circle in node order.
    Circle,
    /// So that distances on paper are those along the links.
    Force,
    /// Every cluster on a circle of its own.
    Grouped,
    /// Where the file says.
    #[serde(untagged)]
    At(Vec<[f64; 2]>),
}

/// A grid of values: `{ from, to, points }`, evenly spaced with both ends, or a list.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum Grid {
    /// Evenly spaced.
    Even(EvenGrid),
    /// As they stand.
    List(Vec<f64>),
}

/// Evenly spaced values.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct EvenGrid {
    /// The first.
    pub from: f64,
    /// The last.
    pub to: f64,
    /// How many.
    pub points: u32,
}

impl Grid {
    /// The values in their order.
    pub fn values(&self) -> Vec<f64> {
        match self {
            Self::List(values) => values.clone(),
            Self::Even(EvenGrid { from, to, points: 1 }) if from == to => vec![*from],
            Self::Even(EvenGrid { from, to, points }) => {
                // Rounded to 12 digits, so that 0.1 … 1.3 reads 0.3 and not 0.30000000000000004.
                let last = f64::from(points.saturating_sub(1));
                let value = |k: u32| from + (to - from) * f64::from(k) / last;
                let rounded = |x: f64| (x * 1e12).round() / 1e12;
                let shorten = |x: f64| if rounded(x).is_finite() { rounded(x) } else { x };
                (0..*points).map(value).map(shorten).collect()
            }
        }
    }
}

/// `"exact"` or a number.
#[derive(Clone, Copy, Debug, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ThresholdSpec {
    /// δe_ij = 0 up to the solver's accuracy.
    #[default]
    Exact,
    /// Single linkage up to this δe_ij.
    #[serde(untagged)]
    Within(f64),
}

impl<'de> Deserialize<'de> for Grid {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Values;
        impl<'de> Visitor<'de> for Values {
            type Value = Grid;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("{ from = …, to = …, points = … } or a list of numbers")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Grid, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(Grid::List)
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Grid, A::Error> {
                EvenGrid::deserialize(MapAccessDeserializer::new(map)).map(Grid::Even)
            }
        }
        deserializer.deserialize_any(Values)
    }
}

impl<'de> Deserialize<'de> for Layout {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NameOrPositions;
        impl<'de> Visitor<'de> for NameOrPositions {
            type Value = Layout;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"circle\", \"force\", \"grouped\" or a list of positions [x, y]")
            }
            fn visit_str<E: Error>(self, name: &str) -> Result<Layout, E> {
                match name {
                    "circle" => Ok(Layout::Circle),
                    "force" => Ok(Layout::Force),
                    "grouped" => Ok(Layout::Grouped),
                    _ => Err(E::unknown_variant(name, &["circle", "force", "grouped"])),
                }
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Layout, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(Layout::At)
            }
        }
        deserializer.deserialize_any(NameOrPositions)
    }
}

impl<'de> Deserialize<'de> for ThresholdSpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Which;
        impl Visitor<'_> for Which {
            type Value = ThresholdSpec;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"exact\" or a number")
            }
            fn visit_str<E: Error>(self, word: &str) -> Result<ThresholdSpec, E> {
                match word {
                    "exact" => Ok(ThresholdSpec::Exact),
                    _ => Err(E::invalid_value(serde::de::Unexpected::Str(word), &self)),
                }
            }
            fn visit_i64<E: Error>(self, threshold: i64) -> Result<ThresholdSpec, E> {
                Ok(ThresholdSpec::Within(threshold as f64))
            }
            fn visit_f64<E: Error>(self, threshold: f64) -> Result<ThresholdSpec, E> {
                Ok(ThresholdSpec::Within(threshold))
            }
        }
        deserializer.deserialize_any(Which)
    }
}
