//! What can go wrong in computing a master stability function.

use dynamics::DynamicsError;
use thiserror::Error;

/// Why Λ(σ) or its zeros could not be computed.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum MsfError {
    /// A grid of σ that is not ascending from zero or above, or has fewer than two points.
    #[error("the grid of sigma must ascend from zero or above and have two points or more")]
    BadGrid,
    /// The orbit or its times are at fault.
    #[error(transparent)]
    Dynamics(#[from] DynamicsError),
}
