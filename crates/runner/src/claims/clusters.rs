//! Claims about clusters: which there are, in which order they are lost, and their names.

use std::collections::BTreeSet;

use clustering::{Partition, RegionClusters};
use graph::Network;
use serde_json::{Value, json};

use super::Judge;
use crate::plan::nodes_named;
use crate::problem::Result;
use crate::spec::{Name, Quantity};

impl Judge<'_> {
    pub(super) fn clusters(&self) -> Result<(Value, Value, String, bool)> {
        let paper: Vec<Vec<Name>> = self.equals("a list of clusters")?;
        let obtained = self.epsilon().first().and_then(|&epsilon| self.clusters_at(epsilon));
        let stated: BTreeSet<BTreeSet<usize>> =
            self.nodes(&paper).into_iter().map(|cluster| cluster.into_iter().collect()).collect();
        let Some(clusters) = obtained else {
            return Ok((json!(texts(&paper)), Value::Null, "exact".into(), false));
        };
        let found = clusters.iter().map(|cluster| cluster.iter().copied().collect()).collect();
        let shown = named(&clusters, &self.plan.network);
        Ok((json!(texts(&paper)), json!(shown), "exact".into(), stated == found))
    }

    fn clusters_at(&self, epsilon: f64) -> Option<Vec<Vec<usize>>> {
        let findings = self.findings;
        if self.spec.of == Quantity::CascadeClusters {
            return findings.predicted_at(epsilon).map(Partition::nontrivial);
        }
        let simulated = findings.simulated.as_ref()?;
        let position = simulated.position(epsilon)?;
        let regions = || findings.agreement.get(position)?.regions.as_ref();
        match self.spec.of {
            Quantity::PredictedRegions => Some(self.of_regions(&regions()?.predicted)),
            Quantity::SimulatedRegions => Some(self.of_regions(&regions()?.simulated)),
            _ => simulated.clusters(position).map(|clusters| clusters.nontrivial()),
        }
    }

    /// Clusters of regions as clusters of their nodes.
    fn of_regions(&self, clusters: &RegionClusters) -> Vec<Vec<usize>> {
        let groups = self.plan.network.groups();
        let nodes = |regions: Vec<usize>| {
            regions.iter().flat_map(|&region| groups[region].nodes.iter().copied()).collect()
        };
        clusters.clusters().into_iter().map(nodes).collect()
    }

    /// Positions of the clusters, from 1, in the order in which they are lost as ε falls.
    pub(super) fn order(&self) -> Result<(Value, Value, String, bool)> {
        let paper: Vec<usize> = self.equals("a list of positions")?;
        let clusters = self.nodes(self.spec.at.clusters.as_deref().unwrap_or_default());
        let lost_at = |cluster: &Vec<usize>| match self.spec.of {
            Quantity::CascadeOrder => self.findings.predicted_loss(cluster),
            _ => self
                .findings
                .simulated
                .as_ref()
                .and_then(|s| s.onset(std::slice::from_ref(cluster)).mean),
        };
        let lost: Option<Vec<f64>> = clusters.iter().map(lost_at).collect();
        let Some(lost) = lost else {
            return Ok((json!(paper), Value::Null, "exact".into(), false));
        };
        let mut order: Vec<usize> = (1..=clusters.len()).collect();
        order.sort_by(|a, b| lost[b - 1].total_cmp(&lost[a - 1]));
        let holds = order == paper;
        Ok((json!(paper), json!(order), "exact".into(), holds))
    }

    /// Node numbers of labels that the plan has checked.
    pub(super) fn nodes(&self, clusters: &[Vec<Name>]) -> Vec<Vec<usize>> {
        let network = &self.plan.network;
        let nodes = |cluster: &Vec<Name>| {
            cluster.iter().filter_map(|name| nodes_named(network, name)).flatten().collect()
        };
        clusters.iter().map(nodes).collect()
    }
}

fn texts(clusters: &[Vec<Name>]) -> Vec<Vec<&str>> {
    clusters.iter().map(|cluster| cluster.iter().map(|name| name.0.as_str()).collect()).collect()
}

/// Clusters of nodes as people name them: whole groups by their names, other nodes by their labels.
fn named<'a>(clusters: &[Vec<usize>], network: &'a Network) -> Vec<Vec<&'a str>> {
    let of_cluster = |cluster: &Vec<usize>| {
        let mut left: BTreeSet<usize> = cluster.iter().copied().collect();
        let mut names = Vec::new();
        for group in network.groups() {
            if group.nodes.iter().all(|node| left.contains(node)) {
                group.nodes.iter().for_each(|node| _ = left.remove(node));
                names.push(group.name.as_str());
            }
        }
        names.extend(left.into_iter().map(|node| network.labels()[node].as_str()));
        names
    };
    clusters.iter().map(of_cluster).collect()
}

/// Clusters of nodes as clusters of labels.
pub fn labelled<'a>(clusters: &[Vec<usize>], network: &'a Network) -> Vec<Vec<&'a str>> {
    let label = |&node: &usize| network.labels()[node].as_str();
    clusters.iter().map(|cluster| cluster.iter().map(label).collect()).collect()
}
