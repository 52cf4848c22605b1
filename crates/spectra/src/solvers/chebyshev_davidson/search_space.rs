//! A basis V with the projection Vᵀ S V, and its Ritz pairs: Vᵀ S V = Q Θ Qᵀ gives (θ, V q).

use faer::Mat;

use crate::error::SpectraError;
use crate::vectors::basis::Basis;
use crate::vectors::block::Block;
use crate::vectors::projection::Projection;
use crate::vectors::small_eigen::Eigen;

/// V and Vᵀ S V.
pub(crate) struct Projected {
    pub basis: Basis,
    projection: Projection,
}

impl Projected {
    /// A basis of eigenvectors to the eigenvalue 0.
    pub fn null_space(basis: Basis) -> Self {
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
