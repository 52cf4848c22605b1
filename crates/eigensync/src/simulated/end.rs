//! One end of a range of ε over seeds, from what each of them tells: a mean, a bound, or groups.
//!
//! Seeds may settle on different attractors, and then a mean over them is of none. Where ends fall into
//! groups (see `simulated/groups`) each group is named, and there is no mean.

use std::fmt;

use dynamics::Estimate;
use serde::Serialize;

use super::groups::{Apart, groups};
use crate::numbers::four_digits;

/// How an end is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Known {
    /// In every seed that tells of it the sweep has a point on either side of it.
    Measured,
    /// In some seed it lies below the sweep: its mean is at most the limit.
    AtMost,
    /// In some seed it lies above the sweep: its mean is at least the limit.
    AtLeast,
    /// Seeds fall into groups, far apart: their mean would be of none of them.
    Groups,
    /// In some seed the clusters are synchronised at no point that was looked at.
    Unseen,
    /// In some seed every orbit that was looked at escaped.
    Escaped,
    /// No point of the sweep that was integrated lies where the clusters are predicted.
    NotSwept,
}

/// One end of a range of ε, over all seeds.
#[derive(Clone, Debug, Serialize)]
pub struct End {
    /// Mean over seeds, where it was measured.
    pub mean: Option<f64>,
    /// Standard deviation over seeds, where it was measured.
    pub spread: Option<f64>,
    /// Of each seed in which it was measured.
    pub of_seeds: Vec<Option<f64>>,
    /// How it is known.
    pub bound: Known,
    /// Where it is at most or at least this.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit: Option<f64>,
    /// Half the distance of the points on either side of it, the largest of all seeds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub half_step: Option<f64>,
    /// The groups into which seeds fall, from small ε up; only where they do.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub groups: Vec<Group>,
    /// Seeds in which the orbit escaped at the next point beyond the end, or at every one looked at.
    pub n_escaped: usize,
    /// The least and the most that its mean can be.
    #[serde(skip)]
    pub interval: Option<[f64; 2]>,
}

/// Seeds in which an end lies near the same ε.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Group {
    /// How many they are.
    pub n_seeds: usize,
    /// The least and the most in these seeds; none where it lies beyond the sweep on that side.
    pub from: Option<f64>,
    /// The most.
    pub to: Option<f64>,
}

impl fmt::Display for Group {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let seeds = if self.n_seeds == 1 { "seed" } else { "seeds" };
        write!(f, "{} {seeds} at ", self.n_seeds)?;
        match (self.from, self.to) {
            (Some(from), Some(to)) if from == to => f.write_str(&four_digits(from)),
            (Some(from), Some(to)) => write!(f, "{} to {}", four_digits(from), four_digits(to)),
            (None, Some(to)) => write!(f, "most {}", four_digits(to)),
            (Some(from), None) => write!(f, "least {}", four_digits(from)),
            (None, None) => f.write_str("no known ε"),
        }
    }
}

/// An end in one seed: the last point that is synchronised, and the next one that is not, with whether
/// its run escaped.
#[derive(Clone, Copy)]
pub(super) struct OfSeed {
    pub(super) kept: f64,
    pub(super) lost: Option<(f64, bool)>,
}

impl OfSeed {
    /// Midway between the two points, where there are two.
    fn midway(self) -> Option<f64> {
        Some(0.5 * (self.kept + self.lost?.0))
    }
}

/// What one seed tells of an end.
#[derive(Clone, Copy)]
pub(super) enum Told {
    /// None of its runs was integrated.
    Nothing,
    /// The clusters are synchronised nowhere, and every orbit escaped.
    Escaped,
    /// The clusters are synchronised nowhere.
    Unseen,
    At(OfSeed),
}

impl End {
    pub(super) fn none(bound: Known) -> Self {
        Self {
            mean: None,
            spread: None,
            of_seeds: Vec::new(),
            bound,
            limit: None,
            half_step: None,
            groups: Vec::new(),
            n_escaped: 0,
            interval: None,
        }
    }

