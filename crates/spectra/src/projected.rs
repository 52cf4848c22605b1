//! A basis V with the projection Vᵀ S V, and its Ritz pairs: Vᵀ S V = Q Θ Qᵀ gives (θ, V q).

use faer::{Mat, MatRef};

use crate::SpectraError;
use crate::block::Block;
use crate::dense::symmetric_eigen;
use crate::orthonormal::Basis;

/// Ritz values, descending, and the coordinates of Ritz vectors in the basis.
pub(crate) struct Ritz {
    pub values: Vec<f64>,
    coordinates: Mat<f64>,
}

impl Ritz {
    /// The coordinates of some.
    pub fn columns(&self, first: usize, count: usize) -> MatRef<'_, f64> {
        self.coordinates.as_ref().subcols(first, count)
    }
}

/// V and Vᵀ S V.
pub(crate) struct Projected {
    pub basis: Basis,
    /// Rows of the lower triangle of Vᵀ S V.
    rows: Vec<Vec<f64>>,
}

impl Projected {
    /// A basis of eigenvectors to the eigenvalue 0.
    pub fn kernel(basis: Basis) -> Self {
        let rows = (0..basis.len()).map(|k| vec![0.0; k + 1]).collect();
        Self { basis, rows }
    }

    /// Adds the vectors Y of an orthonormal block that is orthogonal to the basis.
    ///
    /// - `image`: S Y.
    pub fn append(&mut self, block: &Block, image: &Block) {
        let before = self.basis.len();
        self.basis.append(block);
        let overlaps = self.basis.overlaps(image);
        for v in 0..block.width() {
            let inside = |k: usize| 0.5 * (overlaps[(k, v)] + overlaps[(before + v, k - before)]);
            let entry = |k| if k < before { overlaps[(k, v)] } else { inside(k) };
            self.rows.push((0..=before + v).map(entry).collect());
        }
    }

    /// All Ritz pairs.
    pub fn ritz(&self) -> Result<Ritz, SpectraError> {
        let n_vectors = self.basis.len();
        let pairs = symmetric_eigen(n_vectors, |i, j| self.rows[i][j])?;
        let coordinates = Mat::from_fn(n_vectors, n_vectors, |i, k| pairs.vectors[k][i]);
        Ok(Ritz { values: pairs.values, coordinates })
    }

    /// Replaces the basis by its leading Ritz vectors.
    pub fn rotate(&mut self, ritz: Ritz, kept: usize) -> Ritz {
        self.basis.transform(ritz.columns(0, kept));
        let mut values = ritz.values;
        values.truncate(kept);
        let row = |k| (0..=k).map(|j| if j == k { values[k] } else { 0.0 }).collect();
        self.rows = (0..kept).map(row).collect();
        Ritz { values, coordinates: Mat::identity(kept, kept) }
    }
}
