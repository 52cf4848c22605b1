//! Nodes by their labels and groups by their names, looked up many times.

use std::collections::{HashMap, HashSet};

use crate::{NameError, Network};

/// Labels shown of those that there are.
const SHOWN: usize = 8;

/// The labels and groups of a network.
pub struct Names<'a> {
    network: &'a Network,
    nodes: HashMap<&'a str, usize>,
    groups: HashMap<&'a str, &'a [usize]>,
}

impl<'a> Names<'a> {
    /// Of a network.
    pub fn of(network: &'a Network) -> Self {
        let labels = network.labels().iter().enumerate();
        let groups = network.groups().iter();
        Self {
            network,
            nodes: labels.map(|(node, label)| (label.as_str(), node)).collect(),
            groups: groups.map(|group| (group.name.as_str(), &group.nodes[..])).collect(),
        }
    }

    /// The node with this label.
    ///
    /// # Errors
    /// [`NameError::Unknown`] if there is none.
    pub fn node(&self, label: &str) -> Result<usize, NameError> {
        self.nodes.get(label).copied().ok_or_else(|| self.unknown(label))
    }

    /// Clusters of labels, or of names of groups, as lists of nodes: two nodes or more each, none twice.
    ///
    /// # Errors
    /// A name that is none, a cluster of fewer nodes, a node in two.
    pub fn clusters(&self, named: &[Vec<impl AsRef<str>>]) -> Result<Vec<Vec<usize>>, NameError> {
        let mut seen = HashSet::new();
        let mut clusters = Vec::new();
        for names in named {
            let mut nodes = Vec::new();
            for name in names {
                nodes.extend(self.nodes(name.as_ref())?);
            }
            if nodes.len() < 2 {
                let names = names.iter().map(|name| name.as_ref().to_owned()).collect();
                return Err(NameError::TooFew { names });
            }
            if let Some(&twice) = nodes.iter().find(|&&node| !seen.insert(node)) {
                return Err(NameError::Twice { label: self.network.labels()[twice].clone() });
            }
            clusters.push(nodes);
        }
        Ok(clusters)
    }

    /// The node with this label or, failing that, the nodes of the group of this name.
    ///
    /// # Errors
    /// [`NameError::Unknown`] if there is neither.
    pub fn nodes(&self, name: &str) -> Result<Vec<usize>, NameError> {
        if let Some(&node) = self.nodes.get(name) {
            return Ok(vec![node]);
        }
        self.groups.get(name).map(|nodes| nodes.to_vec()).ok_or_else(|| self.unknown(name))
    }

    fn unknown(&self, name: &str) -> NameError {
        let labels = self.network.labels();
        let mut known: Vec<String> = labels.iter().take(SHOWN).cloned().collect();
        known.extend((labels.len() > SHOWN).then(|| "…".to_owned()));
        NameError::Unknown { name: name.to_owned(), known }
    }
}
