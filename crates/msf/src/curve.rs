//! Λ(σ) with standard errors, and what follows from it.

use dynamics::{Closes, Estimate};

use crate::step::is_certain;
use crate::{Attractor, Isolated, StableRegion};

/// The master stability function as computed.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MasterStability {
    /// The σ of the curve: [`crate::Request::looked_at`], or where nobody says what to look at, evenly spaced
    /// up to twice the last zero.
    pub sigma: Vec<f64>,
    /// Λ at each σ, per unit of model time.
    pub lambda: Vec<Estimate>,
    /// Λ(0): the largest Lyapunov exponent of the isolated oscillator. What half the step changes is
    /// in its standard error where that is more than chance.
    pub isolated: Estimate,
    /// By how much half the step of the integrator changes Λ(0), with the standard error of that; 0 for
    /// a map, which has no step, and for orbits that close, which have none that matters.
    pub isolated_step_shift: Estimate,
    /// What Λ(0) says.
    pub state: Isolated,
    /// How the orbit closes, where it does: Λ is then that of multipliers, and no average.
    pub closes: Option<Closes>,
    /// How many isolated oscillators, of those tried, end in each of the states in which they come to
    /// rest, the most frequent first; none where Λ(0) is not below 0.
    pub rests: Vec<usize>,
    /// How far and how finely was looked.
    pub looked: Looked,
    /// Gaps between neighbouring σ in which Λ comes so near zero that a window may still be hidden.
    pub doubtful: Vec<[f64; 2]>,
    /// The stable set {Λ < 0} as far as was looked; of several attractors, what is stable on each.
    pub stable: StableRegion,
    /// Each of them, the one of most orbits first, where orbits settle on several attractors; the
    /// curve and Λ(0) are then those of the first.
    pub attractors: Vec<Attractor>,
}

/// How far and how finely Λ was looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Looked {
    /// The smallest σ; Λ(0) is known besides.
    pub from: f64,
    /// The largest.
    pub to: f64,
    /// At how many σ.
    pub points: usize,
    /// How many of them lie between those of a grid, where a window might have been missed.
    pub between: usize,
    /// The widest gap between neighbours, as a share of its σ: a narrower window may have been missed.
    pub widest_gap: f64,
}

impl MasterStability {
    /// What half the step changes of Λ(0), where that is more than chance.
    pub fn certain_isolated_step_shift(&self) -> Option<Estimate> {
        is_certain(self.isolated_step_shift).then_some(self.isolated_step_shift)
    }
}
