//! Steps of preparation: closed forms by hand, then what holds on random matrices.

use graph::prepare::{Report, Selection, Step, Symmetrise, apply, prepare};
use graph::{Group, Network, PrepareError, RawNetwork, numbered_labels};
use proptest::prelude::*;

type Entries = Vec<(usize, usize, f64)>;

/// Five nodes: 1→2 twice as strong as 2→1, 3→2 alone, a self-loop at 1 and at 4, 5 alone.
fn example() -> RawNetwork {
    let entries = [(1, 0, 2.0), (0, 1, 1.0), (1, 2, 3.0), (0, 0, 7.0), (3, 3, 1.0)];
    RawNetwork::new(numbered_labels(5), &entries, true)
        .and_then(|raw| raw.with_groups(vec![group("low", &[0, 1]), group("high", &[3, 4])]))
        .and_then(|raw| raw.with_positions((0..5).map(|i| [f64::from(i), 0.0, -1.0]).collect()))
        .unwrap()
}

fn group(name: &str, nodes: &[usize]) -> Group {
    Group { name: name.into(), nodes: nodes.to_vec() }
}

fn entries(raw: &RawNetwork) -> Entries {
    raw.matrix().iter().map(|(&value, (i, j))| (i as usize, j as usize, value)).collect()
}

/// Blocks of nodes, each (first, end).
fn ranges(ranges: &[(usize, usize)]) -> Step {
    Step::Select(Selection::Ranges(ranges.iter().map(|&(start, end)| start..end).collect()))
}

fn labels(labels: &[&str]) -> Step {
    Step::Select(Selection::Labels(labels.iter().map(|&label| label.to_owned()).collect()))
}

/// The report of a step that leaves everything as it is in [`example`].
fn nothing_removed(step: Step) -> Report {
    Report {
        step,
        removed_nodes: vec![],
        removed_groups: vec![],
        removed_links: 0,
        removed_self_loops: 0,
        changed_links: 0,
        n_nodes: 5,
        n_links: 3,
        directed: true,
    }
}

#[track_caller]
fn check_step(expected: &Report, expected_entries: &[(usize, usize, f64)]) -> RawNetwork {
    let (after, report) = apply(&example(), &expected.step).unwrap();
    assert_eq!(&report, expected);
    assert_eq!(entries(&after), expected_entries);
    after
}

#[track_caller]
fn check_refused(raw: &RawNetwork, step: &Step, expected: &PrepareError, message: &str) {
    let refused = apply(raw, step).unwrap_err();
    assert_eq!(&refused, expected);
    assert_eq!(refused.to_string(), message);
}

#[test]
fn a_block_keeps_the_links_inside_it_and_its_groups_and_positions() {
    let report = Report {
        removed_nodes: vec!["1".into(), "5".into()],
        removed_links: 2,
        removed_self_loops: 1,
        n_nodes: 3,
        n_links: 1,
        ..nothing_removed(ranges(&[(1, 4)]))
    };
    let after = check_step(&report, &[(0, 1, 3.0), (2, 2, 1.0)]);
    assert_eq!(after.labels(), ["2", "3", "4"]);
    assert_eq!(after.groups(), [group("low", &[0]), group("high", &[2])]);
    assert_eq!(after.positions(), Some(&[1.0, 2.0, 3.0].map(|x| [x, 0.0, -1.0])[..]));
}

#[test]
fn labels_select_in_the_order_given_and_a_group_goes_with_its_last_node() {
    let report = Report {
        removed_nodes: vec!["4".into(), "5".into()],
        removed_groups: vec!["high".into()],
        removed_self_loops: 1,
        n_nodes: 3,
        ..nothing_removed(labels(&["3", "2", "1"]))
    };
    let after = check_step(&report, &[(1, 0, 3.0), (1, 2, 2.0), (2, 1, 1.0), (2, 2, 7.0)]);
    assert_eq!(after.labels(), ["3", "2", "1"]);
    assert_eq!(after.groups(), [group("low", &[1, 2])]);
    assert_eq!(after.positions().unwrap()[0], [2.0, 0.0, -1.0]);
}

