//! Names of nodes and groups, as files write them and as people read them.

use std::collections::BTreeSet;
use std::fmt;

use graph::Network;
use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

/// A node label, written as a text or as a whole number.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Name(pub String);

impl AsRef<str> for Name {
    fn as_ref(&self) -> &str {
        &self.0
    }
}

impl<'de> Deserialize<'de> for Name {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Label;
        impl Visitor<'_> for Label {
            type Value = Name;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a node label: a text or a whole number")
            }
            fn visit_str<E: Error>(self, label: &str) -> Result<Name, E> {
                Ok(Name(label.to_owned()))
            }
            fn visit_i64<E: Error>(self, label: i64) -> Result<Name, E> {
                Ok(Name(label.to_string()))
            }
        }
        deserializer.deserialize_any(Label)
    }
}

/// Clusters of nodes as clusters of labels.
pub fn labelled<'a>(clusters: &[Vec<usize>], network: &'a Network) -> Vec<Vec<&'a str>> {
    let label = |&node: &usize| network.labels()[node].as_str();
    clusters.iter().map(|cluster| cluster.iter().map(label).collect()).collect()
}

/// Clusters of nodes as people name them: whole groups by their names, other nodes by their labels.
pub fn named<'a>(clusters: &[Vec<usize>], network: &'a Network) -> Vec<Vec<&'a str>> {
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
