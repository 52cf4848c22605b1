//! Raw networks, groups and positions: what is kept, what is refused, what becomes a network.

use graph::{GraphError, Group, Network, RawNetwork, numbered_labels};

fn raw(n_nodes: usize, entries: &[(usize, usize, f64)], directed: bool) -> RawNetwork {
    RawNetwork::new(numbered_labels(n_nodes), entries, directed).unwrap()
}

#[track_caller]
fn check_refused(entries: &[(usize, usize, f64)], directed: bool, expected: &GraphError) {
    let refused = RawNetwork::new(numbered_labels(3), entries, directed).unwrap_err();
    assert_eq!(&refused, expected);
}

#[track_caller]
fn check_no_network(entries: &[(usize, usize, f64)], expected: &GraphError) {
    assert_eq!(&raw(3, entries, true).into_network().unwrap_err(), expected);
}

fn group(name: &str, nodes: &[usize]) -> Group {
    Group { name: name.into(), nodes: nodes.to_vec() }
}

fn three_nodes() -> Network {
    Network::undirected(vec!["a".into(), "b".into(), "c".into()], &[(0, 1, 1.0)]).unwrap()
}

#[track_caller]
fn check_groups_refused(groups: &[Group], expected: &GraphError, message: &str) {
    let refused = three_nodes().with_groups(groups.to_vec()).unwrap_err();
    assert_eq!(&refused, expected);
    assert_eq!(refused.to_string(), message);
}

#[test]
fn labels_count_from_one() {
    assert_eq!(numbered_labels(3), ["1", "2", "3"]);
}

#[test]
fn a_raw_network_keeps_directions_signs_and_self_loops() {
    let raw = raw(3, &[(2, 1, -0.5), (0, 1, 2.0), (1, 1, 3.0), (1, 0, 4.0)], true);
    assert_eq!((raw.n_nodes(), raw.n_links(), raw.n_self_loops()), (3, 3, 1));
    let entries: Vec<_> = raw.matrix().iter().map(|(&value, place)| (place, value)).collect();
    assert_eq!(entries, [((0, 1), 2.0), ((1, 0), 4.0), ((1, 1), 3.0), ((2, 1), -0.5)]);
}

#[test]
fn an_undirected_link_counts_once() {
    let raw = raw(3, &[(0, 1, 2.0), (1, 0, 2.0), (2, 2, 1.0)], false);
    assert_eq!((raw.n_links(), raw.n_self_loops()), (1, 1));
}

#[test]
fn zeros_are_no_links() {
    let raw = raw(2, &[(0, 1, 0.0), (1, 0, -0.0)], true);
    assert_eq!((raw.n_links(), raw.matrix().nnz()), (0, 0));
}

#[test]
fn entries_must_exist_once_and_be_finite() {
    check_refused(&[(0, 3, 1.0)], true, &GraphError::NodeOutOfRange { node: 3, n_nodes: 3 });
    let (row, column) = ("2".to_owned(), "3".to_owned());
    let twice = GraphError::DuplicateEntry { row: row.clone(), column: column.clone() };
    check_refused(&[(1, 2, 1.0), (0, 1, 1.0), (1, 2, 1.0)], true, &twice);
    let infinite = GraphError::BadEntry { row, column, value: f64::INFINITY };
    check_refused(&[(1, 2, f64::INFINITY)], true, &infinite);
    let nan = RawNetwork::new(numbered_labels(1), &[(0, 0, f64::NAN)], true).unwrap_err();
    assert_eq!(
        nan.to_string(),
        "the entry in row `1`, column `1` is NaN; expected a finite number"
    );
    assert_eq!(RawNetwork::new(vec![], &[], true).unwrap_err(), GraphError::Empty);
}

#[test]
fn a_promise_of_symmetry_is_checked() {
    let broken = GraphError::NotSymmetric {
        row: "1".into(),
        column: "2".into(),
        value: 1.0,
        transposed: 2.0,
    };
    check_refused(&[(0, 1, 1.0), (1, 0, 2.0)], false, &broken);
}

#[test]
fn what_is_asymmetric_is_refused_with_its_place_and_both_values() {
    let one_sided = GraphError::NotSymmetric {
        row: "3".into(),
        column: "1".into(),
        value: 0.25,
        transposed: 0.0,
    };
    check_no_network(&[(0, 1, 1.0), (1, 0, 1.0), (2, 0, 0.25)], &one_sided);
    assert_eq!(
        one_sided.to_string(),
        "the matrix is not symmetric: row `3`, column `1` holds 0.25, but row `1`, column `3` \
         holds 0"
    );
}

