//! The range of ε in which clusters were seen synchronised in a sweep, and how well its ends are known.
//!
//! In every seed by itself: the largest ε of the sweep inside a given range at which all of the
//! clusters are synchronised, and from there down and up to the first points at which one of them is
//! not. An end is then midway between the two points on either side of it, and known to half their
//! distance. Where the sweep ends before, the end is not measured but bounded: the onset is *at most*
//! the smallest ε, the upper end *at least* the largest. A run that escaped is not synchronised, and
//! neither are nodes at ε = 0; where these have no error for a reason of their own, ε = 0 tells nothing
//! of coupling and the sweep begins above it.

use dynamics::Estimate;
use serde::Serialize;

use super::{Simulated, completed};

/// Both ends of the range in which clusters were seen.
#[derive(Clone, Debug)]
pub struct Seen {
    /// ε from which on they are synchronised.
    pub onset: End,
    /// ε up to which they are.
    pub end: End,
}

/// How an end is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Known {
    /// In every seed the sweep has a point on either side of it.
    Measured,
    /// In some seed it lies below the sweep: its mean is at most the limit.
    AtMost,
    /// In some seed it lies above the sweep: its mean is at least the limit.
    AtLeast,
    /// In some seed the clusters are synchronised at no point that was looked at.
    Unseen,
    /// No point of the sweep lies where the clusters are predicted.
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
    pub bound: Known,
    /// Where it is at most or at least this.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit: Option<f64>,
    /// Half the distance of the points on either side of it, the largest of all seeds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub half_step: Option<f64>,
    /// Seeds in which the orbit escaped at the next point beyond the end.
    pub n_escaped: usize,
    /// The least and the most that its mean can be.
    #[serde(skip)]
    pub interval: Option<[f64; 2]>,
}

/// An end in one seed: the last point that is synchronised, and the next one that is not.
#[derive(Clone, Copy)]
struct OfSeed {
    kept: f64,
    lost: Option<(f64, bool)>,
}

impl Simulated {
    /// Where these clusters were seen synchronised, looked for at ε in (from, to]; anywhere where no
    /// range is given.
    pub fn seen(&self, clusters: &[Vec<usize>], within: Option<(f64, Option<f64>)>) -> Seen {
        let inside = |&at: &usize| {
            let epsilon = self.epsilon[at];
            let holds = |(from, to): (f64, Option<f64>)| {
                epsilon > from && to.is_none_or(|to| epsilon <= to)
            };
            epsilon > 0.0 && within.is_none_or(holds)
        };
        let candidates: Vec<usize> = (0..self.epsilon.len()).filter(inside).collect();
        if candidates.is_empty() {
            return Seen { onset: End::none(Known::NotSwept), end: End::none(Known::NotSwept) };
        }
        let synchronised = self.synchronised(clusters);
        let ends = |seed: usize| self.ends_in(&synchronised[seed], seed, &candidates);
        let (onsets, ends): (Vec<_>, Vec<_>) = (0..self.seeds.len()).map(ends).unzip();
        Seen { onset: End::of(&onsets, Known::AtMost), end: End::of(&ends, Known::AtLeast) }
    }

    /// Whether all of these clusters are synchronised, by seed and ε.
    fn synchronised(&self, clusters: &[Vec<usize>]) -> Vec<Vec<bool>> {
        let bounds: Vec<f64> = (0..self.epsilon.len()).map(|at| self.bound(at)).collect();
        let at = |seed: usize, at: usize| {
            let run = &self.at(at)[seed];
            let below = |c: &Vec<usize>| self.cluster_error(run, c).is_some_and(|e| e < bounds[at]);
            clusters.iter().all(below)
        };
        let of_seed = |seed| (0..self.epsilon.len()).map(|position| at(seed, position)).collect();
        (0..self.seeds.len()).map(of_seed).collect()
    }

    /// Lower and upper end in one seed; none where the clusters are synchronised at no candidate.
    fn ends_in(
        &self,
        synchronised: &[bool],
        seed: usize,
        candidates: &[usize],
    ) -> (Option<OfSeed>, Option<OfSeed>) {
        let Some(&start) = candidates.iter().rev().find(|&&at| synchronised[at]) else {
            return (None, None);
        };
        let end = |kept: usize, lost: Option<usize>| OfSeed {
            kept: self.epsilon[kept],
            lost: lost.map(|at| (self.epsilon[at], completed(&self.at(at)[seed]).is_none())),
        };
        // Uncoupled nodes without an error do not tell where coupling sets in.
        let first = usize::from(self.epsilon[0] == 0.0 && synchronised[0]);
        let below = (first..start).rev().find(|&at| !synchronised[at]);
        let above = (start + 1..self.epsilon.len()).find(|&at| !synchronised[at]);
        let last = self.epsilon.len() - 1;
        (
            Some(end(below.map_or(first, |at| at + 1), below)),
            Some(end(above.map_or(last, |at| at - 1), above)),
        )
    }
}

impl End {
    fn none(bound: Known) -> Self {
        Self {
            mean: None,
            spread: None,
            of_seeds: Vec::new(),
            bound,
            limit: None,
            half_step: None,
            n_escaped: 0,
            interval: None,
        }
    }

