//! The smallest eigenvalue λ_N alone, by Lanczos steps from a random vector: the smallest Ritz value,
//! whose distance to an eigenvalue is at most its residual β_k |s_k| and, as it lies above λ_N, about
//! the square of that over the gap (Y. Saad, Numerical Methods for Large Eigenvalue Problems (SIAM,
//! 2011), section 6.6). No vector is kept.

use graph::CouplingMatrix;

use crate::error::SpectraError;
use crate::matrix::product::Links;
use crate::matrix::symmetric::symmetric_form;
use crate::plan::scale;
use crate::recurrences::lanczos::Lanczos;
use crate::vectors::random::Random;

/// Largest residual, relative to max_i |w_ii|, at which λ_N is known well enough.
const RESIDUAL: f64 = 1e-7;
/// Steps from one look at the Ritz values to the next.
const BETWEEN_LOOKS: usize = 20;
/// The most steps; eigenvalues at the far end of a spectrum are rarely so dense that they need them.
const MOST_STEPS: usize = 600;
/// Seed of the start vector.
const SEED: u64 = 1;

/// λ_N, the most negative eigenvalue of W, to about 1e-7 of the largest |w_ii|: what the fastest mode
/// is damped by at σ = −ελ_N, without the modes before it.
///
/// # Errors
/// [`SpectraError::NotSymmetric`] and [`SpectraError::NegativeLink`] as in [`crate::leading_modes`],
/// [`SpectraError::NotFinite`] for a matrix that overflows, [`SpectraError::NotConverged`] when 600
/// products do not suffice.
pub fn smallest_eigenvalue(w: &CouplingMatrix) -> Result<f64, SpectraError> {
    let w = &symmetric_form(w)?;
    let scale = scale(w)?;
    let links = Links::new(w);
    let start = Random::new(SEED).block(w.n_nodes(), 1);
    let mut lanczos = Lanczos::from(start, &links, scale);
    loop {
        let goes_on = lanczos.step() && lanczos.steps() < w.n_nodes();
        if goes_on && !lanczos.steps().is_multiple_of(BETWEEN_LOOKS) {
            continue;
        }
        let (ritz, k) = (lanczos.ritz()?, lanczos.steps());
        let residual = lanczos.last_beta() * ritz.vectors[(k - 1, k - 1)].abs();
        if !goes_on || residual <= RESIDUAL * scale {
            return Ok(ritz.values[k - 1].min(0.0));
        }
        if k >= MOST_STEPS {
            return Err(SpectraError::NotConverged {
                converged: 0,
                requested: 1,
                tolerance: RESIDUAL,
                products: k,
            });
        }
    }
}
