//! The choice among the solvers where it is free.
//!
//! Small separators make both a cheap factorisation and, by Cheeger's inequality, small gaps between
//! the leading eigenvalues, on which filters are slow. So shift-invert is taken where its factor is
//! cheap next to the products that a filter is expected to need. Elsewhere networks of medium size go
//! to ARPACK, where it costs a fraction of a second, and large ones to blocks and filters, which take
//! half of its time or less.

use graph::SymmetricForm;

use crate::completeness::Verifier;
use crate::error::SpectraError;
use crate::factorisation::symbolic::{DENSE_SPEED, Symbolic};
use crate::found::Found;
use crate::matrix::product::Links;
use crate::plan::Plan;
use crate::plan::wanted::Wanted;
use crate::progress::Progress;
use crate::solvers::Solver;
use crate::solvers::method::{Solve, Task};
use crate::vectors::random::Random;
use crate::verification::Verification;

/// Up to this many nodes a free choice is dense when more than a twentieth of all modes, or all above
/// a cutoff, are asked for: 2 s and 32 MB a matrix at this size.
pub const DENSE_NODES: usize = 2000;
/// Up to this many nodes it is ARPACK that finds a few modes of a network without small separators.
pub const ARPACK_NODES: usize = 5000;

/// Up to this many nodes it is dense for any number of modes: 30 ms.
const FEW_NODES: usize = 500;
/// Nonzeros of a factor for each of the matrix beyond which no factorisation is tried unless it is
/// asked for.
const CHEAP_FILL: f64 = 10.0;
/// Products that a filter is expected to spend at least.
const EXPECTED_PRODUCTS: f64 = 500.0;
/// Products that it is expected to spend for each level of a breadth-first search; on square grids it
/// is 17.
const PRODUCTS_PER_LEVEL: f64 = 16.0;
/// Solutions of the factorised system that shift-invert is expected to spend, besides four a mode.
const EXPECTED_SOLUTIONS: f64 = 20.0;
/// Most modes that are left to ARPACK where the choice is free: its work grows with their square.
const MOST_ARPACK_MODES: usize = 50;

/// The solver that was asked for, or the one that the numbers of nodes and modes decide for; none where
/// the separators of the network are to decide.
pub(crate) fn by_size(
    asked: Option<Solver>,
    wanted: Wanted,
    n_nodes: usize,
) -> Result<Option<Solver>, SpectraError> {
    let requested = wanted.at_least();
    let Some(solver) = asked else {
        let many = wanted.cutoff().is_some() || requested > n_nodes / 20;
        let dense =
            n_nodes <= FEW_NODES || requested > n_nodes / 2 || n_nodes <= DENSE_NODES && many;
        return Ok(dense.then_some(Solver::Dense));
    };
    let name = solver.name();
    if !solver.is_built() {
        return Err(SpectraError::NotBuilt { solver: name });
    }
    if !solver.finds_all() && requested == n_nodes {
        return Err(SpectraError::AllButOne { solver: name, requested, n_nodes });
    }
    Ok(Some(solver))
}

/// Modes, the solver that found them, and how it is known that they are complete.
///
/// - `solver`: that of [`by_size`].
pub(crate) fn leading(
    w: &SymmetricForm<'_>,
    plan: &Plan,
    solver: Option<Solver>,
    progress: Progress<'_>,
) -> Result<(Found, Solver, Verification), SpectraError> {
    if let Some(solver) = solver
        && let Some(Solve::Dense(solve)) = solver.method().solve
    {
        return Ok((solve(w, plan)?, solver, Verification::Dense));
    }
    let nnz = w.symmetric().nnz() as f64;
    let factorises = solver.is_some_and(|solver| solver.method().factorises);
    let most_fill = if factorises { f64::INFINITY } else { CHEAP_FILL * nnz };
    let symbolic = || Symbolic::within_budget(w.symmetric(), most_fill);
    let (symbolic, links) = rayon::join(symbolic, || Links::new(w));
    let (symbolic, links) = (symbolic.as_ref(), &links);
    let solver = solver.unwrap_or_else(|| by_separators(w, plan, symbolic));
    let Some(Solve::Iterative(solve)) = solver.method().solve else {
        unreachable!("what is dense or was not built is not chosen by separators")
    };
    // By Gershgorin, until a few Lanczos steps find more.
    let low = -2.0 * plan.scale;
    let verifier = Verifier { w, symbolic, links, low, grouping: plan.grouping, progress };
    let random = Random::new(plan.seed);
    let (found, verification) =
        solve(Task { w, plan, links, symbolic, verifier, random, progress })?;
    Ok((found, solver, verification))
}

fn by_separators(w: &SymmetricForm<'_>, plan: &Plan, symbolic: Option<&Symbolic<'_>>) -> Solver {
    let Some(symbolic) = symbolic else { return by_products(w, plan) };
    let solutions = EXPECTED_SOLUTIONS + 4.0 * plan.wanted.at_least() as f64;
    let inverse = symbolic.operations / DENSE_SPEED + 2.0 * solutions * symbolic.nonzeros() as f64;
    let expected = EXPECTED_PRODUCTS.max(PRODUCTS_PER_LEVEL * symbolic.levels as f64);
    let products = expected * w.symmetric().nnz() as f64;
    if inverse < products { Solver::ShiftInvert } else { by_products(w, plan) }
}

/// The solver that only multiplies: ARPACK, where it was built, for a few modes of a network of medium
/// size.
fn by_products(w: &SymmetricForm<'_>, plan: &Plan) -> Solver {
    let few = plan.wanted.cutoff().is_none() && plan.wanted.at_least() <= MOST_ARPACK_MODES;
    let arpack = Solver::Arpack.is_built() && few && w.n_nodes() <= ARPACK_NODES;
    if arpack { Solver::Arpack } else { Solver::Chebyshev }
}
