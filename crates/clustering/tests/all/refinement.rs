//! The coarsest equitable refinement against a refinement by definition, known answers, and its cost.

use clustering::{ClusteringError, Partition, Refiner, equitable_refinement};
use graph::{CouplingMatrix, Network, Normalization, SparseMatrix};
use proptest::prelude::*;

use crate::fixtures::{Random, random_network, read};
use crate::planted;

const TOLERANCE: f64 = 1e-9;

fn matrix(network: &Network, normalization: Normalization) -> SparseMatrix {
    CouplingMatrix::new(network, normalization).matrix().clone()
}

/// The coarsest equitable refinement of all nodes, but for those marked otherwise.
fn refined(w: &SparseMatrix, marks: &[usize]) -> Partition {
    equitable_refinement(w.view(), &Partition::from_marks(marks), TOLERANCE).unwrap()
}

/// Cells cut again and again by the sums to every other cell, node against node.
pub fn by_definition(w: &SparseMatrix, partition: &Partition) -> Partition {
    let n = partition.n_nodes();
    let dense: Vec<Vec<f64>> =
        (0..n).map(|i| (0..n).map(|j| w.get(i, j).copied().unwrap_or(0.0)).collect()).collect();
    let mut cells = partition.clone();
    loop {
        let sums = |i: usize| {
            let mut sums = vec![0.0; cells.n_clusters()];
            (0..n).for_each(|j| sums[cells.cluster_of()[j]] += dense[i][j]);
            sums[cells.cluster_of()[i]] = dense[i].iter().sum::<f64>();
            sums
        };
        let all: Vec<Vec<f64>> = (0..n).map(sums).collect();
        let are_alike = |i: usize, j: usize| {
            cells.cluster_of()[i] == cells.cluster_of()[j]
                && all[i].iter().zip(&all[j]).all(|(a, b)| (a - b).abs() < 1e-7)
        };
        let marks: Vec<usize> =
            (0..n).map(|i| (0..=i).find(|&j| are_alike(i, j)).unwrap()).collect();
        let next = Partition::from_marks(&marks);
        if next == cells {
            return cells;
        }
        cells = next;
    }
}

#[test]
fn a_path_with_its_end_told_apart_falls_into_single_nodes_and_without_stays_whole() {
    // Under a laplacian all nodes together are always equitable: rows sum to zero.
    let path = matrix(&read("1 2\n2 3\n3 4\n4 5\n5 6"), Normalization::Laplacian);
    assert_eq!(refined(&path, &[0; 6]).n_clusters(), 1);
    assert_eq!(refined(&path, &[1, 0, 0, 0, 0, 0]).n_clusters(), 6);
    assert_eq!(refined(&path, &[1, 0, 0, 0, 0, 1]).clusters(), [[0, 5], [1, 4], [2, 3]]);
}

#[test]
fn equal_sums_to_clusters_that_are_not_equitable_are_not_enough() {
    // Nodes p, 1, 2, p', 1', 2', 4, 8, 3: 1 and 2 receive 0.2 from {3, 4, 8} each, 1' and 2' too,
    // but 4 and 8 are linked to each other, and 3 is linked to 1 and 1'.
    let edges = include_str!("nine-node.edges");
    let network = read(edges);
    let w = matrix(&network, Normalization::Laplacian);
    let place = |name: &str| network.labels().iter().position(|label| label == name).unwrap();
    let of = |names: &[&str]| names.iter().map(|name| place(name)).collect::<Vec<_>>();
    let clusters = [of(&["1", "2"]), of(&["1'", "2'"]), of(&["3", "4", "8"])];
    let partition = Partition::from_clusters(9, &clusters).unwrap();
    let cells = equitable_refinement(w.view(), &partition, TOLERANCE).unwrap();
    assert_eq!(cells.n_clusters(), 9, "{:?}", cells.clusters());
}

#[test]
fn directed_links_count_where_they_are_received() {
    // Nodes 2 and 3 receive the same from 1, and send to nobody; 1 receives from 4 alone.
    let mut entries = sprs::TriMatI::<f64, u32>::new((4, 4));
    for (to, from) in [(1, 0), (2, 0), (0, 3)] {
        entries.add_triplet(to, from, 1.0);
        entries.add_triplet(to, to, -1.0);
    }
    let w: SparseMatrix = entries.to_csr();
    assert_eq!(refined(&w, &[0, 1, 1, 2]).clusters(), [vec![0], vec![1, 2], vec![3]]);
    let backwards: SparseMatrix = w.transpose_view().to_csr();
    // Now 2 and 3 receive nothing but their own −1, and so does 4 receive 1 from node 1.
    assert_eq!(refined(&backwards, &[0, 1, 1, 2]).clusters(), [vec![0], vec![1, 2], vec![3]]);
    assert_eq!(refined(&backwards, &[0, 1, 2, 1]).n_clusters(), 4);
}

#[test]
fn a_weak_link_beside_a_strong_one_counts() {
    // Nodes 1 and 2 are tied by 1e12; 1 receives 1 from node 3, and 2 receives 2 from node 4.
    let names = (1..5).map(|i| i.to_string()).collect();
    let links = [(0, 1, 1e12), (0, 2, 1.0), (1, 3, 2.0)];
    let w = matrix(&Network::undirected(names, &links).unwrap(), Normalization::Laplacian);
    assert_eq!(refined(&w, &[0, 0, 1, 1]).n_clusters(), 4);
}

