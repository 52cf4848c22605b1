//! The predicted states as plain data for their figure: which cluster came from which.

use clustering::Partition;
use eigensync::Findings;

use crate::plan::Plan;
use figures::{CascadeCluster, CascadePanel, CascadeState};

/// The states of a prediction, from strong coupling down.
pub fn panel(plan: &Plan, findings: &Findings) -> CascadePanel {
    let states = &findings.cascade;
    let before = std::iter::once(None).chain(states.iter().map(|state| Some(&*state.clusters)));
    let state = |(state, before): (&clustering::State, Option<&Partition>)| CascadeState {
        epsilon: state.epsilon,
        clusters: clusters(plan, &state.clusters, before),
    };
    CascadePanel {
        n_nodes: plan.study.network.n_nodes(),
        states: states.iter().zip(before).map(state).collect(),
    }
}

/// The clusters of two nodes or more, each with the one of the state before that holds all of it.
fn clusters(plan: &Plan, now: &Partition, before: Option<&Partition>) -> Vec<CascadeCluster> {
    let parents = before.map(|before| (before, places(before)));
    let cluster = |nodes: Vec<usize>| CascadeCluster {
        n_nodes: nodes.len(),
        parent: parents.as_ref().and_then(|(before, places)| {
            let of = before.cluster_of();
            let together = nodes.iter().all(|&node| of[node] == of[nodes[0]]);
            places[of[nodes[0]]].filter(|_| together)
        }),
        label: label(plan, &nodes),
    };
    now.nontrivial().into_iter().map(cluster).collect()
}

/// The position of each cluster among those of two nodes or more.
fn places(partition: &Partition) -> Vec<Option<usize>> {
    let mut sizes = vec![0; partition.n_clusters()];
    partition.cluster_of().iter().for_each(|&cluster| sizes[cluster] += 1);
    let mut next = 0;
    let place = |size: usize| {
        (size > 1).then(|| {
            next += 1;
            next - 1
        })
    };
    sizes.into_iter().map(place).collect()
}

/// The group that a cluster is, or its first and last node where they follow one another.
fn label(plan: &Plan, nodes: &[usize]) -> String {
    let network = &plan.study.network;
    if let Some(group) = network.groups().iter().find(|group| group.nodes == nodes) {
        return group.name.clone();
    }
    let (first, last) = (nodes[0], nodes[nodes.len() - 1]);
    let labels = network.labels();
    if last - first + 1 == nodes.len() {
        return format!("{}–{}", labels[first], labels[last]);
    }
    String::new()
}