#[test]
fn several_blocks_come_one_after_the_other() {
    let (after, _) = apply(&example(), &ranges(&[(3, 5), (0, 1)])).unwrap();
    assert_eq!(after.labels(), ["4", "5", "1"]);
}

#[test]
fn self_loops_go_and_links_stay() {
    let report = Report { removed_self_loops: 2, ..nothing_removed(Step::DropSelfLoops) };
    check_step(&report, &[(0, 1, 1.0), (1, 0, 2.0), (1, 2, 3.0)]);
}

#[test]
fn the_union_joins_whom_either_direction_joins() {
    let report = Report {
        changed_links: 2,
        n_links: 2,
        directed: false,
        ..nothing_removed(Step::Symmetrise(Symmetrise::Union))
    };
    let ones = [(0, 0), (0, 1), (1, 0), (1, 2), (2, 1), (3, 3)].map(|(i, j)| (i, j, 1.0));
    check_step(&report, &ones);
}

#[test]
fn the_mean_halves_a_link_of_one_direction() {
    let report = Report {
        changed_links: 2,
        n_links: 2,
        directed: false,
        ..nothing_removed(Step::Symmetrise(Symmetrise::Mean))
    };
    let means = [(0, 0, 7.0), (0, 1, 1.5), (1, 0, 1.5), (1, 2, 1.5), (2, 1, 1.5), (3, 3, 1.0)];
    check_step(&report, &means);
}

#[test]
fn the_maximum_keeps_the_stronger_direction() {
    let report = Report {
        changed_links: 2,
        n_links: 2,
        directed: false,
        ..nothing_removed(Step::Symmetrise(Symmetrise::Max))
    };
    let maxima = [(0, 0, 7.0), (0, 1, 2.0), (1, 0, 2.0), (1, 2, 3.0), (2, 1, 3.0), (3, 3, 1.0)];
    check_step(&report, &maxima);
}

#[test]
fn a_mean_of_zero_removes_the_link() {
    let raw = RawNetwork::new(numbered_labels(2), &[(0, 1, 1.0), (1, 0, -1.0)], true).unwrap();
    let (after, report) = apply(&raw, &Step::Symmetrise(Symmetrise::Mean)).unwrap();
    assert_eq!((report.removed_links, report.changed_links, report.n_links), (1, 0, 0));
    assert_eq!(after.matrix().nnz(), 0);
}

#[test]
fn equal_directions_do_not_count_as_changed() {
    let raw = RawNetwork::new(numbered_labels(2), &[(0, 1, 0.3), (1, 0, 0.3)], true).unwrap();
    for (rule, changed) in [(Symmetrise::Mean, 0), (Symmetrise::Max, 0), (Symmetrise::Union, 1)] {
        let (_, report) = apply(&raw, &Step::Symmetrise(rule)).unwrap();
        assert_eq!((report.changed_links, report.removed_links, report.n_links), (changed, 0, 1));
    }
}

#[test]
fn a_threshold_keeps_what_reaches_it() {
    let report = Report {
        removed_links: 1,
        removed_self_loops: 1,
        n_links: 2,
        ..nothing_removed(Step::Threshold(2.0))
    };
    check_step(&report, &[(0, 0, 7.0), (1, 0, 2.0), (1, 2, 3.0)]);
}

#[test]
fn binarising_counts_the_weights_that_were_not_one() {
    let report = Report { changed_links: 2, ..nothing_removed(Step::Binarise) };
    let ones = [(0, 0), (0, 1), (1, 0), (1, 2), (3, 3)].map(|(i, j)| (i, j, 1.0));
    check_step(&report, &ones);
    let pair = Network::undirected(numbered_labels(2), &[(0, 1, 2.5)]).unwrap();
    let (_, report) = apply(&RawNetwork::from(pair), &Step::Binarise).unwrap();
    assert_eq!((report.changed_links, report.n_links), (1, 1));
}

#[test]
fn a_node_with_only_a_self_loop_is_isolated_and_one_that_only_drives_is_not() {
    let report = Report {
        removed_nodes: vec!["4".into(), "5".into()],
        removed_groups: vec!["high".into()],
        removed_self_loops: 1,
        n_nodes: 3,
        ..nothing_removed(Step::DropIsolated)
    };
    check_step(&report, &[(0, 0, 7.0), (0, 1, 1.0), (1, 0, 2.0), (1, 2, 3.0)]);
}

