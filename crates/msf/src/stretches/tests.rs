//! Windows and their ends, leading modes, ends of the look, and a direct look at σ as the second route.

use proptest::prelude::*;

use super::*;
use crate::{End, Zero};

fn region(intervals: &[(f64, Option<f64>)]) -> StableRegion {
    let known = |&(from, to): &(f64, Option<f64>)| Interval::known(from, to);
    StableRegion { intervals: intervals.iter().map(known).collect() }
}

/// All modes of these transverse eigenvalues, one each.
fn all(lambdas: &[f64]) -> KnownModes {
    let space =
        |(k, &lambda): (usize, &f64)| Eigenspace { modes: k + 1..k + 2, lambda, error: 0.0 };
    let eigenspaces = lambdas.iter().enumerate().map(space).collect();
    KnownModes { eigenspaces, others: None, looked_from: 0.0 }
}

fn leading(lambdas: &[f64], at_most: f64, smallest: Option<f64>) -> KnownModes {
    KnownModes { others: Some(Others { at_most, smallest }), ..all(lambdas) }
}

/// Range of ε and unstable modes of a stretch.
type Shown = (f64, Option<f64>, Vec<usize>);

/// Every stretch, and whether the last one is truncated, which no other is.
fn shown(stable: &StableRegion, known: &KnownModes) -> (Vec<Shown>, bool) {
    let stretches = Stability::new(stable, known).stretches;
    let n_truncated = stretches.iter().filter(|stretch| stretch.truncated).count();
    let is_truncated = stretches.last().is_some_and(|last| last.truncated);
    assert_eq!(n_truncated, usize::from(is_truncated));
    let of = |s: Stretch| (s.epsilon.0, s.epsilon.1, s.unstable_modes);
    (stretches.into_iter().map(of).collect(), is_truncated)
}

#[test]
fn modes_leave_a_window_at_both_of_its_ends() {
    let expected = vec![
        (4.0, None, vec![1, 2]),
        (2.0, Some(4.0), vec![2]),
        (1.0, Some(2.0), vec![]),
        (0.5, Some(1.0), vec![1]),
        (0.0, Some(0.5), vec![1, 2]),
    ];
    let window = region(&[(1.0, Some(4.0))]);
    assert_eq!(shown(&window, &all(&[-1.0, -2.0])), (expected, false));
}

#[test]
fn transitions_that_differ_by_rounding_are_one() {
    // 0.3 / 3 rounds to less than 0.1: there mode 1 leaves through the lower end, and mode 2 enters
    // through the upper one.
    let window = region(&[(0.1, Some(0.3))]);
    let (found, _) = shown(&window, &all(&[-1.0, -3.0]));
    let modes: Vec<_> = found.iter().map(|(.., modes)| modes.clone()).collect();
    assert_eq!(modes, [vec![1, 2], vec![2], vec![1], vec![1, 2]]);
    assert_eq!((found[1].0, found[2].1), (0.1, Some(0.1)));
}

#[test]
fn modes_too_slow_for_any_number_are_unstable_throughout() {
    let (found, _) = shown(&region(&[(8.0, None)]), &all(&[-1e-310, -1.0]));
    assert_eq!(found, [(8.0, None, vec![1]), (0.0, Some(8.0), vec![1, 2])]);
    let window = region(&[(1.0, Some(2.0)), (8.0, None)]);
    assert_eq!(shown(&window, &all(&[-1e-310])).0, [(0.0, None, vec![1])]);
}

#[test]
fn zero_modes_are_stable_only_where_oscillators_are_at_rest() {
    let to = End::Looked { sigma: 9.0 };
    let of = |included| {
        let from = End::Origin { included };
        let stable = StableRegion { intervals: vec![Interval { from, to }] };
        shown(&stable, &all(&[0.0, -1.0])).0
    };
    assert_eq!(of(false), [(0.0, None, vec![1])]);
    assert_eq!(of(true), [(0.0, None, vec![])]);
}

#[test]
fn leading_modes_decide_down_to_where_the_next_one_might_count() {
    let above = region(&[(6.0, None)]);
    let of = |at_most| shown(&above, &leading(&[-1.0, -2.0], at_most, None));
    assert_eq!(of(-2.0), (vec![(6.0, None, vec![]), (3.0, Some(6.0), vec![1])], true));
    // Nothing lies between mode 2 and a cutoff.
    let (found, _) = of(-3.0);
    assert_eq!(found[2], (2.0, Some(3.0), vec![1, 2]));
    // Of several intervals the others are in the last, down to its lower end.
    let two = region(&[(1.0, Some(2.0)), (6.0, None)]);
    let (found, _) = shown(&two, &leading(&[-1.0, -2.0], -2.0, None));
    assert_eq!(found.last().unwrap().0, 3.0);
}

#[test]
fn below_an_upper_end_leading_modes_decide_up_to_where_the_fastest_one_leaves() {
    let zero = Zero { standard_error: 0.5, ..Zero::exact(20.0, false) };
    let mut window = region(&[(2.0, Some(20.0))]);
    window.intervals[0].to = End::Zero(zero);
    let known = leading(&[-1.0, -2.0], -2.0, Some(-5.0));
    let expected = vec![(2.0, Some(4.0), vec![]), (1.0, Some(2.0), vec![1])];
    assert_eq!(shown(&window, &known), (expected, true));
    let decided = Stability::new(&window, &known).decided;
    let expected = Decided { from: 1.0, to: Some(4.0), to_standard_error: Some(0.1) };
    assert_eq!(decided, expected);
    // It leaves before the slowest mode enters, or the second one might be unstable.
    assert_eq!(shown(&window, &leading(&[-1.0, -2.0], -2.0, Some(-50.0))).0, []);
}

