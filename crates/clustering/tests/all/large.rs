//! Clusters of the benchmarks' fixtures against all pairs, closed forms and other bases.

use clustering::{CascadeTree, ClusterRule, EigenvectorDistance, Partition, TreeEnd};
use msf::{Interval, StableRegion};
use spectra::Spectrum;

use crate::fixtures::{block_spectrum, random_spectrum, rotated, vectors_mut};
use crate::large_fixtures::{Fixture, all, communities, ring_of_cliques, scale_free};
use crate::stable_set::cascade;

/// The distance with all transverse modes unstable.
fn distance(spectrum: &Spectrum) -> EigenvectorDistance {
    let modes: Vec<usize> = (1..spectrum.n_modes()).collect();
    EigenvectorDistance::new(spectrum, &modes).unwrap()
}

#[test]
fn clusters_of_every_fixture_are_those_of_all_pairs() {
    for Fixture { name, spectrum, threshold } in all(1_000) {
        let distance = distance(&spectrum);
        for threshold in [0.0, 0.3 * threshold, threshold, 4.0 * threshold] {
            let between = |i, j| distance.between(i, j);
            let all_pairs = Partition::single_linkage(distance.n_nodes(), between, threshold);
            assert_eq!(distance.clusters_within(threshold).unwrap(), all_pairs, "{name}");
        }
        // Rows that are not equal differ by far more than the tolerance in each of these.
        let all_pairs =
            Partition::single_linkage(distance.n_nodes(), |i, j| distance.between(i, j), 1e-13);
        assert_eq!(distance.exact_clusters().unwrap(), all_pairs, "{name}");
    }
}

#[test]
fn planted_communities_are_the_clusters_at_a_threshold_far_below_and_far_above_their_width() {
    let Fixture { spectrum, threshold, .. } = communities(20_000);
    let planted = Partition::from_marks(&(0..20_000).map(|i| i * 8 / 20_000).collect::<Vec<_>>());
    let distance = distance(&spectrum);
    // Communities are 8/7 / √N apart, noise within them is 0.1/√N.
    for factor in [0.5, 1.0, 1.5] {
        assert_eq!(distance.clusters_within(factor * threshold).unwrap(), planted);
    }
    assert_eq!(distance.clusters_within(2.5 * threshold).unwrap().n_clusters(), 1);
}

#[test]
fn every_clique_of_a_ring_has_one_exact_cluster_of_eight_and_is_one_at_the_threshold() {
    let Fixture { spectrum, threshold, .. } = ring_of_cliques(20_000);
    let distance = distance(&spectrum);
    let exact = distance.exact_clusters().unwrap();
    assert_eq!((exact.n_clusters(), exact.nontrivial().len()), (6_000, 2_000));
    assert!(exact.nontrivial().iter().all(|cluster| cluster.len() == 8));
    let cliques = Partition::from_marks(&(0..20_000).map(|i| i / 10).collect::<Vec<_>>());
    assert_eq!(distance.clusters_within(threshold).unwrap(), cliques);
}

#[test]
fn exact_clusters_do_not_depend_on_the_bases_of_eigenspaces() {
    let Fixture { spectrum, .. } = ring_of_cliques(2_000);
    let expected = distance(&spectrum).exact_clusters().unwrap();
    for seed in 0..10 {
        let turned = distance(&rotated(spectrum.clone(), seed));
        assert_eq!(turned.exact_clusters().unwrap(), expected);
    }
}

#[test]
fn rows_equal_up_to_the_tolerance_meet_wherever_they_lie() {
    // Half of each pair of equal rows moves by less than the tolerance: across any boundary of
    // rounding, as there are a thousand pairs.
    let Fixture { mut spectrum, .. } = scale_free(10_000);
    let step = 0.9e-12 / 8f64.sqrt();
    for v in vectors_mut(&mut spectrum).skip(1) {
        v.iter_mut().skip(9).step_by(10).for_each(|x| *x += step);
    }
    let exact = distance(&spectrum).exact_clusters().unwrap();
    assert_eq!(exact.nontrivial().len(), 1_000);
    assert!(exact.nontrivial().iter().all(|pair| pair[0] + 1 == pair[1] && pair[1] % 10 == 9));
}

