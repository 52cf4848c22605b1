//! Regions: means counted by hand, chains, thresholds, and the plain sums as the second route.

use std::cell::Cell;

use clustering::{
    ClusteringError, EigenvectorDistance, Partition, RegionClusters, RegionDistances,
    RegionThresholds, adjusted_rand_index, correlation_of_pairs,
};
use proptest::prelude::*;

use crate::fixtures::{Random, nepal, random_spectrum};

/// Nodes on a line: δ_ij = |x_i − x_j|.
fn on_a_line(x: &[f64], regions: &[Vec<usize>]) -> RegionDistances {
    RegionDistances::new(x.len(), regions, |i, j| (x[i] - x[j]).abs()).unwrap()
}

fn clusters(distances: &RegionDistances, within: f64, between: f64) -> RegionClusters {
    distances.clusters(RegionThresholds { within, between }).unwrap()
}

/// Three regions and a node of none: {0, 1, 3}, {10, 12}, {20}, and a node at 5.
fn three_regions() -> RegionDistances {
    on_a_line(&[0.0, 10.0, 1.0, 5.0, 3.0, 20.0, 12.0], &[vec![0, 2, 4], vec![6, 1], vec![5]])
}

#[test]
fn means_over_regions_on_a_line_are_those_counted_by_hand() {
    let distances = three_regions();
    // Within: (1 + 3 + 2)/3, 2, and no pair at all; between: of the centres, as all lie in order.
    assert_eq!([0, 1, 2].map(|m| distances.within(m)), [2.0, 2.0, 0.0]);
    for (one, other, expected) in [(0, 1, 11.0 - 4.0 / 3.0), (0, 2, 20.0 - 4.0 / 3.0), (1, 2, 9.0)]
    {
        assert!((distances.between(one, other) - expected).abs() < 1e-14);
        assert_eq!(distances.between(one, other), distances.between(other, one));
    }
    assert_eq!(distances.n_regions(), 3);
}

#[test]
fn regions_below_both_thresholds_share_a_colour_and_the_others_are_grey() {
    let distances = on_a_line(&[0., 1., 2., 3., 9., 5., 6.], &[vec![0, 1], vec![3, 2], vec![4, 5]]);
    let found = clusters(&distances, 2.0, 2.5);
    assert_eq!(found.cluster_of_region(), [Some(0), Some(0), None]);
    let grey = None;
    let both = Some(0);
    assert_eq!(found.cluster_of_node(), [both, both, both, both, grey, grey, grey]);
    assert_eq!(found.clusters(), [[0, 1]]);
    assert_eq!((found.n_clusters(), found.n_regions()), (1, 3));
    assert_eq!(found.node_partition().clusters(), [vec![0, 1, 2, 3], vec![4], vec![5], vec![6]]);
}

#[test]
fn a_mean_at_the_threshold_is_not_below_it() {
    let distances = three_regions();
    assert_eq!(clusters(&distances, 2.0, 9.0).cluster_of_region(), [None, None, Some(0)]);
    let (within, between) = (2.0 + 1e-12, 9.0 + 1e-12);
    let expected = [Some(0), Some(1), Some(1)];
    assert_eq!(clusters(&distances, within, between).cluster_of_region(), expected);
    assert_eq!(clusters(&distances, within, 9.0).n_clusters(), 3);
}

#[test]
fn nothing_is_below_a_threshold_of_zero() {
    let distances = on_a_line(&[1.0, 1.0, 1.0], &[vec![0, 1], vec![2]]);
    assert_eq!(clusters(&distances, 0.0, 1.0).n_clusters(), 0);
    assert_eq!(clusters(&distances, 1.0, 0.0).n_clusters(), 2);
    assert_eq!(clusters(&distances, 1.0, 1.0).n_clusters(), 1);
}

