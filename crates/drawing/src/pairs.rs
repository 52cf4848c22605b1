//! Figures of predictions above simulations, one column for each ε: matrices of δe_ij and δx_ij
//! (the paper's Figs. 2 to 4). Nodes stand in the order of their groups or, where there are none, of
//! the predicted clusters, so that what is together is seen together.

use clustering::{Correlation, EigenvectorDistance};
use eigensync::numbers::plain;
use eigensync::{Agreement, Findings, Predicted, Simulated};

use crate::identity::Identities;
use crate::order::{self, Order};
use experiment::Plan;
use figures::{
    Comparison, Figure, Group, HeatMapPanel, Label, Mode, NetworkPanel, components_panel,
};

/// Modes whose eigenvectors are drawn where the experiment does not say.
const DEFAULT_MODES: std::ops::RangeInclusive<usize> = 2..=4;

/// The network, its eigenvectors, and for each ε (the largest first) both matrices.
pub fn matrices(plan: &Plan, findings: &Findings, simulated: &Simulated) -> Figure {
    let columns: Vec<usize> = shown(simulated).collect();
    let epsilons: Vec<f64> = columns.iter().map(|&at| simulated.epsilon[at]).collect();
    let states: Vec<Option<usize>> = epsilons.iter().map(|&e| order::state(findings, e)).collect();
    let first = states.iter().flatten().copied().find(|&state| order::is_parted(findings, state));
    let identities = Identities::showing(plan, findings, first);
    let order = Order::of(plan, findings, &states);
    let groups: Vec<Vec<Group>> =
        states.iter().map(|&state| order.groups(plan, findings, &identities, state)).collect();
    let vectors = findings.spectrum.real_modes().eigenvectors;
    let modes: Vec<Mode> = shown_modes(plan, findings)
        .into_iter()
        .filter_map(|mode| {
            let components = order.arranged(vectors.get(mode - 1)?);
            Some(Mode { label: Label::math("v").subscript(&mode.to_string()), components })
        })
        .collect();
    let matrices = columns.iter().zip(&groups).map(|(&position, groups)| {
        let agreement = findings.agreement.get(position);
        let both = [
            predicted(plan, findings, simulated, position),
            errors(plan, simulated, agreement, position),
        ];
        both.map(|panel| HeatMapPanel {
            values: order.arranged_pairs(&panel.values),
            groups: groups.clone(),
            ..panel
        })
    });
    let mut eigenvectors = components_panel(&modes, groups.first().map_or(&[], Vec::as_slice));
    if !order.is_of_nodes() {
        eigenvectors.x_label = Label::text("place in the order of clusters");
    }
    Comparison {
        title: plan.title.clone(),
        network: network(plan, findings, &identities),
        eigenvectors,
        matrices: matrices.collect(),
    }
    .figure()
}

/// The network coloured by its groups, which keep their names, else by predicted clusters.
fn network(plan: &Plan, findings: &Findings, identities: &Identities) -> NetworkPanel {
    let groups = plan.study.network.groups();
    if groups.is_empty() {
        return crate::network::predicted_network(plan, findings, identities);
    }
    let nodes: Vec<Vec<usize>> = groups.iter().map(|group| group.nodes.clone()).collect();
    let names = groups.iter().map(|group| Label::text(group.name.as_str()));
    crate::network::network(plan, &nodes, names.collect())
}

/// The positions of a sweep that have a column, the largest ε first, as the paper orders its panels.
pub fn shown(simulated: &Simulated) -> impl Iterator<Item = usize> {
    crate::room::columns(simulated.epsilon.len()).into_iter()
}

/// The modes asked for, else those of [`DEFAULT_MODES`] that were computed, or the only one.
fn shown_modes(plan: &Plan, findings: &Findings) -> Vec<usize> {
    let computed = findings.spectrum.n_modes();
    plan.figure.eigenvectors.clone().unwrap_or_else(|| {
        let modes: Vec<usize> = DEFAULT_MODES.filter(|&mode| mode <= computed).collect();
        if modes.is_empty() { vec![1] } else { modes }
    })
}

/// δe_ij; zeros only where it was computed that no mode is unstable, and a word elsewhere.
fn predicted(
    plan: &Plan,
    findings: &Findings,
    simulated: &Simulated,
    position: usize,
) -> HeatMapPanel {
    let n_nodes = plan.study.network.n_nodes();
    let uniform = |value: f64| vec![value; n_nodes * n_nodes];
    let of = findings.agreement.get(position).map_or(&Predicted::NotReached, |a| &a.predicted);
    let (values, word) = match of {
        Predicted::Uncoupled => (uniform(f64::NAN), "uncoupled"),
        Predicted::NotReached => (uniform(f64::NAN), "not predicted"),
        Predicted::AllTogether => (uniform(0.0), ""),
        Predicted::Unstable(_) => {
            let distance = distance(findings, position);
            (distance.map_or_else(|| uniform(f64::NAN), |distance| distance.matrix()), "")
        }
    };
    HeatMapPanel {
        title: epsilon(simulated.epsilon[position]),
        n_nodes,
        values,
        range: None,
        bar_label: Label::math("δe").subscript("ij"),
        without_values: Label::text(word),
        groups: Vec::new(),
    }
}

/// δe_ij over the modes that are unstable at one ε of the sweep; none where there are none, or none
/// are known.
pub fn distance(findings: &Findings, position: usize) -> Option<EigenvectorDistance> {
    let predicted = &findings.agreement.get(position)?.predicted;
    predicted.distance(&findings.spectrum).expect("it could be computed for the agreement")
}

fn errors(
    plan: &Plan,
    simulated: &Simulated,
    agreement: Option<&Agreement>,
    position: usize,
) -> HeatMapPanel {
    let correlation = agreement.and_then(|agreement| agreement.correlation);
    HeatMapPanel {
        title: error_title(simulated, correlation, position),
        n_nodes: plan.study.network.n_nodes(),
        values: error_matrix(plan, simulated, position),
        range: None,
        bar_label: Label::math("δx").subscript("ij"),
        without_values: Label::text(format!("all runs {}", simulated.broke_off())),
        groups: Vec::new(),
    }
}

/// The correlation with δe_ij, and of how many runs the means are if some came to no end.
fn error_title(simulated: &Simulated, correlation: Option<Correlation>, position: usize) -> Label {
    let n_runs = simulated.seeds.len();
    let lost = match simulated.broken_off(position) {
        lost if lost == 0 || lost == n_runs => None,
        lost => Some(format!("{lost} of {n_runs} runs {}", simulated.broke_off())),
    };
    match (correlation.map(|correlation| correlation.pearson), lost) {
        (Some(r), None) => Label::math("r").with_text(format!(" = {r:.2}")),
        (Some(r), Some(lost)) => Label::math("r").with_text(format!(" = {r:.2}, {lost}")),
        (None, lost) => Label::text(lost.unwrap_or_default()),
    }
}

/// δx_ij row by row; NaN where every run escaped.
pub fn error_matrix(plan: &Plan, simulated: &Simulated, position: usize) -> Vec<f64> {
    let n_nodes = plan.study.network.n_nodes();
    let pairs = simulated.mean_pairs(position);
    let error = |i, j| pairs.as_ref().map_or(f64::NAN, |pairs| pairs.of(i, j));
    (0..n_nodes).flat_map(|i| (0..n_nodes).map(move |j| (i, j))).map(|(i, j)| error(i, j)).collect()
}

pub fn epsilon(value: f64) -> Label {
    Label::math("ε").with_math(&format!(" = {}", plain(value)))
}
