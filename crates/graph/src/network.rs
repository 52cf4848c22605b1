//! A network: sparse adjacency a_ij = a_ji ≥ 0 (the strength with which j drives i), a_ii = 0, and
//! what is known of its nodes: labels, groups, positions.

use std::collections::HashMap;

use crate::components::Components;
use crate::nodes::{Group, Nodes};
use crate::{GraphError, SparseMatrix};

/// A weighted network without self-loops.
///
/// `a_ij > 0` when node j drives node i. Undirected networks store both directions with the same
/// weight. Nodes are numbered from 0; node i bears the i-th label.
#[derive(Clone, Debug, PartialEq)]
pub struct Network {
    adjacency: SparseMatrix,
    nodes: Nodes,
}

impl Network {
    /// An undirected network from its links `(i, j, weight)`, each given once.
    ///
    /// O(N + L log k) for N nodes and L links, at most k at a node.
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
        let nodes = Nodes::new(labels)?;
        for &(i, j, weight) in links {
            nodes.check_link(i, j, weight)?;
        }
        let ends = |&(i, j, weight): &(usize, usize, f64)| [(i, j, weight), (j, i, weight)];
        Self::assembled(nodes, links.iter().flat_map(ends), &links.iter().map(|&(i, j, _)| (i, j)))
    }

    /// The same from links whose numbers and weights a reader has checked, no link a self-loop.
    ///
    /// # Errors
    /// Those of [`Self::undirected`] that are left.
    pub(crate) fn of_distinct_ends(
        labels: Vec<String>,
        links: &[(u32, u32, f64)],
    ) -> Result<Self, GraphError> {
        let wide = |&(i, j, _): &(u32, u32, f64)| (i as usize, j as usize);
        let both = links.iter().flat_map(move |link| {
            let (i, j) = wide(link);
            [(i, j, link.2), (j, i, link.2)]
        });
        Self::assembled(Nodes::new(labels)?, both, &links.iter().map(wide))
    }

    fn assembled(
        nodes: Nodes,
        both_directions: impl Iterator<Item = (usize, usize, f64)> + Clone,
        links: &(impl Iterator<Item = (usize, usize)> + Clone),
    ) -> Result<Self, GraphError> {
        let Ok(adjacency) = assemble(nodes.n_nodes(), both_directions) else {
            let [_, repeated] =
                first_repeated(links.clone()).expect("only a link given twice repeats an entry");
            let (i, j) = links.clone().nth(repeated).expect("it is one of the links");
            let (from, to) = (nodes.labels()[i].clone(), nodes.labels()[j].clone());
            return Err(GraphError::DuplicateLink { from, to });
        };
        Ok(Self { adjacency, nodes })
    }

    /// A network from an adjacency matrix that is sound by construction.
    pub(crate) fn from_parts(adjacency: SparseMatrix, nodes: Nodes) -> Self {
        Self { adjacency, nodes }
    }

    pub(crate) fn into_parts(self) -> (SparseMatrix, Nodes) {
        (self.adjacency, self.nodes)
    }

    /// The same network with its nodes divided into groups; a node may be in none.
    ///
    /// # Errors
    /// [`GraphError::EmptyGroup`], [`GraphError::DuplicateGroup`] (two of one name),
    /// [`GraphError::GroupOutOfRange`], and [`GraphError::RepeatedInGroup`] or
    /// [`GraphError::NodeInTwoGroups`] for a node that is listed twice.
    pub fn with_groups(mut self, groups: Vec<Group>) -> Result<Self, GraphError> {
        self.nodes.set_groups(groups)?;
        Ok(self)
    }

    /// The same network with a point of space for every node, in any unit (brains: mm).
    ///
    /// # Errors
    /// [`GraphError::WrongPositionCount`] and [`GraphError::BadPosition`] (not finite).
    pub fn with_positions(mut self, positions: Vec<[f64; 3]>) -> Result<Self, GraphError> {
        self.nodes.set_positions(positions)?;
        Ok(self)
    }

    /// Number of nodes N.
    pub fn n_nodes(&self) -> usize {
        self.nodes.n_nodes()
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
        self.nodes.labels()
    }

    /// Groups of nodes, disjoint, in the order given; none where the network has no division.
    pub fn groups(&self) -> &[Group] {
        self.nodes.groups()
    }

    /// Positions (x, y, z) of all nodes in node order, where they are known.
    pub fn positions(&self) -> Option<&[[f64; 3]]> {
        self.nodes.positions()
    }

    /// The node called `label`, if there is one.
    pub fn node(&self, label: &str) -> Option<usize> {
        self.labels().iter().position(|l| l == label)
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
        Components::of(&self.adjacency).nodes()
    }
}

/// Compressed rows, columns ascending, from entries in any order, or the first repeated entry.
///
/// A counting sort by rows, so that a node with very many links costs no more than many nodes. Rows
/// of entries that come in order need no further sorting.
pub(crate) fn assemble(
    n_nodes: usize,
    entries: impl Iterator<Item = (usize, usize, f64)> + Clone,
) -> Result<SparseMatrix, (usize, usize)> {
    let mut row_starts = vec![0; n_nodes + 1];
    entries.clone().for_each(|(i, _, _)| row_starts[i + 1] += 1);
    for i in 0..n_nodes {
        row_starts[i + 1] += row_starts[i];
    }
    let mut free = row_starts.clone();
    let mut columns = vec![0u32; row_starts[n_nodes]];
    let mut values = vec![0.0; row_starts[n_nodes]];
    for (i, j, value) in entries {
        columns[free[i]] = u32::try_from(j).expect("nodes are numbered in 32 bits");
        values[free[i]] = value;
        free[i] += 1;
    }
    drop(free);
    let mut scratch = Vec::new();
    for i in 0..n_nodes {
        let row = row_starts[i]..row_starts[i + 1];
        let columns = &mut columns[row.clone()];
        sort_by_column(columns, &mut values[row], &mut scratch);
        if let Some(pair) = columns.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err((i, pair[0] as usize));
        }
    }
    Ok(SparseMatrix::new((n_nodes, n_nodes), row_starts, columns, values))
}

fn sort_by_column(columns: &mut [u32], values: &mut [f64], scratch: &mut Vec<(u32, f64)>) {
    if columns.is_sorted() {
        return;
    }
    scratch.clear();
    scratch.extend(columns.iter().copied().zip(values.iter().copied()));
    scratch.sort_unstable_by_key(|&(column, _)| column);
    for ((column, value), entry) in columns.iter_mut().zip(values).zip(scratch) {
        (*column, *value) = *entry;
    }
}

/// The places of the first link that repeats an earlier one, in either direction, and of that one:
/// [earlier, repeated].
pub(crate) fn first_repeated(
    mut links: impl Iterator<Item = (usize, usize)>,
) -> Option<[usize; 2]> {
    let mut seen = HashMap::new();
    let mut places = 0..;
    links.find_map(|(i, j)| {
        let place = places.next()?;
        let earlier = seen.insert((i.min(j), i.max(j)), place)?;
        Some([earlier, place])
    })
}
