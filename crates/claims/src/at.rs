//! Which instance of a quantity a claim is about.

/// What `where` says, with names as nodes; empty where it says nothing.
#[derive(Clone, Debug, Default)]
pub struct At {
    /// Coupling strengths.
    pub epsilon: Vec<f64>,
    /// Modes k, counted from 1; none for all.
    pub modes: Option<Vec<usize>>,
    /// Clusters of nodes.
    pub clusters: Vec<Vec<usize>>,
    /// What the names of groups begin with whose nodes are counted.
    pub group_prefix: Option<String>,
    /// Whether numbers are compared with one another, so that only their order matters.
    pub in_order: bool,
}
