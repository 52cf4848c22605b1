//! The leading modes of S from all its eigenpairs.

use graph::SparseMatrix;

use crate::error::SpectraError;
use crate::found::{Eigenpairs, Found};
use crate::plan::Plan;
use crate::vectors::small_eigen::{Eigen, symmetric_eigen};

/// The leading modes of S, whole eigenspaces only.
pub(crate) fn leading(matrix: &SparseMatrix, plan: &Plan) -> Result<Found, SpectraError> {
    let mut full = vec![0.0; matrix.rows() * matrix.cols()];
    for (i, row) in matrix.outer_iterator().enumerate() {
        for (j, &s_ij) in row.iter() {
            full[i * matrix.cols() + j] = s_ij;
        }
    }
    let Eigen { mut values, vectors } =
        symmetric_eigen(matrix.rows(), |i, j| full[i * matrix.cols() + j])?;
    if plan.wanted.cutoff().is_some() {
        plan.wanted.check(&values, plan.grouping)?;
    }
    let n_modes = plan.wanted.complete(&values, f64::NEG_INFINITY, plan.grouping);
    values.truncate(n_modes.expect("all modes are complete"));
    let modes = vectors.col_iter().take(values.len());
    let vectors = modes.map(|u| u.iter().copied().collect()).collect();
    Ok(Found { pairs: Eigenpairs { values, vectors }, products: 0 })
}
