//! All eigenpairs of a symmetric matrix stored in full, by faer's self-adjoint eigensolver.
//!
//! S = U Λ Uᵀ by reduction to a tridiagonal matrix and divide and conquer. One thread always, so
//! that the result does not depend on how many there are.

use faer::diag::{Diag, DiagRef};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{
    ComputeEigenvectors, self_adjoint_evd, self_adjoint_evd_scratch, tridiagonal_self_adjoint_evd,
};
use faer::{Mat, Par};
use graph::SparseMatrix;

use crate::basis::Eigenpairs;
use crate::request::Plan;
use crate::{SpectraError, completeness::Found};

/// The leading modes of S, whole eigenspaces only.
pub(crate) fn leading(matrix: &SparseMatrix, plan: &Plan) -> Result<Found, SpectraError> {
    let mut full = vec![0.0; matrix.rows() * matrix.cols()];
    for (i, row) in matrix.outer_iterator().enumerate() {
        for (j, &s_ij) in row.iter() {
            full[i * matrix.cols() + j] = s_ij;
        }
    }
    let mut pairs = symmetric_eigen(matrix.rows(), |i, j| full[i * matrix.cols() + j])?;
    if plan.wanted.cutoff().is_some() {
        plan.wanted.check(&pairs.values, plan.grouping)?;
    }
    let n_modes = plan.wanted.complete(&pairs.values, f64::NEG_INFINITY, plan.grouping);
    pairs.truncate(n_modes.expect("all modes are complete"));
    Ok(Found { pairs, products: 0 })
}

/// All eigenpairs of the symmetric matrix with the given entries; the lower triangle is read.
pub(crate) fn symmetric_eigen(
    n_rows: usize,
    entry: impl Fn(usize, usize) -> f64,
) -> Result<Eigenpairs, SpectraError> {
    if n_rows == 0 {
        return Ok(Eigenpairs::default());
    }
    let matrix = Mat::from_fn(n_rows, n_rows, |i, j| if i >= j { entry(i, j) } else { 0.0 });
    let mut ascending = Diag::<f64>::zeros(n_rows);
    let mut vectors = Mat::<f64>::zeros(n_rows, n_rows);
    let scratch = self_adjoint_evd_scratch::<f64>(
        n_rows,
        ComputeEigenvectors::Yes,
        Par::Seq,
        Default::default(),
    );
    self_adjoint_evd(
        matrix.as_ref(),
        ascending.as_mut(),
        Some(vectors.as_mut()),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        Default::default(),
    )
    .map_err(|_| SpectraError::DenseNotConverged { n_rows })?;
    Ok(Eigenpairs {
        values: ascending.column_vector().iter().rev().copied().collect(),
        vectors: vectors.col_iter().rev().map(|u| u.iter().copied().collect()).collect(),
    })
}

/// All eigenpairs of a symmetric tridiagonal matrix.
pub(crate) struct TridiagonalEigen {
    /// Eigenvalues, descending.
    pub values: Vec<f64>,
    /// Eigenvectors, as columns.
    pub vectors: Mat<f64>,
}

/// All eigenpairs of a symmetric tridiagonal matrix.
///
/// - `beside`: the entries beside the diagonal, one fewer.
pub(crate) fn tridiagonal_eigen(
    diagonal: &[f64],
    beside: &[f64],
) -> Result<TridiagonalEigen, SpectraError> {
    let n_rows = diagonal.len();
    let mut ascending = Diag::<f64>::zeros(n_rows);
    let mut vectors = Mat::<f64>::zeros(n_rows, n_rows);
    let padded: Vec<f64> = beside.iter().copied().chain([0.0]).collect();
    let scratch = self_adjoint_evd_scratch::<f64>(
        n_rows,
        ComputeEigenvectors::Yes,
        Par::Seq,
        Default::default(),
    );
    tridiagonal_self_adjoint_evd(
        DiagRef::from_slice(diagonal),
        DiagRef::from_slice(&padded),
        ascending.as_mut(),
        Some(vectors.as_mut()),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        Default::default(),
    )
    .map_err(|_| SpectraError::DenseNotConverged { n_rows })?;
    let values = ascending.column_vector().iter().rev().copied().collect();
    Ok(TridiagonalEigen { values, vectors: vectors.reverse_cols().to_owned() })
}
