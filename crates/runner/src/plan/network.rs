//! The network of an experiment, and whatever names its nodes or modes.

use std::collections::BTreeSet;
use std::path::Path;

use graph::Network;

use super::Checker;
use crate::problem::{Problem, Result};
use crate::spec::{Format, Layout, Name, NetworkSpec};

impl Checker<'_> {
    pub(super) fn network(&self) -> Result<Network> {
        let NetworkSpec::File(spec) = &self.experiment.network;
        let path = self.file.parent().unwrap_or(Path::new("")).join(&spec.path);
        let named = |message: String| {
            self.problem("network.file.path", format!("names {}{message}", path.display()))
        };
        let source = std::fs::File::open(&path).map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound => named(", which does not exist".into())
                .hint("paths are relative to the folder of the experiment file"),
            _ => named(format!(", which cannot be opened: {error}")),
        })?;
        if path.is_dir() {
            return Err(named(", which is a folder; expected a file of links".into()));
        }
        let read = match spec.format {
            Format::EdgeList => graph::formats::edge_list::read(source),
        };
        let network = read.map_err(|error| named(format!(": {error}")))?;
        if network.n_nodes() == 1 {
            let message = ", a network of one node; synchronisation needs two or more";
            return Err(named(message.into()));
        }
        let strengths = network.strengths();
        if let Some(node) = strengths.iter().position(|strength| !strength.is_finite()) {
            let label = &network.labels()[node];
            let message = format!(": the weights of node `{label}` add up to more than 1.8e308");
            return Err(named(message));
        }
        Ok(network)
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
        let mut seen = BTreeSet::new();
        let mut clusters = Vec::new();
        for names in named {
            let nodes: Vec<usize> =
                names.iter().map(|name| self.label(key, name, network)).collect::<Result<_>>()?;
            if nodes.len() < 2 {
                let names: Vec<_> = names.iter().map(|name| name.0.as_str()).collect();
                let message = format!(
                    "has the cluster [{}]; a cluster has two nodes or more",
                    names.join("")
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

    /// Modes, counted from 1: no more of them than there are.
    pub(super) fn modes(&self, key: &str, modes: &[usize], most: usize) -> Result<()> {
        match modes.iter().find(|mode| !(1..=most).contains(*mode)) {
            None => Ok(()),
            Some(mode) => Err(self.modes_problem(key, *mode, most)),
        }
    }

    fn modes_problem(&self, key: &str, mode: usize, most: usize) -> Problem {
        self.problem(key, format!("has mode {mode}, but the modes computed are 1 to {most}"))
    }

    /// What the figure is told of nodes, modes and couplings must exist.
    pub(super) fn figure(&self, network: &Network) -> Result<()> {
        let (figure, n_nodes) = (&self.experiment.figure, network.n_nodes());
        if let Layout::At(positions) = &figure.layout {
            if positions.len() != n_nodes {
                let message = format!("has {} positions for {n_nodes} nodes", positions.len());
                return Err(self.problem("figure.layout", message));
            }
            if let Some(node) = positions.iter().flatten().position(|x| !x.is_finite()) {
                let label = &network.labels()[node / 2];
                let message = format!("has a position of node \"{label}\" that is not finite");
                return Err(self.problem("figure.layout", message));
            }
        }
        self.modes("figure.mark_modes", figure.mark_modes.as_deref().unwrap_or_default(), n_nodes)?;
        match figure.source_transitions.iter().find(|epsilon| !epsilon.is_finite()) {
            None => Ok(()),
            Some(epsilon) => {
                let message = format!("contains {epsilon}; its values must be finite");
                Err(self.problem("figure.source_transitions", message))
            }
        }
    }
}