    /// An end over seeds, which is a bound of this kind where it lies beyond the sweep in some.
    fn of(seeds: &[Option<OfSeed>], beyond: Known) -> Self {
        let midway = |seed: &Option<OfSeed>| {
            let OfSeed { kept, lost } = (*seed)?;
            Some(0.5 * (kept + lost?.0))
        };
        let of_seeds: Vec<Option<f64>> = seeds.iter().map(midway).collect();
        let escaped = |seed: &&Option<OfSeed>| seed.and_then(|s| s.lost).is_some_and(|lost| lost.1);
        let n_escaped = seeds.iter().filter(escaped).count();
        let Some(ends) = seeds.iter().copied().collect::<Option<Vec<OfSeed>>>() else {
            return Self { of_seeds, n_escaped, ..Self::none(Known::Unseen) };
        };
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let kept = mean(&ends.iter().map(|end| end.kept).collect::<Vec<_>>());
        let Some(lost) = ends.iter().map(|end| Some(end.lost?.0)).collect::<Option<Vec<f64>>>()
        else {
            let open = if beyond == Known::AtMost { [0.0, kept] } else { [kept, f64::INFINITY] };
            let limit = Some(kept);
            return Self { of_seeds, n_escaped, limit, interval: Some(open), ..Self::none(beyond) };
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
            n_escaped,
            interval: Some([kept.min(lost), kept.max(lost)]),
        }
    }

    /// How well a measured end is known: its spread over seeds or half a step, whichever is larger.
    pub fn uncertainty(&self) -> Option<f64> {
        Some(self.spread?.max(self.half_step?))
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{from, simulated};
    use super::*;

    const PAIR: [[usize; 2]; 1] = [[0, 1]];

    fn seen(sweep: &Simulated, within: Option<(f64, Option<f64>)>) -> Seen {
        sweep.seen(&PAIR.map(Vec::from), within)
    }

    #[test]
    fn an_onset_lies_above_the_last_coupling_at_which_synchrony_is_lost() {
        // Seed 2 bursts once more at ε = 3 after looking synchronised at 2.
        let sweep = simulated(&[[5.0, 5.0], [5.0, 5.0], [0.0, 0.0], [0.0, 0.2], [0.0, 0.0]]);
        let Seen { onset, end } = seen(&sweep, None);
        assert_eq!(onset.of_seeds, [Some(1.5), Some(3.5)]);
        assert_eq!((onset.mean, onset.spread), (Some(2.5), Some(2f64.sqrt())));
        assert_eq!((onset.bound, onset.half_step), (Known::Measured, Some(0.5)));
        assert_eq!((end.mean, end.bound, end.limit), (None, Known::AtLeast, Some(4.0)));
    }

    #[test]
    fn clusters_synchronised_at_no_coupling_in_one_seed_have_no_onset() {
        let onset = seen(&simulated(&[[5.0, 5.0], [5.0, 0.0]]), None).onset;
        assert_eq!(onset.of_seeds, [None, Some(0.5)]);
        assert_eq!((onset.mean, onset.bound), (None, Known::Unseen));
    }

    #[test]
    fn an_onset_below_the_sweep_is_bounded_and_not_measured() {
        let onset = seen(&from(3.0, &[[0.0, 5.0], [0.0, 0.0]]), None).onset;
        assert_eq!((onset.mean, onset.spread), (None, None));
        // One seed sets in below 3, the other below 4.
        assert_eq!((onset.bound, onset.limit), (Known::AtMost, Some(3.5)));
        assert_eq!(onset.of_seeds, [None, Some(3.5)]);
    }

    #[test]
    fn a_state_that_is_bounded_above_has_two_ends_however_far_the_sweep_goes() {
        let sweep = from(1.0, &[[5.0; 2], [0.0; 2], [0.0; 2], [5.0, f64::INFINITY], [5.0; 2]]);
        for within in [None, Some((1.2, Some(3.7)))] {
            let Seen { onset, end } = seen(&sweep, within);
            assert_eq!([onset.mean, end.mean], [Some(1.5), Some(3.5)]);
            assert_eq!([onset.n_escaped, end.n_escaped], [0, 1]);
        }
    }

    #[test]
    fn of_two_ranges_the_one_inside_the_prediction_is_meant() {
        let sweep = from(1.0, &[[5.0; 2], [0.0; 2], [5.0; 2], [0.0; 2], [5.0; 2]]);
        let onset = |within| seen(&sweep, Some(within)).onset.mean;
        assert_eq!(onset((1.5, Some(2.5))), Some(1.5));
        assert_eq!(onset((3.5, Some(4.5))), Some(3.5));
        assert_eq!(onset((1.5, None)), Some(3.5));
    }

    #[test]
    fn a_range_outside_the_sweep_has_no_ends() {
        let sweep = from(1.0, &[[0.0; 2], [0.0; 2]]);
        for within in [(2.5, None), (0.1, Some(0.9)), (1.2, Some(1.8))] {
            let Seen { onset, end } = seen(&sweep, Some(within));
            assert_eq!([onset.bound, end.bound], [Known::NotSwept; 2]);
            assert_eq!([onset.mean, onset.limit, end.mean, end.limit], [None; 4]);
        }
    }

    #[test]
    fn uncoupled_nodes_without_an_error_say_nothing_of_where_coupling_sets_in() {
        let onset = seen(&simulated(&[[0.0; 2], [0.0; 2], [0.0; 2]]), None).onset;
        assert_eq!((onset.bound, onset.limit), (Known::AtMost, Some(1.0)));
        // Uncoupled nodes that are apart do: the onset is somewhere above 0.
        let onset = seen(&simulated(&[[5.0; 2], [0.0; 2], [0.0; 2]]), None).onset;
        assert_eq!((onset.bound, onset.mean), (Known::Measured, Some(0.5)));
        // Where only ε = 0 was looked at, nothing was.
        assert_eq!(seen(&simulated(&[[0.0; 2]]), None).onset.bound, Known::NotSwept);
    }
}
