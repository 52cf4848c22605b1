//! Which modes are unstable on each stretch of ε between neighbouring transitions, as far as the modes
//! that were computed and the σ that were looked at decide it.
//!
//! As ε falls from infinity to zero, eigenspaces of σ = −ελ leave (and enter) the stable set at their
//! transitions, and in between the unstable modes stay the same. Eigenvalue 0 has σ = 0 at every ε: the
//! zero modes of a network of several components are unstable throughout, unless σ = 0 is stable
//! itself, where oscillators are at rest.
//!
//! All modes decide every ε at which each has a σ that is known. Leading modes decide down to where the
//! next one would count; where the stable set ends at a σ₂, the fastest modes leave it as ε grows, and
//! from leading modes and λ_N alone it is known that none has done so while ε < σ₂ / |λ_N|.

use crate::transitions::{SAME_COUPLING, transitions};
use crate::{Eigenspace, Interval, StableRegion, Transition, coupling_at};

/// What is known of the modes of a coupling matrix, and where the look at Λ(σ) began.
#[derive(Clone, Debug)]
pub struct KnownModes {
    /// The transverse modes that were computed, λ descending.
    pub eigenspaces: Vec<Eigenspace>,
    /// The others; none where there are none.
    pub others: Option<Others>,
    /// The smallest σ that was looked at.
    pub looked_from: f64,
}

/// What is known of modes that were not computed.
#[derive(Clone, Copy, Debug)]
pub struct Others {
    /// No λ among them is larger; 0 where nothing is known.
    pub at_most: f64,
    /// λ_N, the smallest of all, where it is known.
    pub smallest: Option<f64>,
}

/// The ε at which it is known which modes are unstable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decided {
    /// Lower end: 0, or where an eigenspace that was not computed might become unstable, or a mode comes
    /// to a σ below all that were looked at.
    pub from: f64,
    /// Upper end, where λ_N leaves the lowest interval: the fastest modes may be unstable above. None
    /// where there is no end; 0 where nothing is decided.
    pub to: Option<f64>,
    /// Of the upper end.
    pub to_standard_error: Option<f64>,
}

/// A range of ε in which the same modes are unstable.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch {
    /// Open range, from below; no upper end where it is unbounded.
    pub epsilon: (f64, Option<f64>),
    /// The unstable transverse modes, counted from 0, ascending.
    pub unstable_modes: Vec<usize>,
    /// Whether it ends only because nothing is decided below.
    pub truncated: bool,
}

/// Where modes change their stability, and which are unstable in between.
#[derive(Clone, Debug)]
pub struct Stability {
    /// All of them, eigenspace by eigenspace, and within one by ascending σ.
    pub transitions: Vec<Transition>,
    /// Where the stretches lie.
    pub decided: Decided,
    /// From the largest ε down, without gaps; neighbours differ in their modes. None where nothing is
    /// decided.
    pub stretches: Vec<Stretch>,
}

impl Stability {
    /// From the stable set and what is known of the modes.
    pub fn new(stable: &StableRegion, known: &KnownModes) -> Self {
        let transitions = transitions(stable, &known.eigenspaces);
        let decided = Decided::by(stable, known);
        let stretches = stretches(stable, &known.eigenspaces, &transitions, &decided);
        Self { transitions, decided, stretches }
    }
}

impl Decided {
    const NOTHING: Self = Self { from: 0.0, to: Some(0.0), to_standard_error: None };

    fn by(stable: &StableRegion, known: &KnownModes) -> Self {
        let from = known.begins_at(stable);
        let Some(others) = known.others else {
            return Self { from, to: None, to_standard_error: None };
        };
        let Some(interval) = foremost(stable).filter(|_| others.at_most < 0.0) else {
            return Self::NOTHING;
        };
        let from = from.max(coupling_at(interval.lower(), others.at_most));
        match (interval.upper(), others.smallest.filter(|&lambda| lambda < 0.0)) {
            (None, _) => Self { from, to: None, to_standard_error: None },
            (Some(_), None) => Self::NOTHING,
            (Some(sigma), Some(smallest)) => Self {
                from,
                to: Some(coupling_at(sigma, smallest)),
                to_standard_error: interval
                    .to
                    .zero()
                    .map(|zero| coupling_at(zero.standard_error, smallest)),
            },
        }
    }

    fn is_anything(&self) -> bool {
        self.to.is_none_or(|to| self.from < to)
    }
}

