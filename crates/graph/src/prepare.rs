//! Preparation: steps from what a file holds to a network, a_ij = a_ji ≥ 0 and a_ii = 0, in the
//! order in which the caller states them, each with a report of what it removed and changed.
//!
//! The steps do not commute: a threshold before the mean of both directions drops other links than
//! one after it. The usual order is that of [`Step`].

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use crate::components::Components;
use crate::network::assemble;
use crate::{PrepareError, RawNetwork, SparseMatrix};

/// One step of preparation.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// Keeps some of the nodes and the links between them.
    Select(Selection),
    /// Sets a_ii = 0.
    DropSelfLoops,
    /// Makes a_ij = a_ji, after which the network is undirected.
    Symmetrise(Symmetrise),
    /// Drops links and self-loops whose weight is below a finite value.
    Threshold(f64),
    /// Gives every link and self-loop the weight 1.
    Binarise,
    /// Drops nodes without a link to or from another node.
    DropIsolated,
    /// Keeps the connected component with most nodes, and of equal ones the one whose first node
    /// comes first; the direction of links does not matter.
    LargestComponent,
}

/// Which nodes to keep. They come in the order stated here, each once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Selection {
    /// Blocks of nodes, numbered from 0, the end excluded.
    Ranges(Vec<Range<usize>>),
    /// Nodes by their labels.
    Labels(Vec<String>),
}

/// What becomes of a_ij and a_ji, 0 where there is no link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetrise {
    /// 1 where a_ij > 0 or a_ji > 0.
    Union,
    /// (a_ij + a_ji) / 2.
    Mean,
    /// The larger of both.
    Max,
}

/// What a step removed and changed, and what it left.
///
/// Links leave out self-loops. They are entries a_ij where the network is directed after the step,
/// and pairs of linked nodes where it is not.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The step.
    pub step: Step,
    /// Labels of the nodes that went, in node order.
    pub removed_nodes: Vec<String>,
    /// Names of the groups that went with the last of their nodes.
    pub removed_groups: Vec<String>,
    /// Number of links that went, with their nodes or without.
    pub removed_links: usize,
    /// Number of self-loops that went.
    pub removed_self_loops: usize,
    /// Number of links that stayed and have another weight, at least in one direction.
    pub changed_links: usize,
    /// Number of nodes left.
    pub n_nodes: usize,
    /// Number of links left.
    pub n_links: usize,
    /// Whether the network is still directed.
    pub directed: bool,
}

/// Applies the steps one after the other.
///
/// # Errors
/// The [`PrepareError`] of the first step that fails; [`apply`] tells which.
pub fn prepare(
    mut raw: RawNetwork,
    steps: &[Step],
) -> Result<(RawNetwork, Vec<Report>), PrepareError> {
    let mut reports = Vec::with_capacity(steps.len());
    for step in steps {
        let (next, report) = apply(&raw, step)?;
        reports.push(report);
        raw = next;
    }
    Ok((raw, reports))
}

/// Applies one step. Groups and positions follow the nodes.
///
/// # Errors
/// - selection: [`PrepareError::EmptySelection`], [`PrepareError::EmptyRange`],
///   [`PrepareError::RangeOutOfRange`], [`PrepareError::UnknownLabel`],
///   [`PrepareError::SelectedTwice`]
/// - union, max and binarise: [`PrepareError::NegativeWeight`], which they would lose or make
///   positive
/// - threshold: [`PrepareError::BadThreshold`]
/// - dropping isolated nodes: [`PrepareError::AllIsolated`]
pub fn apply(raw: &RawNetwork, step: &Step) -> Result<(RawNetwork, Report), PrepareError> {
    let (after, changed_links) = match step {
        Step::Select(selection) => (select(raw, &selected(raw, selection)?), 0),
        Step::DropSelfLoops => (filter(raw, |i, j, _| i != j), 0),
        Step::Symmetrise(rule) => symmetrise(raw, *rule)?,
        Step::Threshold(threshold) if !threshold.is_finite() => {
            return Err(PrepareError::BadThreshold { threshold: *threshold });
        }
        Step::Threshold(threshold) => (filter(raw, |_, _, value| value >= *threshold), 0),
        Step::Binarise => binarise(raw)?,
        Step::DropIsolated => (select(raw, &linked_nodes(raw)?), 0),
        Step::LargestComponent => (select(raw, &largest_component(raw)), 0),
    };
    let report = report(step, raw, &after, changed_links);
    Ok((after, report))
}