    /// An end over seeds; it is a bound of this kind where it lies beyond the sweep in some.
    pub(super) fn of(seeds: &[Told], beyond: Known, apart: Apart) -> Self {
        let at = |told: &Told| if let Told::At(end) = told { Some(*end) } else { None };
        let of_seeds: Vec<Option<f64>> = seeds.iter().map(|told| at(told)?.midway()).collect();
        let escaped = |told: &&Told| match told {
            Told::At(end) => end.lost.is_some_and(|lost| lost.1),
            Told::Escaped => true,
            Told::Unseen | Told::Nothing => false,
        };
        let n_escaped = seeds.iter().filter(escaped).count();
        let ends: Vec<OfSeed> = seeds.iter().filter_map(at).collect();
        let without = |bound| Self { of_seeds: of_seeds.clone(), n_escaped, ..Self::none(bound) };
        if seeds.iter().any(|told| matches!(told, Told::Unseen)) {
            return without(Known::Unseen);
        }
        if seeds.iter().any(|told| matches!(told, Told::Escaped)) {
            return without(Known::Escaped);
        }
        if ends.is_empty() {
            return without(Known::NotSwept);
        }
        if let Some(groups) = grouped(&ends, beyond, apart) {
            let least = groups[0].from.unwrap_or(0.0);
            let most = groups[groups.len() - 1].to.unwrap_or(f64::INFINITY);
            return Self { groups, interval: Some([least, most]), ..without(Known::Groups) };
        }
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let kept = mean(&ends.iter().map(|end| end.kept).collect::<Vec<_>>());
        let Some(lost) = ends.iter().map(|end| Some(end.lost?.0)).collect::<Option<Vec<f64>>>()
        else {
            let open = if beyond == Known::AtMost { [0.0, kept] } else { [kept, f64::INFINITY] };
            return Self { limit: Some(kept), interval: Some(open), ..without(beyond) };
        };
        let values: Vec<f64> = of_seeds.iter().flatten().copied().collect();
        let estimate = Estimate::from_independent(&values);
        let root_n = (values.len() as f64).sqrt();
        let half_steps = ends.iter().zip(&lost).map(|(end, lost)| 0.5 * (end.kept - lost).abs());
        let lost = mean(&lost);
        Self {
            mean: Some(estimate.mean),
            spread: Some(if values.len() > 1 { estimate.standard_error * root_n } else { 0.0 }),
            of_seeds,
            bound: Known::Measured,
            limit: None,
            half_step: half_steps.reduce(f64::max),
            groups: Vec::new(),
            n_escaped,
            interval: Some([kept.min(lost), kept.max(lost)]),
        }
    }

    /// How well a measured end is known: its spread over seeds or half a step, whichever is larger.
    pub fn uncertainty(&self) -> Option<f64> {
        Some(self.spread?.max(self.half_step?))
    }
}

/// The groups into which ends fall, if they do, from small ε up. An end beyond the sweep is no number
/// that the scatter of others could be held against: those that are measured, many steps away, are
/// another group.
fn grouped(ends: &[OfSeed], beyond: Known, apart: Apart) -> Option<Vec<Group>> {
    let values: Vec<f64> = ends.iter().map(|end| end.midway().unwrap_or(end.kept)).collect();
    // An end is known to the step of the sweep beside it.
    let steps = ends.iter().filter_map(|end| Some((end.kept - end.lost?.0).abs()));
    let step = steps.reduce(f64::max)?;
    let (outside, inside): (Vec<usize>, Vec<usize>) =
        (0..ends.len()).partition(|&at| ends[at].lost.is_none());
    let distances = inside.iter().flat_map(|&a| outside.iter().map(move |&b| (a, b)));
    let gap = distances.map(|(a, b)| (values[a] - values[b]).abs()).reduce(f64::min);
    let is_split = |gap: f64| apart.counts([outside.len(), inside.len()], gap, 0.0, step);
    let found = match (gap.is_some_and(is_split), beyond) {
        (false, _) => groups(&values, step, apart)?,
        (true, Known::AtMost) => vec![outside, inside],
        (true, _) => vec![inside, outside],
    };
    let group = |members: Vec<usize>| {
        let inside = |at: &usize| ends[*at].lost.is_some();
        let is_known = |side: Known| beyond != side || members.iter().all(inside);
        let of_members = || members.iter().map(|&at| values[at]);
        Group {
            n_seeds: members.len(),
            from: is_known(Known::AtMost).then(|| of_members().fold(f64::INFINITY, f64::min)),
            to: is_known(Known::AtLeast).then(|| of_members().fold(0.0, f64::max)),
        }
    };
    Some(found.into_iter().map(group).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_beyond_the_sweep_are_a_group_beside_those_that_scatter_inside() {
        let end = |kept: f64, lost: Option<f64>| OfSeed { kept, lost: lost.map(|at| (at, false)) };
        let measured = |at: f64| end(at + 0.1, Some(at - 0.1));
        let ends = [end(0.2, None), measured(1.9), measured(3.3), end(0.2, None), measured(2.5)];
        let of = |ends: &[OfSeed]| grouped(ends, Known::AtMost, Apart::UNEXPECTED);
        let groups: Vec<String> = of(&ends).unwrap().iter().map(ToString::to_string).collect();
        assert_eq!(groups, ["2 seeds at most 0.2", "3 seeds at 1.9 to 3.3"]);
        assert_eq!(of(&ends[..3]), None, "one seed may have burst");
        assert_eq!(of(&ends[1..3]), None);
    }
}
