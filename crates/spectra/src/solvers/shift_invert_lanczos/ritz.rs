//! The Rayleigh–Ritz procedure on S in the span of a basis V: Vᵀ S V = Q Θ Qᵀ gives the pairs
//! (θ, V q), each with its residual.
//!
//! Source: Y. Saad, Numerical Methods for Large Eigenvalue Problems (SIAM, 2011), section 4.3.

use faer::Mat;
use graph::SymmetricForm;

use crate::error::SpectraError;
use crate::found::{Eigenpairs, Found};
use crate::matrix::product::multiply_block;
use crate::vectors::basis::Basis;
use crate::vectors::block::Block;
use crate::vectors::small_eigen::symmetric_eigen;

/// Ritz pairs of S.
pub(crate) struct Modes {
    /// Ritz values, descending.
    pub values: Vec<f64>,
    /// Ritz vectors.
    pub basis: Basis,
    /// ‖S u − θ u‖ of each.
    pub residuals: Vec<f64>,
}

impl Modes {
    /// Those of a span, with one product a vector.
    pub fn in_span(w: &SymmetricForm<'_>, mut basis: Basis) -> Result<Self, SpectraError> {
        let n_vectors = basis.len();
        let mut images = Basis::empty(basis.n_rows());
        let mut projected = Mat::<f64>::zeros(n_vectors, n_vectors);
        for range in Block::ranges(n_vectors) {
            let image = multiply_block(w.symmetric(), &basis.block(range.clone()));
            let overlaps = basis.overlaps(&image);
            projected.as_mut().subcols_mut(range.start, range.len()).copy_from(&overlaps);
            images.append(&image);
        }
        let pairs =
            symmetric_eigen(n_vectors, |i, j| 0.5 * (projected[(i, j)] + projected[(j, i)]))?;
        basis.transform(pairs.vectors.as_ref());
        images.transform(pairs.vectors.as_ref());
        let residuals = basis.residuals(&images, &pairs.values);
        Ok(Self { values: pairs.values, basis, residuals })
    }

    /// The first of them, with the products that they took.
    pub fn first(mut self, n_modes: usize, products: usize) -> Found {
        self.values.truncate(n_modes);
        let vectors = (0..n_modes).map(|k| self.basis.vector(k)).collect();
        Found { pairs: Eigenpairs { values: self.values, vectors }, products }
    }
}
