//! Why clusters could not be predicted.

use thiserror::Error;

/// Why a distance, a partition or a cascade could not be had. Fields count modes and nodes from 0,
/// messages from 1, as the literature numbers λ_1, λ_2, ….
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ClusteringError {
    /// Whoever was told of the progress wanted to stop.
    #[error("the work was stopped")]
    Cancelled,
    /// A mode beyond those computed.
    #[error("mode {} is not among the {n_modes} that were computed", mode + 1)]
    ModeOutOfRange {
        /// The mode.
        mode: usize,
        /// Number of modes computed.
        n_modes: usize,
    },
    /// Mode 0 given as a transverse mode.
    #[error("mode 1 is the synchronous motion itself; expected transverse modes, from 2 on")]
    SynchronousMode,
    /// Some modes of an eigenspace without the others.
    #[error(
        "modes {} to {} have one eigenvalue and become unstable together, but mode {} is missing",
        first + 1, last + 1, missing + 1
    )]
    PartOfEigenspace {
        /// First transverse mode of the eigenspace.
        first: usize,
        /// Its last mode.
        last: usize,
        /// The first of its modes that was left out.
        missing: usize,
    },
    /// The eigenspace of λ_1 does not contain the vector of equal components.
    #[error(
        "the eigenspace of the largest eigenvalue holds {overlap} of the vector of equal \
         components, expected 1: either rows of the coupling matrix do not sum to zero, or some \
         modes of eigenvalue 0 were not computed"
    )]
    NoSynchronousMode {
        /// Squared length of the projection of (1, …, 1)/√N onto the eigenspace.
        overlap: f64,
    },
    /// An eigenvector with a component that is no number.
    #[error("component {} of mode {} is not finite", node + 1, mode + 1)]
    NotFinite {
        /// The mode.
        mode: usize,
        /// The node.
        node: usize,
    },
    /// Eigenvectors too inaccurate to tell equal components from different ones.
    #[error(
        "eigenvectors are uncertain by {tolerance:e}, too much for exact clusters (limit \
         {limit:e}): lower the residuals or use a threshold"
    )]
    SpectrumTooRough {
        /// Bound on the error of a distance in the unstable subspace.
        tolerance: f64,
        /// Largest such bound that is accepted.
        limit: f64,
    },
    /// A threshold that is negative or not finite.
    #[error("expected a threshold that is finite and not negative, found {threshold}")]
    BadThreshold {
        /// The threshold.
        threshold: f64,
    },
    /// A weight of the coupling matrix that is no number.
    #[error("the weight of the link from node {} to node {} is {weight}", column + 1, row + 1)]
    WeightNotFinite {
        /// The node that receives.
        row: usize,
        /// The node that sends.
        column: usize,
        /// The weight.
        weight: f64,
    },
    /// A cluster or region names a node that does not exist.
    #[error("a cluster or region names node {}, but there are only {n_nodes} nodes", node + 1)]
    NodeOutOfRange {
        /// The node.
        node: usize,
        /// Number of nodes.
        n_nodes: usize,
    },
    /// A node listed twice.
    #[error("node {} is listed twice among the clusters or regions", node + 1)]
    NodeListedTwice {
        /// The node.
        node: usize,
    },
    /// A region without nodes.
    #[error("region {} has no nodes", region + 1)]
    EmptyRegion {
        /// The region.
        region: usize,
    },
    /// A distance that is negative or not finite.
    #[error(
        "the distance of nodes {} and {} is {distance}, expected a finite number that is not \
         negative", i + 1, j + 1
    )]
    BadDistance {
        /// One node.
        i: usize,
        /// The other node.
        j: usize,
        /// Their distance.
        distance: f64,
    },
}
