//! What the iterative solver multiplies by: A = S + c·1, and A with known modes deflated, (1 − V Vᵀ) A.

use graph::SparseMatrix;

use crate::basis::project_out;

/// A square linear operator y = A x.
pub(crate) trait Operator {
    /// Number of rows N.
    fn n_rows(&self) -> usize;
    /// Overwrites y, length N, with A x.
    fn apply(&self, x: &[f64], y: &mut [f64]);
}

/// y = M x for a matrix in compressed rows, each row summed from its first column to its last.
pub(crate) fn multiply(matrix: &SparseMatrix, x: &[f64], y: &mut [f64]) {
    assert_eq!((matrix.rows(), matrix.cols()), (y.len(), x.len()), "shapes of y = M x");
    let indptr = matrix.indptr();
    let row_ends = &indptr.raw_storage()[1..];
    let (columns, values) = (matrix.indices(), matrix.data());
    let mut start = 0;
    for (y_i, &end) in y.iter_mut().zip(row_ends) {
        let row = columns[start..end].iter().zip(&values[start..end]);
        *y_i = row.map(|(&j, &m_ij)| m_ij * x[j as usize]).sum();
        start = end;
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use graph::{CouplingMatrix, Network, Normalization};

    #[test]
    fn the_product_is_that_of_sprs() {
        let labels = (0..7).map(|i| i.to_string()).collect();
        let links = [(0, 1, 0.3), (1, 2, 1.7), (2, 0, 2.1), (3, 4, 0.9), (4, 6, 5.0)];
        let network = Network::undirected(labels, &links).unwrap();
        let w = CouplingMatrix::new(&network, Normalization::Laplacian);
        let x: Vec<f64> = (0..7).map(|i| (f64::from(i) * 1.3).sin()).collect();
        let mut y = vec![f64::NAN; 7];
        multiply(w.matrix(), &x, &mut y);
        let mut expected = vec![0.0; 7];
        sprs::prod::mul_acc_mat_vec_csr(w.matrix().view(), x.as_slice(), &mut expected);
        for (y_i, expected_i) in y.iter().zip(&expected) {
            assert!((y_i - expected_i).abs() < 1e-15, "{y:?} {expected:?}");
        }
    }
}
