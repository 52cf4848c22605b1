//! The cascade: the paper's two networks, windows, partial spectra, and a scan as the second route.

use clustering::{
    ClusterRule, ClusteringError, EigenvectorDistance, State, Stretch, merge_equal_clusters,
};
use graph::Normalization;
use msf::{End, Interval, StableRegion};
use proptest::prelude::*;
use spectra::Spectrum;

use crate::fixtures::{
    leading, nepal, random_network, random_spectrum, read, rotated, six_nodes, spectrum_of,
};
use crate::stable_set::cascade;

/// The critical generic coupling of the Lorenz oscillators of Fig. 1.
const SIGMA_C: f64 = 8.17;

fn region(intervals: &[(f64, Option<f64>)]) -> StableRegion {
    let intervals = intervals.iter().map(|&(from, to)| Interval::known(from, to)).collect();
    StableRegion { intervals }
}

fn above(sigma_c: f64) -> StableRegion {
    region(&[(sigma_c, None)])
}

fn exact(spectrum: &Spectrum, stable: &StableRegion) -> Vec<State> {
    cascade(spectrum, stable, ClusterRule::Exact).unwrap()
}

/// Nontrivial clusters with nodes counted from 1, as the paper does.
fn clusters(state: &State) -> Vec<Vec<usize>> {
    let one_based = |cluster: Vec<usize>| cluster.into_iter().map(|node| node + 1).collect();
    state.clusters.nontrivial().into_iter().map(one_based).collect()
}

#[track_caller]
fn check_range(state: &State, from: f64, to: Option<f64>) {
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-12 * b.abs();
    let (obtained_from, obtained_to) = state.epsilon;
    assert!(close(obtained_from, from), "from {obtained_from} instead of {from}");
    assert_eq!(obtained_to.is_some(), to.is_some());
    assert!(obtained_to.zip(to).is_none_or(|(a, b)| close(a, b)), "to {obtained_to:?}, {to:?}");
}

#[test]
fn six_nodes_lose_synchrony_as_two_clusters_then_two_pairs_then_none() {
    let states = exact(&six_nodes(), &above(SIGMA_C));
    // One simple eigenvalue −2, −3, −4, −5, −6 after the other.
    assert_eq!(states.len(), 6);
    for (k, state) in states.iter().enumerate() {
        let upper = (k > 0).then(|| SIGMA_C / (k as f64 + 1.0));
        let lower = if k < 5 { SIGMA_C / (k as f64 + 2.0) } else { 0.0 };
        check_range(state, lower, upper);
        assert_eq!(state.unstable_modes, (1..=k).collect::<Vec<_>>());
        assert!(!state.truncated);
    }
    assert_eq!(clusters(&states[0]), [[1, 2, 3, 4, 5, 6]]);
    assert_eq!(clusters(&states[1]), [[1, 2, 6], [3, 4, 5]]);
    assert_eq!(clusters(&states[2]), [[2, 6], [3, 5]]);
    assert!(states[3..].iter().all(|state| state.clusters.n_clusters() == 6));
}

#[test]
fn merged_six_node_states_are_the_four_of_the_paper() {
    let merged = merge_equal_clusters(&exact(&six_nodes(), &above(SIGMA_C)));
    assert_eq!(merged.len(), 4);
    check_range(&merged[3], 0.0, Some(SIGMA_C / 4.0));
    assert_eq!(merged[3].unstable_modes, [1, 2, 3, 4, 5]);
}

#[test]
fn nepal_has_the_eigenvalues_printed_in_the_paper() {
    let printed =
        [0., -0.94, -3.10, -8., -8., -8., -8., -9., -9., -9., -9., -9.94, -14., -14., -14.03];
    for (obtained, printed) in nepal().real_eigenvalues().iter().zip(printed) {
        assert!((obtained - printed).abs() < 0.005, "{obtained} instead of {printed}");
    }
}

