//! What keeps a study from being finished.

use clustering::ClusteringError;
use dynamics::DynamicsError;
use msf::MsfError;
use spectra::SpectraError;

/// Why there are no findings.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The curve Λ(σ).
    #[error("the master stability function could not be computed: {0}")]
    Curve(MsfError),
    /// The modes.
    #[error("the spectrum could not be computed: {0}")]
    Spectrum(SpectraError),
    /// The states over ε.
    #[error("the cascade could not be predicted: {0}")]
    Cascade(ClusteringError),
    /// A part of the spectrum that says nothing of any coupling strength.
    #[error(
        "the cascade could not be predicted: all {computed} computed eigenvalues of {n_nodes} are \
         zero: compute more modes"
    )]
    OnlyZeroModes {
        /// Number of modes computed.
        computed: usize,
        /// Number of modes of the coupling matrix.
        n_nodes: usize,
    },
    /// Which clusters are exact.
    #[error("the clusters cannot be labelled: {0}")]
    Labels(ClusteringError),
    /// The replicas.
    #[error("the sweep could not be simulated: {0}")]
    Sweep(DynamicsError),
    /// Both sides.
    #[error("prediction and simulation cannot be compared: {0}")]
    Agreement(ClusteringError),
    /// The observer wanted to stop.
    #[error("stopped before its end")]
    Cancelled,
}
