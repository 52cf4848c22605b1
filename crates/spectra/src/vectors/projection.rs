//! The projection Vᵀ A V of a symmetric A on a basis V that grows, and its eigenpairs.

use faer::MatRef;

use crate::error::SpectraError;
use crate::vectors::small_eigen::{Eigen, symmetric_eigen};

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
