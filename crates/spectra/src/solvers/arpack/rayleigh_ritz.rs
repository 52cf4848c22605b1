//! The Rayleigh–Ritz procedure on a few vectors kept one by one.

use crate::error::SpectraError;
use crate::found::Eigenpairs;
use crate::solvers::arpack::operator::Operator;
use crate::vectors::column::{add_scaled, dot, normalise};
use crate::vectors::small_eigen::symmetric_eigen;

/// The eigenpairs of A restricted to the span of orthonormal vectors: H = Qᵀ A Q, H y = θ y, u = Q y.
///
/// Spends one product a vector.
pub(crate) fn rayleigh_ritz(
    operator: &dyn Operator,
    basis: &[Vec<f64>],
) -> Result<Eigenpairs, SpectraError> {
    let n_rows = operator.n_rows();
    let mut image = vec![0.0; n_rows];
    let mut projected = vec![vec![0.0; basis.len()]; basis.len()];
    for (q, row) in basis.iter().zip(&mut projected) {
        operator.apply(q, &mut image);
        for (h, other) in row.iter_mut().zip(basis) {
            *h = dot(other, &image);
        }
    }
    let small = symmetric_eigen(basis.len(), |i, j| 0.5 * (projected[i][j] + projected[j][i]))?;
    let vectors = small.vectors.col_iter().map(|y| combine(basis, y.iter(), n_rows)).collect();
    Ok(Eigenpairs { values: small.values, vectors })
}

/// Σ_k y_k q_k.
fn combine<'a>(basis: &[Vec<f64>], y: impl Iterator<Item = &'a f64>, n_rows: usize) -> Vec<f64> {
    let mut sum = vec![0.0; n_rows];
    for (q, &y_k) in basis.iter().zip(y) {
        add_scaled(y_k, q, &mut sum);
    }
    normalise(&mut sum);
    sum
}
