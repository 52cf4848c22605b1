//! The range of ε in which clusters were seen synchronised in a sweep, and how well its ends are known.
//!
//! In every seed by itself: the largest ε of the sweep inside a given range at which all of the
//! clusters are synchronised, and from there down and up to the first points at which one of them is
//! not. An end is then midway between the two points on either side of it, and known to half their
//! distance. Where the sweep ends before, the end is not measured but bounded: the onset is *at most*
//! the smallest ε, the upper end *at least* the largest. A run that escaped is not synchronised, and
//! neither are nodes at ε = 0; where these have no error for a reason of their own, ε = 0 tells nothing
//! of coupling and the sweep begins above it.

use dynamics::{Estimate, Outcome, Run};
use serde::Serialize;

use super::Simulated;

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
    /// In every seed that tells of it the sweep has a point on either side of it.
    Measured,
    /// In some seed it lies below the sweep: its mean is at most the limit.
    AtMost,
    /// In some seed it lies above the sweep: its mean is at least the limit.
    AtLeast,
    /// In some seed the clusters are synchronised at no point that was looked at.
    Unseen,
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

/// What one run shows of some clusters.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Sight {
    Synchronised,
    Apart,
    Escaped,
    /// The integrator gave up.
    Nothing,
}

/// An end in one seed: the last point that is synchronised, and the next one that is not, with whether
/// its run escaped.
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
        // A seed of which no run was integrated there tells nothing, and the others decide.
        let ends_in = |seen: &Vec<Sight>| {
            let tells = candidates.iter().any(|&at| seen[at] != Sight::Nothing);
            tells.then(|| self.ends_in(seen, &candidates))
        };
        let ends: Vec<Option<[Option<OfSeed>; 2]>> =
            self.sights(clusters).iter().map(ends_in).collect();
        let of = |end: usize, beyond| {
            let of_seeds: Vec<_> = ends.iter().map(|ends| ends.map(|ends| ends[end])).collect();
            End::of(&of_seeds, beyond)
        };
        Seen { onset: of(0, Known::AtMost), end: of(1, Known::AtLeast) }
    }

    /// What is seen of these clusters, by seed and ε.
    fn sights(&self, clusters: &[Vec<usize>]) -> Vec<Vec<Sight>> {
        let bounds: Vec<f64> = (0..self.epsilon.len()).map(|at| self.bound(at)).collect();
        let sight = |run: &Run, bound: f64| {
            let below = |c: &Vec<usize>| self.cluster_error(run, c).is_some_and(|e| e < bound);
            match run.outcome {
                Outcome::Failed { .. } => Sight::Nothing,
                Outcome::Escaped { .. } => Sight::Escaped,
                Outcome::Completed(_) if clusters.iter().all(below) => Sight::Synchronised,
                Outcome::Completed(_) => Sight::Apart,
            }
        };
        let of_seed = |seed: usize| {
            bounds.iter().enumerate().map(|(at, &bound)| sight(&self.at(at)[seed], bound)).collect()
        };
        (0..self.seeds.len()).map(of_seed).collect()
    }

    /// Lower and upper end in one seed; none where the clusters are synchronised at no candidate.
    fn ends_in(&self, seen: &[Sight], candidates: &[usize]) -> [Option<OfSeed>; 2] {
        let is_synchronised = |at: &usize| seen[*at] == Sight::Synchronised;
        let Some(&start) = candidates.iter().rev().find(|at| is_synchronised(at)) else {
            return [None, None];
        };
        // Uncoupled nodes without an error do not tell where coupling sets in.
        let first = usize::from(self.epsilon[0] == 0.0 && is_synchronised(&0));
        let tells = |at: &usize| seen[*at] != Sight::Nothing;
        let end = |beyond: &mut dyn Iterator<Item = usize>| {
            let mut kept = start;
            for at in beyond.filter(tells) {
                if !is_synchronised(&at) {
                    let lost = Some((self.epsilon[at], seen[at] == Sight::Escaped));
                    return Some(OfSeed { kept: self.epsilon[kept], lost });
                }
                kept = at;
            }
            Some(OfSeed { kept: self.epsilon[kept], lost: None })
        };
        [end(&mut (first..start).rev()), end(&mut (start + 1..self.epsilon.len()))]
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

    /// An end over seeds, of which some may tell nothing, and some that there is none; it is a bound
    /// of this kind where it lies beyond the sweep in some.
    fn of(seeds: &[Option<Option<OfSeed>>], beyond: Known) -> Self {
        let midway = |seed: &Option<Option<OfSeed>>| {
            let OfSeed { kept, lost } = (*seed)??;
            Some(0.5 * (kept + lost?.0))
        };
        let of_seeds: Vec<Option<f64>> = seeds.iter().map(midway).collect();
        let telling = || seeds.iter().flatten();
        let escaped = |seed: &&Option<OfSeed>| seed.and_then(|s| s.lost).is_some_and(|lost| lost.1);
        let n_escaped = telling().filter(escaped).count();
        if telling().next().is_none() {
            return Self { of_seeds, ..Self::none(Known::NotSwept) };
        }
        let Some(ends) = telling().copied().collect::<Option<Vec<OfSeed>>>() else {
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

    /// The same sweep in which the integrator gave up at these points, as (ε, seed) from 0.
    fn failed_at(mut sweep: Simulated, points: &[(usize, usize)]) -> Simulated {
        for &(at, seed) in points {
            let outcome = Outcome::Failed { time: 1.0, reason: "too stiff".into() };
            sweep.runs[at * 2 + seed].outcome = outcome;
        }
        sweep
    }

    #[test]
    fn an_integrator_that_gives_up_measures_no_end_and_is_no_escape() {
        let both = |at: usize| [(at, 0), (at, 1)];
        let sweep = || from(1.0, &[[5.0; 2], [0.0; 2], [0.0; 2], [0.0; 2]]);
        let Seen { onset, end } = seen(&failed_at(sweep(), &both(3)), None);
        assert_eq!((onset.bound, onset.mean), (Known::Measured, Some(1.5)));
        assert_eq!((end.bound, end.limit, end.n_escaped), (Known::AtLeast, Some(3.0), 0));
        let Seen { onset, .. } = seen(&failed_at(sweep(), &both(0)), None);
        assert_eq!((onset.bound, onset.limit, onset.n_escaped), (Known::AtMost, Some(2.0), 0));
        // Between two points that were integrated the end is known to half of their distance.
        let Seen { onset, .. } = seen(&failed_at(sweep(), &both(1)), None);
        assert_eq!(
            (onset.bound, onset.mean, onset.half_step),
            (Known::Measured, Some(2.0), Some(1.0))
        );
        // One seed bounds the mean.
        let sweep = from(1.0, &[[0.0; 2], [0.0; 2], [f64::INFINITY, 5.0]]);
        let Seen { end, .. } = seen(&failed_at(sweep, &[(2, 1)]), None);
        assert_eq!((end.bound, end.limit, end.n_escaped), (Known::AtLeast, Some(2.0), 1));
    }

    #[test]
    fn a_seed_of_which_nothing_was_integrated_leaves_the_others_to_tell() {
        let sweep = || from(1.0, &[[5.0; 2], [0.0; 2]]);
        let onset = seen(&failed_at(sweep(), &[(0, 1), (1, 1)]), None).onset;
        assert_eq!((onset.bound, onset.mean), (Known::Measured, Some(1.5)));
        assert_eq!(onset.of_seeds, [Some(1.5), None]);
        let all = [(0, 0), (0, 1), (1, 0), (1, 1)];
        let Seen { onset, end } = seen(&failed_at(sweep(), &all), None);
        assert_eq!([onset.bound, end.bound], [Known::NotSwept; 2]);
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
