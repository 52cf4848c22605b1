//! Figures of predictions above simulations, one column for each ε: matrices of δe_ij and δx_ij
//! (the paper's Figs. 2 to 4), or nodes in space coloured by clusters of regions (its Fig. 5).

use crate::agreement::Agreement;
use crate::figures::{
    Comparison, Content, Figure, Group, HeatMapPanel, Label, Mode, PositionsPanel,
    components_panel, pairs_figure,
};
use crate::findings::Findings;
use crate::plan::Plan;
use crate::simulated::Simulated;

/// The network, its eigenvectors, and for each ε (the largest first) both matrices.
pub fn matrices(plan: &Plan, findings: &Findings, simulated: &Simulated) -> Figure {
    let modes: Vec<Mode> = plan
        .figure()
        .eigenvectors
        .iter()
        .filter_map(|&mode| {
            let components = findings.spectrum.eigenvectors.get(mode - 1)?.clone();
            Some(Mode { label: Label::math("v").subscript(&mode.to_string()), components })
        })
        .collect();
    let groups = groups(plan);
    let matrices = descending(simulated).map(|position| {
        let agreement = findings.agreement.get(position);
        [
            predicted(plan, simulated, agreement, position),
            errors(plan, simulated, agreement, position),
        ]
    });
    let clusters: Vec<Vec<usize>> =
        plan.network.groups().iter().map(|group| group.nodes.clone()).collect();
    Comparison {
        title: plan.experiment.title.clone(),
        network: super::network(plan, &clusters),
        eigenvectors: components_panel(&modes, &groups),
        matrices: matrices.collect(),
    }
    .figure()
}

/// Nodes at their places, coloured by predicted clusters above simulated ones.
pub fn regions(plan: &Plan, findings: &Findings, simulated: &Simulated) -> Figure {
    let positions = plan.network.positions().unwrap_or_default();
    let panel = |position: usize, clusters: Vec<Option<usize>>| {
        Content::Positions(PositionsPanel {
            title: epsilon(simulated.epsilon[position]),
            positions: positions.to_vec(),
            clusters,
            grey_label: Label::text("not synchronisable"),
        })
    };
    let columns = descending(simulated).filter_map(|position| {
        let regions = findings.agreement.get(position)?.regions.as_ref()?;
        let sides = [regions.predicted.cluster_of_node(), regions.simulated.cluster_of_node()];
        Some(sides.map(|clusters| panel(position, clusters)))
    });
    pairs_figure(plan.experiment.title.clone(), columns.collect())
}

/// The positions of a sweep, the largest ε first, as the paper orders its panels.
fn descending(simulated: &Simulated) -> impl Iterator<Item = usize> {
    (0..simulated.epsilon.len()).rev()
}

fn predicted(
    plan: &Plan,
    simulated: &Simulated,
    agreement: Option<&Agreement>,
    position: usize,
) -> HeatMapPanel {
    let n_nodes = plan.network.n_nodes();
    let distance = agreement.and_then(|agreement| agreement.distance.as_ref());
    HeatMapPanel {
        title: epsilon(simulated.epsilon[position]),
        n_nodes,
        // With no unstable mode all nodes are predicted to be together.
        values: distance
            .map_or_else(|| vec![0.0; n_nodes * n_nodes], clustering::EigenvectorDistance::matrix),
        range: None,
        bar_label: Label::math("δe").subscript("ij"),
        groups: groups(plan),
    }
}

fn errors(
    plan: &Plan,
    simulated: &Simulated,
    agreement: Option<&Agreement>,
    position: usize,
) -> HeatMapPanel {
    let correlation = agreement.and_then(|agreement| agreement.correlation);
    HeatMapPanel {
        title: match correlation {
            Some(correlation) => {
                Label::math("r").with_text(format!(" = {:.2}", correlation.pearson))
            }
            None => Label::default(),
        },
        n_nodes: plan.network.n_nodes(),
        values: error_matrix(plan, simulated, position),
        range: None,
        bar_label: Label::math("δx").subscript("ij"),
        groups: groups(plan),
    }
}

/// δx_ij row by row; NaN where every run escaped.
pub fn error_matrix(plan: &Plan, simulated: &Simulated, position: usize) -> Vec<f64> {
    let n_nodes = plan.network.n_nodes();
    let pairs = simulated.mean_pairs(position);
    let error = |i, j| pairs.as_ref().map_or(f64::NAN, |pairs| pairs.of(i, j));
    (0..n_nodes).flat_map(|i| (0..n_nodes).map(move |j| (i, j))).map(|(i, j)| error(i, j)).collect()
}

/// The groups whose nodes are consecutive; others have no place on an axis.
fn groups(plan: &Plan) -> Vec<Group> {
    let groups = plan.network.groups().iter().filter_map(|group| {
        let (first, last) = (*group.nodes.first()?, *group.nodes.last()?);
        let consecutive = last - first + 1 == group.nodes.len();
        consecutive
            .then(|| Group { label: Label::text(group.name.as_str()), nodes: first..last + 1 })
    });
    groups.collect()
}

fn epsilon(value: f64) -> Label {
    Label::math("ε").with_math(&format!(" = {value}"))
}
