//! Modes of S as a solver hands them over.

/// Eigenvalues, descending, with unit eigenvectors in the same order.
#[derive(Default)]
pub(crate) struct Eigenpairs {
    pub values: Vec<f64>,
    pub vectors: Vec<Vec<f64>>,
}

impl Eigenpairs {
    /// Number of pairs.
    pub fn len(&self) -> usize {
        self.values.len()
    }
}

/// Modes of S, and what they cost.
pub(crate) struct Found {
    pub pairs: Eigenpairs,
    /// Matrix–vector products spent.
    pub products: usize,
}
