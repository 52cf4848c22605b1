//! The network of an experiment, and whatever names its nodes or modes.

use std::collections::{HashMap, HashSet};

use graph::Network;
use graph::prepare::Report;

use eigensync::WantedModes;

use super::{ALL_PAIRS, Checker};
use crate::spec::{FigureKind, Layout, Name};
use user::{Problem, Result};

impl Checker<'_> {
    /// The network, with what its preparation did, if it can be coupled at all.
    pub(super) fn network(&self) -> Result<(Network, Vec<Report>)> {
        let (network, reports) = self.source()?;
        if network.n_nodes() == 1 {
            let message = "has one node; synchronisation needs two or more";
            return Err(self.of_network(message));
        }
        let strengths = network.strengths();
        if let Some(node) = strengths.iter().position(|strength| !strength.is_finite()) {
            let label = &network.labels()[node];
            let message = format!("has weights at node `{label}` that add up to more than 1.8e308");
            return Err(self.of_network(&message));
        }
        Ok((network, reports))
    }

    pub(super) fn label(&self, key: &str, name: &Name, network: &Network) -> Result<usize> {
        network.node(&name.0).ok_or_else(|| {
            let labels = network.labels();
            let shown: Vec<_> = labels.iter().take(8).map(String::as_str).collect();
            let more = if labels.len() > shown.len() { ", …" } else { "" };
            let message = format!("names node \"{}\", which the network does not have", name.0);
            self.problem(key, message).hint(format!("its nodes are {}{more}", shown.join(", ")))
        })
    }

    /// Clusters of node labels as lists of nodes: two nodes or more each, none twice.
    pub(super) fn clusters(
        &self,
        key: &str,
        named: &[Vec<Name>],
        network: &Network,
    ) -> Result<Vec<Vec<usize>>> {
        if named.is_empty() {
            return Ok(Vec::new());
        }
        let known = Names::of(network);
        let mut seen = HashSet::new();
        let mut clusters = Vec::new();
        for names in named {
            let mut nodes = Vec::new();
            for name in names {
                match known.nodes(&name.0) {
                    Some(of_name) => nodes.extend(of_name),
                    None => nodes.push(self.label(key, name, network)?),
                }
            }
            if nodes.len() < 2 {
                let names: Vec<_> = names.iter().map(|name| name.0.as_str()).collect();
                let message = format!(
                    "has the cluster [{}]; a cluster has two nodes or more",
                    names.join(", ")
                );
                return Err(self.problem(key, message));
            }
            if let Some(&twice) = nodes.iter().find(|&&node| !seen.insert(node)) {
                let label = &network.labels()[twice];
                let message = format!("has node \"{label}\" twice; clusters share no nodes");
                return Err(self.problem(key, message));
            }
            clusters.push(nodes);
        }
        Ok(clusters)
    }

    /// Modes, counted from 1: no more of them than there are, and none twice.
    pub(super) fn modes(&self, key: &str, modes: &[usize], most: usize) -> Result<()> {
        if let Some(mode) = modes.iter().find(|mode| !(1..=most).contains(*mode)) {
            return Err(self.modes_problem(key, *mode, most));
        }
        let mut seen = HashSet::new();
        match modes.iter().find(|mode| !seen.insert(**mode)) {
            None => Ok(()),
            Some(mode) => Err(self.problem(key, format!("has mode {mode} more than once"))),
        }
    }

    fn modes_problem(&self, key: &str, mode: usize, most: usize) -> Problem {
        self.problem(key, format!("has mode {mode}, but the modes computed are 1 to {most}"))
    }

    /// The regions are groups, and their thresholds make sense.
    pub(super) fn regions(&self, network: &Network) -> Result<()> {
        let Some(regions) = &self.experiment.regions else { return Ok(()) };
        if network.groups().is_empty() {
            return Err(self.problem("regions", "needs groups, and the network has none"));
        }
        if network.n_nodes() > ALL_PAIRS {
            let message = format!(
                "needs the errors of all pairs, kept for networks of up to {ALL_PAIRS} nodes"
            );
            return Err(self.problem("regions", message));
        }
        let bounds = [
            ("distance_within", regions.distance_within),
            ("distance_between", regions.distance_between),
            ("error_within", regions.error_within),
            ("error_between", regions.error_between),
        ];
        bounds
            .iter()
            .try_for_each(|(key, bound)| self.bound(&format!("regions.{key}"), *bound, true))?;
        self.region_ranges(regions, network.n_nodes())
    }

    /// Matrices and regions need what they show. Matrices of too many nodes are no mistake: the figure
    /// is of another kind then, as `check` foresees.
    fn figure_kind(&self, network: &Network) -> Result<()> {
        let kind = self.experiment.figure.kind;
        let regions = self.experiment.regions.is_some();
        let missing = match kind {
            FigureKind::Sweep | FigureKind::None => None,
            _ if self.experiment.sweep.is_none() => Some("a [sweep]"),
            FigureKind::Regions if !regions => Some("the thresholds of [regions]"),
            FigureKind::Regions if network.positions().is_none() => Some("positions of the nodes"),
            _ => None,
        };
        match missing {
            None => Ok(()),
            Some(what) => Err(self.problem("figure.kind", format!("needs {what}"))),
        }
    }

    /// What the figure is told of nodes, modes and couplings must exist.
    pub(super) fn figure(&self, network: &Network, spectrum: &WantedModes) -> Result<()> {
        let (figure, n_nodes) = (&self.experiment.figure, network.n_nodes());
        self.figure_kind(network)?;
        if let Layout::At(positions) = &figure.layout {
            if positions.len() != n_nodes {
                let message = format!("has {} positions for {n_nodes} nodes", positions.len());
                return Err(self.problem("figure.layout", message));
            }
            let labelled = network.labels().iter().zip(positions);
            labelled.into_iter().try_for_each(|(label, at)| self.position_range(label, *at))?;
        }
        let computed = spectrum.most_modes(n_nodes);
        if let Some(modes) = &figure.eigenvectors {
            if modes.is_empty() {
                let problem = self.problem("figure.eigenvectors", "is empty, but needs a mode");
                return Err(problem.hint("leave it out for modes 2, 3 and 4"));
            }
            self.modes("figure.eigenvectors", modes, computed)?;
        }
        self.modes(
            "figure.mark_modes",
            figure.mark_modes.as_deref().unwrap_or_default(),
            computed,
        )?;
        match figure.source_transitions.iter().find(|epsilon| !epsilon.is_finite()) {
            None => Ok(()),
            Some(epsilon) => {
                let message = format!("contains {epsilon}; its values must be finite");
                Err(self.problem("figure.source_transitions", message))
            }
        }
    }
}

/// Nodes by their labels, and groups by their names, looked up many times.
struct Names<'a> {
    nodes: HashMap<&'a str, usize>,
    groups: HashMap<&'a str, &'a [usize]>,
}

impl<'a> Names<'a> {
    fn of(network: &'a Network) -> Self {
        let labels = network.labels().iter().enumerate();
        let groups = network.groups().iter();
        Self {
            nodes: labels.map(|(node, label)| (label.as_str(), node)).collect(),
            groups: groups.map(|group| (group.name.as_str(), &group.nodes[..])).collect(),
        }
    }

    /// The node with this label or, failing that, the nodes of the group of this name.
    fn nodes(&self, name: &str) -> Option<Vec<usize>> {
        let node = self.nodes.get(name).map(|&node| vec![node]);
        node.or_else(|| self.groups.get(name).map(|nodes| nodes.to_vec()))
    }
}

/// The node with this label or, failing that, the nodes of the group of this name.
pub fn nodes_named(network: &Network, name: &Name) -> Option<Vec<usize>> {
    let group = || network.groups().iter().find(|group| group.name == name.0);
    network.node(&name.0).map(|node| vec![node]).or_else(|| Some(group()?.nodes.clone()))
}
