//! Counts of the network as it was prepared.

use crate::Number;
use crate::found::Found;

/// Its nodes, or those of the groups whose names begin so.
pub fn nodes(found: &Found<'_>) -> Vec<Number> {
    let network = &found.study.network;
    let nodes = match &found.at.group_prefix {
        None => network.n_nodes(),
        Some(prefix) => {
            let groups = network.groups().iter().filter(|group| group.name.starts_with(prefix));
            groups.map(|group| group.nodes.len()).sum()
        }
    };
    vec![Number::exactly(nodes as f64)]
}

/// Its links.
pub fn links(found: &Found<'_>) -> Vec<Number> {
    vec![Number::exactly(found.study.network.n_links() as f64)]
}

/// Its groups.
pub fn groups(found: &Found<'_>) -> Vec<Number> {
    vec![Number::exactly(found.study.network.groups().len() as f64)]
}
