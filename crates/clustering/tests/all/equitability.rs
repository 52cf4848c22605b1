//! Equitable partitions: small networks by hand, all pairs as the second route.

use clustering::{ClusteringError, Partition, equitable};
use graph::{CouplingMatrix, Network, Normalization, SparseMatrix};
use proptest::prelude::*;

use crate::fixtures::{random_network, read};

const TOLERANCE: f64 = 1e-9;

fn matrix(network: &Network, normalization: Normalization) -> SparseMatrix {
    CouplingMatrix::new(network, normalization).matrix().clone()
}

fn laplacian(edges: &str) -> SparseMatrix {
    matrix(&read(edges), Normalization::Laplacian)
}

#[track_caller]
fn check_deviations(w: &SparseMatrix, marks: &[usize], expected: &[f64]) {
    let found = equitable(w.view(), &Partition::from_marks(marks), TOLERANCE).unwrap();
    assert_eq!(found.deviations.len(), expected.len());
    for (found, expected) in found.deviations.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-15, "{found} instead of {expected}");
    }
}

const SIX_NODES: &str = include_str!("../../../../experiments/networks/six-node.edges");
const PATH: &str = "1 2\n2 3\n3 4\n4 5";

#[test]
fn the_clusters_of_the_six_nodes_are_equitable() {
    let w = laplacian(SIX_NODES);
    for marks in [[0, 0, 1, 1, 1, 0], [0, 1, 2, 3, 2, 1], [0; 6], [0, 1, 2, 3, 4, 5]] {
        let found = equitable(w.view(), &Partition::from_marks(&marks), TOLERANCE).unwrap();
        assert!(found.holds() && found.largest_deviation() < 1e-15, "{marks:?}");
    }
}

#[test]
fn mirrored_nodes_of_a_path_are_equitable_and_neighbours_are_not() {
    let w = laplacian(PATH);
    check_deviations(&w, &[0, 1, 2, 1, 0], &[0.0, 0.0, 0.0]);
    // Nodes 1 and 2 with weights −1 and −2, 1 and 1 to each other, 0 and 1 to node 3: the sums to
    // the own cluster are 0 and −1, those to node 3 are 0 and 1, and node 2 has Σ|w| = 4.
    check_deviations(&w, &[0, 0, 1, 2, 3], &[0.25, 0.0, 0.0, 0.0]);
}

#[test]
fn weights_within_a_cluster_are_free() {
    // Rows of W sum to zero: links among nodes 1, 2, 3 may differ, those to node 4 may not.
    let unequal = Network::undirected(
        (1..5).map(|i| i.to_string()).collect(),
        &[(0, 1, 5.0), (1, 2, 0.1), (0, 3, 1.0), (1, 3, 1.0), (2, 3, 1.0)],
    );
    let w = matrix(&unequal.unwrap(), Normalization::Laplacian);
    let found = equitable(w.view(), &Partition::from_marks(&[0, 0, 0, 1]), TOLERANCE).unwrap();
    assert!(found.holds(), "{found:?}");
}

#[test]
fn a_link_that_only_one_node_has_counts_in_full() {
    // Of nodes 1 and 2 only the first is linked to node 3: sums 1 and 0, Σ|w| = 2 and 0.
    check_deviations(&laplacian("1 3\n2"), &[0, 0, 1], &[0.5, 0.0]);
}

#[test]
fn nodes_without_links_are_equitable_in_any_partition() {
    check_deviations(&laplacian("1\n2\n3"), &[0, 0, 1], &[0.0, 0.0]);
    check_deviations(&laplacian("1"), &[0], &[0.0]);
}

#[test]
fn columns_and_rows_of_storage_give_the_same_answer() {
    // Node 1 receives from 3, node 2 does not; both send alike.
    let mut entries = sprs::TriMatI::<f64, u32>::new((3, 3));
    entries.add_triplet(0, 2, 1.0);
    entries.add_triplet(0, 0, -1.0);
    let partition = Partition::from_marks(&[0, 0, 1]);
    let by_rows: SparseMatrix = entries.to_csr();
    let by_columns: SparseMatrix = entries.to_csc();
    let found = equitable(by_rows.view(), &partition, TOLERANCE).unwrap();
    assert_eq!(found.deviations, [0.5, 0.0]);
    assert_eq!(found, equitable(by_columns.view(), &partition, TOLERANCE).unwrap());
}

#[test]
fn weights_that_are_no_numbers_are_refused() {
    let mut w = laplacian(PATH);
    *w.get_mut(1, 2).unwrap() = f64::INFINITY;
    let error = equitable(w.view(), &Partition::one_cluster(5), TOLERANCE).unwrap_err();
    let expected = ClusteringError::WeightNotFinite { row: 1, column: 2, weight: f64::INFINITY };
    assert_eq!(error, expected);
    let error = equitable(laplacian(PATH).view(), &Partition::one_cluster(5), -1.0).unwrap_err();
    assert_eq!(error, ClusteringError::BadThreshold { threshold: -1.0 });
}

/// The deviation of every cluster by its definition.
fn by_definition(w: &SparseMatrix, partition: &Partition) -> Vec<f64> {
    let clusters = partition.clusters();
    let weight = |i: usize, j: usize| w.get(i, j).copied().unwrap_or(0.0);
    let total = |i: usize, to: &[usize]| to.iter().map(|&j| weight(i, j)).sum::<f64>();
    let strength = |i: usize| (0..w.rows()).map(|j| weight(i, j).abs()).sum::<f64>();
    let deviation = |nodes: &Vec<usize>| {
        let strongest = nodes.iter().map(|&i| strength(i)).fold(0.0, f64::max);
        let mut largest = 0.0f64;
        for to in &clusters {
            for &i in nodes {
                for &j in nodes {
                    largest = largest.max(total(i, to) - total(j, to));
                }
            }
        }
        if strongest > 0.0 { largest / strongest } else { 0.0 }
    };
    clusters.iter().map(deviation).collect()
}

proptest! {
    #[test]
    fn deviations_are_those_of_all_pairs(
        seed in any::<u64>(), n in 1usize..12, density in 0.0..1.0,
        marks in prop::collection::vec(0usize..4, 12), is_normalized in any::<bool>(),
    ) {
        let normalization =
            if is_normalized { Normalization::Normalized } else { Normalization::Laplacian };
        let w = matrix(&random_network(n, density, seed), normalization);
        let partition = Partition::from_marks(&marks[..n]);
        let found = equitable(w.view(), &partition, TOLERANCE).unwrap();
        for (found, expected) in found.deviations.iter().zip(by_definition(&w, &partition)) {
            prop_assert!((found - expected).abs() < 1e-14);
            prop_assert!(*found <= 2.0 + 1e-14);
        }
    }
}
