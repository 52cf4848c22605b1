//! What an atlas says: a document of its own kind, told by its table `[atlas]`. It has no network and no
//! coupling: of each of its oscillators every coupling of one component into another is looked at.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use super::defaults::{per_mille, ten_thousand, thousand};
use super::oscillator::OscillatorSpec;

/// An atlas of master stability functions.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Atlas {
    /// One line that says what it shows.
    #[serde(skip_serializing)]
    pub title: String,
    /// Where its settings and published values come from.
    #[serde(default, skip_serializing)]
    pub source: String,
    /// Seed of everything random.
    #[serde(default = "super::defaults::one")]
    pub seed: u64,
    /// How each curve is computed.
    #[serde(default)]
    pub msf: AtlasMsfSpec,
    /// `[atlas.NAME]`: its systems, in the order of the figure.
    pub atlas: IndexMap<String, SystemSpec>,
}

/// `[msf]` of an atlas: as that of an experiment, but where to look is found by a first look.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct AtlasMsfSpec {
    /// Values of σ for each pair, which lie closer towards 0.
    pub points: u32,
    /// Time before the averages begin.
    pub transient: f64,
    /// Time of the average behind each point of a curve.
    pub average: f64,
    /// Interval between renormalisations of the tangent vectors, 0.5 where it is left out; of a map 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub renormalise: Option<f64>,
    /// Standard error at which a zero of Λ is known well enough, relative to it.
    pub relative_error: f64,
}

impl Default for AtlasMsfSpec {
    fn default() -> Self {
        Self {
            points: 97,
            transient: thousand(),
            average: ten_thousand(),
            renormalise: None,
            relative_error: 3.0 * per_mille(),
        }
    }
}

/// `[atlas.NAME]`: an oscillator with its parameters, and what others have found of its couplings.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct SystemSpec {
    /// What the figure calls it; its name where it is left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// As `[oscillator.NAME]` or `[oscillator.custom]` of an experiment.
    pub oscillator: OscillatorSpec,
    /// Step of the integrator; that of the library where it is left out, 0.01 for custom flows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step: Option<f64>,
    /// Time of the average behind each point, in place of that of all systems: a fast one needs less.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub average: Option<f64>,
    /// What others have found, by pairs of components such as `"x:y"`.
    #[serde(default, skip_serializing)]
    pub published: IndexMap<String, PublishedSpec>,
}

/// Stable windows as they were published.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct PublishedSpec {
    /// [from, to], ascending; `to` is `inf` where no end was found.
    pub windows: Vec<[f64; 2]>,
    /// To what accuracy their ends are given, such as a unit of the last place.
    pub within: f64,
    /// Where; the source of the atlas where it is left out.
    #[serde(default)]
    pub source: String,
    /// Why a difference is expected: the verdict is then `differs as known`.
    pub known_difference: Option<String>,
}
