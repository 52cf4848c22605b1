//! The range of ε in which clusters were seen synchronised in a sweep, and how well its ends are known.
//!
//! In every seed by itself: the largest ε of the sweep inside a given range at which all of the
//! clusters are synchronised, and from there down and up to the first points at which one of them is
//! not. An end is then midway between the two points on either side of it, and known to half their
//! distance. Where the sweep ends before, the end is not measured but bounded: the onset is *at most*
//! the smallest ε, the upper end *at least* the largest. A run that escaped is not synchronised, and
//! neither are nodes at ε = 0; where these have no error for a reason of their own, ε = 0 tells nothing
//! of coupling and the sweep begins above it.
//!
//! What becomes of an end over seeds is in `simulated/end`.

use dynamics::{Outcome, Run};

use super::Simulated;
use super::end::{End, Known, OfSeed, Told};

/// Both ends of the range in which clusters were seen.
#[derive(Clone, Debug)]
pub struct Seen {
    /// ε from which on they are synchronised.
    pub onset: End,
    /// ε up to which they are.
    pub end: End,
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
        let seeds: Vec<[Told; 2]> =
            self.sights(clusters).iter().map(|seen| self.ends_in(seen, &candidates)).collect();
        let of = |end: usize, beyond| {
            End::of(&seeds.iter().map(|ends| ends[end]).collect::<Vec<_>>(), beyond, self.apart)
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

    /// Lower and upper end in one seed.
    fn ends_in(&self, seen: &[Sight], candidates: &[usize]) -> [Told; 2] {
        let is_synchronised = |at: &usize| seen[*at] == Sight::Synchronised;
        let Some(&start) = candidates.iter().rev().find(|at| is_synchronised(at)) else {
            let any = |sight: Sight| candidates.iter().any(|&at| seen[at] == sight);
            // A seed of which no run was integrated there tells nothing, and the others decide.
            return [match (any(Sight::Apart), any(Sight::Escaped)) {
                (true, _) => Told::Unseen,
                (false, true) => Told::Escaped,
                (false, false) => Told::Nothing,
            }; 2];
        };
        // Uncoupled nodes without an error do not tell where coupling sets in.
        let first = usize::from(self.epsilon[0] == 0.0 && is_synchronised(&0));
        let tells = |at: &usize| seen[*at] != Sight::Nothing;
        let end = |beyond: &mut dyn Iterator<Item = usize>| {
            let mut kept = start;
            for at in beyond.filter(tells) {
                if !is_synchronised(&at) {
                    let lost = Some((self.epsilon[at], seen[at] == Sight::Escaped));
                    return Told::At(OfSeed { kept: self.epsilon[kept], lost });
                }
                kept = at;
            }
            Told::At(OfSeed { kept: self.epsilon[kept], lost: None })
        };
        [end(&mut (first..start).rev()), end(&mut (start + 1..self.epsilon.len()))]
    }
}

#[cfg(test)]
mod tests {
    use super::super::groups::Apart;
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
    fn ends_in_two_groups_have_no_mean_and_each_group_is_told() {
        // One seed rests, and is synchronised from the first point on; the other sets in at 9.
        let errors = |at: usize| [0.0, if at < 8 { 5.0 } else { 0.0 }];
        let mut sweep = from(1.0, &(0..10).map(errors).collect::<Vec<_>>());
        let onset = seen(&sweep, None).onset;
        assert_eq!((onset.bound, onset.limit), (Known::AtMost, Some(5.0)), "it may have burst");
        sweep.apart = Apart::EXPECTED;
        let Seen { onset, end } = seen(&sweep, None);
        assert_eq!((onset.bound, onset.mean, onset.limit), (Known::Groups, None, None));
        assert_eq!((onset.interval, onset.uncertainty()), (Some([0.0, 8.5]), None));
        let groups: Vec<String> = onset.groups.iter().map(ToString::to_string).collect();
        assert_eq!(groups, ["1 seed at most 1", "1 seed at 8.5"]);
        assert_eq!((end.bound, end.limit), (Known::AtLeast, Some(10.0)));
    }

    #[test]
    fn clusters_of_which_every_orbit_escaped_are_not_said_to_be_apart() {
        let escapes = [f64::INFINITY; 2];
        let onset = seen(&from(1.0, &[escapes, escapes]), None).onset;
        assert_eq!((onset.bound, onset.n_escaped), (Known::Escaped, 2));
        let onset = seen(&from(1.0, &[[5.0, f64::INFINITY], escapes]), None).onset;
        assert_eq!(onset.bound, Known::Unseen);
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