#[test]
fn sums_that_only_round_differently_are_equal_and_chains_of_near_ones_are_cut() {
    let star = |weights: &[f64]| {
        let n = weights.len() + 1;
        let links: Vec<_> = weights.iter().enumerate().map(|(k, &w)| (0, k + 1, w)).collect();
        let names = (0..n).map(|i| i.to_string()).collect();
        let w = matrix(&Network::undirected(names, &links).unwrap(), Normalization::Laplacian);
        let marks: Vec<usize> = (0..n).map(|i| usize::from(i > 0)).collect();
        refined(&w, &marks).n_clusters() - 1
    };
    assert_eq!(star(&[0.3, 0.1 + 0.2, 0.3 * (1.0 + 1e-15)]), 1);
    assert_eq!(star(&[1.0, 1.0 + 5e-10, 1.0 + 2e-9]), 2);
    // A chain of steps of 0.9 tolerances: no two nodes of a cell are further apart than one.
    assert_eq!(star(&[1.0, 1.0 + 9e-10, 1.0 + 18e-10, 1.0 + 27e-10]), 4);
}

#[test]
fn weights_that_are_no_numbers_and_tolerances_below_zero_are_refused() {
    let mut w = matrix(&read("1 2\n2 3"), Normalization::Laplacian);
    assert!(matches!(
        equitable_refinement(w.view(), &Partition::one_cluster(3), -1.0),
        Err(ClusteringError::BadThreshold { .. })
    ));
    *w.get_mut(1, 2).unwrap() = f64::NAN;
    assert!(matches!(
        equitable_refinement(w.view(), &Partition::one_cluster(3), TOLERANCE),
        Err(ClusteringError::WeightNotFinite { row: 1, column: 2, .. })
    ));
}

/// A path of so many nodes, the first marked: every cut makes the next.
#[test]
fn a_path_of_two_hundred_thousand_nodes_is_refined_within_a_few_looks_at_each_link() {
    let n = 200_000;
    let links: Vec<_> = (1..n).map(|i| (i - 1, i, 1.0)).collect();
    let network = Network::undirected((0..n).map(|i| i.to_string()).collect(), &links).unwrap();
    let w = matrix(&network, Normalization::Laplacian);
    let marks: Vec<usize> = (0..n).map(|i| usize::from(i == 0)).collect();
    // A look at all links for every cut would take hours.
    assert_eq!(refined(&w, &marks).n_clusters(), n);
}

proptest! {
    #[test]
    fn the_refinement_is_that_by_definition(
        seed in any::<u64>(), is_normalized in any::<bool>(), marks in prop::collection::vec(0usize..2, 64),
        n_marked in 0usize..64,
    ) {
        let normalization =
            if is_normalized { Normalization::Normalized } else { Normalization::Laplacian };
        let network = planted::network(seed);
        let w = matrix(&network, normalization);
        let marks: Vec<usize> =
            (0..network.n_nodes()).map(|i| if i < n_marked { marks[i % 64] } else { 2 }).collect();
        let partition = Partition::from_marks(&marks);
        prop_assert_eq!(refined(&w, &marks), by_definition(&w, &partition));
    }

    #[test]
    fn the_refinement_of_directed_links_is_that_by_definition(
        seed in any::<u64>(), n in 2usize..14, density in 0.0..0.6, marks in prop::collection::vec(0usize..3, 14),
    ) {
        let mut random = Random::new(seed);
        let mut entries = sprs::TriMatI::<f64, u32>::new((n, n));
        for i in 0..n {
            let mut sum = 0.0;
            for j in (0..n).filter(|&j| j != i) {
                if random.uniform() < density {
                    let weight = if random.uniform() < 0.5 { 1.0 } else { 0.1 };
                    entries.add_triplet(i, j, weight);
                    sum += weight;
                }
            }
            entries.add_triplet(i, i, -sum);
        }
        let w: SparseMatrix = entries.to_csr();
        let partition = Partition::from_marks(&marks[..n]);
        prop_assert_eq!(refined(&w, &marks[..n]), by_definition(&w, &partition));
    }

    #[test]
    fn refining_step_by_step_is_refining_at_once(
        seed in any::<u64>(), steps in prop::collection::vec((0usize..40, 0usize..40), 1..6),
    ) {
        let network = planted::network(seed);
        let w = matrix(&network, Normalization::Laplacian);
        let n = network.n_nodes();
        let mut refiner = Refiner::new(w.view(), TOLERANCE).unwrap();
        let mut partition = Partition::one_cluster(n);
        for (i, j) in steps {
            let pair: Vec<usize> =
                (0..n).map(|k| usize::from(k == i % n || k == j % n)).collect();
            partition = partition.intersection(&Partition::from_marks(&pair));
            let at_once = equitable_refinement(w.view(), &partition, TOLERANCE).unwrap();
            prop_assert_eq!(refiner.coarsest(&partition), at_once);
        }
    }

    #[test]
    fn the_order_of_nodes_does_not_matter(seed in any::<u64>(), n in 1usize..20, density in 0.0..1.0) {
        let network = random_network(n, density, seed);
        let adjacency = network.adjacency();
        let backwards: Vec<_> = adjacency
            .iter()
            .map(|(&weight, (i, j))| (n - 1 - i as usize, n - 1 - j as usize, weight))
            .filter(|(i, j, _)| i < j)
            .collect();
        let names = (0..n).map(|i| i.to_string()).collect();
        let mirrored = Network::undirected(names, &backwards).unwrap();
        let marks: Vec<usize> = (0..n).map(|i| i % 3).collect();
        let found = refined(&matrix(&network, Normalization::Normalized), &marks);
        let marks: Vec<usize> = marks.into_iter().rev().collect();
        let other = refined(&matrix(&mirrored, Normalization::Normalized), &marks);
        let back: Vec<usize> = other.cluster_of().iter().rev().copied().collect();
        prop_assert_eq!(found, Partition::from_marks(&back));
    }
}
