//! A network: sparse adjacency a_ij ≥ 0 (the strength with which j drives i) and node labels.

use std::collections::HashSet;

use sprs::TriMatI;

use crate::{GraphError, SparseMatrix};

/// A weighted network without self-loops.
///
/// `a_ij > 0` when node j drives node i. Undirected networks store both directions with the same
/// weight. Nodes are numbered from 0; node i bears the i-th label.
#[derive(Clone, Debug, PartialEq)]
pub struct Network {
    adjacency: SparseMatrix,
    labels: Vec<String>,
}

impl Network {
    /// An undirected network from its links `(i, j, weight)`, each given once.
    ///
    /// # Errors
    /// [`GraphError::Empty`] without nodes, [`GraphError::TooManyNodes`] beyond 32-bit numbers,
    /// [`GraphError::DuplicateLabel`], [`GraphError::NodeOutOfRange`], [`GraphError::SelfLoop`],
    /// [`GraphError::BadWeight`] (zero, negative or not finite) and [`GraphError::DuplicateLink`],
    /// which name the link by the labels of its nodes.
    pub fn undirected(
        labels: Vec<String>,
        links: &[(usize, usize, f64)],
    ) -> Result<Self, GraphError> {
        let n_nodes = labels.len();
        check_labels(&labels)?;
        let mut entries = TriMatI::with_capacity((n_nodes, n_nodes), 2 * links.len());
        for &(i, j, weight) in links {
            check_link(&labels, i, j, weight)?;
            entries.add_triplet(i, j, weight);
            entries.add_triplet(j, i, weight);
        }
        let adjacency: SparseMatrix = entries.to_csr();
        if adjacency.nnz() != 2 * links.len() {
            let (from, to) = duplicate(links).expect("to_csr merges only links given twice");
            let (from, to) = (labels[from].clone(), labels[to].clone());
            return Err(GraphError::DuplicateLink { from, to });
        }
        Ok(Self { adjacency, labels })
    }

    /// Number of nodes N.
    pub fn n_nodes(&self) -> usize {
        self.labels.len()
    }

    /// Number of undirected links L.
    pub fn n_links(&self) -> usize {
        self.adjacency.nnz() / 2
    }

    /// The adjacency matrix {a_ij}, shape (N, N), symmetric, zero diagonal.
    pub fn adjacency(&self) -> &SparseMatrix {
        &self.adjacency
    }

    /// Node labels, in node order.
    pub fn labels(&self) -> &[String] {
        &self.labels
    }

    /// The node called `label`, if there is one.
    pub fn node(&self, label: &str) -> Option<usize> {
        self.labels.iter().position(|l| l == label)
    }

    /// Strength k_i = Σ_j a_ij of every node (the degree where links have unit weight).
    pub fn strengths(&self) -> Vec<f64> {
        self.adjacency.outer_iterator().map(|row| row.data().iter().sum()).collect()
    }

    /// Nodes without any link.
    pub fn isolated_nodes(&self) -> Vec<usize> {
        self.adjacency
            .outer_iterator()
            .enumerate()
            .filter_map(|(i, row)| (row.nnz() == 0).then_some(i))
            .collect()
    }

    /// Connected components, each a sorted list of nodes, ordered by their first node.
    pub fn components(&self) -> Vec<Vec<usize>> {
        let mut seen = vec![false; self.n_nodes()];
        let mut components = Vec::new();
        for start in 0..self.n_nodes() {
            if seen[start] {
                continue;
            }
            seen[start] = true;
            let mut component = vec![start];
            let mut next = 0;
            while next < component.len() {
                let row = self.adjacency.outer_view(component[next]).expect("a node has a row");
                for &j in row.indices() {
                    if !std::mem::replace(&mut seen[j as usize], true) {
                        component.push(j as usize);
                    }
                }
                next += 1;
            }
            component.sort_unstable();
            components.push(component);
        }
        components
    }
}

fn check_labels(labels: &[String]) -> Result<(), GraphError> {
    let n_nodes = labels.len();
    if n_nodes == 0 {
        return Err(GraphError::Empty);
    }
    if u32::try_from(n_nodes).is_err() {
        return Err(GraphError::TooManyNodes { n_nodes });
    }
    let mut seen = HashSet::with_capacity(n_nodes);
    match labels.iter().find(|&label| !seen.insert(label)) {
        Some(label) => Err(GraphError::DuplicateLabel { label: label.clone() }),
        None => Ok(()),
    }
}

fn check_link(labels: &[String], i: usize, j: usize, weight: f64) -> Result<(), GraphError> {
    let n_nodes = labels.len();
    if let Some(&node) = [i, j].iter().find(|&&node| node >= n_nodes) {
        return Err(GraphError::NodeOutOfRange { node, n_nodes });
    }
    if i == j {
        return Err(GraphError::SelfLoop { node: labels[i].clone() });
    }
    if !(weight.is_finite() && weight > 0.0) {
        let (from, to) = (labels[i].clone(), labels[j].clone());
        return Err(GraphError::BadWeight { from, to, weight });
    }
    Ok(())
}

/// The first link that repeats an earlier one in either direction.
fn duplicate(links: &[(usize, usize, f64)]) -> Option<(usize, usize)> {
    let mut seen = HashSet::new();
    links.iter().find(|&&(i, j, _)| !seen.insert((i.min(j), i.max(j)))).map(|&(i, j, _)| (i, j))
}
