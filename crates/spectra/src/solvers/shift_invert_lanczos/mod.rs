//! Lanczos' method on the inverse, from a sparse factorisation.

mod ritz;
mod search;

use crate::error::SpectraError;
use crate::factorisation::symbolic::{MOST_NONZEROS, MOST_OPERATIONS};
use crate::found::Found;
use crate::solvers::method::{Method, Solve, Task};
use crate::solvers::shift_invert_lanczos::search::Search;
use crate::verification::Verification;

/// Shift-invert.
pub(crate) const METHOD: Method = Method {
    name: "shift_invert",
    finds_all: true,
    rounding: 0.0,
    factorises: true,
    solve: Some(Solve::Iterative(leading)),
};

fn leading(task: Task<'_>) -> Result<(Found, Verification), SpectraError> {
    let Task { w, plan, symbolic, verifier, random, progress, .. } = task;
    let symbolic = symbolic.ok_or_else(|| SpectraError::FactorTooLarge {
        n_nodes: w.n_nodes(),
        most: MOST_NONZEROS,
        most_operations: MOST_OPERATIONS,
    })?;
    // Within the pool a thread finds in its cache what it wrote the time before: a third faster.
    rayon::scope(|_| {
        // Nothing smaller than the grouping is told apart from 0.
        Search::new(w, plan, (symbolic, plan.grouping), random, progress)?.run(&verifier)
    })
}
