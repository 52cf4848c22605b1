//! Counts, lists and clusters in words, as much of them as is read.

use experiment::Plan;
use user::text::one_line;

/// Modes and states shown; the results folder has them all.
pub const SHOWN: usize = 12;
/// Nodes shown of one cluster, and characters of the name of one.
pub const NODES: usize = 8;
const LABEL: usize = 24;

/// The first of some values.
pub fn abridged(values: impl Iterator<Item = String>) -> String {
    let mut shown: Vec<String> = values.take(SHOWN + 1).collect();
    if shown.len() > SHOWN {
        shown[SHOWN] = "…".into();
    }
    shown.join(", ")
}

/// A cluster by its first nodes.
pub fn named(plan: &Plan, nodes: &[usize]) -> String {
    let shown = nodes.iter().take(NODES).map(|&node| {
        let label = one_line(&plan.study.network.labels()[node]);
        match label.char_indices().nth(LABEL) {
            Some((end, _)) => format!("{}…", &label[..end]),
            None => label.into_owned(),
        }
    });
    let more = if nodes.len() > NODES { ", …" } else { "" };
    format!("{{{}{more}}}", shown.collect::<Vec<_>>().join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_are_abridged() {
        let values = |count: usize| abridged((0..count).map(|k| k.to_string()));
        assert_eq!(values(2), "0, 1");
        assert!(values(12).ends_with("10, 11"));
        assert!(values(13).ends_with("11, …"));
    }
}
