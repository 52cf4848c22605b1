//! A basis V with the projection Vᵀ S V, and its Ritz pairs: Vᵀ S V = Q Θ Qᵀ gives (θ, V q).

use faer::{Mat, MatRef};

use crate::SpectraError;
use crate::block::Block;
use crate::dense::{Eigen, symmetric_eigen};
use crate::orthonormal::Basis;

/// Vᵀ A V of a symmetric A, whose lower triangle grows row by row.
#[derive(Default)]
pub(crate) struct Projection {
    rows: Vec<Vec<f64>>,
}

impl Projection {
    /// That of eigenvectors to these eigenvalues.
    pub fn diagonal(values: &[f64]) -> Self {
        let row = |k| (0..=k).map(|j| if j == k { values[k] } else { 0.0 }).collect();
        Self { rows: (0..values.len()).map(row).collect() }
    }

    /// Number of vectors.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Adds a block Y to V.
    ///
    /// - `overlaps`: Vᵀ A Y from the row `first` on, Y being part of V; the rows before are 0.
    pub fn append(&mut self, first: usize, overlaps: MatRef<'_, f64>) {
        let before = self.len();
        let h = |i: usize, v: usize| if i < first { 0.0 } else { overlaps[(i - first, v)] };
        for v in 0..overlaps.ncols() {
            let inside = |k: usize| 0.5 * (h(k, v) + h(before + v, k - before));
            let row = (0..=before + v).map(|k| if k < before { h(k, v) } else { inside(k) });
            self.rows.push(row.collect());
        }
    }

    /// Q and Θ.
    pub fn eigen(&self) -> Result<Eigen, SpectraError> {
        symmetric_eigen(self.len(), |i, j| self.rows[i][j])
    }
}

/// V and Vᵀ S V.
pub(crate) struct Projected {
    pub basis: Basis,
    projection: Projection,
}

impl Projected {
    /// A basis of eigenvectors to the eigenvalue 0.
    pub fn kernel(basis: Basis) -> Self {
        let projection = Projection::diagonal(&vec![0.0; basis.len()]);
        Self { basis, projection }
    }

    /// Adds the vectors Y of an orthonormal block that is orthogonal to the basis.
    ///
    /// - `image`: S Y.
    pub fn append(&mut self, block: &Block, image: &Block) {
        self.basis.append(block);
        self.projection.append(0, self.basis.overlaps(image).as_ref());
    }

    /// Ritz values, descending, and the coordinates of Ritz vectors in the basis.
    pub fn ritz(&self) -> Result<Eigen, SpectraError> {
        self.projection.eigen()
    }

    /// Replaces the basis by its leading Ritz vectors.
    pub fn rotate(&mut self, ritz: Eigen, kept: usize) -> Eigen {
        self.basis.transform(ritz.columns(0, kept));
        let mut values = ritz.values;
        values.truncate(kept);
        self.projection = Projection::diagonal(&values);
        Eigen { values, vectors: Mat::identity(kept, kept) }
    }
}
