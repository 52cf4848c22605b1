//! The tree of the cascade: the paper's two networks, windows, and invariants.

use clustering::{
    CascadeTree, ClusterKind, ClusterRule, State, StateLabels, TreeEnd, TreeRow,
    hold_against_links, merge_equal_clusters,
};
use graph::{CouplingMatrix, Normalization};
use msf::{Interval, StableRegion};
use proptest::prelude::*;

use crate::fixtures::{leading, nepal, random_network, read, six_nodes, spectrum_of};
use crate::stable_set::cascade;

fn region(from: f64, to: Option<f64>) -> StableRegion {
    StableRegion { intervals: vec![Interval::known(from, to)] }
}

fn only(mut trees: Vec<CascadeTree>) -> CascadeTree {
    assert_eq!(trees.len(), 1);
    trees.pop().unwrap()
}

/// (parent, size, first node counted from 1, ε from, ε to) of every cluster.
type Line = (Option<usize>, usize, usize, f64, Option<f64>);

fn lines(tree: &CascadeTree) -> Vec<Line> {
    let round = |x: f64| (x * 1e9).round() / 1e9;
    let line = |row: TreeRow| {
        let (from, to) = (round(row.epsilon_from), row.epsilon_to.map(round));
        (row.parent, row.size, row.first_node + 1, from, to)
    };
    tree.rows().map(line).collect()
}

#[test]
fn six_nodes_split_into_two_threes_then_pairs_then_single_nodes() {
    let states = cascade(&six_nodes(), &region(6.0, None), ClusterRule::Exact).unwrap();
    let tree = only(CascadeTree::of_each_run(&states, 1));
    // λ = −2, −3, −4 become unstable at ε = 3, 2, 1.5.
    let expected: Vec<Line> = vec![
        (None, 6, 1, 3.0, None),
        (Some(0), 3, 1, 2.0, Some(3.0)),
        (Some(0), 3, 3, 2.0, Some(3.0)),
        (Some(1), 1, 1, 0.0, Some(2.0)),
        (Some(1), 2, 2, 1.5, Some(2.0)),
        (Some(2), 2, 3, 1.5, Some(2.0)),
        (Some(2), 1, 4, 0.0, Some(2.0)),
        (Some(4), 1, 2, 0.0, Some(1.5)),
        (Some(4), 1, 6, 0.0, Some(1.5)),
        (Some(5), 1, 3, 0.0, Some(1.5)),
        (Some(5), 1, 5, 0.0, Some(1.5)),
    ];
    assert_eq!(lines(&tree), expected);
    assert_eq!((tree.end, tree.states.clone(), tree.n_unlisted), (TreeEnd::ZeroCoupling, 0..6, 0));
    assert_eq!(tree.clusters[0].children, 1..3);
    assert!(tree.clusters[5].splits && !tree.clusters[6].splits);
    assert_eq!(tree.members(&states, 2), [2, 3, 4]);
    assert_eq!(tree.members(&states, 5), [2, 4]);
}

#[test]
fn clusters_too_small_to_be_listed_are_counted() {
    let states = cascade(&six_nodes(), &region(6.0, None), ClusterRule::Exact).unwrap();
    let tree = only(CascadeTree::of_each_run(&states, 2));
    assert_eq!(tree.clusters.iter().map(|c| c.size).collect::<Vec<_>>(), [6, 3, 3, 2, 2]);
    let unlisted: Vec<usize> = tree.clusters.iter().map(|c| c.n_unlisted).collect();
    assert_eq!(unlisted, [0, 1, 1, 2, 2]);
    assert!(tree.clusters[4].splits && tree.clusters[4].children.is_empty());
    let none = only(CascadeTree::of_each_run(&states, 7));
    assert_eq!((none.clusters.len(), none.n_unlisted), (0, 6));
}

#[test]
fn a_cluster_that_stays_spans_its_states_merged_or_not() {
    let states = cascade(&nepal(), &region(9.0, None), ClusterRule::Exact).unwrap();
    let tree = only(CascadeTree::of_each_run(&states, 2));
    let merged = only(CascadeTree::of_each_run(&merge_equal_clusters(&states), 2));
    assert_eq!(lines(&tree), lines(&merged));
    // The cliques of 5, 3 and 5 nodes split at λ = −8, −14, −9.
    let ends: Vec<(usize, f64)> = lines(&tree)[1..].iter().map(|l| (l.1, l.3)).collect();
    assert_eq!(ends, [(5, 1.125), (3, (9.0 / 14.0 * 1e9f64).round() / 1e9), (5, 1.0)]);
    assert_eq!(tree.clusters[0].n_unlisted, 2);
}

#[test]
fn components_are_roots_of_their_own() {
    let spectrum = spectrum_of(&read("1 2\n2 3\n3 1\n4 5\n6"), Normalization::Laplacian);
    let states = cascade(&spectrum, &region(6.0, None), ClusterRule::Exact).unwrap();
    let tree = only(CascadeTree::of_each_run(&states, 1));
    let roots: Vec<Line> = lines(&tree).into_iter().filter(|line| line.0.is_none()).collect();
    assert_eq!(roots, [(None, 3, 1, 2.0, None), (None, 2, 4, 3.0, None), (None, 1, 6, 0.0, None)]);
}

