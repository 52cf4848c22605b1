//! `[coupling]`: the coupling matrix W and the coupling function H.

use std::fmt;

use indexmap::IndexMap;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

/// `[coupling]`: the coupling matrix W and the coupling function H, either one component into another
/// or a function.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct CouplingSpec {
    /// Which coupling matrix.
    pub matrix: MatrixKind,
    /// Component read from the driving node.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from: Option<String>,
    /// Component whose equation it enters.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to: Option<String>,
    /// In place of both: a D × D matrix of numbers, or formulas of the components.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub function: Option<FunctionSpec>,
    /// Names for parts of the formulas.
    #[serde(default, rename = "where", skip_serializing_if = "IndexMap::is_empty")]
    pub subexpressions: IndexMap<String, String>,
    /// Parameters of the formulas, beside those of the oscillator.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub parameters: IndexMap<String, f64>,
}

/// How weights become couplings.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum), value(rename_all = "snake_case"))]
pub enum MatrixKind {
    /// w_ij = a_ij.
    Laplacian,
    /// w_ij = a_ij / k_i.
    Normalized,
}

/// A coupling function H, written in one of two ways.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum FunctionSpec {
    /// Component = formula of what enters its equation.
    Formulas(IndexMap<String, String>),
    /// Row d, column c: the weight with which component c enters equation d.
    Matrix(Vec<Vec<f64>>),
}

impl<'de> Deserialize<'de> for FunctionSpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct FormulasOrMatrix;
        impl<'de> Visitor<'de> for FormulasOrMatrix {
            type Value = FunctionSpec;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a table of formulas or a matrix of numbers, row by row")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, rows: A) -> Result<FunctionSpec, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(rows)).map(FunctionSpec::Matrix)
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<FunctionSpec, A::Error> {
                IndexMap::deserialize(MapAccessDeserializer::new(map)).map(FunctionSpec::Formulas)
            }
        }
        deserializer.deserialize_any(FormulasOrMatrix)
    }
}
