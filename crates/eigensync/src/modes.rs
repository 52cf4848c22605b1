//! Which modes of the coupling matrix a prediction needs, by which solver.

use std::collections::HashSet;
use std::fmt;

use msf::StableRegion;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use spectra::{ARPACK_NODES, Modes, Request, Solver};

/// Tolerance of networks that are large, of more than [`ARPACK_NODES`]; in others solvers go to the
/// limit of rounding at no cost to speak of.
const LARGE_TOLERANCE: f64 = 1e-10;

/// Up to this many nodes all modes are computed where nobody says how many: half a minute and 1 GB.
pub const ALL_MODES: usize = 5000;

/// Leading modes where nobody says how many, and all are not needed or too many, beyond one zero mode
/// for each component.
const LEADING_MODES: usize = 20;
/// Zero modes beyond which the network must be prepared, or the number of modes be said.
const MOST_ZERO_MODES: usize = 1000;

/// `"auto"`, `"all"`, a number of leading modes, or `{ unstable_at = … }`, as files write it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Wanted {
    /// All N where the stable set has an upper end, leading ones where it has none.
    Auto,
    /// All N.
    All,
    /// All that are unstable at this ε, or above.
    UnstableAt(f64),
    /// So many of the largest eigenvalues.
    #[serde(untagged)]
    Leading(u64),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct UnstableAt {
    unstable_at: f64,
}

/// The modes to compute.
#[derive(Clone, Debug)]
pub struct WantedModes {
    request: Request,
    wanted: Wanted,
    /// Where a few will do and nobody says how many.
    leading: usize,
}

impl WantedModes {
    /// Of a network of so many nodes and components. What is not said is chosen by its size.
    pub fn new(
        (n_nodes, n_components): (usize, usize),
        wanted: Option<Wanted>,
        solver: Option<Solver>,
        tolerance: Option<f64>,
    ) -> Self {
        let by_size = if n_nodes > ALL_MODES { Wanted::Auto } else { Wanted::All };
        let wanted = wanted.unwrap_or(by_size);
        let modes = match wanted {
            // A network that has no more shows all of its modes.
            Wanted::Leading(modes) => {
                Modes::Leading(usize::try_from(modes).unwrap_or(usize::MAX).min(n_nodes))
            }
            Wanted::All | Wanted::Auto | Wanted::UnstableAt(_) => Modes::All,
        };
        let small = Request::default().tolerance;
        let by_size = if n_nodes > ARPACK_NODES { LARGE_TOLERANCE } else { small };
        let tolerance = tolerance.unwrap_or(by_size);
        let zero_modes = if n_components > MOST_ZERO_MODES { 0 } else { n_components.max(1) - 1 };
        Self {
            request: Request { modes, solver, tolerance, ..Request::default() },
            wanted,
            leading: (LEADING_MODES + zero_modes).min(n_nodes),
        }
    }

    /// What is asked of the solver once the stable set is known. At ε the unstable modes are those
    /// with λ_k > −σ/ε, where the stable set reaches from σ on; where it ends again, the fastest modes
    /// are unstable as well, and are left out unless all are computed.
    pub fn request(&self, stable: &StableRegion, n_nodes: usize) -> Request {
        let lower = match &stable.intervals[..] {
            [] => None,
            [.., last] if stable.is_unbounded() => Some(last.lower()),
            [first, ..] => Some(first.lower()),
        };
        let modes = match (self.wanted, lower) {
            (Wanted::UnstableAt(epsilon), Some(lower)) if lower > 0.0 => {
                Modes::Above(-lower / epsilon)
            }
            (Wanted::UnstableAt(_) | Wanted::Auto, _) => {
                let few_will_do = stable.is_unbounded() || n_nodes > ALL_MODES;
                if few_will_do { Modes::Leading(self.leading) } else { Modes::All }
            }
            (Wanted::All | Wanted::Leading(_), _) => self.request.modes,
        };
        Request { modes, ..self.request }
    }

    /// Largest relative residual of a mode.
    pub fn tolerance(&self) -> f64 {
        self.request.tolerance
    }

    /// Whether matrices of N × N numbers will be taken.
    pub fn is_dense(&self, n_nodes: usize) -> bool {
        self.request.solver.is_some_and(Solver::is_dense) || self.most_modes(n_nodes) > n_nodes / 2
    }

    /// The modes asked for, or by default.
    pub fn wanted(&self) -> Wanted {
        self.wanted
    }

    /// The most modes that there may be.
    pub fn most_modes(&self, n_nodes: usize) -> usize {
        match (self.wanted, self.request.modes) {
            (Wanted::Leading(_), Modes::Leading(modes)) => modes,
            (Wanted::UnstableAt(_), _) => self.request.max_modes.min(n_nodes),
            (Wanted::Auto, _) if n_nodes > ALL_MODES => self.leading,
            _ => n_nodes,
        }
    }
}

/// What is wrong with modes as they are named, counted from 1: there are no more of them than so many, and
/// none is named twice.
pub fn misnamed_modes(modes: &[usize], most: usize) -> Option<String> {
    if let Some(mode) = modes.iter().find(|mode| !(1..=most).contains(*mode)) {
        return Some(format!("has mode {mode}, but the modes computed are 1 to {most}"));
    }
    let mut seen = HashSet::new();
    let twice = modes.iter().find(|mode| !seen.insert(**mode))?;
    Some(format!("has mode {twice} more than once"))
}

impl<'de> Deserialize<'de> for Wanted {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Which;
        impl<'de> Visitor<'de> for Which {
            type Value = Wanted;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"auto\", \"all\", a whole number or { unstable_at = … }")
            }
            fn visit_str<E: Error>(self, word: &str) -> Result<Wanted, E> {
                match word {
                    "auto" => Ok(Wanted::Auto),
                    "all" => Ok(Wanted::All),
                    _ => Err(E::invalid_value(serde::de::Unexpected::Str(word), &self)),
                }
            }
            fn visit_i64<E: Error>(self, modes: i64) -> Result<Wanted, E> {
                u64::try_from(modes)
                    .map(Wanted::Leading)
                    .map_err(|_| E::invalid_value(serde::de::Unexpected::Signed(modes), &self))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Wanted, A::Error> {
                UnstableAt::deserialize(MapAccessDeserializer::new(map))
                    .map(|UnstableAt { unstable_at }| Wanted::UnstableAt(unstable_at))
            }
        }
        deserializer.deserialize_any(Which)
    }
}
