//! Small and broken networks: one node, two nodes, isolated nodes, several components, no transverse
//! mode, weights over twelve orders of magnitude, components that are no numbers.

use clustering::{
    CascadeTree, ClusterKind, ClusterRule, ClusteringError, EigenvectorDistance, Partition, State,
    StateLabels, equitable, hold_against_links,
};
use graph::{CouplingMatrix, Network, Normalization};
use msf::{Interval, StableRegion};

use crate::fixtures::{nepal, read, spectrum_of, vectors_mut};
use crate::stable_set::cascade;

const RULES: [ClusterRule; 2] = [ClusterRule::Exact, ClusterRule::Threshold(1e-6)];

fn above(sigma_c: f64) -> StableRegion {
    StableRegion { intervals: vec![Interval::known(sigma_c, None)] }
}

/// The states of a network, with the labels of each state's clusters.
fn predicted(network: &Network, rule: ClusterRule) -> Vec<(State, Vec<ClusterKind>)> {
    let coupling = CouplingMatrix::new(network, Normalization::Laplacian);
    let spectrum = spectrum_of(network, Normalization::Laplacian);
    let mut states = cascade(&spectrum, &above(1.0), rule).unwrap();
    let w = coupling.matrix().view();
    hold_against_links(&mut states, &spectrum, w, rule, 1e-9).unwrap();
    let trees = CascadeTree::of_each_run(&states, 1);
    let listed =
        |tree: &CascadeTree| tree.clusters.iter().filter(|c| !c.splits).map(|c| c.size).sum();
    assert!(trees.iter().map(listed).all(|n: usize| n == network.n_nodes()));
    let kinds = |state: &State| {
        let alone = std::slice::from_ref(state);
        let labels = StateLabels::of(state, alone, &spectrum, w, rule, 1e-9).unwrap();
        labels.labels.into_iter().map(|label| label.kind).collect()
    };
    states.iter().map(|state| (state.clone(), kinds(state))).collect()
}

#[test]
fn one_node_is_one_cluster_at_every_coupling() {
    for rule in RULES {
        let states = predicted(&read("1"), rule);
        assert_eq!(states.len(), 1);
        assert_eq!(
            (states[0].0.epsilon, &states[0].1[..]),
            ((0.0, None), &[ClusterKind::Single][..])
        );
    }
}

#[test]
fn two_nodes_are_together_above_one_coupling_and_apart_below() {
    for rule in RULES {
        let states = predicted(&read("1 2"), rule);
        // λ_2 = −2 is damped above ε = 1/2.
        let critical = states[1].0.epsilon.1.unwrap();
        assert!(states.len() == 2 && (critical - 0.5).abs() < 1e-15);
        assert_eq!(states[0].0.epsilon, (critical, None));
        assert_eq!(states[0].1, [ClusterKind::Exact]);
        assert_eq!(states[1].1, [ClusterKind::Single; 2]);
    }
}

#[test]
fn isolated_nodes_are_clusters_of_their_own_throughout() {
    for rule in RULES {
        let states = predicted(&read("1 2\n2 3\n3 1\n4\n5"), rule);
        assert_eq!(states[0].0.clusters.clusters(), [vec![0, 1, 2], vec![3], vec![4]]);
        assert_eq!(states[0].1, [ClusterKind::Exact, ClusterKind::Single, ClusterKind::Single]);
        assert_eq!(states[1].0.clusters.n_clusters(), 5);
    }
}

#[test]
fn weights_over_twelve_orders_of_magnitude_keep_the_strong_pair_to_the_end() {
    // Pairs tied by 1e6 and by 1e-6 around a middle, which is linked to each equally.
    let names = (1..6).map(|i| i.to_string()).collect();
    let links = [(0, 1, 1e6), (2, 3, 1e-6), (4, 0, 1.0), (4, 1, 1.0), (4, 2, 1e-3), (4, 3, 1e-3)];
    let network = Network::undirected(names, &links).unwrap();
    let clusters = |(state, _): &(State, Vec<ClusterKind>)| state.clusters.clusters();
    let states = predicted(&network, ClusterRule::Exact);
    let found: Vec<_> = states.iter().map(clusters).collect();
    let pair = vec![vec![0, 1], vec![2], vec![3], vec![4]];
    let expected = [
        vec![vec![0, 1, 2, 3, 4]],
        // λ = −(1e-3 + 2e-6): the weak pair against itself.
        vec![vec![0, 1, 4], vec![2], vec![3]],
        pair.clone(),
        pair,
        vec![vec![0], vec![1], vec![2], vec![3], vec![4]],
    ];
    assert_eq!(found, expected);
    assert!(states[2..4].iter().all(|(_, kinds)| kinds[0] == ClusterKind::Exact));
    // Of {1, 2, 5} only node 5 is linked to others, by 2e-3 in all beside the 2e6 of node 1.
    let w = CouplingMatrix::new(&network, Normalization::Laplacian);
    let found = equitable(w.matrix().view(), &states[1].0.clusters, 1e-12).unwrap();
    assert!(!found.holds() && (found.largest_deviation() * 2e9 - 2.0).abs() < 1e-3, "{found:?}");
}

#[test]
fn components_that_are_no_numbers_are_named() {
    let mut spectrum = nepal();
    vectors_mut(&mut spectrum).nth(3).unwrap()[4] = f64::NAN;
    let expected = ClusteringError::NotFinite { mode: 3, node: 4 };
    assert_eq!(EigenvectorDistance::new(&spectrum, &[3, 4, 5, 6]).unwrap_err(), expected);
    assert!(EigenvectorDistance::new(&spectrum, &[1]).is_ok());
    for rule in RULES {
        assert_eq!(cascade(&spectrum, &above(1.0), rule).unwrap_err(), expected);
    }
    assert_eq!(expected.to_string(), "component 5 of mode 4 is not finite");
}

#[test]
fn a_network_without_links_has_one_state_of_single_nodes() {
    for rule in RULES {
        let states = predicted(&read("1\n2\n3\n4"), rule);
        assert_eq!(states.len(), 1);
        assert_eq!(*states[0].0.clusters, Partition::singletons(4));
    }
}
