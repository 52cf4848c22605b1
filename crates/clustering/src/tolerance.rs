//! How far apart rows of an exact cluster may be: what the solver's residuals can have done to them.
//!
//! A computed eigenbasis of a symmetric matrix is off by no more than ‖R‖ / gap, R its residuals and
//! gap the distance of its eigenvalues to the others (Davis & Kahan, SIAM J. Numer. Anal. 7, 1
//! (1970)), and ‖e_i − e_j‖ = √2.

use spectra::RealModes;

use crate::ClusteringError;
use crate::modes::transverse;

/// Below this, components are equal whatever the residuals say: no solver in double precision is
/// more accurate.
const ROUNDING: f64 = 1e-12;

/// Room in the bound on eigenvectors for what the residuals of a non-symmetric (normalized) matrix
/// leave open, the condition of its similarity to a symmetric one.
const SAFETY: f64 = 10.0;

/// Smallest gap, relative to the largest |λ| computed, that enters the bound.
const SMALLEST_GAP: f64 = 1e-4;

/// Largest uncertainty for exact clusters, relative to a typical component 1/√N.
const LARGEST_UNCERTAINTY: f64 = 1e-3;

/// [`crate::EigenvectorDistance::exact_tolerance`] for these eigenspaces.
pub(crate) fn exact_tolerance(spectrum: &RealModes<'_>, chosen: &[usize]) -> f64 {
    let spaces = &spectrum.eigenspaces;
    let residual = chosen
        .iter()
        .flat_map(|&s| &spectrum.residuals[spaces[s].clone()])
        .fold(0.0, |norm: f64, &r| norm.hypot(r));
    let largest = spectrum.eigenvalues.last().map_or(0.0, |l| l.abs());
    let gap = gap(spectrum, chosen).max(SMALLEST_GAP * largest);
    // Written so that a residual that is not a number stays one, and 0/0 does not make one.
    let error = if residual == 0.0 { 0.0 } else { residual / gap };
    let bound = SAFETY * std::f64::consts::SQRT_2 * error;
    if bound < ROUNDING { ROUNDING } else { bound }
}

/// Distance of the chosen eigenvalues to the other transverse ones; zero where it is unknown, with
/// the next eigenvalue not computed, and infinite where there are no others. `chosen` ascends.
fn gap(spectrum: &RealModes<'_>, chosen: &[usize]) -> f64 {
    let spaces = &spectrum.eigenspaces;
    let is_partial = spectrum.eigenvalues.len() < spectrum.eigenvectors[0].len();
    let is_chosen = |space: usize| chosen.binary_search(&space).is_ok();
    if is_partial && is_chosen(spaces.len() - 1) {
        return 0.0;
    }
    let mut gap = f64::INFINITY;
    for (upper, pair) in spaces.windows(2).enumerate() {
        let is_boundary = is_chosen(upper) != is_chosen(upper + 1);
        if is_boundary && !transverse(&pair[0]).is_empty() {
            let (above, below) = (pair[0].end - 1, pair[1].start);
            gap = gap.min(spectrum.eigenvalues[above] - spectrum.eigenvalues[below]);
        }
    }
    gap
}

/// # Errors
/// [`ClusteringError::SpectrumTooRough`] for a tolerance beyond 1e-3/√N.
pub(crate) fn check_tolerance(tolerance: f64, n_nodes: usize) -> Result<(), ClusteringError> {
    let limit = LARGEST_UNCERTAINTY / (n_nodes as f64).sqrt();
    if tolerance.is_nan() || tolerance > limit {
        return Err(ClusteringError::SpectrumTooRough { tolerance, limit });
    }
    Ok(())
}