#[test]
fn nepal_loses_its_clusters_at_modes_4_8_and_13() {
    let spectrum = rotated(nepal(), 1);
    let lambda = spectrum.real_eigenvalues();
    let merged = merge_equal_clusters(&exact(&spectrum, &above(SIGMA_C)));
    let (first, second, third) = (vec![1, 2, 3, 4, 5], vec![9, 10, 11, 12, 13], vec![6, 7, 8]);
    let expected = [
        vec![(1..=15).collect()],
        vec![first, third.clone(), second.clone()],
        vec![third.clone(), second],
        vec![third],
        vec![],
    ];
    assert_eq!(merged.iter().map(clusters).collect::<Vec<_>>(), expected);
    let critical = [1, 3, 7, 12].map(|mode| SIGMA_C / -lambda[mode]);
    check_range(&merged[0], critical[0], None);
    for k in 1..4 {
        check_range(&merged[k], critical[k], Some(critical[k - 1]));
    }
    check_range(&merged[4], 0.0, Some(critical[3]));
    // The paper's ε_4, ε_8, ε_13 with σ_c ≈ 8.3 are 1.04, 0.92, 0.6.
    for (ours, printed) in critical[1..].iter().zip([1.04, 0.92, 0.6]) {
        assert!((ours * 8.3 / SIGMA_C - printed).abs() < 0.01);
    }
}

#[test]
fn unmerged_nepal_states_have_one_range_an_eigenvalue() {
    let states = exact(&nepal(), &above(SIGMA_C));
    let modes: Vec<usize> = states.iter().map(|state| state.unstable_modes.len()).collect();
    assert_eq!(modes, [0, 1, 2, 6, 10, 11, 13, 14]);
    assert_eq!(clusters(&states[1]), clusters(&states[2]));
}

#[test]
fn a_bounded_window_loses_synchrony_at_both_ends() {
    // Stable where 0.187 < σ < 4.61, as for Rössler oscillators coupled through x.
    let (low, high) = (0.187, 4.61);
    let states = exact(&six_nodes(), &region(&[(low, Some(high))]));
    assert_eq!(states.len(), 11);
    // From strong coupling, the last modes become stable first: all are at ε = 4.61/6.
    check_range(&states[0], high / 2.0, None);
    assert_eq!(states[0].unstable_modes, [1, 2, 3, 4, 5]);
    check_range(&states[1], high / 3.0, Some(high / 2.0));
    assert_eq!(states[1].unstable_modes, [2, 3, 4, 5]);
    check_range(&states[5], low / 2.0, Some(high / 6.0));
    assert_eq!(clusters(&states[5]), [[1, 2, 3, 4, 5, 6]]);
    check_range(&states[6], low / 3.0, Some(low / 2.0));
    assert_eq!(clusters(&states[6]), [[1, 2, 6], [3, 4, 5]]);
    // Only λ_6 unstable: v_6 = (0, 1, −1, 0, 1, −1)/2.
    check_range(&states[4], high / 6.0, Some(high / 5.0));
    assert_eq!(clusters(&states[4]), [vec![1, 4], vec![2, 5], vec![3, 6]]);
    check_range(&states[10], 0.0, Some(low / 6.0));
}

#[test]
fn several_windows_bring_clusters_back() {
    // Complete graph K4: one eigenvalue −4, three times; stable in (1, 2) and beyond 3.
    let k4 = spectrum_of(&read("1 2\n1 3\n1 4\n2 3\n2 4\n3 4"), Normalization::Laplacian);
    let states = exact(&k4, &region(&[(1.0, Some(2.0)), (3.0, None)]));
    let n_clusters: Vec<usize> = states.iter().map(|state| state.clusters.n_clusters()).collect();
    assert_eq!(n_clusters, [1, 4, 1, 4]);
    for (state, (from, to)) in
        states.iter().zip([(0.75, None), (0.5, Some(0.75)), (0.25, Some(0.5)), (0.0, Some(0.25))])
    {
        check_range(state, from, to);
    }
}

