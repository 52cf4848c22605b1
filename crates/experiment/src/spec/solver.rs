//! Eigensolvers by their names: every one that [`Solver::ALL`] lists, or `"auto"`.

use std::iter;
use std::sync::LazyLock;

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use spectra::Solver;

use super::named::by_name;

/// Who finds the modes; where it is none, the network and the modes decide.
#[derive(Clone, Copy, Debug, Default)]
pub struct SolverSpec(pub Option<Solver>);

/// What files call the free choice.
const AUTO: &str = "auto";

static NAMES: LazyLock<Vec<&'static str>> =
    LazyLock::new(|| iter::once(AUTO).chain(Solver::ALL.iter().map(|s| s.name())).collect());

impl<'de> Deserialize<'de> for SolverSpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        by_name(deserializer, &NAMES, |name| match name {
            AUTO => Some(Self(None)),
            name => Solver::named(name).map(|solver| Self(Some(solver))),
        })
    }
}

impl Serialize for SolverSpec {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.0.map_or(AUTO, Solver::name))
    }
}
