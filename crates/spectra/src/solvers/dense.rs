//! The leading modes of S from all its eigenpairs.

use graph::SymmetricForm;

use crate::error::SpectraError;
use crate::found::{Eigenpairs, Found};
use crate::plan::Plan;
use crate::solvers::method::{Method, Solve};
use crate::vectors::small_eigen::{Eigen, symmetric_eigen};

/// The dense solver.
pub(crate) const METHOD: Method = Method {
    name: "dense",
    finds_all: true,
    rounding: 1e-15,
    factorises: false,
    solve: Some(Solve::Dense(leading)),
};

/// The leading modes of S, whole eigenspaces only.
fn leading(w: &SymmetricForm<'_>, plan: &Plan) -> Result<Found, SpectraError> {
    let matrix = w.symmetric();
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
