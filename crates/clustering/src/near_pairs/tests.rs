//! The tree against a look at all pairs, and how its work grows.

use proptest::prelude::*;

use super::*;
use crate::metric::{Block, Metric};

/// Blocks of these widths and factors.
fn metric(blocks: &[(usize, f64)]) -> Metric {
    let mut end = 0;
    let block = |&(width, factor): &(usize, f64)| {
        end += width;
        Block { columns: end - width..end, factor }
    };
    Metric { blocks: blocks.iter().map(block).collect() }
}

fn clusters(points: Points, threshold: f64, groups: &Partition) -> Partition {
    clusters_within_groups(points, threshold, groups, &mut { usize::MAX }).unwrap()
}

fn all_pairs(points: Points, threshold: f64, groups: &Partition) -> Partition {
    let group = groups.cluster_of();
    let distance = |i: usize, j: usize| match group[i] == group[j] {
        true => points.metric.distance_up_to(f64::INFINITY, points.row(i), points.row(j)),
        false => f64::INFINITY,
    };
    Partition::single_linkage(groups.n_nodes(), distance, threshold)
}

fn blocks() -> impl Strategy<Value = Metric> {
    prop::collection::vec((1usize..4, 0.01..2.0), 1..5).prop_map(|blocks| metric(&blocks))
}

/// Points of no structure, on a lattice (where distances tie), or in a few clumps.
fn component(kind: u8, (place, clump): (f64, u8)) -> f64 {
    match kind {
        0 => place,
        1 => (10.0 * place).round() / 10.0,
        _ => f64::from(clump) + 0.01 * place,
    }
}

proptest! {
    #[test]
    fn the_tree_links_as_all_pairs_do(
        n_nodes in 1usize..200,
        metric in blocks(),
        kind in 0u8..3,
        places in prop::collection::vec((-1.0..1.0, 0u8..3), 400),
        groups in prop::collection::vec(0usize..3, 200),
        threshold in prop::sample::select(vec![0.0, 0.001, 0.01, 0.1, 0.2, 0.5, 1.0, 3.0]),
    ) {
        let components = places.into_iter().cycle().map(|place| component(kind, place));
        let rows: Vec<f64> = components.take(n_nodes * metric.width()).collect();
        let points = Points { rows: &rows, metric: &metric };
        let groups = Partition::from_marks(&groups[..n_nodes]);
        for groups in [Partition::one_cluster(n_nodes), groups] {
            let expected = all_pairs(points, threshold, &groups);
            prop_assert_eq!(clusters(points, threshold, &groups), expected);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    // Enough nodes for strips to be halved several times.
    #[test]
    fn strips_link_as_all_pairs_do(
        n_nodes in 400usize..900,
        dimension in 1usize..9,
        kind in 0u8..3,
        places in prop::collection::vec((-1.0..1.0, 0u8..3), 7919),
        reach in prop::sample::select(vec![0.01, 0.05, 0.1, 0.2, 0.3, 0.4]),
    ) {
        let metric = metric(&vec![(1, 1.0 / dimension as f64); dimension]);
        let components = places.into_iter().cycle().map(|place| component(kind, place));
        let rows: Vec<f64> = components.take(n_nodes * dimension).collect();
        let points = Points { rows: &rows, metric: &metric };
        let groups = Partition::one_cluster(n_nodes);
        for threshold in [reach, 0.1 * reach] {
            let expected = all_pairs(points, threshold, &groups);
            prop_assert_eq!(clusters(points, threshold, &groups), expected);
        }
    }
}

#[test]
fn many_equal_rows_meet_many_others() {
    // Nodes of a line within the threshold of a point of 500 nodes, one step apart from one
    // another where that is more than the threshold.
    let line = |i: u32| [f64::from(i) * 0.004, 1.0];
    let rows: Vec<f64> =
        (0..1000).flat_map(|i| if i < 500 { [1.0, 0.0] } else { line(i - 500) }).collect();
    let metric = metric(&[(1, 1.0), (1, 1.0)]);
    let points = Points { rows: &rows, metric: &metric };
    let groups = Partition::one_cluster(1000);
    for threshold in [0.003, 0.0041, 0.999, 1.0, 1.001, 1.5, 2.0] {
        let expected = all_pairs(points, threshold, &groups);
        assert_eq!(clusters(points, threshold, &groups), expected, "{threshold}");
    }
}

/// How many components are looked at for nodes at these places in the plane.
fn work(n_nodes: usize, place: impl Fn(usize) -> [f64; 2], threshold: f64) -> usize {
    let rows: Vec<f64> = (0..n_nodes).flat_map(place).collect();
    let mut left = usize::MAX;
    let metric = metric(&[(1, 1.0), (1, 1.0)]);
    let points = Points { rows: &rows, metric: &metric };
    let groups = Partition::one_cluster(n_nodes);
    clusters_within_groups(points, threshold, &groups, &mut left).unwrap();
    usize::MAX - left
}

/// Numbers in [0, 1) without a pattern that the tree could meet.
fn scattered(i: usize, multiplier: f64) -> f64 {
    (i as f64 * multiplier).fract()
}

#[test]
fn sixteen_times_the_nodes_are_at_most_thirty_times_the_work() {
    // N log N grows by a factor of 16 · (log 64,000 / log 4,000) < 22.
    let (golden, silver) = (0.618_033_988_749_895, 0.414_213_562_373_095);
    let plane = |i: usize| [scattered(i, golden), scattered(i, silver)];
    let clumps = |i: usize| plane(i).map(|x| f64::from((i % 8) as u32) + 0.01 * x);
    let growth = |small: usize, large: usize| large as f64 / small as f64;
    let (few, many) = (4_000, 64_000);
    for threshold in [0.0, 0.001, 0.01, 0.1, 3.0] {
        let grown = growth(work(few, clumps, threshold), work(many, clumps, threshold));
        assert!(grown < 30.0, "clumps at {threshold}: {grown}");
    }
    for reach in [0.1, 1.0, 3.0, 10.0] {
        let threshold = |n: usize| reach / (n as f64).sqrt();
        let grown = growth(work(few, plane, threshold(few)), work(many, plane, threshold(many)));
        assert!(grown < 30.0, "plane at {reach} steps: {grown}");
    }
}

#[test]
fn too_much_work_has_no_answer() {
    let rows: Vec<f64> = (0..100).map(f64::from).collect();
    let metric = metric(&[(1, 1.0)]);
    let points = Points { rows: &rows, metric: &metric };
    let groups = Partition::one_cluster(100);
    assert_eq!(clusters_within_groups(points, 0.5, &groups, &mut 150), None);
    let mut work = 10_000;
    assert!(clusters_within_groups(points, 0.5, &groups, &mut work).is_some());
    assert!(0 < work && work < 9_900);
}
