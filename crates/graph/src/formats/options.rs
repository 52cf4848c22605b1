//! What may be chosen of a file, whatever its format.

use super::matrix::Layout;

/// The choices; each format says which of them it has ([`Choice`](super::Choice)).
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Which of several matrices, by its name; without it the only one.
    pub variable: Option<String>,
    /// Which attributes are what.
    pub attributes: Attributes,
    /// Which part of a matrix, and which way it points.
    pub layout: Layout,
}

/// Which attributes of nodes and edges are read, by the names that the file has for them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Attributes {
    /// Number of an edge that is its weight; without it every edge has weight 1.
    pub weight: Option<String>,
    /// Attribute of a node that is its label; without it the label is the node's `id`.
    pub label: Option<String>,
    /// Attribute of a node that names its group; a node without it is in none.
    pub group: Option<String>,
    /// Numbers of a node that are its position: two or three, or none for no positions.
    pub position: Vec<String>,
}
