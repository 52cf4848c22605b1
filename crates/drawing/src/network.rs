//! The network, coloured by clusters, or its eigenvalues where it is too large to be seen.

use eigensync::Findings;
use experiment::Plan;
use experiment::spec::Layout;
use figures::{Content, Label, LinePanel, Link, NetworkPanel, Node, Placement, Series};

use crate::identity::{Identities, own_name};
use crate::stretches::{range, stretches};

/// Up to this many nodes a network is drawn with its links.
const DRAWN_NODES: usize = 1000;

/// The network coloured by clusters or, where it is too large to be seen, its leading eigenvalues. The
/// clusters are those of the experiment, else those of the predicted state that has the most.
pub fn network_or_spectrum(
    plan: &Plan,
    findings: &Findings,
    identities: &mut Identities,
) -> Content {
    let own = plan.study.sweep.as_ref().map_or(&[][..], |sweep| &sweep.observables.clusters);
    if plan.study.network.n_nodes() > DRAWN_NODES {
        identities.shown = None;
        return Content::Lines(spectrum(findings));
    }
    if !own.is_empty() {
        identities.shown = None;
        let name = |(m, nodes): (usize, &Vec<usize>)| own_name(&plan.study.network, m, nodes);
        return Content::Network(network(plan, own, (1..).zip(own).map(name).collect()));
    }
    Content::Network(predicted_network(plan, findings, identities))
}

/// The network coloured by the clusters of the predicted state to be shown, grey where there is none.
pub fn predicted_network(
    plan: &Plan,
    findings: &Findings,
    identities: &Identities,
) -> NetworkPanel {
    let Some(shown) = identities.shown else {
        return network(plan, &[], Vec::new());
    };
    let state = &findings.cascade[shown];
    let mut clusters: Vec<_> =
        state.clusters.nontrivial().into_iter().zip(&identities.of_state[shown]).collect();
    // These have the first colours.
    clusters.sort_by_key(|(_, identity)| identity.colour);
    let (nodes, names): (Vec<_>, Vec<_>) =
        clusters.into_iter().map(|(nodes, identity)| (nodes, identity.name.clone())).unzip();
    NetworkPanel {
        title: range(&stretches(&findings.cascade), shown),
        ..network(plan, &nodes, names)
    }
}

/// λ_k against k.
fn spectrum(findings: &Findings) -> LinePanel {
    let eigenvalues = findings.spectrum.real_eigenvalues();
    LinePanel {
        x_label: Label::text("mode ").with_math("k"),
        y_label: Label::math("λ").subscript("k"),
        series: vec![Series {
            x: (1..=eigenvalues.len()).map(|k| k as f64).collect(),
            y: eigenvalues,
            ..Series::default()
        }],
        ..LinePanel::default()
    }
}

/// The network coloured by clusters, the first of which has the first colour.
pub fn network(plan: &Plan, clusters: &[Vec<usize>], names: Vec<Label>) -> NetworkPanel {
    let network = &plan.study.network;
    let mut cluster_of = vec![None; network.n_nodes()];
    for (cluster, nodes) in clusters.iter().enumerate() {
        nodes.iter().for_each(|&node| cluster_of[node] = Some(cluster));
    }
    let nodes = network.labels().iter().enumerate();
    let links = network.adjacency().outer_iterator().enumerate().flat_map(|(from, row)| {
        let row: Vec<_> = row.iter().map(|(to, &weight)| Link { from, to, weight }).collect();
        row.into_iter().filter(|link| link.from < link.to)
    });
    NetworkPanel {
        nodes: nodes
            .map(|(i, label)| Node { label: label.clone(), cluster: cluster_of[i] })
            .collect(),
        links: links.collect(),
        placement: match &plan.figure.layout {
            Layout::Circle => Placement::Circle,
            Layout::Force => Placement::Stress,
            Layout::Grouped => Placement::Grouped,
            Layout::At(positions) => Placement::At(positions.clone()),
        },
        cluster_labels: names,
        title: Label::default(),
    }
}
