//! Predicted beside simulated onsets: a row for each predicted cluster, from strong coupling down.

use std::fmt::Write;

use clustering::{CascadeTree, State, TreeCluster};
use comfy_table::Table;
use comfy_table::presets::NOTHING;

use super::words::{SHOWN, named};
use eigensync::Findings;
use eigensync::numbers::with_error;
use eigensync::numbers::{four_digits, two_digits};
use eigensync::{End, Known, Seen, Simulated};
use experiment::Plan;

/// A cluster as it was predicted and seen.
struct Row {
    nodes: Vec<usize>,
    /// The range of ε in which its nodes are predicted to be together.
    predicted: (f64, Option<f64>),
    seen: Seen,
}

/// The rows of all clusters, as far as there is room; none without a sweep that observed all pairs.
pub fn of(plan: &Plan, findings: &Findings) -> Option<String> {
    plan.study.sweep.as_ref().filter(|sweep| sweep.observables.pairs)?;
    let simulated = findings.simulated.as_ref()?;
    let mut clusters: Vec<&TreeCluster> = findings
        .trees
        .iter()
        .flat_map(|tree| tree.clusters.iter().filter(|c| parts(tree, c)))
        .collect();
    if clusters.is_empty() {
        return None;
    }
    clusters.sort_by(|a, b| b.epsilon.0.total_cmp(&a.epsilon.0));
    let mut table = Table::new();
    table.load_style(NOTHING);
    table.set_header(["cluster", "predicted for epsilon", "seen from", "to", "runs that escaped"]);
    let rows = clusters.iter().take(SHOWN).filter_map(|cluster| row(findings, cluster));
    for Row { nodes, predicted, seen } in rows {
        let [from, to] = [&seen.onset, &seen.end].map(end);
        table.add_row([
            named(plan, &nodes),
            range(findings, predicted),
            from,
            to,
            escaped(simulated, predicted),
        ]);
    }
    let mut text = format!("{table}\n");
    if clusters.len() > SHOWN {
        let more = clusters.len() - SHOWN;
        writeln!(text, "… and {more} more clusters").expect("a string takes every line");
    }
    Some(text)
}

/// Whether a cluster comes apart where its range ends, rather than stays together and is no longer
/// exact: then it is followed by itself.
fn parts(tree: &CascadeTree, cluster: &TreeCluster) -> bool {
    !tree.clusters[cluster.children.clone()].iter().any(|part| part.size == cluster.size)
}

fn row(findings: &Findings, cluster: &TreeCluster) -> Option<Row> {
    let last = cluster.states.end - 1;
    let of = findings.cascade[last].clusters.cluster_of();
    let nodes: Vec<usize> =
        (0..of.len()).filter(|&node| of[node] == of[cluster.first_node]).collect();
    let is_together = |state: &&State| {
        let of = state.clusters.cluster_of();
        nodes.iter().all(|&node| of[node] == of[nodes[0]])
    };
    let first = findings.cascade[..=last].iter().rev().take_while(is_together).last()?;
    let seen = findings.state_seen(last, std::slice::from_ref(&nodes))?;
    Some(Row { predicted: (cluster.epsilon.0, first.epsilon.1), nodes, seen })
}

/// A predicted range with the errors of its ends.
fn range(findings: &Findings, (from, to): (f64, Option<f64>)) -> String {
    let shown = |epsilon: f64| {
        let transition = findings.transition_at(epsilon);
        transition.map_or_else(|| four_digits(epsilon), |t| with_error(epsilon, t.standard_error))
    };
    match to {
        Some(to) => format!("{} to {}", shown(from), shown(to)),
        None => format!("above {}", shown(from)),
    }
}

/// How many runs in a range escaped, where there are runs.
fn escaped(simulated: &Simulated, (from, to): (f64, Option<f64>)) -> String {
    let is_inside = |epsilon: f64| epsilon > from && to.is_none_or(|to| epsilon <= to);
    let inside = (0..simulated.epsilon.len()).filter(|&at| is_inside(simulated.epsilon[at]));
    let (runs, escaped) = inside.fold((0, 0), |(runs, escaped), at| {
        (runs + simulated.seeds.len(), escaped + simulated.escaped(at))
    });
    if runs == 0 { String::new() } else { format!("{escaped} of {runs}") }
}

/// An end of a range as far as it is known.
fn end(end: &End) -> String {
    let limit = || end.limit.map_or_else(String::new, four_digits);
    let text = match end.bound {
        Known::Measured => {
            let mean = end.mean.map_or_else(String::new, four_digits);
            let error = end.uncertainty().map_or_else(String::new, two_digits);
            format!("{mean} ± {error}")
        }
        Known::AtMost => format!("at most {}", limit()),
        Known::AtLeast => format!("at least {}", limit()),
        Known::Groups => end.groups.iter().map(ToString::to_string).collect::<Vec<_>>().join(", "),
        Known::Unseen => match end.of_seeds.iter().flatten().count() {
            0 => "not seen".into(),
            seen => format!("not seen in every seed, measured in {seen} of {}", end.of_seeds.len()),
        },
        Known::Escaped => "escaped".into(),
        Known::NotSwept => "not swept".into(),
    };
    match end.n_escaped {
        0 => text,
        _ if end.bound == Known::Escaped => text,
        escaped => format!("{text}, where {escaped} of {} escaped", end.of_seeds.len()),
    }
}
