//! What the iterative solver multiplies by: A = S + c·1, and A with known modes deflated, (1 − V Vᵀ) A.

use graph::SparseMatrix;

use crate::matrix::product::multiply;
use crate::vectors::column::project_out;

/// A square linear operator y = A x.
pub(crate) trait Operator {
    /// Number of rows N.
    fn n_rows(&self) -> usize;
    /// Overwrites y, length N, with A x.
    fn apply(&self, x: &[f64], y: &mut [f64]);
}

/// S + shift · 1.
pub(crate) struct Shifted<'a> {
    pub matrix: &'a SparseMatrix,
    pub shift: f64,
}

impl Operator for Shifted<'_> {
    fn n_rows(&self) -> usize {
        self.matrix.rows()
    }

    fn apply(&self, x: &[f64], y: &mut [f64]) {
        multiply(self.matrix, x, y);
        for (y_i, x_i) in y.iter_mut().zip(x) {
            *y_i += self.shift * x_i;
        }
    }
}

/// (1 − V Vᵀ) A, with orthonormal eigenvectors V of A.
///
/// On the complement of V this is A; V itself has eigenvalue 0, which lies below the rest of the
/// spectrum when A is positive definite. A projection before the product would change nothing,
/// because A V = V Λ.
pub(crate) struct Deflated<'a> {
    pub operator: &'a dyn Operator,
    pub found: &'a [Vec<f64>],
}

impl Operator for Deflated<'_> {
    fn n_rows(&self) -> usize {
        self.operator.n_rows()
    }

    fn apply(&self, x: &[f64], y: &mut [f64]) {
        self.operator.apply(x, y);
        project_out(self.found, y);
    }
}
