//! What a cascade panel is told.

use crate::label::Label;

/// The predicted clusters at every coupling strength, from strong coupling down.
#[derive(Clone, Debug)]
pub struct CascadePanel {
    /// Number of nodes of the network, N.
    pub n_nodes: usize,
    /// The states, at least one, each beginning in ε where the one before ends.
    pub states: Vec<CascadeState>,
    /// Position of the state whose clusters another panel of the figure shows, which has a frame.
    pub shown: Option<usize>,
}

/// The clusters between two critical couplings.
#[derive(Clone, Debug)]
pub struct CascadeState {
    /// Open range of ε, from its lower end; the first may have no upper end, the last may reach
    /// down to 0. Where the last ends above 0 the prediction does, and clusters may go on or not.
    pub epsilon: (f64, Option<f64>),
    /// Clusters of two nodes or more; all other nodes are alone.
    pub clusters: Vec<CascadeCluster>,
}

/// One cluster of a state.
#[derive(Clone, Debug)]
pub struct CascadeCluster {
    /// Number of its nodes, two or more.
    pub n_nodes: usize,
    /// Position, among the clusters of the state before, of the one it came from; none in the
    /// first state, or where clusters have merged again. A state with such a merged cluster is
    /// laid out anew, by size, since no place in the state before holds it.
    pub parent: Option<usize>,
    /// Shown where there is room, such as C₁ or a name of a group; empty for none.
    pub label: Label,
    /// Number of its colour, the same in all panels. The largest part of a cluster has its colour.
    pub colour: usize,
}

impl CascadeState {
    /// Nodes that are in no cluster of `n_nodes` nodes.
    pub(super) fn n_alone(&self, n_nodes: usize) -> usize {
        n_nodes - self.clusters.iter().map(|c| c.n_nodes).sum::<usize>()
    }
}