#[test]
fn regions_are_linked_in_chains_but_not_through_a_region_that_is_not_synchronisable() {
    let x = [0.0, 2.0, 4.0, 6.0];
    let alone: Vec<Vec<usize>> = (0..4).map(|i| vec![i]).collect();
    assert_eq!(clusters(&on_a_line(&x, &alone), 1.0, 2.5).clusters(), [[0, 1, 2, 3]]);
    // The third region now has nodes at 3 and 5: wide, and the only bridge.
    let x = [0.0, 2.0, 3.0, 6.0, 5.0];
    let regions = [vec![0], vec![1], vec![2, 4], vec![3]];
    assert_eq!(clusters(&on_a_line(&x, &regions), 1.0, 2.5).clusters(), [vec![0, 1], vec![3]]);
}

#[test]
fn cliques_of_the_nepal_grid_are_regions_without_distance_when_modes_2_and_3_are_unstable() {
    let spectrum = nepal();
    let distance = EigenvectorDistance::new(&spectrum, &[1, 2]).unwrap();
    let regions = [(0..5).collect(), (5..8).collect(), (8..13).collect(), vec![13], vec![14]];
    let means = RegionDistances::new(15, &regions, |i, j| distance.between(i, j)).unwrap();
    let v = spectrum.real_modes().eigenvectors;
    for (one, first) in regions.iter().enumerate() {
        assert!(means.within(one) < 1e-14);
        for (other, second) in regions.iter().enumerate().filter(|&(other, _)| other != one) {
            let (i, j) = (first[0], second[0]);
            let expected = 0.5 * ((v[1][i] - v[1][j]).abs() + (v[2][i] - v[2][j]).abs());
            assert!((means.between(one, other) - expected).abs() < 1e-14);
        }
    }
}

#[test]
fn agreement_counts_verdicts_and_compares_regions_synchronisable_in_both() {
    // Regions of one node at x, those of {x, x + 9} not synchronisable.
    let analysis = |x: [f64; 6], wide: &[usize]| {
        let mut positions = x.to_vec();
        let mut regions: Vec<Vec<usize>> = (0..6).map(|m| vec![m]).collect();
        for &m in wide {
            regions[m].push(positions.len());
            positions.push(x[m] + 9.0);
        }
        clusters(&on_a_line(&positions, &regions), 1.0, 1.5)
    };
    let theory = analysis([0., 1., 10., 11., 20., 30.], &[5]);
    let simulation = analysis([0., 1., 10., 20., 21., 30.], &[4]);
    let agreement = theory.agreement(&simulation);
    assert_eq!((agreement.n_regions, agreement.n_same_verdict, agreement.n_in_both), (6, 4, 4));
    assert_eq!(agreement.verdict_fraction(), 4.0 / 6.0);
    // {0,1}{2,3} and {0,1}{2}{3} of four: I = 1, A = 2, B = 1, E = 2/6, (2/3) / (3/2 − 1/3) = 4/7.
    assert!((agreement.adjusted_rand_index.unwrap() - 4.0 / 7.0).abs() < 1e-15);
    assert_eq!(agreement, simulation.agreement(&theory));
    let with_itself = theory.agreement(&theory);
    assert_eq!((with_itself.verdict_fraction(), with_itself.adjusted_rand_index), (1.0, Some(1.0)));
}

#[test]
fn clusters_of_fewer_than_two_common_regions_have_no_agreement() {
    let one = clusters(&on_a_line(&[0., 0., 9.], &[vec![0], vec![1, 2]]), 1.0, 1.0);
    let other = clusters(&on_a_line(&[0., 0., 0.], &[vec![0], vec![1, 2]]), 1.0, 1.0);
    let agreement = one.agreement(&other);
    assert_eq!((agreement.n_same_verdict, agreement.n_in_both), (1, 1));
    assert_eq!(agreement.adjusted_rand_index, None);
    let nothing = clusters(&on_a_line(&[], &[]), 1.0, 1.0);
    assert_eq!(nothing.agreement(&nothing).verdict_fraction(), 1.0);
}

