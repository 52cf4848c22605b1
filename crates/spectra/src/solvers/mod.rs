//! The solvers of S, one folder or file each, and the choice among them where it is free.
//!
//! Small separators make both a cheap factorisation and, by Cheeger's inequality, small gaps between
//! the leading eigenvalues, on which filters are slow. So shift-invert is taken where its factor is
//! cheap next to the products that a filter is expected to need. Elsewhere networks of medium size go
//! to ARPACK, where it costs a fraction of a second, and large ones to blocks and filters, which take
//! half of its time or less.

#[cfg(feature = "arpack")]
pub(crate) mod arpack;
pub(crate) mod chebyshev_davidson;
pub(crate) mod dense;
pub(crate) mod shift_invert_lanczos;

use graph::SymmetricForm;

use crate::completeness::Verifier;
use crate::error::SpectraError;
use crate::factorisation::symbolic::{DENSE_SPEED, MOST_NONZEROS, MOST_OPERATIONS, Symbolic};
use crate::found::Found;
use crate::matrix::product::Links;
use crate::plan::Plan;
use crate::progress::Progress;
use crate::recurrences::spectral_density::SpectralDensity;
use crate::request::{ARPACK_NODES, SolverChoice};
use crate::solvers::chebyshev_davidson::Amplifier;
use crate::spectrum::{Solver, Verification};
use crate::vectors::random::Random;

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

/// Modes, the solver that found them, and how it is known that they are complete.
pub(crate) fn leading(
    w: &SymmetricForm<'_>,
    plan: &Plan,
    progress: Progress<'_>,
) -> Result<(Found, Solver, Verification), SpectraError> {
    match plan.choice {
        SolverChoice::Dense => {
            Ok((dense::leading(w.symmetric(), plan)?, Solver::Dense, Verification::Dense))
        }
        SolverChoice::Auto
        | SolverChoice::Arpack
        | SolverChoice::Chebyshev
        | SolverChoice::ShiftInvert => by_iteration(w, plan, progress),
    }
}

/// The same by one of the solvers that find the leading modes alone.
fn by_iteration(
    w: &SymmetricForm<'_>,
    plan: &Plan,
    progress: Progress<'_>,
) -> Result<(Found, Solver, Verification), SpectraError> {
    let most_fill = match plan.choice {
        SolverChoice::ShiftInvert => f64::INFINITY,
        SolverChoice::Dense
        | SolverChoice::Auto
        | SolverChoice::Arpack
        | SolverChoice::Chebyshev => CHEAP_FILL * w.symmetric().nnz() as f64,
    };
    let symbolic = || Symbolic::within_budget(w.symmetric(), most_fill);
    let (symbolic, links) = rayon::join(symbolic, || Links::new(w));
    // By Gershgorin, until a few Lanczos steps find more.
    let low = -2.0 * plan.scale;
    let grouping = plan.grouping;
    let symbolic = symbolic.as_ref();
    let mut verifier = Verifier { w, symbolic, links: &links, low, grouping, progress };
    let solver = choose(w, plan, symbolic)?;
    let mut random = Random::new(plan.seed);
    let (found, verification) = match (solver, symbolic) {
        #[cfg(not(feature = "arpack"))]
        (Solver::Arpack, _) => unreachable!("a plan never asks for what was not built"),
        #[cfg(feature = "arpack")]
        (Solver::Arpack, _) => {
            verifier.low = SpectralDensity::new(&links, plan.scale, &mut random)?.low;
            arpack::leading(w, plan, &verifier, random, progress)?
        }
        // Within the pool a thread finds in its cache what it wrote the time before: a third faster.
        (Solver::ShiftInvert, Some(symbolic)) => rayon::scope(|_| {
            // Nothing smaller than the grouping is told apart from 0.
            shift_invert_lanczos::Search::new(w, plan, (symbolic, grouping), random, progress)?
                .run(&verifier)
        })?,
        (Solver::Dense, _) | (Solver::ShiftInvert, None) => {
            unreachable!("nothing chooses these here")
        }
        (Solver::Chebyshev, _) => rayon::scope(|_| {
            let density = SpectralDensity::new(&links, plan.scale, &mut random)?;
            verifier.low = density.low;
            let first_guess = density.exceeded_by(4 * (plan.wanted.at_least() + 4));
            let amplifier = Amplifier { links: &links, low: density.low, first_guess };
            let search = chebyshev_davidson::Search::new(
                (w, &links),
                plan,
                random,
                density.products,
                progress,
            )?;
            search.run(&amplifier, &verifier)
        })?,
    };
    Ok((found, solver, verification))
}

fn choose(
    w: &SymmetricForm<'_>,
    plan: &Plan,
    symbolic: Option<&Symbolic<'_>>,
) -> Result<Solver, SpectraError> {
    match (plan.choice, symbolic) {
        (SolverChoice::Dense, _) => unreachable!("the dense solver is not iterative"),
        (SolverChoice::Arpack, _) => Ok(Solver::Arpack),
        (SolverChoice::Chebyshev, _) => Ok(Solver::Chebyshev),
        (SolverChoice::Auto, None) => Ok(by_products(w, plan)),
        (SolverChoice::ShiftInvert, Some(_)) => Ok(Solver::ShiftInvert),
        (SolverChoice::ShiftInvert, None) => Err(SpectraError::FactorTooLarge {
            n_nodes: w.n_nodes(),
            most: MOST_NONZEROS,
            most_operations: MOST_OPERATIONS,
        }),
        (SolverChoice::Auto, Some(symbolic)) => {
            let solutions = EXPECTED_SOLUTIONS + 4.0 * plan.wanted.at_least() as f64;
            let inverse =
                symbolic.operations / DENSE_SPEED + 2.0 * solutions * symbolic.nonzeros() as f64;
            let expected = EXPECTED_PRODUCTS.max(PRODUCTS_PER_LEVEL * symbolic.levels as f64);
            let products = expected * w.symmetric().nnz() as f64;
            Ok(if inverse < products { Solver::ShiftInvert } else { by_products(w, plan) })
        }
    }
}

/// The solver that only multiplies: ARPACK, where it was built, for a few modes of a network of medium
/// size.
fn by_products(w: &SymmetricForm<'_>, plan: &Plan) -> Solver {
    let few = plan.wanted.cutoff().is_none() && plan.wanted.at_least() <= MOST_ARPACK_MODES;
    let arpack = SolverChoice::Arpack.is_built() && few && w.n_nodes() <= ARPACK_NODES;
    if arpack { Solver::Arpack } else { Solver::Chebyshev }
}
