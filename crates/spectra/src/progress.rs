//! What a long solve tells while it runs.

use std::ops::ControlFlow;

use crate::error::SpectraError;

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

/// Asked in the midst of a long piece of work, so many products after it began, whether to go on.
pub(crate) type Asked<'a> = &'a dyn Fn(usize) -> Result<(), SpectraError>;

impl Advance {
    /// Tells how far it has come, and stops where that is wanted.
    pub(crate) fn tell(self, progress: Progress<'_>) -> Result<(), SpectraError> {
        if progress(self).is_break() { Err(SpectraError::Cancelled) } else { Ok(()) }
    }

    /// Tells the same of work that goes on from here.
    pub(crate) fn asked(
        self,
        progress: Progress<'_>,
    ) -> impl Fn(usize) -> Result<(), SpectraError> {
        move |more| Self { products: self.products + more, ..self }.tell(progress)
    }
}
