//! How far work has come, told on the way, and whether it goes on.

use std::ops::ControlFlow;

/// Called with the number of steps done since the last call, from any thread; says whether to go on.
pub type Progress<'a> = &'a (dyn Fn(u64) -> ControlFlow<()> + Sync);

/// Nobody is told, and nothing is stopped.
pub const QUIET: Progress<'static> = &|_| ControlFlow::Continue(());
