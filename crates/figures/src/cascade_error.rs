//! What can be wrong with the data of a cascade.

use thiserror::Error;

/// Why a cascade cannot be drawn. States and clusters are counted from 0; `panel` is the letter.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CascadeError {
    /// Nothing to draw.
    #[error("panel {panel} has no {what}")]
    Empty {
        /// Its letter.
        panel: String,
        /// What is missing.
        what: &'static str,
    },
    /// A range whose ends are not finite, below zero, or do not ascend.
    #[error("panel {panel}: state {state} would reach from ε = {from} to {to}")]
    BadRange {
        /// Letter of the panel.
        panel: String,
        /// The state.
        state: usize,
        /// Lower end.
        from: f64,
        /// Upper end; infinite for none.
        to: f64,
    },
    /// A state that does not begin where the one before it ends.
    #[error(
        "panel {panel}: state {state} begins at ε = {from}, but the one before ends at {before}"
    )]
    Gap {
        /// Letter of the panel.
        panel: String,
        /// The state.
        state: usize,
        /// Its upper end; infinite for none.
        from: f64,
        /// Lower end of the state before.
        before: f64,
    },
    /// A cluster of fewer than two nodes.
    #[error(
        "panel {panel}: the nodes of cluster {cluster} of state {state} number {n_nodes}, fewer than two"
    )]
    TooFewNodes {
        /// Letter of the panel.
        panel: String,
        /// The state.
        state: usize,
        /// The cluster.
        cluster: usize,
        /// Its nodes.
        n_nodes: usize,
    },
    /// A cluster from one that does not exist.
    #[error(
        "panel {panel}: cluster {cluster} of state {state} comes from cluster {parent}, but there \
         are {n_before} in the state before"
    )]
    ParentOutOfRange {
        /// Letter of the panel.
        panel: String,
        /// The state.
        state: usize,
        /// The cluster.
        cluster: usize,
        /// Where it would come from.
        parent: usize,
        /// Clusters of the state before; 0 for the first state.
        n_before: usize,
    },
    /// Clusters with more nodes than what they came from: the network, or one cluster.
    #[error("panel {panel}: clusters of state {state} have {found} nodes out of {n_nodes}")]
    TooManyNodes {
        /// Letter of the panel.
        panel: String,
        /// The state.
        state: usize,
        /// Nodes of the clusters.
        found: usize,
        /// Nodes of what they came from.
        n_nodes: usize,
    },
}
