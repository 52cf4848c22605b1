//! The predicted states as plain data for their figure: which cluster came from which.

use clustering::Partition;
use eigensync::Findings;

use crate::identity::{Identities, Identity};
use crate::stretches::{Stretch, stretches};
use experiment::Plan;
use figures::{CascadeCluster, CascadePanel, CascadeState};

/// The states of a prediction, from strong coupling down.
pub fn panel(plan: &Plan, findings: &Findings, identities: &Identities) -> CascadePanel {
    let seen = stretches(&findings.cascade);
    let firsts: Vec<usize> = seen.iter().map(|stretch| stretch.states.start).collect();
    let clusters_of = |first: usize| &*findings.cascade[first].clusters;
    let before = std::iter::once(None).chain(firsts.iter().map(|&first| Some(clusters_of(first))));
    let state = |((stretch, &first), before): ((&Stretch, &usize), _)| CascadeState {
        epsilon: stretch.epsilon,
        clusters: clusters(clusters_of(first), before, &identities.of_state[first]),
    };
    CascadePanel {
        n_nodes: plan.study.network.n_nodes(),
        states: seen.iter().zip(&firsts).zip(before).map(state).collect(),
        shown: identities
            .shown
            .and_then(|shown| seen.iter().position(|stretch| stretch.states.contains(&shown))),
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
