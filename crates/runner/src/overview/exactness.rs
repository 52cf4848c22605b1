//! What `exact` means in a prediction, how far the clusters that are not exact are from it, which exact
//! ones they hold, and what is there by chance.

use eigensync::numbers::{four_digits, two_digits};
use eigensync::{EQUITABLE, Findings};
use std::fmt::Write;

use clustering::{ClusterKind, ClusterLabel, ClusterRule, State, StateLabels};

use super::words::{NODES, SHOWN, named};
use experiment::Plan;
use figures::grouped;

/// The lines about the exactness of a prediction.
pub fn of(plan: &Plan, findings: &Findings) -> String {
    let largest = |of: fn(&StateLabels) -> f64| findings.labels.iter().map(of).fold(0.0, f64::max);
    let tolerance = largest(|labels| labels.exact_tolerance);
    let mut text = format!(
        "\nexact: equal within {} in all unstable modes, and a cell of an equitable partition, total \
         weights to each cell equal within {EQUITABLE:e}\n",
        two_digits(tolerance)
    );
    let labels = || findings.labels.iter().flat_map(|state| &state.labels);
    let approximate = labels().filter(|label| label.kind == ClusterKind::Approximate);
    let worst = approximate.map(|label| (label.spread, label.deviation));
    if let Some((spread, deviation)) = worst.reduce(|a, b| (a.0.max(b.0), a.1.max(b.1))) {
        line(
            &mut text,
            format_args!(
                "the other clusters are approximate: their nodes are up to {} apart in the unstable \
                 modes, their total weights differ by up to {} of a node's strength",
                two_digits(spread),
                two_digits(deviation)
            ),
        );
    }
    if let ClusterRule::Threshold(threshold) = plan.study.rule {
        text.push_str(&beyond(threshold, labels()));
    }
    text.push_str(&parts(plan, findings));
    for state in &findings.cascade {
        text.push_str(&by_chance(state));
    }
    text
}

/// Clusters whose nodes are linked through others only.
fn beyond<'a>(threshold: f64, labels: impl Iterator<Item = &'a ClusterLabel>) -> String {
    let beyond =
        labels.filter(|label| label.exceeds_threshold == Some(true)).map(|label| label.spread);
    let (n_beyond, widest) = beyond.fold((0, 0.0), |(n, widest), x| (n + 1, f64::max(widest, x)));
    if n_beyond == 0 {
        return String::new();
    }
    let clusters = if n_beyond == 1 { "cluster is a chain" } else { "clusters are chains" };
    format!(
        "{} {clusters}: nodes up to {} apart, beyond the threshold of {}\n",
        grouped(n_beyond),
        two_digits(widest),
        four_digits(threshold)
    )
}

/// Approximate clusters with the exact ones that they hold.
fn parts(plan: &Plan, findings: &Findings) -> String {
    let mut text = String::new();
    let mut n_more = 0;
    for (state, labels) in findings.cascade.iter().zip(&findings.labels) {
        if labels.labels.iter().all(|label| label.n_exact_parts == 0) {
            continue;
        }
        let clusters = state.clusters.clusters();
        for (nodes, label) in clusters.iter().zip(&labels.labels) {
            if label.n_exact_parts == 0 {
                continue;
            }
            if text.lines().count() >= SHOWN {
                n_more += 1;
                continue;
            }
            let parts: Vec<String> =
                state.exact_parts(nodes).iter().take(NODES).map(|part| named(plan, part)).collect();
            let more = if label.n_exact_parts > parts.len() { " …" } else { "" };
            let clusters = if label.n_exact_parts == 1 { "cluster" } else { "clusters" };
            line(
                &mut text,
                format_args!(
                    "{}: {} is approximate, holds {} exact {clusters}: {}{more}",
                    below(state),
                    named(plan, nodes),
                    grouped(label.n_exact_parts),
                    parts.join(" "),
                ),
            );
        }
    }
    if n_more > 0 {
        line(&mut text, format_args!("… and {} more that hold exact clusters", grouped(n_more)));
    }
    text
}

/// The clusters of a state that chance explains.
fn by_chance(state: &State) -> String {
    let Some(chance) = state.coincidences else { return String::new() };
    format!(
        "{}: {} groups of nodes agree within the accuracy of the modes, as chance would have it \
         ({} coincidences, {} expected); they are no clusters\n",
        below(state),
        grouped(chance.n_clusters),
        grouped(chance.found),
        grouped(chance.expected.round() as usize)
    )
}

fn below(state: &State) -> String {
    match state.epsilon.1 {
        Some(to) => format!("below {}", four_digits(to)),
        None => format!("above {}", four_digits(state.epsilon.0)),
    }
}

fn line(text: &mut String, what: std::fmt::Arguments<'_>) {
    writeln!(text, "{what}").expect("a string takes every line");
}