fn report(step: &Step, before: &RawNetwork, after: &RawNetwork, changed_links: usize) -> Report {
    let labels: HashSet<&String> = after.labels().iter().collect();
    let removed_nodes = before.labels().iter().filter(|&label| !labels.contains(label));
    let groups: HashSet<&String> = after.groups().iter().map(|group| &group.name).collect();
    let names = before.groups().iter().map(|group| &group.name);
    let same_unit = before.is_directed() == after.is_directed();
    let links_before = if same_unit { before.n_links() } else { linked_pairs(before).count() };
    Report {
        step: step.clone(),
        removed_nodes: removed_nodes.cloned().collect(),
        removed_groups: names.filter(|&name| !groups.contains(name)).cloned().collect(),
        removed_links: links_before - after.n_links(),
        removed_self_loops: before.n_self_loops() - after.n_self_loops(),
        changed_links,
        n_nodes: after.n_nodes(),
        n_links: after.n_links(),
        directed: after.is_directed(),
    }
}

fn selected(raw: &RawNetwork, selection: &Selection) -> Result<Vec<usize>, PrepareError> {
    let nodes = match selection {
        Selection::Ranges(ranges) => nodes_in_ranges(raw, ranges)?,
        Selection::Labels(labels) => nodes_of_labels(raw, labels)?,
    };
    if nodes.is_empty() {
        return Err(PrepareError::EmptySelection);
    }
    let mut seen = vec![false; raw.n_nodes()];
    match nodes.iter().find(|&&node| std::mem::replace(&mut seen[node], true)) {
        Some(&node) => Err(PrepareError::SelectedTwice { label: raw.labels()[node].clone() }),
        None => Ok(nodes),
    }
}

fn nodes_in_ranges(raw: &RawNetwork, ranges: &[Range<usize>]) -> Result<Vec<usize>, PrepareError> {
    let n_nodes = raw.n_nodes();
    let mut nodes = Vec::new();
    for &Range { start, end } in ranges {
        if start >= end {
            return Err(PrepareError::EmptyRange { start, end });
        }
        if end > n_nodes {
            return Err(PrepareError::RangeOutOfRange { start, end, n_nodes });
        }
        nodes.extend(start..end);
    }
    Ok(nodes)
}

fn nodes_of_labels(raw: &RawNetwork, labels: &[String]) -> Result<Vec<usize>, PrepareError> {
    let node_of: HashMap<&String, usize> = raw.labels().iter().zip(0..).collect();
    let node = |label: &String| {
        let unknown = || PrepareError::UnknownLabel { label: label.clone() };
        node_of.get(label).copied().ok_or_else(unknown)
    };
    labels.iter().map(node).collect()
}

fn select(raw: &RawNetwork, kept: &[usize]) -> RawNetwork {
    let mut number = vec![None; raw.n_nodes()];
    kept.iter().enumerate().for_each(|(new, &old)| number[old] = Some(new));
    let links = entries(raw).filter_map(|(i, j, value)| Some((number[i]?, number[j]?, value)));
    let matrix = matrix(kept.len(), links);
    RawNetwork::from_parts(matrix, raw.nodes().select(kept), raw.is_directed())
}

fn filter(raw: &RawNetwork, keep: impl Fn(usize, usize, f64) -> bool) -> RawNetwork {
    let kept = entries(raw).filter(|&(i, j, value)| keep(i, j, value));
    RawNetwork::from_parts(matrix(raw.n_nodes(), kept), raw.nodes().clone(), raw.is_directed())
}