#[test]
fn leading_modes_alone_decide_nothing_where_the_fastest_ones_count() {
    let window = region(&[(0.187, Some(4.61))]);
    let nothing = Decided { from: 0.0, to: Some(0.0), to_standard_error: None };
    for known in [leading(&[-1.0], -1.0, None), leading(&[0.0], 0.0, Some(-1.0))] {
        for stable in [&window, &StableRegion::default()] {
            let found = Stability::new(stable, &known);
            assert_eq!((found.decided, found.stretches), (nothing, vec![]));
        }
    }
    let found = Stability::new(&region(&[(0.0, None)]), &leading(&[0.0], 0.0, None));
    assert_eq!((found.decided, found.stretches), (nothing, vec![]));
}

#[test]
fn nothing_is_decided_below_the_sigma_that_were_looked_at() {
    // Mode 1 comes to σ = 10, where the look began, at ε = 5.
    let mut stable = region(&[(10.0, None)]);
    stable.intervals[0].from = End::Looked { sigma: 10.0 };
    let looked = KnownModes { looked_from: 10.0, ..all(&[-2.0, -3.0]) };
    assert_eq!(shown(&stable, &looked), (vec![(5.0, None, vec![])], true));
    // Where nothing was found stable, something may be so below as well.
    let nowhere = StableRegion::default();
    assert_eq!(shown(&nowhere, &looked), (vec![(5.0, None, vec![1, 2])], true));
    let from_zero = KnownModes { looked_from: 0.0, ..looked };
    assert_eq!(shown(&nowhere, &from_zero), (vec![(0.0, None, vec![1, 2])], false));
}

fn any_region() -> impl Strategy<Value = StableRegion> {
    (prop::collection::btree_set(1u32..200, 0..7), any::<bool>()).prop_map(|(edges, is_open)| {
        let mut edges: Vec<f64> = edges.into_iter().map(|e| f64::from(e) / 10.0).collect();
        if is_open != (edges.len() % 2 == 1) {
            edges.pop();
        }
        let ends = |e: &[f64]| Interval::known(e[0], e.get(1).copied());
        StableRegion { intervals: edges.chunks(2).map(ends).collect() }
    })
}

proptest! {
    #[test]
    fn every_coupling_lies_in_the_stretch_that_a_direct_look_gives(
        stable in any_region(), mut rates in prop::collection::vec(0.01..20.0f64, 0..12),
        n_computed in 0usize..12, couplings in prop::collection::vec(0.001..30.0, 20),
    ) {
        rates.sort_by(f64::total_cmp);
        let lambdas: Vec<f64> = rates.iter().map(|rate| -rate).collect();
        let whole = Stability::new(&stable, &all(&lambdas));
        let n_computed = n_computed.min(lambdas.len());
        let (computed, rest) = lambdas.split_at(n_computed);
        let at_most = computed.last().copied().unwrap_or(0.0);
        let part = Stability::new(&stable, &leading(computed, at_most, rest.last().copied()));
        for epsilon in couplings {
            let found = |stability: &Stability| {
                let holds = |s: &&Stretch| {
                    s.epsilon.0 < epsilon && s.epsilon.1.is_none_or(|to| epsilon < to)
                };
                let mut held = stability.stretches.iter().filter(holds);
                (held.next().map(|stretch| stretch.unstable_modes.clone()), held.count())
            };
            let is_unstable = |&k: &usize| !stable.contains(epsilon * rates[k - 1]);
            let modes: Vec<usize> = (1..=rates.len()).filter(is_unstable).collect();
            prop_assert_eq!(found(&whole), (Some(modes.clone()), 0));
            // What leading modes decide is what all modes do.
            if let (Some(leading), n_others) = found(&part)
                && !rest.is_empty()
            {
                prop_assert_eq!((leading, n_others), (modes, 0));
            }
        }
    }

    #[test]
    fn stretches_follow_one_another_and_meet_at_transitions(
        stable in any_region(), rates in prop::collection::vec(0.01..20.0f64, 0..12),
    ) {
        let mut lambdas: Vec<f64> = rates.iter().map(|rate| -rate).collect();
        lambdas.sort_by(|a, b| b.total_cmp(a));
        let Stability { stretches, transitions, .. } = Stability::new(&stable, &all(&lambdas));
        prop_assert_eq!(stretches[0].epsilon.1, None);
        prop_assert_eq!(stretches.last().unwrap().epsilon.0, 0.0);
        for pair in stretches.windows(2) {
            prop_assert_eq!(Some(pair[0].epsilon.0), pair[1].epsilon.1);
            prop_assert!(pair[1].epsilon.0 < pair[0].epsilon.0);
            prop_assert_ne!(&pair[0].unstable_modes, &pair[1].unstable_modes);
            // To the last bit.
            prop_assert!(transitions.iter().any(|t| t.epsilon == pair[0].epsilon.0));
        }
    }
}