#[test]
#[should_panic(expected = "analyses of 1 and 2 regions")]
fn analyses_of_different_regions_cannot_be_compared() {
    let one = clusters(&on_a_line(&[0., 1.], &[vec![0, 1]]), 1.0, 1.0);
    let _ = one.agreement(&clusters(&on_a_line(&[0., 1.], &[vec![0], vec![1]]), 1.0, 1.0));
}

#[test]
fn the_distance_of_a_pair_is_asked_for_once() {
    let questions = Cell::new(0);
    let regions = [(0..40).collect(), (40..99).collect::<Vec<_>>()];
    RegionDistances::new(100, &regions, |i, j| {
        assert!(i < j);
        questions.set(questions.get() + 1);
        1.0
    })
    .unwrap();
    // Node 99 belongs to no region.
    assert_eq!(questions.get(), 99 * 98 / 2);
}

#[track_caller]
fn check_refused(regions: &[Vec<usize>], expected: &ClusteringError) {
    let error = RegionDistances::new(4, regions, |_, _| 1.0).unwrap_err();
    assert_eq!(&error, expected);
}

#[test]
fn regions_that_make_no_sense_are_refused() {
    check_refused(&[vec![0], vec![]], &ClusteringError::EmptyRegion { region: 1 });
    let out_of_range = ClusteringError::NodeOutOfRange { node: 4, n_nodes: 4 };
    check_refused(&[vec![0, 4]], &out_of_range);
    check_refused(&[vec![0, 1], vec![2, 1]], &ClusteringError::NodeListedTwice { node: 1 });
    check_refused(&[vec![3, 3]], &ClusteringError::NodeListedTwice { node: 3 });
}

#[test]
fn distances_and_thresholds_that_make_no_sense_are_refused() {
    for bad in [f64::NAN, f64::INFINITY, -1e-9] {
        let distance = |i, j| if (i, j) == (1, 3) { bad } else { 1.0 };
        let error = RegionDistances::new(4, &[vec![0, 3], vec![1]], distance).unwrap_err();
        assert!(matches!(error, ClusteringError::BadDistance { i: 1, j: 3, .. }));
        let one = on_a_line(&[0.0], &[vec![0]]);
        for thresholds in [(bad, 1.0), (1.0, bad)] {
            let (within, between) = thresholds;
            let error = one.clusters(RegionThresholds { within, between }).unwrap_err();
            assert!(matches!(error, ClusteringError::BadThreshold { .. }));
        }
    }
}

/// Nodes at random places on a line, in regions marked at random; marks from `n_regions` are none.
fn random_regions(n_nodes: usize, n_regions: usize, seed: u64) -> (Vec<f64>, Vec<Vec<usize>>) {
    let mut random = Random::new(seed);
    let mut regions = vec![Vec::new(); n_regions + 1];
    for node in 0..n_nodes {
        let mark = (random.uniform() * (n_regions as f64 + 0.5)) as usize;
        regions[mark].push(node);
    }
    regions.truncate(n_regions);
    regions.retain(|region| !region.is_empty());
    ((0..n_nodes).map(|_| random.uniform()).collect(), regions)
}