#[test]
fn where_clusters_merge_again_one_tree_ends_and_another_begins() {
    // In a bounded window the last modes become stable first, and clusters merge as ε falls.
    let states = cascade(&six_nodes(), &region(0.187, Some(4.61)), ClusterRule::Exact).unwrap();
    let trees = CascadeTree::of_each_run(&states, 1);
    assert!(trees.len() > 1);
    let mut next = 0;
    for tree in &trees {
        assert_eq!(tree.states.start, next);
        next = tree.states.end;
        let expected = if next == states.len() {
            TreeEnd::ZeroCoupling
        } else {
            TreeEnd::ClustersMerge { epsilon: states[next].epsilon.1.unwrap() }
        };
        assert_eq!(tree.end, expected);
    }
    assert_eq!(next, states.len());
    // Below ε = 4.61/6 all are stable until 0.187/2, and from there on clusters only split.
    let last = trees.last().unwrap();
    assert_eq!((last.clusters[0].size, last.clusters[0].states.start), (6, 5));
    assert_eq!(last.clusters.len(), 11);
}

#[test]
fn the_tree_of_leading_modes_says_that_it_is_cut() {
    let states = cascade(&leading(nepal(), 8), &region(9.0, None), ClusterRule::Exact).unwrap();
    let tree = only(CascadeTree::of_each_run(&states, 2));
    assert_eq!(tree.end, TreeEnd::ModesNotComputed);
    let alive: Vec<usize> = tree.clusters.iter().filter(|c| !c.splits).map(|c| c.size).collect();
    // The clique of λ = −8 has split; those of −14 and −9 have not, as far as these modes tell.
    assert_eq!(alive, [3, 5]);
}

#[test]
fn no_states_make_no_tree() {
    assert!(CascadeTree::of_each_run(&[], 1).is_empty());
}

#[test]
fn clusters_of_the_power_grid_are_labelled_exact_and_accidents_are_not() {
    use ClusterKind::{Approximate, Exact, Single};
    let labelled = |edges: &str| {
        let network = read(edges);
        let spectrum = spectrum_of(&network, Normalization::Laplacian);
        let rule = ClusterRule::Exact;
        let mut states = cascade(&spectrum, &region(1.0, None), rule).unwrap();
        let w = CouplingMatrix::new(&network, Normalization::Laplacian);
        let w = w.matrix().view();
        hold_against_links(&mut states, &spectrum, w, rule, 1e-9).unwrap();
        let mut tree = only(CascadeTree::of_each_run(&states, 1));
        let of = |state| {
            let alone = std::slice::from_ref(state);
            StateLabels::of(state, alone, &spectrum, w, rule, 1e-9).unwrap()
        };
        tree.label(&states, &states.iter().map(of).collect::<Vec<_>>());
        tree.rows().map(|row| (row.size, row.kind.unwrap())).collect::<Vec<_>>()
    };
    let nepal = labelled(include_str!("../../../../experiments/networks/nepal.edges"));
    assert!(nepal.iter().all(|&(size, kind)| kind == if size == 1 { Single } else { Exact }));
    // Nodes 4 and 8 have equal components in v_2 alone, and nothing else in common.
    let path_with_a_tail = labelled("1 2\n2 3\n3 4\n4 5\n5 6\n6 7\n4 8");
    let expected = [(8, Exact), (2, Approximate)];
    assert_eq!(path_with_a_tail.iter().filter(|(size, _)| *size > 1).count(), 2);
    assert!(expected.iter().all(|line| path_with_a_tail.contains(line)));
}

#[test]
fn a_cluster_that_stays_together_is_cut_where_its_exact_synchrony_is_lost() {
    // A path with a tail: v_2 tells all nodes apart, and none by more than 0.5 from its neighbours.
    let path = "1 2\n2 3\n3 4\n4 5\n5 6\n6 7\n7 8 0.9\n8 9\n9 10\n2 11";
    let spectrum = spectrum_of(&read(path), Normalization::Laplacian);
    let states = cascade(&spectrum, &region(8.0, None), ClusterRule::Threshold(0.5)).unwrap();
    let tree = only(CascadeTree::of_each_run(&merge_equal_clusters(&states), 2));
    let critical = 8.0 / -spectrum.real_eigenvalues()[1];
    let cuts: Vec<_> =
        tree.clusters.iter().map(|c| (c.parent, c.size, c.epsilon, c.splits)).collect();
    let expected =
        [(None, 11, (critical, None), true), (Some(0), 11, (0.0, Some(critical)), false)];
    assert!((cuts[0].2.0 - critical).abs() < 1e-9 * critical);
    assert_eq!(
        cuts.iter().map(|c| (c.0, c.1, c.3)).collect::<Vec<_>>(),
        expected.iter().map(|c| (c.0, c.1, c.3)).collect::<Vec<_>>()
    );
    assert_eq!(cuts[1].2, (0.0, Some(cuts[0].2.0)));
}

