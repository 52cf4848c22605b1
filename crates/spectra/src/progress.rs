//! What a long solve tells while it runs.

use std::ops::ControlFlow;

/// How far a solve has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Advance {
    /// Matrix–vector products spent so far, solutions of factorised systems included.
    pub products: usize,
    /// Modes found to the residual asked for.
    pub converged: usize,
    /// Modes looked for, as far as known: with a cutoff the number may grow.
    pub wanted: usize,
}

/// Called whenever a solver has come further, from whichever thread it works on; says whether to go on.
pub type Progress<'a> = &'a (dyn Fn(Advance) -> ControlFlow<()> + Sync);