#[test]
fn the_largest_component_follows_links_against_their_direction() {
    let report = Report {
        removed_nodes: vec!["4".into(), "5".into()],
        removed_groups: vec!["high".into()],
        removed_self_loops: 1,
        n_nodes: 3,
        ..nothing_removed(Step::LargestComponent)
    };
    check_step(&report, &[(0, 0, 7.0), (0, 1, 1.0), (1, 0, 2.0), (1, 2, 3.0)]);
}

#[test]
fn of_two_largest_components_the_one_with_the_first_node_stays() {
    // {0, 3} and {1, 2} are of one size, 4 is alone.
    let raw = RawNetwork::new(numbered_labels(5), &[(2, 1, 1.0), (0, 3, 1.0)], true).unwrap();
    let (after, report) = apply(&raw, &Step::LargestComponent).unwrap();
    assert_eq!(after.labels(), ["1", "4"]);
    assert_eq!((report.removed_links, report.n_links), (1, 1));
}

#[test]
fn the_order_of_the_steps_matters() {
    // The mean of the link 1–2 is 1.5, that of 2–3 too, but one of its directions is missing.
    let (mean, threshold) = (Step::Symmetrise(Symmetrise::Mean), Step::Threshold(1.5));
    let (after, _) = prepare(example(), &[mean.clone(), threshold.clone()]).unwrap();
    assert_eq!(after.n_links(), 2);
    let (after, _) = prepare(example(), &[threshold, mean]).unwrap();
    assert_eq!(entries(&after)[1], (0, 1, 1.0));
}

#[test]
fn all_steps_lead_to_a_network_and_report_in_turn() {
    let steps = [
        ranges(&[(0, 4)]),
        Step::DropSelfLoops,
        Step::Symmetrise(Symmetrise::Mean),
        Step::Threshold(0.5),
        Step::Binarise,
        Step::DropIsolated,
        Step::LargestComponent,
    ];
    let (raw, reports) = prepare(example(), &steps).unwrap();
    assert!(reports.iter().map(|report| &report.step).eq(&steps));
    let nodes: Vec<_> = reports.iter().map(|report| report.n_nodes).collect();
    assert_eq!(nodes, [4, 4, 4, 4, 4, 3, 3]);
    let network = raw.into_network().unwrap();
    let path = Network::undirected(numbered_labels(3), &[(0, 1, 1.0), (1, 2, 1.0)]).unwrap();
    assert_eq!(network.adjacency(), path.adjacency());
    assert_eq!(network.groups(), [group("low", &[0, 1])]);
}

#[test]
fn selections_that_make_no_sense_are_refused() {
    check_refused(
        &example(),
        &ranges(&[(2, 6)]),
        &PrepareError::RangeOutOfRange { start: 2, end: 6, n_nodes: 5 },
        "nodes 3 to 6 are selected, but there are only 5 nodes",
    );
    check_refused(
        &example(),
        &ranges(&[(3, 3)]),
        &PrepareError::EmptyRange { start: 3, end: 3 },
        "nodes 4 to 3 are selected; expected a range of at least one node",
    );
    check_refused(
        &example(),
        &ranges(&[(0, 3), (2, 4)]),
        &PrepareError::SelectedTwice { label: "3".into() },
        "node `3` is selected twice",
    );
    check_refused(
        &example(),
        &labels(&["1", "one"]),
        &PrepareError::UnknownLabel { label: "one".into() },
        "node `one` is selected, but no node is called that",
    );
    check_refused(
        &example(),
        &labels(&[]),
        &PrepareError::EmptySelection,
        "the selection names no nodes",
    );
}

#[test]
fn negative_weights_must_go_before_steps_that_would_lose_their_sign() {
    let raw = RawNetwork::new(numbered_labels(2), &[(1, 0, -0.5)], true).unwrap();
    let (row, column) = ("2".into(), "1".into());
    let expected = PrepareError::NegativeWeight { row, column, value: -0.5 };
    let message = "row `2`, column `1` holds -0.5; expected no weight below zero";
    for step in
        [Step::Binarise, Step::Symmetrise(Symmetrise::Union), Step::Symmetrise(Symmetrise::Max)]
    {
        check_refused(&raw, &step, &expected, message);
        prepare(raw.clone(), &[Step::Threshold(0.0), step]).unwrap();
    }
}

