//! All eigenpairs of a symmetric matrix stored in full, by faer's self-adjoint eigensolver.
//!
//! S = U Λ Uᵀ by reduction to a tridiagonal matrix and divide and conquer. One thread always, so
//! that the result does not depend on how many there are.

use faer::diag::{Diag, DiagMut, DiagRef};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{
    ComputeEigenvectors, EvdError, self_adjoint_evd, self_adjoint_evd_scratch,
    tridiagonal_self_adjoint_evd,
};
use faer::{Mat, MatMut, MatRef, Par};

use crate::error::SpectraError;

/// All eigenpairs of a small symmetric matrix.
pub(crate) struct Eigen {
    /// Eigenvalues, descending.
    pub values: Vec<f64>,
    /// Eigenvectors, as columns.
    pub vectors: Mat<f64>,
}

impl Eigen {
    /// Some neighbouring eigenvectors.
    pub fn columns(&self, first: usize, count: usize) -> MatRef<'_, f64> {
        self.vectors.as_ref().subcols(first, count)
    }
}

/// All eigenpairs of the symmetric matrix with the given entries; the lower triangle is read.
pub(crate) fn symmetric_eigen(
    n_rows: usize,
    entry: impl Fn(usize, usize) -> f64,
) -> Result<Eigen, SpectraError> {
    let matrix = Mat::from_fn(n_rows, n_rows, |i, j| if i >= j { entry(i, j) } else { 0.0 });
    eigen(n_rows, |values, vectors, stack| {
        self_adjoint_evd(matrix.as_ref(), values, vectors, Par::Seq, stack, Default::default())
    })
}

/// All eigenpairs of a symmetric tridiagonal matrix.
///
/// - `beside`: the entries beside the diagonal, one fewer.
pub(crate) fn tridiagonal_eigen(diagonal: &[f64], beside: &[f64]) -> Result<Eigen, SpectraError> {
    let padded: Vec<f64> = beside.iter().copied().chain([0.0]).collect();
    let (diagonal, beside) = (DiagRef::from_slice(diagonal), DiagRef::from_slice(&padded));
    eigen(diagonal.dim(), |values, vectors, stack| {
        let (par, params) = (Par::Seq, Default::default());
        tridiagonal_self_adjoint_evd(diagonal, beside, values, vectors, par, stack, params)
    })
}

/// What an eigensolver of faer finds, in descending order.
fn eigen(
    n_rows: usize,
    solve: impl FnOnce(DiagMut<'_, f64>, Option<MatMut<'_, f64>>, &mut MemStack) -> Result<(), EvdError>,
) -> Result<Eigen, SpectraError> {
    let mut values = Diag::zeros(n_rows);
    let mut vectors = Mat::zeros(n_rows, n_rows);
    if n_rows > 0 {
        let (job, params) = (ComputeEigenvectors::Yes, Default::default());
        let scratch = self_adjoint_evd_scratch::<f64>(n_rows, job, Par::Seq, params);
        let mut buffer = MemBuffer::new(scratch);
        solve(values.as_mut(), Some(vectors.as_mut()), MemStack::new(&mut buffer))
            .map_err(|_| SpectraError::DenseNotConverged { n_rows })?;
    }
    Ok(Eigen {
        values: values.column_vector().iter().rev().copied().collect(),
        vectors: vectors.reverse_cols().to_owned(),
    })
}
