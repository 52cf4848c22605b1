//! What can be wrong with a network.

use thiserror::Error;

/// Why a network could not be read or built.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum GraphError {
    /// No nodes.
    #[error("the network has no nodes")]
    Empty,
    /// More nodes than 32-bit indices can number.
    #[error("{n_nodes} nodes are more than the {} that can be numbered", u32::MAX)]
    TooManyNodes {
        /// Number of nodes found.
        n_nodes: usize,
    },
    /// Two nodes of the same name.
    #[error("two nodes are called `{label}`")]
    DuplicateLabel {
        /// Their label.
        label: String,
    },
    /// A link names a node that does not exist.
    #[error("a link names node {node}, but there are only {n_nodes} nodes")]
    NodeOutOfRange {
        /// Node number from 0.
        node: usize,
        /// Number of nodes.
        n_nodes: usize,
    },
    /// A link from a node to itself.
    #[error("node `{node}` is linked to itself")]
    SelfLoop {
        /// Its label.
        node: String,
    },
    /// A weight that is zero, negative or not finite.
    #[error("the link {from}–{to} has weight {weight}; expected a finite weight above zero")]
    BadWeight {
        /// Label of one end.
        from: String,
        /// Label of the other end.
        to: String,
        /// The weight found.
        weight: f64,
    },
    /// The same link twice.
    #[error("the link {from}–{to} is given twice")]
    DuplicateLink {
        /// Label of one end.
        from: String,
        /// Label of the other end.
        to: String,
    },
}
