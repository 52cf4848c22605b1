//! The predicted states in a summary: their ranges of ε, their clusters, and which of these are exact.

use clustering::{ClusterKind, ClusterLabel, ClusterRule, Coincidences, State, StateLabels};
use eigensync::{End, Findings, Seen};
use serde::Serialize;

use super::names::named;
use experiment::Plan;

/// Up to this many nodes a summary names the nodes of every cluster.
const LISTED_NODES: usize = 5000;

/// A predicted state.
#[derive(Serialize)]
pub struct StateRecord {
    /// Its range of ε; no upper end for the first.
    pub epsilon: (f64, Option<f64>),
    /// Those unstable anywhere in the range, and how many are so at one ε of it: the least, the most.
    pub unstable_modes: Vec<usize>,
    /// The least and the most that are unstable at one ε.
    pub n_unstable: (usize, usize),
    /// Number of clusters of two nodes or more, and of nodes in none.
    pub n_clusters: usize,
    /// Nodes in no cluster.
    pub n_alone: usize,
    /// Of the clusters of two nodes or more.
    pub n_exact: usize,
    /// Clusters that links do not keep equal.
    pub n_approximate: usize,
    /// How far apart nodes of an exact cluster may be in the unstable subspace.
    pub exact_tolerance: f64,
    /// Whether the nodes of each cluster have the same total weight to every cluster, up to rounding.
    pub equitable: bool,
    /// By how much the most unequal of them differ, relative to their strength.
    pub largest_deviation: f64,
    /// Clusters that chance alone explains: they are not among the others.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coincidences: Option<CoincidenceRecord>,
    /// These clusters, for networks of up to 5000 nodes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clusters: Option<Vec<Vec<String>>>,
    /// Their labels, in the same order.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub labels: Option<Vec<LabelRecord>>,
    /// From which ε on the simulation shows these clusters; none without simulation or clusters.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub simulated_onset: Option<End>,
    /// Up to which ε it does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub simulated_end: Option<End>,
    /// Runs of the sweep in this range of ε; none without a sweep.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub simulated_runs: Option<RunsRecord>,
}

/// Runs of a sweep, and how many of them escaped.
#[derive(Serialize)]
pub struct RunsRecord {
    /// All of them.
    pub runs: usize,
    /// Those that escaped.
    pub escaped: usize,
}

/// Whether a cluster is exact, and how far it is from that.
#[derive(Serialize)]
pub struct LabelRecord {
    /// `exact` or `approximate`.
    pub kind: &'static str,
    /// Largest δe of its first node and any other.
    pub spread: f64,
    /// Largest difference of its nodes' total weights to one cluster, relative to their strength.
    pub deviation: f64,
    /// Under a threshold, whether the largest δe exceeds it; null where that is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exceeds_threshold: Option<Option<bool>>,
    /// The exact clusters that an approximate one holds.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub holds_exact: Vec<Vec<String>>,
}

/// How many clusters and nodes chance joined, and how many pairs it was expected to.
#[derive(Serialize)]
pub struct CoincidenceRecord {
    /// Clusters of two nodes or more.
    pub n_clusters: usize,
    /// Pairs found.
    pub found: usize,
    /// Pairs expected.
    pub expected: f64,
}

pub fn records(plan: &Plan, findings: &Findings) -> Vec<StateRecord> {
    let labelled = findings.cascade.iter().zip(&findings.labels).enumerate();
    labelled.map(|(at, (state, labels))| record(plan, findings, (at, state), labels)).collect()
}

fn record(
    plan: &Plan,
    findings: &Findings,
    (at, state): (usize, &State),
    labels: &StateLabels,
) -> StateRecord {
    let is_listed = plan.study.network.n_nodes() <= LISTED_NODES;
    let clusters = is_listed.then(|| state.clusters.nontrivial());
    let n_alone = labels.count(ClusterKind::Single);
    let n_clusters = labels.labels.len() - n_alone;
    let has_pairs = plan.study.sweep.as_ref().is_some_and(|sweep| sweep.observables.pairs);
    let seen = clusters.as_ref().filter(|_| n_clusters > 0 && has_pairs);
    let seen = seen.and_then(|clusters| findings.state_seen(at, clusters));
    let (simulated_onset, simulated_end) = seen.map(|Seen { onset, end }| (onset, end)).unzip();
    let shared = labels.labels.iter().filter(|label| label.kind != ClusterKind::Single);
    let label = |(label, nodes): (&ClusterLabel, &Vec<usize>)| LabelRecord {
        kind: label.kind.name(),
        spread: label.spread,
        deviation: label.deviation,
        exceeds_threshold: (plan.study.rule != ClusterRule::Exact)
            .then_some(label.exceeds_threshold),
        holds_exact: named(&state.exact_parts(nodes), plan),
    };
    let coincidences = state.coincidences.map(|Coincidences { n_clusters, found, expected }| {
        CoincidenceRecord { n_clusters, found, expected }
    });
    StateRecord {
        epsilon: state.epsilon,
        unstable_modes: state.unstable_modes.iter().map(|mode| mode + 1).collect(),
        n_unstable: state.n_unstable,
        n_clusters,
        n_alone,
        n_exact: labels.count(ClusterKind::Exact),
        n_approximate: labels.count(ClusterKind::Approximate),
        exact_tolerance: labels.exact_tolerance,
        equitable: labels.equitability.holds(),
        largest_deviation: labels.equitability.largest_deviation(),
        coincidences,
        labels: clusters.as_ref().map(|clusters| shared.zip(clusters).map(label).collect()),
        simulated_onset,
        simulated_end,
        simulated_runs: findings.runs_in(state).map(|[runs, escaped]| RunsRecord { runs, escaped }),
        clusters: clusters.map(|clusters| named(&clusters, plan)),
    }
}