#[test]
fn an_empty_stable_set_leaves_one_state_without_synchrony() {
    let states = exact(&six_nodes(), &StableRegion::default());
    assert_eq!(states.len(), 1);
    check_range(&states[0], 0.0, None);
    assert_eq!(states[0].unstable_modes, [1, 2, 3, 4, 5]);
    assert!(clusters(&states[0]).is_empty());
}

#[test]
fn oscillators_stable_at_every_coupling_stay_one_cluster() {
    let states = exact(&six_nodes(), &above(0.0));
    assert_eq!(states.len(), 1);
    check_range(&states[0], 0.0, None);
    assert_eq!(states[0].clusters.n_clusters(), 1);
}

#[test]
fn components_never_synchronise_with_one_another() {
    // Triangle (0, −3, −3), pair (0, −2) and a node alone.
    let spectrum = spectrum_of(&read("1 2\n2 3\n3 1\n4 5\n6"), Normalization::Laplacian);
    let states = exact(&rotated(spectrum, 4), &above(6.0));
    assert_eq!(states.len(), 3);
    check_range(&states[0], 3.0, None);
    assert_eq!(states[0].unstable_modes, [1, 2]);
    assert_eq!(clusters(&states[0]), [vec![1, 2, 3], vec![4, 5]]);
    check_range(&states[1], 2.0, Some(3.0));
    assert_eq!(clusters(&states[1]), [[1, 2, 3]]);
    check_range(&states[2], 0.0, Some(2.0));
    assert!(clusters(&states[2]).is_empty());
}

#[test]
fn nodes_without_links_are_one_state_without_synchrony() {
    let spectrum = spectrum_of(&read("1\n2\n3"), Normalization::Laplacian);
    let states = exact(&spectrum, &above(SIGMA_C));
    assert_eq!(states.len(), 1);
    assert_eq!(states[0].unstable_modes, [1, 2]);
    assert_eq!(states[0].clusters.n_clusters(), 3);
}

#[test]
fn a_single_node_is_always_synchronised() {
    let states = exact(&spectrum_of(&read("1"), Normalization::Laplacian), &above(SIGMA_C));
    assert_eq!((states.len(), states[0].clusters.n_clusters()), (1, 1));
}

#[test]
fn leading_modes_give_the_upper_part_of_the_cascade() {
    let whole = exact(&nepal(), &above(SIGMA_C));
    // Eight modes cut the eigenspace of −9, the first of which is the eighth.
    let part = exact(&leading(nepal(), 8), &above(SIGMA_C));
    assert_eq!(part.len(), 4);
    assert_eq!(part[..3], whole[..3]);
    let last = &part[3];
    assert_eq!(
        (&last.clusters, &last.unstable_modes),
        (&whole[3].clusters, &whole[3].unstable_modes)
    );
    check_range(last, SIGMA_C / 9.0, whole[3].epsilon.1);
    assert!(last.truncated && part[..3].iter().all(|state| !state.truncated));
    assert!(merge_equal_clusters(&part).last().unwrap().truncated);
}

#[test]
fn modes_above_a_cutoff_decide_down_to_where_one_at_the_cutoff_would_become_unstable() {
    let whole = exact(&nepal(), &above(SIGMA_C));
    let mut spectrum = leading(nepal(), 11);
    let last = *spectrum.real_eigenvalues().last().unwrap();
    let cutoff = last - 0.5;
    spectrum.cutoff = Some(cutoff);
    let part = exact(&spectrum, &above(SIGMA_C));
    assert_eq!(part[..4], whole[..4]);
    let below = &part[4];
    assert_eq!((part.len(), &below.unstable_modes), (5, &whole[4].unstable_modes));
    assert_eq!(below.clusters, whole[4].clusters);
    check_range(below, SIGMA_C / -cutoff, Some(SIGMA_C / -last));
    assert!(below.truncated);
}

#[test]
fn leading_modes_stop_above_the_highest_window() {
    // Above σ = 3 for good, and in (1, 2): an uncomputed λ ≤ −8 may be between them below 3/8.
    let stable = region(&[(1.0, Some(2.0)), (3.0, None)]);
    let states = exact(&leading(nepal(), 7), &stable);
    check_range(states.last().unwrap(), 3.0 / 8.0, states[states.len() - 2].epsilon.0.into());
    assert!(states.last().unwrap().truncated);
}