#[test]
fn a_hundred_thousand_equal_rows_are_one_cluster_at_once() {
    // All pairs would be five thousand million.
    let n = 100_000;
    let mut spectrum = communities(n).spectrum;
    for (mode, v) in vectors_mut(&mut spectrum).enumerate().skip(1) {
        let level = 1.0 / (n as f64).sqrt();
        v.iter_mut().enumerate().for_each(|(i, x)| *x = if i < mode { -level } else { level });
    }
    let distance = distance(&spectrum);
    for clusters in [distance.exact_clusters(), distance.clusters_within(0.0)] {
        let clusters = clusters.unwrap();
        assert_eq!((clusters.n_clusters(), clusters.sizes()[7]), (8, n - 7));
    }
}

#[test]
fn the_tree_of_a_ring_of_cliques_keeps_every_clique_together() {
    let Fixture { spectrum, .. } = ring_of_cliques(5_000);
    let stable = StableRegion { intervals: vec![Interval::known(1.0, None)] };
    let states = cascade(&spectrum, &stable, ClusterRule::Exact).unwrap();
    let trees = CascadeTree::of_each_run(&states, 2);
    assert_eq!((states.len(), trees.len()), (4, 1));
    assert_eq!(trees[0].end, TreeEnd::ModesNotComputed);
    // All nodes, then the eight equal ones of each clique, which the waves never split.
    assert_eq!(trees[0].clusters.len(), 501);
    assert_eq!((trees[0].clusters[0].size, trees[0].clusters[0].n_unlisted), (5_000, 1_000));
    assert!(trees[0].clusters[1..].iter().all(|c| c.size == 8 && c.states == (1..4)));
}

/// What a million nodes cost; run with `--ignored --nocapture` to see it.
#[test]
#[ignore = "a measurement"]
fn cascades_of_a_million_nodes() {
    let stable = StableRegion { intervals: vec![Interval::known(1.0, None)] };
    for Fixture { name, spectrum, threshold } in all(1_000_000) {
        for rule in [ClusterRule::Exact, ClusterRule::Threshold(threshold)] {
            let start = std::time::Instant::now();
            let states = cascade(&spectrum, &stable, rule).unwrap();
            let cascade = start.elapsed();
            let trees = CascadeTree::of_each_run(&states, 2);
            let tree = start.elapsed() - cascade;
            let n_listed: usize = trees.iter().map(|tree| tree.clusters.len()).sum();
            println!(
                "{name} {rule:?}: {} states in {cascade:?}, {n_listed} in {} trees in {tree:?}",
                states.len(),
                trees.len()
            );
        }
    }
}

/// What large networks cost; run with `--ignored --nocapture` to see it.
#[test]
#[ignore = "a measurement"]
fn cascades_of_large_networks() {
    let time = |name: &str, spectrum: &Spectrum, stable: &StableRegion, rule| {
        let start = std::time::Instant::now();
        let states = cascade(spectrum, stable, rule).unwrap();
        println!("{name} {rule:?}: {} states in {:?}", states.len(), start.elapsed());
    };
    let stable = |from, to| StableRegion { intervals: vec![Interval::known(from, to)] };
    let (open, window) = (stable(8.17, None), stable(0.2, Some(5.0)));
    let all = random_spectrum(1000, 1000, 1);
    time("1000 nodes, all modes", &all, &open, ClusterRule::Exact);
    for threshold in [0.01, 0.03, 0.035, 0.04] {
        time("1000 nodes, all modes", &all, &open, ClusterRule::Threshold(threshold));
        time("1000 nodes, all modes, window", &all, &window, ClusterRule::Threshold(threshold));
    }
    time("1000 nodes with twins", &with_twins(&all), &open, ClusterRule::Exact);
    let few = random_spectrum(20_000, 20, 1);
    time("20000 nodes, 20 modes", &few, &open, ClusterRule::Exact);
    for threshold in [1e-4, 1e-3, 5e-3] {
        time("20000 nodes, 20 modes", &few, &open, ClusterRule::Threshold(threshold));
    }
    let blocks = block_spectrum(20_000, 8);
    time("20000 nodes in 8 equal blocks", &blocks, &open, ClusterRule::Exact);
    time("20000 nodes in 8 equal blocks", &blocks, &open, ClusterRule::Threshold(1e-4));
}

/// The spectrum with nodes 0 and 1 alike in all but the last mode, which is (1, −1, 0, …)/√2.
fn with_twins(spectrum: &Spectrum) -> Spectrum {
    let mut twins = spectrum.clone();
    for v in vectors_mut(&mut twins) {
        (v[0], v[1]) = (0.5 * (v[0] + v[1]), 0.5 * (v[0] + v[1]));
    }
    let last = vectors_mut(&mut twins).last().unwrap();
    last.fill(0.0);
    (last[0], last[1]) = (0.5f64.sqrt(), -0.5f64.sqrt());
    twins
}
