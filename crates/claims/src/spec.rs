//! `[claims.NAME]`: what the source says, and how near ours must come.

use serde::Deserialize;

use crate::{Name, Of, Trend};

/// One entry of `[claims]`: a value the source states, and how near ours must come.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClaimSpec {
    /// Which quantity.
    pub of: Of,
    /// Which instance of it.
    #[serde(default, rename = "where")]
    pub at: Where,
    /// The source's value; exactly one of `equals`, `at_most`, `at_least` and `trend` is given.
    pub equals: Option<toml::Value>,
    /// The most that the number may be.
    pub at_most: Option<f64>,
    /// The least that it may be.
    pub at_least: Option<f64>,
    /// How the quantity changes along the list `where.epsilon`.
    pub trend: Option<Trend>,
    /// How far it may lie off.
    pub abs_tol: Option<f64>,
    /// The same as a part of what is claimed.
    pub rel_tol: Option<f64>,
    /// Where the source says it; the experiment's own source by default.
    #[serde(default)]
    pub source: String,
    /// Why the tolerance is what it is.
    #[serde(default)]
    pub reason: String,
    /// Why a difference is expected: the verdict is then `differs as known`.
    pub known_difference: Option<String>,
}

/// Which instance of a quantity a claim is about.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Where {
    /// A coupling strength or, for a quantity that is a number, a list of them.
    pub epsilon: Option<OneOrMany>,
    /// Modes k, counted from 1 as in λ_k.
    pub modes: Option<Vec<usize>>,
    /// Clusters of node labels.
    pub clusters: Option<Vec<Vec<Name>>>,
    /// What the names of groups begin with whose nodes are counted.
    pub group_prefix: Option<String>,
}

/// One number, or a list.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub enum OneOrMany {
    /// One.
    One(f64),
    /// Several.
    Many(Vec<f64>),
}

impl OneOrMany {
    /// The numbers as a list.
    pub fn list(&self) -> &[f64] {
        match self {
            Self::One(number) => std::slice::from_ref(number),
            Self::Many(numbers) => numbers,
        }
    }
}
