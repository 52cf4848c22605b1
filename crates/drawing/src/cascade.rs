//! The predicted states as plain data for their figure: which cluster came from which.

use clustering::Partition;
use eigensync::Findings;

use crate::identity::{Identities, Identity};
use experiment::Plan;
use figures::{CascadeCluster, CascadePanel, CascadeState};

/// The states of a prediction, from strong coupling down.
pub fn panel(plan: &Plan, findings: &Findings, identities: &Identities) -> CascadePanel {
    let states = &findings.cascade;
    let before = std::iter::once(None).chain(states.iter().map(|state| Some(&*state.clusters)));
    let states = states.iter().zip(before).zip(&identities.of_state);
    let state = |((state, before), identities): ((&clustering::State, _), &Vec<_>)| CascadeState {
        epsilon: state.epsilon,
        clusters: clusters(&state.clusters, before, identities),
    };
    CascadePanel {
        n_nodes: plan.study.network.n_nodes(),
        states: states.map(state).collect(),
        shown: identities.shown,
    }
}

/// The clusters of two nodes or more, each with the one of the state before that holds all of it.
fn clusters(
    now: &Partition,
    before: Option<&Partition>,
    identities: &[Identity],
) -> Vec<CascadeCluster> {
    let parents = before.map(|before| (before, places(before)));
    let cluster = |(nodes, identity): (Vec<usize>, &Identity)| CascadeCluster {
        n_nodes: nodes.len(),
        parent: parents.as_ref().and_then(|(before, places)| {
            let of = before.cluster_of();
            let together = nodes.iter().all(|&node| of[node] == of[nodes[0]]);
            places[of[nodes[0]]].filter(|_| together)
        }),
        label: identity.name.clone(),
        colour: identity.colour,
    };
    now.nontrivial().into_iter().zip(identities).map(cluster).collect()
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
