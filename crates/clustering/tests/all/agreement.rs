//! Agreement of partitions: values from the literature, degenerate cases, brute force.

use clustering::{Partition, adjusted_rand_index, maximum_overlap};
use proptest::prelude::*;

fn marks(marks: &[usize]) -> Partition {
    Partition::from_marks(marks)
}

#[track_caller]
fn check_index(a: &[usize], b: &[usize], expected: f64) {
    let index = adjusted_rand_index(&marks(a), &marks(b));
    assert!((index - expected).abs() < 1e-15, "{index} instead of {expected}");
    assert_eq!(index, adjusted_rand_index(&marks(b), &marks(a)));
}

#[test]
fn the_index_of_a_hand_counted_table_is_12_over_37() {
    // n_ab = [[2, 1], [0, 3]]: I = 1 + 0 + 3 = 4, A = 3 + 3 = 6, B = 1 + 6 = 7, C(6,2) = 15,
    // E = 42/15, index (4 − 2.8) / (6.5 − 2.8) = 12/37.
    check_index(&[0, 0, 0, 1, 1, 1], &[0, 0, 1, 1, 1, 1], 12.0 / 37.0);
}

#[test]
fn crossed_pairs_have_index_minus_one_half() {
    // n_ab all 1: I = 0, A = B = 2, E = 4/6, index −(2/3) / (2 − 2/3).
    check_index(&[0, 0, 1, 1], &[0, 1, 0, 1], -0.5);
}

#[test]
fn degenerate_partitions_have_index_one_among_equals_and_zero_otherwise() {
    for equal in [vec![0], vec![0, 0, 0], vec![0, 1, 2], vec![]] {
        check_index(&equal, &equal, 1.0);
    }
    check_index(&[0, 0, 0, 0], &[0, 1, 2, 3], 0.0);
    check_index(&[0, 0, 1, 1], &[0, 1, 2, 3], 0.0);
    check_index(&[0, 0, 1, 1], &[0, 0, 0, 0], 0.0);
}

#[test]
fn independent_partitions_have_index_zero_on_average() {
    // The mean over all 720 orders of the second partition is zero by construction of E.
    let (a, b) = ([0, 0, 0, 1, 1, 2], [0, 0, 1, 1, 2, 3]);
    let mut sum = 0.0;
    let orders = permutations(6);
    for order in &orders {
        let shuffled: Vec<usize> = order.iter().map(|&i| b[i]).collect();
        sum += adjusted_rand_index(&marks(&a), &marks(&shuffled));
    }
    assert!((sum / orders.len() as f64).abs() < 1e-14);
}

#[test]
fn the_greedy_match_is_not_always_the_best() {
    // n_ab = [[4, 3], [3, 0]]: taking the 4 first leaves 0; 3 + 3 is better.
    let a = marks(&[0, 0, 0, 0, 0, 0, 0, 1, 1, 1]);
    let b = marks(&[0, 0, 0, 0, 1, 1, 1, 0, 0, 0]);
    let overlap = maximum_overlap(&a, &b);
    assert_eq!(overlap.matches, [(0, 1), (1, 0)]);
    assert_eq!((overlap.n_agreeing, overlap.n_nodes), (6, 10));
    assert_eq!(overlap.fraction(), 0.6);
}

#[test]
fn one_cluster_and_singletons_agree_on_one_node() {
    let overlap = maximum_overlap(&Partition::one_cluster(5), &Partition::singletons(5));
    assert_eq!(overlap.fraction(), 0.2);
    assert_eq!(overlap.matches.len(), 1);
    assert_eq!(
        maximum_overlap(&Partition::singletons(0), &Partition::singletons(0)).fraction(),
        1.0
    );
}

#[test]
fn many_equal_clusters_are_matched_at_once() {
    let pairs: Vec<usize> = (0..20_000).map(|i| i / 2).collect();
    assert_eq!(maximum_overlap(&marks(&pairs), &marks(&pairs)).n_agreeing, 20_000);
}

#[test]
#[should_panic(expected = "partitions of 2 and 3 nodes")]
fn partitions_of_different_networks_have_no_agreement() {
    let _ = adjusted_rand_index(&Partition::singletons(2), &Partition::singletons(3));
}

fn permutations(n: usize) -> Vec<Vec<usize>> {
    if n == 0 {
        return vec![vec![]];
    }
    let shorter = permutations(n - 1);
    let insert = |p: &Vec<usize>, at: usize| [&p[..at], &[n - 1], &p[at..]].concat();
    shorter.iter().flat_map(|p| (0..n).map(move |at| insert(p, at))).collect()
}

/// The best matching by trying all of them, with empty clusters to make up the numbers.
fn brute_force(a: &[usize], b: &[usize], n_clusters: usize) -> usize {
    let agreeing = |p: &Vec<usize>| a.iter().zip(b).filter(|&(&a, &b)| p[a] == b).count();
    permutations(n_clusters).iter().map(agreeing).max().unwrap()
}

fn two_partitions() -> impl Strategy<Value = (Vec<usize>, Vec<usize>)> {
    prop::collection::vec((0usize..6, 0usize..6), 1..40).prop_map(|pairs| pairs.into_iter().unzip())
}

proptest! {
    #[test]
    fn the_matching_is_as_good_as_the_best_of_all((a, b) in two_partitions()) {
        let overlap = maximum_overlap(&marks(&a), &marks(&b));
        prop_assert_eq!(overlap.n_agreeing, brute_force(&a, &b, 6));
    }

    #[test]
    fn the_matches_are_one_to_one_and_add_up((a, b) in two_partitions()) {
        let (a, b) = (marks(&a), marks(&b));
        let overlap = maximum_overlap(&a, &b);
        let mut counted = 0;
        for (i, &(x, y)) in overlap.matches.iter().enumerate() {
            prop_assert!(overlap.matches[..i].iter().all(|&(u, v)| u != x && v != y));
            let both = a.cluster_of().iter().zip(b.cluster_of());
            let shared = both.filter(|&(&u, &v)| u == x && v == y).count();
            prop_assert!(shared > 0);
            counted += shared;
        }
        prop_assert_eq!(counted, overlap.n_agreeing);
    }

    #[test]
    fn the_index_is_symmetric_and_at_most_one((a, b) in two_partitions()) {
        let (a, b) = (marks(&a), marks(&b));
        let index = adjusted_rand_index(&a, &b);
        prop_assert_eq!(index, adjusted_rand_index(&b, &a));
        prop_assert!((-1.0..=1.0).contains(&index));
        prop_assert_eq!(index == 1.0, a == b);
    }
}
