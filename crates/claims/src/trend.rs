//! How numbers change one after another.

use serde::Deserialize;

/// Each value against the one before it.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Trend {
    /// Larger than the one before.
    Rises,
    /// Smaller than the one before.
    Falls,
}