impl KnownModes {
    /// ε at which the slowest mode comes to the smallest σ that was looked at, where the stable set
    /// begins only there, or may do so below; else 0.
    fn begins_at(&self, stable: &StableRegion) -> f64 {
        let unknown_below = match &stable.intervals[..] {
            [] => Some(self.looked_from),
            _ => stable.unknown_below(),
        };
        let slowest = self.eigenspaces.iter().map(|space| space.lambda).find(|&l| l < 0.0);
        unknown_below.zip(slowest).map_or(0.0, |(sigma, lambda)| coupling_at(sigma, lambda))
    }
}

/// The interval in which modes that were not computed are taken to be: the last where it has no upper
/// end, since they are the fastest, else the first.
fn foremost(stable: &StableRegion) -> Option<&Interval> {
    if stable.is_unbounded() { stable.intervals.last() } else { stable.intervals.first() }
}

fn stretches(
    stable: &StableRegion,
    eigenspaces: &[Eigenspace],
    transitions: &[Transition],
    decided: &Decided,
) -> Vec<Stretch> {
    if !decided.is_anything() {
        return Vec::new();
    }
    let mut modes = Modes::at_infinity(stable, eigenspaces);
    let down = in_order(transitions, decided.from);
    // Those of ε beyond all numbers are passed as well.
    let is_above = |t: &&Transition| t.epsilon >= decided.to.unwrap_or(f64::INFINITY);
    let (above, mut down) = down.split_at(down.partition_point(is_above));
    modes.pass(above);
    let mut stretches = Vec::new();
    let mut to = decided.to;
    while let Some(&next) = down.first() {
        let from = next.epsilon;
        add(&mut stretches, (from, to), modes.unstable());
        let is_here = |t: &&Transition| t.epsilon >= from * (1.0 - SAME_COUPLING);
        let (here, below) = down.split_at(down.partition_point(is_here));
        modes.pass(here);
        (down, to) = (below, Some(from));
    }
    add(&mut stretches, (decided.from, to), modes.unstable());
    if let Some(last) = stretches.last_mut() {
        last.truncated = decided.from > 0.0;
    }
    stretches
}

/// The transitions above an ε, from the largest ε down, and where one mode has several at once, as
/// beyond all numbers, in the order in which its σ falls.
fn in_order(transitions: &[Transition], epsilon: f64) -> Vec<&Transition> {
    let is_above = |t: &&Transition| t.lambda < 0.0 && t.epsilon > epsilon * (1.0 + SAME_COUPLING);
    let mut down: Vec<&Transition> = transitions.iter().filter(is_above).collect();
    down.sort_by(|a, b| {
        b.epsilon.total_cmp(&a.epsilon).then(b.zero.sigma.total_cmp(&a.zero.sigma))
    });
    down
}

/// Adds a stretch, or makes the last one longer if the same modes are unstable there.
fn add(stretches: &mut Vec<Stretch>, epsilon: (f64, Option<f64>), unstable_modes: Vec<usize>) {
    match stretches.last_mut() {
        Some(last) if last.unstable_modes == unstable_modes => last.epsilon.0 = epsilon.0,
        _ => stretches.push(Stretch { epsilon, unstable_modes, truncated: false }),
    }
}

/// Which modes are unstable, as ε falls.
struct Modes {
    is_unstable: Vec<bool>,
}

impl Modes {
    fn at_infinity(stable: &StableRegion, eigenspaces: &[Eigenspace]) -> Self {
        let n_modes = eigenspaces.iter().map(|space| space.modes.end).max().unwrap_or(0);
        let mut is_unstable = vec![false; n_modes];
        for space in eigenspaces {
            let is_stable = match space.lambda {
                0.0 => stable.contains(0.0),
                _ => stable.is_unbounded(),
            };
            is_unstable[space.modes.clone()].fill(!is_stable);
        }
        Self { is_unstable }
    }

    /// Below these transitions, which go down.
    fn pass(&mut self, transitions: &[&Transition]) {
        for transition in transitions {
            // Below the lower end of an interval, at which Λ falls.
            self.is_unstable[transition.modes.clone()].fill(transition.zero.falling);
        }
    }

    fn unstable(&self) -> Vec<usize> {
        (0..self.is_unstable.len()).filter(|&mode| self.is_unstable[mode]).collect()
    }
}

#[cfg(test)]
mod tests;