#[test]
fn a_small_exact_cluster_under_a_threshold_is_cut_where_it_stops_being_exact() {
    // The leaves 1 and 2 of a are alike until their own mode, λ = −1, is unstable.
    let network = read("a 1\na 2\nb 3\nb 4\nb 5\na b");
    let spectrum = spectrum_of(&network, Normalization::Laplacian);
    let states = cascade(&spectrum, &region(1.0, None), ClusterRule::Threshold(0.3)).unwrap();
    let trees = CascadeTree::of_each_run(&merge_equal_clusters(&states), 2);
    for (row, tree) in trees.iter().flat_map(|tree| tree.clusters.iter().map(move |c| (c, tree))) {
        let exact = row.states.clone().map(|s| {
            let state = &merge_equal_clusters(&states)[s];
            let nodes = state.clusters.clusters();
            let of = nodes.iter().find(|nodes| nodes.contains(&row.first_node)).unwrap();
            of.iter().all(|&node| state.cells.cluster_of()[node] == state.cells.cluster_of()[of[0]])
        });
        let exact: Vec<bool> = exact.collect();
        assert!(exact.windows(2).all(|pair| pair[0] == pair[1]), "{row:?} in {tree:?}");
    }
    assert!(trees[0].clusters[0].splits);
}

/// The clusters listed for a state, by first node, as (first node, size).
fn alive(tree: &CascadeTree, state: usize) -> Vec<(usize, usize)> {
    let clusters = tree.clusters.iter().filter(|c| c.states.contains(&state));
    let mut alive: Vec<_> = clusters.map(|c| (c.first_node, c.size)).collect();
    alive.sort_unstable();
    alive
}

fn check_tree(tree: &CascadeTree, states: &[State], smallest: usize) {
    check_innermost(tree, states);
    for number in tree.states.clone() {
        let State { clusters, epsilon, .. } = &states[number];
        let listed: Vec<_> = clusters
            .clusters()
            .iter()
            .filter(|c| c.len() >= smallest)
            .map(|c| (c[0], c.len()))
            .collect();
        assert_eq!(alive(tree, number), listed);
        for cluster in tree.clusters.iter().filter(|c| c.states.contains(&number)) {
            assert!(cluster.epsilon.0 <= epsilon.0);
            let reaches = |to: f64| epsilon.1.is_some_and(|upper| upper <= to);
            assert!(cluster.epsilon.1.is_none_or(reaches));
        }
    }
    for (id, cluster) in tree.clusters.iter().enumerate() {
        let children = &tree.clusters[cluster.children.clone()];
        assert!(children.iter().all(|child| child.parent == Some(id)));
        assert!(children.iter().all(|child| child.epsilon.1 == Some(cluster.epsilon.0)));
        let parts = cluster.n_unlisted + children.iter().map(|child| child.size).sum::<usize>();
        assert_eq!(parts, if cluster.splits { cluster.size } else { 0 });
        assert_eq!(tree.members(states, id).len(), cluster.size);
    }
}

proptest! {
    #[test]
    fn every_state_is_a_cut_through_its_tree(
        seed in any::<u64>(), n in 1usize..12, density in 0.2..1.0, smallest in 1usize..4,
        window in (0.0..2.0, prop::option::of(2.0..9.0)),
        threshold in prop::option::of(0.0..0.4),
    ) {
        let spectrum = spectrum_of(&random_network(n, density, seed), Normalization::Laplacian);
        let rule = threshold.map_or(ClusterRule::Exact, ClusterRule::Threshold);
        let states = cascade(&spectrum, &region(window.0, window.1), rule).unwrap();
        let trees = CascadeTree::of_each_run(&states, smallest);
        prop_assert_eq!(trees.iter().map(|tree| tree.states.len()).sum::<usize>(), states.len());
        for tree in &trees {
            check_tree(tree, &states, smallest);
        }
        if rule == ClusterRule::Exact && window.1.is_none() {
            prop_assert_eq!(trees.len(), 1);
        }
    }
}

/// Every node is in its innermost cluster, and in none of the clusters below it.
fn check_innermost(tree: &CascadeTree, states: &[State]) {
    let members: Vec<Vec<usize>> =
        (0..tree.clusters.len()).map(|id| tree.members(states, id)).collect();
    let innermost = tree.innermost(states);
    for (node, &innermost) in innermost.iter().enumerate() {
        let holds = |id: &usize| members[*id].contains(&node);
        let of = (0..tree.clusters.len()).filter(holds);
        // Of a cluster that stays together while it stops being exact the later one.
        let smallest = of.min_by_key(|&id| (members[id].len(), std::cmp::Reverse(id)));
        assert_eq!(innermost, smallest, "node {node}");
    }
}
