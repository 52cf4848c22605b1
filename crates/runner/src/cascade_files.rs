//! The predicted cascade in files that others read: `cascade.csv`, a row for each cluster and the one
//! it came from; `clusters.csv`, a row for each node and the smallest of these that it is ever in;
//! `cascade.nwk`, the same trees in Newick's format, as programs for phylogenies read it.
//!
//! Clusters are those of two nodes or more, numbered from 1 through all trees.
//!
//! Source of the format: J. Felsenstein, "The Newick tree format" (1986); a branch is as long as the
//! range of ε in which its cluster holds.

use eigensync::Findings;
use std::io::BufWriter;

use clustering::{CascadeTree, ClusterRule, TreeCluster};

use experiment::Plan;
use results_folder::Folder;
use user::Result;
use user::text::number;

const COLUMNS: [&str; 15] = [
    "cluster",
    "parent",
    "tree",
    "nodes",
    "first_node",
    "modes",
    "epsilon_from",
    "epsilon_to",
    "critical_coupling",
    "kind",
    "spread",
    "deviation",
    "modes_to",
    "exceeds_threshold",
    "holds_exact",
];

/// Writes the three files.
pub fn write(folder: &Folder, plan: &Plan, findings: &Findings) -> Result<()> {
    let rows = numbered(findings).flat_map(|(number, first, tree)| {
        let row =
            move |(place, cluster)| row(plan, findings, [number, first + place], first, cluster);
        tree.clusters.iter().enumerate().map(row)
    });
    folder.write_table("cascade.csv", &COLUMNS.map(str::to_owned), rows)?;
    folder.write_through("clusters.csv", |out| write_nodes(out, plan, findings))?;
    folder.write("cascade.nwk", newick(findings))
}

/// The trees, each with its number from 1 and the number of its first cluster.
pub fn numbered(findings: &Findings) -> impl Iterator<Item = (usize, usize, &CascadeTree)> {
    let mut first = 1;
    (1..).zip(&findings.trees).map(move |(number, tree)| {
        let numbered = (number, first, tree);
        first += tree.clusters.len();
        numbered
    })
}

fn row(
    plan: &Plan,
    findings: &Findings,
    [tree, cluster]: [usize; 2],
    first: usize,
    of: &TreeCluster,
) -> Vec<String> {
    let optional = |value: Option<f64>| value.map_or_else(String::new, number);
    let states = findings.cascade[of.states.clone()].iter();
    let modes = |end: fn((usize, usize)) -> usize| states.clone().map(move |s| end(s.n_unstable));
    let is_under_threshold = plan.study.rule != ClusterRule::Exact;
    vec![
        cluster.to_string(),
        of.parent.map_or_else(String::new, |parent| (first + parent).to_string()),
        tree.to_string(),
        of.size.to_string(),
        plan.study.network.labels()[of.first_node].clone(),
        modes(|(least, _)| least).min().unwrap_or(0).to_string(),
        number(of.epsilon.0),
        optional(of.epsilon.1),
        optional(of.splits.then_some(of.epsilon.0)),
        of.label.map_or("", |label| label.kind.name()).to_owned(),
        optional(of.label.map(|label| label.spread)),
        optional(of.label.map(|label| label.deviation)),
        modes(|(_, most)| most).max().unwrap_or(0).to_string(),
        of.label
            .filter(|_| is_under_threshold)
            .map_or("", |label| match label.exceeds_threshold {
                Some(true) => "true",
                Some(false) => "false",
                None => "unknown",
            })
            .to_owned(),
        of.label.map_or_else(String::new, |label| label.n_exact_parts.to_string()),
    ]
}

/// The innermost cluster of every node, and below which ε the node is alone.
fn write_nodes(
    out: &mut BufWriter<std::fs::File>,
    plan: &Plan,
    findings: &Findings,
) -> std::io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(["tree", "node", "cluster", "alone_below", "exact_with"])?;
    for (number, first, tree) in numbered(findings) {
        let number = number.to_string();
        let texts: Vec<[String; 2]> = tree
            .clusters
            .iter()
            .enumerate()
            .map(|(place, cluster)| [(first + place).to_string(), self::number(cluster.epsilon.0)])
            .collect();
        let innermost = tree.innermost(&findings.cascade);
        let exact = exact_firsts(tree, findings, &innermost);
        let labels = plan.study.network.labels();
        for ((label, innermost), first) in labels.iter().zip(innermost).zip(exact) {
            let [cluster, splits] = innermost.map_or(["", ""], |place| {
                let [cluster, splits] = &texts[place];
                [cluster, if tree.clusters[place].splits { splits } else { "" }]
            });
            let first = first.map_or("", |first| &labels[first][..]);
            table.write_record([&number[..], label, cluster, splits, first])?;
        }
    }
    table.flush()
}

/// The first node of the exact cluster that holds each node as long as its innermost cluster lasts:
/// that cluster itself, or a part of it; none where the node is no part of one.
fn exact_firsts(
    tree: &CascadeTree,
    findings: &Findings,
    innermost: &[Option<usize>],
) -> Vec<Option<usize>> {
    let mut firsts = vec![None; innermost.len()];
    for number in tree.states.clone() {
        let cells = &findings.cascade[number].cells;
        let (first_nodes, sizes) = (cells.first_nodes(), cells.sizes());
        let ends_here = |place: usize| tree.clusters[place].states.end == number + 1;
        for (node, &cell) in cells.cluster_of().iter().enumerate() {
            if sizes[cell] > 1 && innermost[node].is_some_and(ends_here) {
                firsts[node] = Some(first_nodes[cell]);
            }
        }
    }
    firsts
}

/// A line for each cluster that came from no other.
fn newick(findings: &Findings) -> String {
    let mut text = String::new();
    for (_, first, tree) in numbered(findings) {
        let is_root = |place: &usize| tree.clusters[*place].parent.is_none();
        for root in (0..tree.clusters.len()).filter(is_root) {
            add_newick(&mut text, tree, first, root);
            text.push_str(";\n");
        }
    }
    text
}

/// Adds a cluster behind its parts: `(parts)number:length`. Without recursion, since a cascade may
/// have as many generations as there are modes.
fn add_newick(text: &mut String, tree: &CascadeTree, first: usize, root: usize) {
    let mut open = vec![(root, 0)];
    while let Some((place, n_done)) = open.pop() {
        let cluster = &tree.clusters[place];
        if let Some(part) = cluster.children.clone().nth(n_done) {
            text.push(if n_done == 0 { '(' } else { ',' });
            open.extend([(place, n_done + 1), (part, 0)]);
            continue;
        }
        if n_done > 0 {
            text.push(')');
        }
        text.push_str(&(first + place).to_string());
        if let (from, Some(to)) = cluster.epsilon {
            text.push(':');
            text.push_str(&number(to - from));
        }
    }
}