#[test]
fn a_network_has_neither_self_loops_nor_negative_weights() {
    check_no_network(&[(1, 1, 1.0)], &GraphError::SelfLoop { node: "2".into() });
    let (from, to) = ("1".into(), "3".into());
    let negative = GraphError::BadWeight { from, to, weight: -1.0 };
    check_no_network(&[(0, 2, -1.0), (2, 0, -1.0)], &negative);
}

#[test]
fn a_symmetric_raw_network_becomes_the_network_of_its_links() {
    let entries = [(0, 1, 2.0), (1, 0, 2.0), (2, 1, 0.5), (1, 2, 0.5)];
    let expected = Network::undirected(numbered_labels(3), &[(0, 1, 2.0), (1, 2, 0.5)]).unwrap();
    for directed in [false, true] {
        assert_eq!(raw(3, &entries, directed).into_network().unwrap(), expected);
    }
    assert_eq!(RawNetwork::from(expected.clone()).into_network().unwrap(), expected);
}

#[test]
fn groups_and_positions_survive_the_way_to_a_network_and_back() {
    let positions = vec![[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]];
    let raw = raw(2, &[], false)
        .with_groups(vec![group("left", &[1])])
        .and_then(|raw| raw.with_positions(positions.clone()))
        .unwrap();
    let network = raw.clone().into_network().unwrap();
    assert_eq!(network.groups(), [group("left", &[1])]);
    assert_eq!(network.positions(), Some(&positions[..]));
    assert_eq!(RawNetwork::from(network), raw);
}

#[test]
fn a_network_without_groups_and_positions_has_none() {
    assert!(three_nodes().groups().is_empty());
    assert_eq!(three_nodes().positions(), None);
}

#[test]
fn nodes_of_a_group_are_ascending_and_groups_keep_their_order() {
    let network = three_nodes().with_groups(vec![group("z", &[2, 0]), group("a", &[1])]).unwrap();
    assert_eq!(network.groups(), [group("z", &[0, 2]), group("a", &[1])]);
}

#[test]
fn groups_must_be_disjoint_named_once_and_of_nodes_that_exist() {
    let (one, two) = (|| "one".to_owned(), || "two".to_owned());
    check_groups_refused(
        &[group("one", &[0, 3])],
        &GraphError::GroupOutOfRange { group: one(), node: 3, n_nodes: 3 },
        "the group `one` names node 3 (from 0), but there are only 3 nodes",
    );
    check_groups_refused(
        &[group("one", &[0, 1]), group("two", &[2, 1])],
        &GraphError::NodeInTwoGroups { node: "b".into(), first: one(), second: two() },
        "node `b` is in the groups `one` and `two`; expected one group at most",
    );
    check_groups_refused(
        &[group("one", &[2, 2])],
        &GraphError::RepeatedInGroup { node: "c".into(), group: one() },
        "the group `one` names node `c` twice",
    );
    check_groups_refused(
        &[group("one", &[0]), group("one", &[1])],
        &GraphError::DuplicateGroup { group: one() },
        "two groups are called `one`",
    );
    check_groups_refused(
        &[group("one", &[])],
        &GraphError::EmptyGroup { group: one() },
        "the group `one` has no nodes",
    );
}

#[test]
fn every_node_needs_one_finite_position() {
    let too_few = three_nodes().with_positions(vec![[0.0; 3]; 2]).unwrap_err();
    assert_eq!(too_few, GraphError::WrongPositionCount { n_positions: 2, n_nodes: 3 });
    let position = [0.0, f64::INFINITY, 0.0];
    let infinite = three_nodes().with_positions(vec![[0.0; 3], [0.0; 3], position]).unwrap_err();
    assert_eq!(infinite, GraphError::BadPosition { node: "c".into(), position });
}

#[test]
fn a_hub_of_a_hundred_thousand_links_is_assembled_at_once() {
    // Quadratic work at a hub would take minutes.
    let n_nodes = 100_001;
    let links: Vec<_> = (1..n_nodes).rev().map(|leaf| (0, leaf, 1.0)).collect();
    let star = Network::undirected(numbered_labels(n_nodes), &links).unwrap();
    assert_eq!(star.strengths()[0], 100_000.0);
    assert_eq!(star.n_links(), 100_000);
}
