//! Networks: what is refused, and what is found out about the rest.

use graph::{GraphError, Network};

fn labels(n_nodes: usize) -> Vec<String> {
    (1..=n_nodes).map(|i| i.to_string()).collect()
}

fn network(n_nodes: usize, links: &[(usize, usize, f64)]) -> Network {
    Network::undirected(labels(n_nodes), links).unwrap()
}

#[track_caller]
fn check_refused(n_nodes: usize, links: &[(usize, usize, f64)], expected: &GraphError) {
    assert_eq!(&Network::undirected(labels(n_nodes), links).unwrap_err(), expected);
}

#[test]
fn a_link_acts_in_both_directions_with_one_weight() {
    let network = network(3, &[(2, 0, 1.5)]);
    assert_eq!((network.n_nodes(), network.n_links()), (3, 1));
    assert_eq!(network.adjacency().get(0, 2), Some(&1.5));
    assert_eq!(network.adjacency().get(2, 0), Some(&1.5));
    assert_eq!(network.adjacency().nnz(), 2);
}

#[test]
fn strengths_are_sums_of_weights() {
    assert_eq!(network(4, &[(0, 1, 1.0), (1, 2, 2.5)]).strengths(), [1.0, 3.5, 2.5, 0.0]);
}

#[test]
fn nodes_without_links_are_isolated() {
    assert_eq!(network(5, &[(1, 3, 1.0)]).isolated_nodes(), [0, 2, 4]);
    assert!(network(2, &[(0, 1, 1.0)]).isolated_nodes().is_empty());
}

#[test]
fn components_are_sorted_and_ordered_by_their_first_node() {
    // 0–5–2 is a path met out of order, 1–4 a pair, 3 alone.
    let network = network(6, &[(4, 1, 1.0), (5, 2, 1.0), (0, 5, 1.0)]);
    assert_eq!(network.components(), [vec![0, 2, 5], vec![1, 4], vec![3]]);
}

#[test]
fn a_node_is_found_by_its_label() {
    let network = Network::undirected(vec!["v1".into(), "area 17".into()], &[]).unwrap();
    assert_eq!(network.node("area 17"), Some(1));
    assert_eq!(network.node("area"), None);
    assert_eq!(network.labels(), ["v1", "area 17"]);
}

#[test]
fn a_network_needs_a_node() {
    check_refused(0, &[], &GraphError::Empty);
}

#[test]
fn two_nodes_cannot_share_a_label() {
    let error = Network::undirected(vec!["a".into(), "b".into(), "a".into()], &[]).unwrap_err();
    assert_eq!(error, GraphError::DuplicateLabel { label: "a".into() });
}

#[test]
fn a_link_to_a_node_that_does_not_exist_is_refused() {
    check_refused(2, &[(0, 2, 1.0)], &GraphError::NodeOutOfRange { node: 2, n_nodes: 2 });
}

#[test]
fn a_link_to_itself_is_refused() {
    check_refused(2, &[(1, 1, 1.0)], &GraphError::SelfLoop { node: "2".into() });
}

#[test]
fn weights_must_be_finite_and_above_zero() {
    for weight in [0.0, -0.0, -1.0, f64::INFINITY, f64::NEG_INFINITY] {
        let expected = GraphError::BadWeight { from: "1".into(), to: "2".into(), weight };
        check_refused(2, &[(0, 1, weight)], &expected);
    }
    let nan = Network::undirected(labels(2), &[(0, 1, f64::NAN)]).unwrap_err();
    assert!(matches!(nan, GraphError::BadWeight { weight, .. } if weight.is_nan()));
}

#[test]
fn a_link_given_in_both_directions_is_a_duplicate() {
    let expected = GraphError::DuplicateLink { from: "3".into(), to: "1".into() };
    check_refused(3, &[(0, 1, 1.0), (0, 2, 1.0), (2, 0, 1.0)], &expected);
}