proptest! {
    #[test]
    fn means_are_the_sums_printed_in_the_paper(
        seed in any::<u64>(), n in 0usize..25, n_regions in 1usize..7,
    ) {
        let (x, regions) = random_regions(n, n_regions, seed);
        let distances = on_a_line(&x, &regions);
        for (one, first) in regions.iter().enumerate() {
            for (other, second) in regions.iter().enumerate() {
                let mut sum = 0.0;
                for &i in first {
                    sum += second.iter().map(|&j| (x[i] - x[j]).abs()).sum::<f64>();
                }
                let (n_m, n_other) = (first.len() as f64, second.len() as f64);
                let n_pairs = if one == other { n_m * (n_m - 1.0) } else { n_m * n_other };
                let expected = if n_pairs == 0.0 { 0.0 } else { sum / n_pairs };
                prop_assert!((distances.between(one, other) - expected).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn regions_of_one_node_each_make_the_clusters_of_single_linkage(
        seed in any::<u64>(), n in 1usize..30, threshold in 0.001..0.3,
    ) {
        let mut random = Random::new(seed);
        let x: Vec<f64> = (0..n).map(|_| random.uniform()).collect();
        let alone: Vec<Vec<usize>> = (0..n).map(|i| vec![i]).collect();
        let found = clusters(&on_a_line(&x, &alone), 1.0, threshold);
        let linked = Partition::single_linkage(n, |i, j| (x[i] - x[j]).abs(), threshold);
        prop_assert_eq!(found.node_partition(), linked);
    }

    #[test]
    fn another_unit_of_distance_or_order_of_regions_changes_no_cluster(
        seed in any::<u64>(), n in 1usize..25, n_regions in 1usize..7,
        within in 0.0..0.6, between in 0.0..0.6, power in -9i32..9,
    ) {
        let (x, mut regions) = random_regions(n, n_regions, seed);
        let found = clusters(&on_a_line(&x, &regions), within, between);
        // Powers of two scale without rounding.
        let unit = 2f64.powi(power);
        let scaled: Vec<f64> = x.iter().map(|x| unit * x).collect();
        let same = clusters(&on_a_line(&scaled, &regions), unit * within, unit * between);
        prop_assert_eq!(&same, &found);
        regions.reverse();
        let reversed = clusters(&on_a_line(&x, &regions), within, between);
        prop_assert_eq!(reversed.node_partition(), found.node_partition());
    }

    #[test]
    fn a_higher_threshold_within_only_adds_regions(
        seed in any::<u64>(), n in 1usize..25, n_regions in 1usize..7,
        low in 0.0..0.4, more in 0.0..0.4, between in 0.0..0.6,
    ) {
        let (x, regions) = random_regions(n, n_regions, seed);
        let distances = on_a_line(&x, &regions);
        let (few, many) = (clusters(&distances, low, between), clusters(&distances, low + more, between));
        let (few_of, many_of) = (few.cluster_of_region(), many.cluster_of_region());
        prop_assert!(few_of.iter().zip(many_of).all(|(few, many)| few.is_none() || many.is_some()));
        // Of the regions in both, further regions can only link more.
        let both = |of: &[Option<usize>]| -> Vec<usize> {
            of.iter().zip(few_of).filter(|(_, few)| few.is_some()).map(|(of, _)| of.unwrap()).collect()
        };
        let (fine, coarse) = (Partition::from_marks(&both(few_of)), Partition::from_marks(&both(many_of)));
        prop_assert!(fine.is_refinement_of(&coarse));
        let agreement = few.agreement(&many);
        prop_assert_eq!(agreement.n_in_both, fine.n_nodes());
        if let Some(index) = agreement.adjusted_rand_index {
            prop_assert_eq!(index, adjusted_rand_index(&fine, &coarse));
        }
    }
}

/// What a thousand nodes in 65 regions cost; run with `--ignored --nocapture` to see it.
#[test]
#[ignore = "a measurement"]
fn regions_and_correlations_of_a_thousand_nodes() {
    let distance = EigenvectorDistance::new(&random_spectrum(1000, 7, 1), &[1, 2, 3, 4, 5, 6]);
    let matrix = distance.unwrap().matrix();
    let of = |i: usize, j: usize| matrix[1000 * i + j];
    let regions: Vec<Vec<usize>> = (0..65).map(|m| (m..1000).step_by(65).collect()).collect();
    let start = std::time::Instant::now();
    let found = clusters(&RegionDistances::new(1000, &regions, of).unwrap(), 0.05, 0.05);
    println!("{} clusters of regions in {:?}", found.n_clusters(), start.elapsed());
    let start = std::time::Instant::now();
    let found = correlation_of_pairs(1000, of, |i, j| of(i, j).sqrt()).unwrap();
    println!("{found:?} in {:?}", start.elapsed());
    assert!(found.spearman > 1.0 - 1e-12 && found.pearson < found.spearman);
}
