//! How far work has come, told on the way, and whether it goes on.

use std::ops::ControlFlow;

use crate::ClusteringError;

/// Called with the number of states done since the last call; says whether to go on.
pub type Progress<'a> = &'a dyn Fn(u64) -> ControlFlow<()>;

/// Nobody is told, and nothing is stopped.
pub const QUIET: Progress<'static> = &|_| ControlFlow::Continue(());

/// What was told to stop stops.
pub(crate) fn go_on(told: ControlFlow<()>) -> Result<(), ClusteringError> {
    match told {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(ClusteringError::Cancelled),
    }
}
