//! Partitions, and single linkage by two routes.

use clustering::{ClusteringError, EigenvectorDistance, Partition};
use graph::Normalization;
use proptest::prelude::*;

use crate::fixtures::{random_network, spectrum_of};

fn partition(n_nodes: usize, clusters: &[&[usize]]) -> Partition {
    let clusters: Vec<_> = clusters.iter().map(|c| c.to_vec()).collect();
    Partition::from_clusters(n_nodes, &clusters).unwrap()
}

fn marks() -> impl Strategy<Value = Vec<usize>> {
    prop::collection::vec(0usize..6, 1..20)
}

#[test]
fn clusters_are_numbered_by_their_first_node() {
    let partition = Partition::from_marks(&[7, 3, 7, 0, 3]);
    assert_eq!(partition.cluster_of(), [0, 1, 0, 2, 1]);
    assert_eq!(partition.clusters(), [vec![0, 2], vec![1, 4], vec![3]]);
    assert_eq!(partition.nontrivial(), [[0, 2], [1, 4]]);
    assert_eq!((partition.n_nodes(), partition.n_clusters()), (5, 3));
}

#[test]
fn equal_partitions_are_equal_however_they_are_written() {
    assert_eq!(partition(5, &[&[4, 1], &[2, 0]]), partition(5, &[&[0, 2], &[1, 4], &[3]]));
    assert_eq!(partition(3, &[&[], &[2, 0, 1]]), Partition::one_cluster(3));
    assert_eq!(partition(3, &[]), Partition::singletons(3));
}

#[test]
fn clusters_must_be_of_nodes_that_exist_and_disjoint() {
    let error = Partition::from_clusters(3, &[vec![0, 3]]).unwrap_err();
    assert_eq!(error, ClusteringError::NodeOutOfRange { node: 3, n_nodes: 3 });
    for clusters in [vec![vec![0, 1], vec![1]], vec![vec![1, 1]]] {
        let error = Partition::from_clusters(3, &clusters).unwrap_err();
        assert_eq!(error, ClusteringError::NodeListedTwice { node: 1 });
    }
}

#[test]
fn a_split_cluster_refines_and_a_moved_node_does_not() {
    let coarse = partition(5, &[&[0, 1, 2], &[3, 4]]);
    assert!(partition(5, &[&[0, 2], &[3, 4]]).is_refinement_of(&coarse));
    assert!(!coarse.is_refinement_of(&partition(5, &[&[0, 2], &[3, 4]])));
    assert!(!partition(5, &[&[0, 1], &[2, 3]]).is_refinement_of(&coarse));
}

#[test]
#[should_panic(expected = "partitions of 2 and 3 nodes")]
fn partitions_of_different_networks_cannot_be_compared() {
    let _ = Partition::singletons(2).is_refinement_of(&Partition::singletons(3));
}

#[test]
fn single_linkage_follows_chains() {
    // Places 0, 1, 2 on a line are a chain; 3.5 is further from 2 than the threshold.
    let place = [2.0f64, 0.0, 3.5, 1.0];
    let distance = |i: usize, j: usize| (place[i] - place[j]).abs();
    assert_eq!(Partition::single_linkage(4, distance, 1.0), partition(4, &[&[0, 1, 3]]));
    assert_eq!(Partition::single_linkage(4, distance, 0.99), Partition::singletons(4));
    assert_eq!(Partition::single_linkage(4, distance, 1.5), Partition::one_cluster(4));
}

#[test]
fn a_distance_that_is_not_a_number_links_nothing() {
    let distance = |_, j| if j == 2 { f64::NAN } else { 0.0 };
    assert_eq!(Partition::single_linkage(3, distance, 1.0), partition(3, &[&[0, 1]]));
}

proptest! {
    #[test]
    fn clusters_and_back_give_the_same_partition(marks in marks()) {
        let partition = Partition::from_marks(&marks);
        let clusters = partition.clusters();
        prop_assert_eq!(&Partition::from_clusters(marks.len(), &clusters).unwrap(), &partition);
        prop_assert!(clusters.iter().all(|cluster| cluster.is_sorted()));
        prop_assert!(clusters.is_sorted_by_key(|cluster| cluster[0]));
        for i in 0..marks.len() {
            for j in 0..marks.len() {
                let together = partition.cluster_of()[i] == partition.cluster_of()[j];
                prop_assert_eq!(together, marks[i] == marks[j]);
            }
        }
    }

    #[test]
    fn refinement_is_a_partial_order(a in marks(), seed in marks()) {
        let n = a.len().min(seed.len());
        let joint: Vec<_> = (0..n).map(|i| 10 * a[i] + seed[i]).collect();
        let (a, b) = (Partition::from_marks(&a[..n]), Partition::from_marks(&seed[..n]));
        let meet = Partition::from_marks(&joint);
        prop_assert!(meet.is_refinement_of(&a) && meet.is_refinement_of(&b));
        prop_assert!(a.is_refinement_of(&Partition::one_cluster(n)));
        prop_assert!(Partition::singletons(n).is_refinement_of(&a));
        prop_assert_eq!(a.is_refinement_of(&b) && b.is_refinement_of(&a), a == b);
    }

    #[test]
    fn looking_only_along_one_coordinate_finds_every_link(
        seed in any::<u64>(), n in 3usize..16, last in 1usize..16, threshold in 0.0..0.4,
    ) {
        let spectrum = spectrum_of(&random_network(n, 0.5, seed), Normalization::Laplacian);
        // Whole eigenspaces only.
        let end = spectrum.real_modes().eigenspaces.iter().map(|s| s.end).find(|&e| e > last.min(n - 1)).unwrap();
        let modes: Vec<usize> = (1..end).collect();
        let distance = EigenvectorDistance::new(&spectrum, &modes).unwrap();
        let all_pairs = Partition::single_linkage(n, |i, j| distance.between(i, j), threshold);
        prop_assert_eq!(distance.clusters_within(threshold).unwrap(), all_pairs);
    }

    #[test]
    fn a_larger_threshold_only_merges(seed in any::<u64>(), small in 0.0..0.3, more in 0.0..0.3) {
        let spectrum = spectrum_of(&random_network(12, 0.6, seed), Normalization::Laplacian);
        let modes: Vec<usize> = (1..12).collect();
        let distance = EigenvectorDistance::new(&spectrum, &modes).unwrap();
        let fine = distance.clusters_within(small).unwrap();
        prop_assert!(fine.is_refinement_of(&distance.clusters_within(small + more).unwrap()));
    }
}