#[test]
fn nothing_is_predicted_below_the_sigma_that_were_looked_at() {
    // Stable from σ = 10 on, where the look began: mode 2 of the six nodes, λ = −2, comes to it at 5.
    let mut stable = above(10.0);
    stable.intervals[0].from = End::Looked { sigma: 10.0 };
    let states = exact(&six_nodes(), &stable);
    let [state] = &states[..] else { panic!("{states:?}") };
    check_range(state, 5.0, None);
    assert!(state.truncated && state.unstable_modes.is_empty());
}

#[test]
fn oscillators_at_rest_are_equal_in_every_component_of_the_network() {
    let two_pairs = spectrum_of(&read("1 2\n3 4\n"), Normalization::Laplacian);
    let mut stable = region(&[(0.0, None)]);
    let states = exact(&two_pairs, &stable);
    assert_eq!(states.iter().map(|s| s.clusters.n_clusters()).collect::<Vec<_>>(), [2]);
    stable.intervals[0].from = End::Origin { included: true };
    let states = exact(&two_pairs, &stable);
    assert_eq!(states.iter().map(|s| s.clusters.n_clusters()).collect::<Vec<_>>(), [1]);
}

/// The states of Nepal where these modes are unstable on the two sides of ε = 1.
fn about_one(
    [above, below]: [&[usize]; 2],
    to: f64,
    rule: ClusterRule,
) -> Result<Vec<State>, ClusteringError> {
    let stretch = |epsilon, modes: &[usize]| Stretch {
        epsilon,
        unstable_modes: modes.to_vec(),
        truncated: false,
    };
    let stretches = vec![stretch((1.0, None), above), stretch((0.0, Some(to)), below)];
    clustering::cascade(&nepal(), stretches, rule, clustering::QUIET)
}

#[test]
fn unstable_modes_are_whole_eigenspaces_without_the_synchronous_mode() {
    let part = ClusteringError::PartOfEigenspace { first: 3, last: 6, missing: 6 };
    let beyond = ClusteringError::ModeOutOfRange { mode: 15, n_modes: 15 };
    let all: Vec<usize> = (1..15).collect();
    for rule in [ClusterRule::Exact, ClusterRule::Threshold(0.03)] {
        // All nodes are single above already, so that no cluster asks for the modes below.
        let error = |below: &[usize]| about_one([&all, below], 1.0, rule).unwrap_err();
        assert_eq!(error(&[1, 2, 3, 4, 5]), part);
        assert_eq!(error(&[0, 1]), ClusteringError::SynchronousMode);
        assert_eq!(error(&[1, 15]), beyond);
    }
}

#[test]
#[should_panic(expected = "a stretch of ε over (0.0, Some(0.5)) below one over (1.0, None)")]
fn stretches_with_a_gap_are_refused() {
    let _ = about_one([&[], &[1]], 0.5, ClusterRule::Exact);
}

#[test]
fn no_stretch_has_no_state() {
    assert_eq!(
        clustering::cascade(&nepal(), vec![], ClusterRule::Exact, clustering::QUIET),
        Ok(vec![])
    );
}

#[test]
fn a_threshold_keeps_nearly_equal_nodes_together() {
    // v_2 of the Nepal grid: −0.11 on {1–5}, −0.07 on {6–8}, −0.05 on {9–13}, then 0.06 and 0.95.
    let states = cascade(&nepal(), &above(SIGMA_C), ClusterRule::Threshold(0.03)).unwrap();
    let expected = [vec![1, 2, 3, 4, 5], vec![6, 7, 8, 9, 10, 11, 12, 13]];
    assert_eq!(clusters(&states[1]), expected);
}

