//! The network in a summary, and what its preparation did.

use experiment::Plan;
use experiment::spec::StepSpec;
use graph::prepare::Report;
use serde::Serialize;
use serde_json::Value;

/// The network after preparation.
#[derive(Serialize)]
pub struct NetworkRecord {
    /// SHA-256 of links and weights, so that a changed digit is seen as such.
    pub links_hash: String,
    /// What each step of preparation removed and left.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub preparation: Vec<StepRecord>,
    /// Its groups.
    pub groups: usize,
    /// Nodes.
    pub nodes: usize,
    /// Links.
    pub links: usize,
    /// Connected components.
    pub components: usize,
    /// Nodes without links.
    pub isolated_nodes: usize,
}

/// What a step of preparation did.
#[derive(Serialize)]
pub struct StepRecord {
    /// As experiment files say it.
    pub step: Value,
    /// Nodes that went.
    pub removed_nodes: usize,
    /// Groups that lost all of their nodes.
    pub removed_groups: Vec<String>,
    /// Links that went.
    pub removed_links: usize,
    /// Links of nodes to themselves that went.
    pub removed_self_loops: usize,
    /// Links whose weights changed.
    pub changed_links: usize,
    /// Nodes.
    pub nodes: usize,
    /// Links.
    pub links: usize,
    /// Whether what is left is directed.
    pub directed: bool,
}

/// The network of a plan.
pub fn record(plan: &Plan) -> NetworkRecord {
    let network = &plan.study.network;
    NetworkRecord {
        preparation: step_records(plan),
        groups: network.groups().len(),
        nodes: network.n_nodes(),
        links: network.n_links(),
        components: plan.study.n_components,
        isolated_nodes: network.isolated_nodes().len(),
        links_hash: plan.links_hash.clone(),
    }
}

fn step_records(plan: &Plan) -> Vec<StepRecord> {
    let record = |(step, report): &(StepSpec, Report)| StepRecord {
        step: serde_json::to_value(step).unwrap_or_default(),
        removed_nodes: report.removed_nodes.len(),
        removed_groups: report.removed_groups.clone(),
        removed_links: report.removed_links,
        removed_self_loops: report.removed_self_loops,
        changed_links: report.changed_links,
        nodes: report.n_nodes,
        links: report.n_links,
        directed: report.directed,
    };
    plan.preparation.iter().map(record).collect()
}
