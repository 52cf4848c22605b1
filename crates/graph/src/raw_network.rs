//! What a file holds before it is a network: any finite a_ij, row i and column j, with which node j
//! drives node i. The steps of `prepare` make a_ij = a_ji ≥ 0 and a_ii = 0 of it.

use crate::network::assemble;
use crate::nodes::{Group, Nodes};
use crate::{GraphError, Network, SparseMatrix};

/// What a matrix or graph file holds before it is a network: links of either sign, in one
/// direction or both, and self-loops on the diagonal.
///
/// `a_ij ≠ 0`, row i and column j, when node j drives node i.
#[derive(Clone, Debug, PartialEq)]
pub struct RawNetwork {
    matrix: SparseMatrix,
    nodes: Nodes,
    directed: bool,
}

impl RawNetwork {
    /// A raw network from its entries `(i, j, a_ij)`, each given once; zeros are no links.
    ///
    /// - `directed`: false where the source promises a_ij = a_ji and both are given here; true
    ///   where it allows them to differ, or does not say.
    ///
    /// # Errors
    /// [`GraphError::Empty`], [`GraphError::TooManyNodes`], [`GraphError::DuplicateLabel`],
    /// [`GraphError::NodeOutOfRange`], [`GraphError::BadEntry`] (not finite),
    /// [`GraphError::DuplicateEntry`], and [`GraphError::NotSymmetric`] where a matrix that is not
    /// directed differs from its transpose.
    pub fn new(
        labels: Vec<String>,
        entries: &[(usize, usize, f64)],
        directed: bool,
    ) -> Result<Self, GraphError> {
        let nodes = Nodes::new(labels)?;
        for &(i, j, value) in entries {
            nodes.check_entry(i, j, value)?;
        }
        Self::assembled(nodes, entries.iter().copied(), directed)
    }

    /// The same from entries whose numbers and values a reader has checked.
    ///
    /// # Errors
    /// Those of [`Self::new`] that are left.
    pub(crate) fn of_checked(
        labels: Vec<String>,
        entries: &[(u32, u32, f64)],
        directed: bool,
    ) -> Result<Self, GraphError> {
        let wide = |&(i, j, value): &(u32, u32, f64)| (i as usize, j as usize, value);
        Self::assembled(Nodes::new(labels)?, entries.iter().map(wide), directed)
    }

    fn assembled(
        nodes: Nodes,
        entries: impl Iterator<Item = (usize, usize, f64)> + Clone,
        directed: bool,
    ) -> Result<Self, GraphError> {
        let links = entries.filter(|&(_, _, value)| value != 0.0);
        let matrix = assemble(nodes.n_nodes(), links).map_err(|(i, j)| {
            let (row, column) = (nodes.labels()[i].clone(), nodes.labels()[j].clone());
            GraphError::DuplicateEntry { row, column }
        })?;
        if !directed {
            nodes.check_symmetric(&matrix)?;
        }
        Ok(Self { matrix, nodes, directed })
    }

    /// What a step of preparation makes of the matrix and the nodes, both sound by construction.
    pub(crate) fn from_parts(matrix: SparseMatrix, nodes: Nodes, directed: bool) -> Self {
        Self { matrix, nodes, directed }
    }

    /// The same, with its nodes divided into groups.
    ///
    /// # Errors
    /// Those of [`Network::with_groups`].
    pub fn with_groups(mut self, groups: Vec<Group>) -> Result<Self, GraphError> {
        self.nodes.set_groups(groups)?;
        Ok(self)
    }

    /// The same, with a point of space for every node.
    ///
    /// # Errors
    /// Those of [`Network::with_positions`].
    pub fn with_positions(mut self, positions: Vec<[f64; 3]>) -> Result<Self, GraphError> {
        self.nodes.set_positions(positions)?;
        Ok(self)
    }

    /// The network, if the matrix already is symmetric and its weights are above zero.
    ///
    /// # Errors
    /// For the first entry at fault, by rows: [`GraphError::SelfLoop`], [`GraphError::BadWeight`]
    /// (negative) or [`GraphError::NotSymmetric`].
    pub fn into_network(self) -> Result<Network, GraphError> {
        for (&value, (i, j)) in &self.matrix {
            self.nodes.check_link(i as usize, j as usize, value)?;
        }
        if self.directed {
            self.nodes.check_symmetric(&self.matrix)?;
        }
        Ok(Network::from_parts(self.matrix, self.nodes))
    }

    /// Number of nodes N.
    pub fn n_nodes(&self) -> usize {
        self.nodes.n_nodes()
    }

    /// Number of links without self-loops: entries off the diagonal where the network is directed,
    /// pairs of linked nodes where it is not.
    pub fn n_links(&self) -> usize {
        let entries = self.matrix.nnz() - self.n_self_loops();
        if self.directed { entries } else { entries / 2 }
    }

    /// Number of nodes with a_ii ≠ 0.
    pub fn n_self_loops(&self) -> usize {
        (0..self.n_nodes()).filter(|&i| self.matrix.get(i, i).is_some()).count()
    }

    /// The matrix {a_ij}, shape (N, N), without stored zeros.
    pub fn matrix(&self) -> &SparseMatrix {
        &self.matrix
    }

    /// Node labels, in node order.
    pub fn labels(&self) -> &[String] {
        self.nodes.labels()
    }

    /// Groups of nodes, as [`Network::groups`].
    pub fn groups(&self) -> &[Group] {
        self.nodes.groups()
    }

    /// Positions of all nodes, as [`Network::positions`].
    pub fn positions(&self) -> Option<&[[f64; 3]]> {
        self.nodes.positions()
    }

    /// Whether a_ij and a_ji may differ.
    pub fn is_directed(&self) -> bool {
        self.directed
    }

    pub(crate) fn nodes(&self) -> &Nodes {
        &self.nodes
    }
}

impl From<Network> for RawNetwork {
    fn from(network: Network) -> Self {
        let (matrix, nodes) = network.into_parts();
        Self { matrix, nodes, directed: false }
    }
}
