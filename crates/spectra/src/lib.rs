//! Leading eigenvalues, eigenvectors and eigenspaces of a coupling matrix, with none lost.
//!
//! W v_k = λ_k v_k with λ_1 ≥ λ_2 ≥ …. All solvers work on the symmetric matrix S similar to W and
//! take its eigenvectors u to node space by v = D^{-1/2} u; see [`graph::CouplingMatrix`].
//!
//! Entry: [`leading_modes`]. Knows nothing of what the modes are for.

mod choice;
mod eigenspace;
mod error;
mod progress;
mod real_modes;
mod request;
mod resolve;
mod spectrum;

mod completeness;
mod factorisation;
mod found;
mod matrix;
mod modes;
mod plan;
mod recurrences;
mod smallest_eigenvalue;
mod solvers;
mod subspace;
mod vectors;
mod verification;

pub use choice::{ARPACK_NODES, DENSE_NODES};
pub use eigenspace::{Eigenspace, Eigenvalue};
pub use error::SpectraError;
pub use progress::{Advance, Progress};
pub use real_modes::RealModes;
pub use request::{Modes, Request};
pub use smallest_eigenvalue::smallest_eigenvalue;
pub use solvers::Solver;
pub use spectrum::Spectrum;
pub use subspace::subspace_distance;
pub use verification::Verification;

use graph::CouplingMatrix;

/// The modes of W that belong to its largest eigenvalues.
///
/// Whole eigenspaces only: when the count asked for would cut an eigenspace, the rest of that
/// eigenspace is returned as well, because a part of it would depend on an arbitrary basis. The
/// spectrum may therefore have more modes than [`Modes::Leading`] asked for, never fewer.
///
/// As many modes are of eigenvalue 0, exactly, as the network has components; what rounding beside the
/// largest weight does not tell from 0 has eigenvalues of its own, as the weak links make them.
///
/// Every eigenpair satisfies ‖S u − λ u‖ ≤ `tolerance` · max_i |w_ii| with ‖u‖ = 1 (for the dense
/// solver also allowed is N · 10⁻¹⁵ · max_i |w_ii|). [`Eigenspace::residuals`] are those of W itself
/// in node space, which differ from these by at most √(max k_i / min k_i) for a normalized matrix.
///
/// The same matrix and request give the same bits on the same machine, whatever was solved before
/// and whatever other threads solve meanwhile; with ARPACK this needs a fixed number of BLAS threads.
///
/// # Errors
/// [`SpectraError::NoModes`], [`SpectraError::TooManyModes`], [`SpectraError::BadTolerance`],
/// [`SpectraError::NotBuilt`], [`SpectraError::AllButOne`] and [`SpectraError::TooLargeForArpack`] for
/// requests that cannot be met; [`SpectraError::NotSymmetric`] for a matrix that is not similar to a symmetric one and
/// [`SpectraError::NegativeLink`] for one with a negative link, which no solver takes yet;
/// [`SpectraError::NotFinite`] for a matrix that overflows; [`SpectraError::NotConverged`],
/// [`SpectraError::CompletenessUnproven`] and [`SpectraError::EigenspaceTooLarge`] when the work
/// allowed does not suffice.
pub fn leading_modes(w: &CouplingMatrix, request: &Request) -> Result<Spectrum, SpectraError> {
    leading_modes_with(w, request, &|_| std::ops::ControlFlow::Continue(()))
}

/// The same as [`leading_modes`], telling on the way how far it has come, and stopping where that is
/// wanted. Iterative solvers ask at every product of a vector or a block. The dense solver tells of
/// nothing: a second at 1000 nodes, growing as N³, passes in one call of faer, and so does a
/// factorisation, of half a minute at the most.
///
/// # Errors
/// Those of [`leading_modes`], and [`SpectraError::Cancelled`].
pub fn leading_modes_with(
    w: &CouplingMatrix,
    request: &Request,
    progress: Progress<'_>,
) -> Result<Spectrum, SpectraError> {
    let w = &matrix::symmetric::symmetric_form(w)?;
    let (plan, solver) = request.resolve(w)?;
    let (found, solver, verification) = choice::leading(w, &plan, solver, progress)?;
    modes::node_space::spectrum(w, found, &plan, (solver, verification))
}
