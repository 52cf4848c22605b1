//! What is known of the nodes of a network: labels, groups (disjoint), positions.

use std::collections::HashSet;

use crate::{GraphError, SparseMatrix};

/// Nodes that belong together: a community, a brain region.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    /// What the group is called; no two groups of a network share a name.
    pub name: String,
    /// Its nodes, numbered from 0, at least one; a network keeps them ascending.
    pub nodes: Vec<usize>,
}

/// Labels "1", "2", …, for networks whose nodes have no names.
pub fn numbered_labels(n_nodes: usize) -> Vec<String> {
    (1..=n_nodes).map(|i| i.to_string()).collect()
}

/// What is known of the nodes themselves.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Nodes {
    labels: Vec<String>,
    groups: Vec<Group>,
    positions: Option<Vec<[f64; 3]>>,
}

impl Nodes {
    pub(crate) fn new(labels: Vec<String>) -> Result<Self, GraphError> {
        let n_nodes = labels.len();
        if n_nodes == 0 {
            return Err(GraphError::Empty);
        }
        if u32::try_from(n_nodes).is_err() {
            return Err(GraphError::TooManyNodes { n_nodes });
        }
        let mut seen = HashSet::with_capacity(n_nodes);
        if let Some(label) = labels.iter().find(|&label| !seen.insert(label)) {
            return Err(GraphError::DuplicateLabel { label: label.clone() });
        }
        Ok(Self { labels, groups: Vec::new(), positions: None })
    }

    pub(crate) fn n_nodes(&self) -> usize {
        self.labels.len()
    }

    pub(crate) fn labels(&self) -> &[String] {
        &self.labels
    }

    pub(crate) fn groups(&self) -> &[Group] {
        &self.groups
    }

    pub(crate) fn positions(&self) -> Option<&[[f64; 3]]> {
        self.positions.as_deref()
    }

    pub(crate) fn set_groups(&mut self, mut groups: Vec<Group>) -> Result<(), GraphError> {
        let mut names = HashSet::with_capacity(groups.len());
        let mut group_of = vec![None; self.n_nodes()];
        for group in &groups {
            if group.nodes.is_empty() {
                return Err(GraphError::EmptyGroup { group: group.name.clone() });
            }
            if !names.insert(&group.name) {
                return Err(GraphError::DuplicateGroup { group: group.name.clone() });
            }
            for &node in &group.nodes {
                self.claim(&mut group_of, node, &group.name)?;
            }
        }
        groups.iter_mut().for_each(|group| group.nodes.sort_unstable());
        self.groups = groups;
        Ok(())
    }

    /// Notes that `node` is in `group`, unless it already is in one.
    fn claim<'a>(
        &self,
        group_of: &mut [Option<&'a str>],
        node: usize,
        group: &'a str,
    ) -> Result<(), GraphError> {
        let n_nodes = self.n_nodes();
        let name = || group.to_owned();
        let Some(owner) = group_of.get_mut(node) else {
            return Err(GraphError::GroupOutOfRange { group: name(), node, n_nodes });
        };
        let node = || self.labels[node].clone();
        match owner.replace(group) {
            None => Ok(()),
            Some(first) if first == group => {
                Err(GraphError::RepeatedInGroup { node: node(), group: name() })
            }
            Some(first) => {
                let first = first.to_owned();
                Err(GraphError::NodeInTwoGroups { node: node(), first, second: name() })
            }
        }
    }

    pub(crate) fn set_positions(&mut self, positions: Vec<[f64; 3]>) -> Result<(), GraphError> {
        let (n_positions, n_nodes) = (positions.len(), self.labels.len());
        if n_positions != n_nodes {
            return Err(GraphError::WrongPositionCount { n_positions, n_nodes });
        }
        let is_bad = |p: &[f64; 3]| !p.iter().all(|x| x.is_finite());
        if let Some(i) = positions.iter().position(is_bad) {
            let node = self.labels[i].clone();
            return Err(GraphError::BadPosition { node, position: positions[i] });
        }
        self.positions = Some(positions);
        Ok(())
    }

    /// The nodes `kept`, in that order, each once. Groups that lose all their nodes go.
    pub(crate) fn select(&self, kept: &[usize]) -> Self {
        let mut number = vec![None; self.labels.len()];
        kept.iter().enumerate().for_each(|(new, &old)| number[old] = Some(new));
        let in_group = |group: &Group| {
            let mut nodes: Vec<_> = group.nodes.iter().filter_map(|&node| number[node]).collect();
            nodes.sort_unstable();
            (!nodes.is_empty()).then(|| Group { name: group.name.clone(), nodes })
        };
        Self {
            labels: kept.iter().map(|&node| self.labels[node].clone()).collect(),
            groups: self.groups.iter().filter_map(in_group).collect(),
            positions: self.positions.as_ref().map(|p| kept.iter().map(|&node| p[node]).collect()),
        }
    }

    fn check_range(&self, i: usize, j: usize) -> Result<(), GraphError> {
        let n_nodes = self.labels.len();
        match [i, j].into_iter().find(|&node| node >= n_nodes) {
            Some(node) => Err(GraphError::NodeOutOfRange { node, n_nodes }),
            None => Ok(()),
        }
    }

    pub(crate) fn check_link(&self, i: usize, j: usize, weight: f64) -> Result<(), GraphError> {
        self.check_range(i, j)?;
        if i == j {
            return Err(GraphError::SelfLoop { node: self.labels[i].clone() });
        }
        if !(weight.is_finite() && weight > 0.0) {
            let (from, to) = (self.labels[i].clone(), self.labels[j].clone());
            return Err(GraphError::BadWeight { from, to, weight });
        }
        Ok(())
    }

    pub(crate) fn check_entry(&self, i: usize, j: usize, value: f64) -> Result<(), GraphError> {
        self.check_range(i, j)?;
        if !value.is_finite() {
            let (row, column) = (self.labels[i].clone(), self.labels[j].clone());
            return Err(GraphError::BadEntry { row, column, value });
        }
        Ok(())
    }

    /// Refuses the first entry, by rows, that differs from its transposed one.
    pub(crate) fn check_symmetric(&self, matrix: &SparseMatrix) -> Result<(), GraphError> {
        if is_symmetric(matrix) {
            return Ok(());
        }
        for (&value, (i, j)) in matrix {
            let (i, j) = (i as usize, j as usize);
            let transposed = matrix.get(j, i).copied().unwrap_or(0.0);
            if value != transposed {
                let (row, column) = (self.labels[i].clone(), self.labels[j].clone());
                return Err(GraphError::NotSymmetric { row, column, value, transposed });
            }
        }
        Ok(())
    }
}

/// Whether a matrix of compressed rows equals its transpose. O(entries).
///
/// Taken by rows, the entries of a symmetric matrix ask for those of every other row in their order:
/// no entry has to be searched for.
fn is_symmetric(matrix: &SparseMatrix) -> bool {
    let (columns, values) = (matrix.indices(), matrix.data());
    let row = |i: usize| matrix.indptr().outer_inds_sz(i);
    let mut next: Vec<usize> = (0..matrix.rows()).map(|i| row(i).start).collect();
    (0..matrix.rows()).all(|i| {
        row(i).all(|entry| {
            let j = columns[entry] as usize;
            let transposed = next[j];
            next[j] += 1;
            let is_there = transposed < row(j).end && columns[transposed] as usize == i;
            is_there && values[transposed] == values[entry]
        })
    })
}
