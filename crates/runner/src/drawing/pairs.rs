//! Figures of predictions above simulations, one column for each ε: matrices of δe_ij and δx_ij
//! (the paper's Figs. 2 to 4), or nodes in space coloured by clusters of regions (its Fig. 5).

use clustering::{Correlation, EigenvectorDistance, Partition, maximum_overlap};

use crate::agreement::{Agreement, Predicted, Regions};
use crate::findings::Findings;
use crate::plan::Plan;
use crate::problem::plain;
use crate::simulated::Simulated;
use figures::{
    Comparison, Content, Figure, Group, HeatMapPanel, Label, Mode, NetworkPanel, PositionsPanel,
    components_panel, pairs_figure,
};

/// Modes whose eigenvectors are drawn where the experiment does not say.
const DEFAULT_MODES: std::ops::RangeInclusive<usize> = 2..=4;

/// The network, its eigenvectors, and for each ε (the largest first) both matrices.
pub fn matrices(plan: &Plan, findings: &Findings, simulated: &Simulated) -> Figure {
    let modes: Vec<Mode> = shown_modes(plan, findings)
        .into_iter()
        .filter_map(|mode| {
            let components = findings.spectrum.eigenvectors.get(mode - 1)?.clone();
            Some(Mode { label: Label::math("v").subscript(&mode.to_string()), components })
        })
        .collect();
    let groups = groups(plan);
    let matrices = shown(simulated).map(|position| {
        let agreement = findings.agreement.get(position);
        [
            predicted(plan, findings, simulated, position),
            errors(plan, simulated, agreement, position),
        ]
    });
    Comparison {
        title: plan.experiment.title.clone(),
        network: grouped_network(plan),
        eigenvectors: components_panel(&modes, &groups),
        matrices: matrices.collect(),
    }
    .figure()
}

/// The network coloured by its groups, which keep their names.
fn grouped_network(plan: &Plan) -> NetworkPanel {
    let groups = plan.network.groups();
    let nodes: Vec<Vec<usize>> = groups.iter().map(|group| group.nodes.clone()).collect();
    let names = groups.iter().map(|group| Label::text(group.name.as_str()));
    super::network(plan, &nodes, names.collect())
}

/// Nodes at their places, coloured by predicted clusters above simulated ones.
pub fn regions(plan: &Plan, findings: &Findings, simulated: &Simulated) -> Figure {
    let positions = plan.network.positions().unwrap_or_default();
    let panel = |position: usize, clusters: Vec<Option<usize>>, grey: &str| {
        Content::Positions(PositionsPanel {
            title: epsilon(simulated.epsilon[position]),
            positions: positions.to_vec(),
            clusters,
            grey_label: Label::text(grey),
        })
    };
    let columns = shown(simulated).map(|position| {
        let agreement = findings.agreement.get(position);
        if let Some(regions) = agreement.and_then(|agreement| agreement.regions.as_ref()) {
            return colours(regions)
                .map(|clusters| panel(position, clusters, "not synchronisable"));
        }
        // Nothing to tell nodes apart by, or nothing to compare: the word says which.
        let grey = |word| panel(position, vec![None; positions.len()], word);
        let of = agreement.map_or(&Predicted::NotReached, |agreement| &agreement.predicted);
        let predicted = match of {
            Predicted::Uncoupled => grey("uncoupled"),
            Predicted::NotReached => grey("not predicted"),
            Predicted::AllTogether => panel(position, vec![Some(0); positions.len()], ""),
            Predicted::Unstable(_) => grey("not compared"),
        };
        let escaped = simulated.bounded(position) == 0;
        [predicted, grey(if escaped { "all runs escaped" } else { "not compared" })]
    });
    pairs_figure(plan.experiment.title.clone(), columns.collect())
}

/// Colours of nodes on both sides: predicted clusters by falling size, and for each simulated cluster
/// the colour of the predicted one that it overlaps most.
fn colours(regions: &Regions) -> [Vec<Option<usize>>; 2] {
    let sides = [regions.predicted.cluster_of_node(), regions.simulated.cluster_of_node()];
    let [predicted, simulated] = &sides;
    let (one, other): (Vec<usize>, Vec<usize>) =
        predicted.iter().zip(simulated).filter_map(|(a, b)| a.zip(*b)).unzip();
    let matches =
        maximum_overlap(&Partition::from_marks(&one), &Partition::from_marks(&other)).matches;
    // Partitions number clusters by their first node.
    let (one, other) = (in_order_of_appearance(&one), in_order_of_appearance(&other));
    let of_predicted = by_falling_size(predicted, regions.predicted.n_clusters());
    let mut of_simulated = vec![None; regions.simulated.n_clusters()];
    for (a, b) in matches {
        of_simulated[other[b]] = Some(of_predicted[one[a]]);
    }
    let unmatched = by_falling_size(simulated, regions.simulated.n_clusters());
    let next = |cluster: usize| of_predicted.len() + unmatched[cluster];
    let of_simulated: Vec<usize> = of_simulated
        .into_iter()
        .enumerate()
        .map(|(cluster, colour)| colour.unwrap_or_else(|| next(cluster)))
        .collect();
    let coloured = |nodes: &[Option<usize>], colours: &[usize]| {
        nodes.iter().map(|cluster| cluster.map(|cluster| colours[cluster])).collect()
    };
    [coloured(predicted, &of_predicted), coloured(simulated, &of_simulated)]
}

/// Every mark once, in the order in which marks appear.
fn in_order_of_appearance(marks: &[usize]) -> Vec<usize> {
    let mut seen = Vec::new();
    for &mark in marks {
        if !seen.contains(&mark) {
            seen.push(mark);
        }
    }
    seen
}

/// The place of each cluster among all of them by falling size.
fn by_falling_size(cluster_of: &[Option<usize>], n_clusters: usize) -> Vec<usize> {
    let mut sizes = vec![0; n_clusters];
    cluster_of.iter().flatten().for_each(|&cluster| sizes[cluster] += 1);
    let mut order: Vec<usize> = (0..n_clusters).collect();
    order.sort_by_key(|&cluster| std::cmp::Reverse(sizes[cluster]));
    let mut place = vec![0; n_clusters];
    for (rank, cluster) in order.into_iter().enumerate() {
        place[cluster] = rank;
    }
    place
}

/// The positions of a sweep that have a column, the largest ε first, as the paper orders its panels.
fn shown(simulated: &Simulated) -> impl Iterator<Item = usize> {
    super::room::columns(simulated.epsilon.len()).into_iter()
}

/// The modes asked for, else those of [`DEFAULT_MODES`] that were computed, or the only one.
fn shown_modes(plan: &Plan, findings: &Findings) -> Vec<usize> {
    let computed = findings.spectrum.eigenvectors.len();
    plan.figure().eigenvectors.clone().unwrap_or_else(|| {
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
    let n_nodes = plan.network.n_nodes();
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
        groups: groups(plan),
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
        n_nodes: plan.network.n_nodes(),
        values: error_matrix(plan, simulated, position),
        range: None,
        bar_label: Label::math("δx").subscript("ij"),
        without_values: Label::text(format!("all runs {}", simulated.broke_off())),
        groups: groups(plan),
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
    Label::math("ε").with_math(&format!(" = {}", plain(value)))
}