fn any_region() -> impl Strategy<Value = StableRegion> {
    (prop::collection::btree_set(1u32..200, 0..7), any::<bool>()).prop_map(|(edges, is_open)| {
        let mut edges: Vec<f64> = edges.into_iter().map(|e| f64::from(e) / 10.0).collect();
        if is_open != (edges.len() % 2 == 1) {
            edges.pop();
        }
        let intervals = edges.chunks(2).map(|e| Interval::known(e[0], e.get(1).copied())).collect();
        StableRegion { intervals }
    })
}

proptest! {
    #[test]
    fn every_coupling_lies_in_the_state_that_a_direct_look_gives(
        seed in any::<u64>(), n in 2usize..9, density in 0.2..1.0,
        stable in any_region(), couplings in prop::collection::vec(0.001..30.0, 20),
    ) {
        let spectrum = spectrum_of(&random_network(n, density, seed), Normalization::Laplacian);
        let states = exact(&spectrum, &stable);
        for epsilon in couplings {
            let holds = |s: &&State| s.epsilon.0 < epsilon && s.epsilon.1.is_none_or(|to| epsilon < to);
            let found: Vec<&State> = states.iter().filter(holds).collect();
            prop_assert_eq!(found.len(), 1);
            let lambda = spectrum.real_eigenvalues();
            let unstable = |&k: &usize| {
                let sigma = -epsilon * lambda[k];
                sigma < 1e-9 || !stable.contains(sigma)
            };
            let modes: Vec<usize> = (1..n).filter(unstable).collect();
            prop_assert_eq!(&found[0].unstable_modes, &modes);
            let distance = EigenvectorDistance::new(&spectrum, &modes).unwrap();
            prop_assert_eq!(&*found[0].clusters, &distance.exact_clusters().unwrap());
        }
    }

    #[test]
    fn a_threshold_cascade_has_the_clusters_of_each_of_its_states(
        seed in any::<u64>(), n in 1usize..40, stable in any_region(), threshold in 0.0..0.3,
    ) {
        let spectrum = random_spectrum(n, n, seed);
        let states = cascade(&spectrum, &stable, ClusterRule::Threshold(threshold)).unwrap();
        let exact_states = exact(&spectrum, &stable);
        prop_assert_eq!(states.len(), exact_states.len());
        for (state, exact_state) in states.iter().zip(exact_states) {
            prop_assert_eq!(state.epsilon, exact_state.epsilon);
            prop_assert_eq!(&state.unstable_modes, &exact_state.unstable_modes);
            let distance = EigenvectorDistance::new(&spectrum, &state.unstable_modes).unwrap();
            prop_assert_eq!(&*state.clusters, &distance.clusters_within(threshold).unwrap());
        }
    }

    #[test]
    fn states_follow_one_another_without_gaps(
        seed in any::<u64>(), n in 1usize..9, stable in any_region(),
    ) {
        let spectrum = spectrum_of(&random_network(n, 0.5, seed), Normalization::Normalized);
        let states = exact(&spectrum, &stable);
        prop_assert_eq!(states[0].epsilon.1, None);
        prop_assert_eq!(states.last().unwrap().epsilon.0, 0.0);
        for pair in states.windows(2) {
            prop_assert_eq!(Some(pair[0].epsilon.0), pair[1].epsilon.1);
            prop_assert!(pair[1].epsilon.0 < pair[0].epsilon.0);
            prop_assert_ne!(&pair[0].unstable_modes, &pair[1].unstable_modes);
        }
        let merged = merge_equal_clusters(&states);
        prop_assert_eq!(merged[0].epsilon.1, None);
        for pair in merged.windows(2) {
            prop_assert_eq!(Some(pair[0].epsilon.0), pair[1].epsilon.1);
            prop_assert_ne!(&pair[0].clusters, &pair[1].clusters);
        }
    }

    #[test]
    fn above_one_critical_coupling_clusters_only_split(seed in any::<u64>(), n in 2usize..12) {
        let spectrum = spectrum_of(&random_network(n, 0.6, seed), Normalization::Laplacian);
        for pair in exact(&spectrum, &above(SIGMA_C)).windows(2) {
            prop_assert!(pair[1].clusters.is_refinement_of(&pair[0].clusters));
        }
    }
}
