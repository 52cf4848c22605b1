//! Eigenvalues of small matrices, by the QR algorithm of nalgebra.

use nalgebra::{Complex, DMatrix, Schur};

/// Entries beyond this are too large for their squares to be numbers.
const HUGE: f64 = 1e100;
/// Sweeps of the QR algorithm; a few for each eigenvalue are usual.
const MOST_SWEEPS: usize = 10_000;

/// Eigenvalues of a small matrix; none of one that is too large, or whose eigenvalues are not found.
pub(crate) fn eigenvalues(a: DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    let size = largest(&a);
    let schur = (size < HUGE).then(|| Schur::try_new(a, f64::EPSILON, MOST_SWEEPS)).flatten()?;
    Some(schur.complex_eigenvalues().iter().copied().collect())
}

/// The largest |entry|.
pub(crate) fn largest(a: &DMatrix<f64>) -> f64 {
    a.iter().fold(0.0f64, |size, entry| size.max(entry.abs()))
}