#[test]
fn a_threshold_must_be_finite() {
    check_refused(
        &example(),
        &Step::Threshold(f64::INFINITY),
        &PrepareError::BadThreshold { threshold: f64::INFINITY },
        "the threshold is inf; expected a finite number",
    );
    assert!(apply(&example(), &Step::Threshold(f64::NAN)).is_err());
}

#[test]
fn dropping_every_node_is_refused() {
    let raw = RawNetwork::new(numbered_labels(2), &[(0, 0, 1.0)], false).unwrap();
    let message = "all 2 nodes are isolated, so that dropping them leaves no network";
    check_refused(&raw, &Step::DropIsolated, &PrepareError::AllIsolated { n_nodes: 2 }, message);
}

/// Up to twelve nodes and distinct entries, some of them on the diagonal.
fn any_raw() -> impl Strategy<Value = RawNetwork> {
    (1usize..12).prop_flat_map(|n_nodes| {
        let entry = ((0..n_nodes, 0..n_nodes), 0.01..10.0f64);
        prop::collection::hash_map(entry.0, entry.1, 0..30).prop_map(move |entries| {
            let entries: Entries =
                entries.into_iter().map(|((i, j), value)| (i, j, value)).collect();
            RawNetwork::new(numbered_labels(n_nodes), &entries, true).unwrap()
        })
    })
}

fn any_rule() -> impl Strategy<Value = Symmetrise> {
    prop::sample::select(vec![Symmetrise::Union, Symmetrise::Mean, Symmetrise::Max])
}

proptest! {
    #[test]
    fn without_diagonal_and_symmetrised_anything_is_a_network(raw in any_raw(), rule in any_rule()) {
        let steps = [Step::DropSelfLoops, Step::Symmetrise(rule)];
        let (prepared, _) = prepare(raw.clone(), &steps).unwrap();
        let network = prepared.into_network().unwrap();
        for (&value, (i, j)) in network.adjacency() {
            let [a, b] = [(i, j), (j, i)]
                .map(|(i, j)| raw.matrix().get(i as usize, j as usize).copied().unwrap_or(0.0));
            let expected = match rule {
                Symmetrise::Union => 1.0,
                Symmetrise::Mean => (a + b) / 2.0,
                Symmetrise::Max => a.max(b),
            };
            prop_assert_eq!(value, expected);
        }
        let linked = |&(&_, (i, j)): &(&f64, (u32, u32))| i != j;
        for (_, (i, j)) in raw.matrix().iter().filter(linked) {
            prop_assert!(network.adjacency().get(i as usize, j as usize).is_some());
        }
    }

    #[test]
    fn a_step_taken_twice_changes_nothing_more(raw in any_raw(), rule in any_rule()) {
        let steps = [
            Step::DropSelfLoops,
            Step::Symmetrise(rule),
            Step::Threshold(1.0),
            Step::Binarise,
            Step::LargestComponent,
        ];
        for step in steps {
            let (once, _) = apply(&raw, &step).unwrap();
            let (twice, report) = apply(&once, &step).unwrap();
            prop_assert_eq!(&twice, &once);
            prop_assert_eq!((report.removed_links, report.changed_links), (0, 0));
            prop_assert!(report.removed_nodes.is_empty());
        }
    }

    #[test]
    fn the_largest_component_is_connected_and_no_other_is_larger(raw in any_raw()) {
        let steps = [Step::DropSelfLoops, Step::Symmetrise(Symmetrise::Union)];
        let (symmetric, _) = prepare(raw.clone(), &steps).unwrap();
        let sizes = symmetric.into_network().unwrap().components();
        let largest = sizes.iter().map(Vec::len).max();
        let (component, _) = prepare(raw, &[&[Step::LargestComponent], &steps[..]].concat()).unwrap();
        let components = component.into_network().unwrap().components();
        prop_assert_eq!(components.len(), 1);
        prop_assert_eq!(components.iter().map(Vec::len).max(), largest);
    }
}