fn symmetrise(raw: &RawNetwork, rule: Symmetrise) -> Result<(RawNetwork, usize), PrepareError> {
    let value_of: fn(f64, f64) -> f64 = match rule {
        Symmetrise::Union => |_, _| 1.0,
        Symmetrise::Mean => f64::midpoint,
        Symmetrise::Max => f64::max,
    };
    if rule != Symmetrise::Mean {
        refuse_negative(raw)?;
    }
    let mut links = Vec::with_capacity(raw.matrix().nnz());
    let mut changed_links = 0;
    for (i, j, value, transposed) in linked_pairs(raw) {
        let common = value_of(value, transposed);
        if common != 0.0 {
            changed_links += usize::from(common != value || common != transposed);
            links.extend([(i, j, common), (j, i, common)]);
        }
    }
    let loops = entries(raw).filter(|&(i, j, _)| i == j);
    links.extend(loops.map(|(i, _, value)| (i, i, value_of(value, value))));
    let matrix = matrix(raw.n_nodes(), links.into_iter());
    Ok((RawNetwork::from_parts(matrix, raw.nodes().clone(), false), changed_links))
}

fn binarise(raw: &RawNetwork) -> Result<(RawNetwork, usize), PrepareError> {
    refuse_negative(raw)?;
    let entry_changes = entries(raw).filter(|&(i, j, value)| i != j && value != 1.0).count();
    let changed_links = if raw.is_directed() { entry_changes } else { entry_changes / 2 };
    let ones = raw.matrix().map(|_| 1.0);
    Ok((RawNetwork::from_parts(ones, raw.nodes().clone(), raw.is_directed()), changed_links))
}

fn refuse_negative(raw: &RawNetwork) -> Result<(), PrepareError> {
    match entries(raw).find(|&(_, _, value)| value < 0.0) {
        None => Ok(()),
        Some((i, j, value)) => {
            let (row, column) = (raw.labels()[i].clone(), raw.labels()[j].clone());
            Err(PrepareError::NegativeWeight { row, column, value })
        }
    }
}

fn linked_nodes(raw: &RawNetwork) -> Result<Vec<usize>, PrepareError> {
    let n_nodes = raw.n_nodes();
    let mut is_linked = vec![false; n_nodes];
    for (i, j, _) in entries(raw).filter(|&(i, j, _)| i != j) {
        is_linked[i] = true;
        is_linked[j] = true;
    }
    let linked: Vec<usize> = (0..n_nodes).filter(|&node| is_linked[node]).collect();
    if linked.is_empty() { Err(PrepareError::AllIsolated { n_nodes }) } else { Ok(linked) }
}

fn largest_component(raw: &RawNetwork) -> Vec<usize> {
    let both_directions = linked_pairs(raw).flat_map(|(i, j, ..)| [(i, j, 1.0), (j, i, 1.0)]);
    let components = Components::of(&matrix(raw.n_nodes(), both_directions)).nodes();
    let first_largest = components.into_iter().reduce(|a, b| if b.len() > a.len() { b } else { a });
    first_largest.expect("a network has a node")
}

/// Pairs i ≠ j with a_ij ≠ 0 or a_ji ≠ 0, each once, as (i, j, a_ij, a_ji).
fn linked_pairs(raw: &RawNetwork) -> impl Iterator<Item = (usize, usize, f64, f64)> + Clone {
    entries(raw).filter(|&(i, j, _)| i != j).filter_map(|(i, j, value)| {
        let transposed = raw.matrix().get(j, i).copied();
        (i < j || transposed.is_none()).then(|| (i, j, value, transposed.unwrap_or(0.0)))
    })
}

fn entries(raw: &RawNetwork) -> impl Iterator<Item = (usize, usize, f64)> + Clone {
    let rows = (0..raw.n_nodes()).map(|i| (i, raw.matrix().indptr().outer_inds_sz(i)));
    let (columns, values) = (raw.matrix().indices(), raw.matrix().data());
    rows.flat_map(move |(i, range)| range.map(move |e| (i, columns[e] as usize, values[e])))
}

fn matrix(
    n_nodes: usize,
    entries: impl Iterator<Item = (usize, usize, f64)> + Clone,
) -> SparseMatrix {
    assemble(n_nodes, entries).expect("the entries of one matrix are distinct")
}
