//! The checked form of a request, which the solvers work from.

pub(crate) mod grouping;
pub(crate) mod wanted;

use graph::SymmetricForm;

use crate::error::SpectraError;
use crate::plan::wanted::Wanted;

/// A request that has been checked against the matrix.
pub(crate) struct Plan {
    /// Which modes to hand over.
    pub wanted: Wanted,
    /// max_i |w_ii|, or 1 for a network without links; ‖S‖ is at most twice this.
    pub scale: f64,
    /// Largest ‖S u − λ u‖ of a mode that is returned.
    pub residual_bound: f64,
    /// Eigenvalues closer than this are one eigenspace.
    pub grouping: f64,
    /// As in [`crate::Request`].
    pub tolerance: f64,
    pub max_products: usize,
    pub seed: u64,
}

impl Plan {
    /// Takes products from those allowed.
    ///
    /// - `spent`: the products so far.
    /// - `converged`: the modes so far.
    pub fn spend(
        &self,
        spent: &mut usize,
        products: usize,
        converged: usize,
    ) -> Result<(), SpectraError> {
        if *spent + products > self.max_products {
            return Err(self.exhausted(converged, *spent));
        }
        *spent += products;
        Ok(())
    }

    /// The answer when the products are spent.
    pub fn exhausted(&self, converged: usize, products: usize) -> SpectraError {
        let requested = self.wanted.at_least();
        if converged >= requested {
            return SpectraError::CompletenessUnproven { requested, products };
        }
        SpectraError::NotConverged { converged, requested, tolerance: self.tolerance, products }
    }
}

/// max_i |w_ii|: the largest degree of a laplacian, 1 for a normalized matrix.
pub(crate) fn scale(w: &SymmetricForm<'_>) -> Result<f64, SpectraError> {
    let mut largest = 0.0f64;
    for (node, row) in w.symmetric().outer_iterator().enumerate() {
        for &value in row.data() {
            if !value.is_finite() {
                return Err(SpectraError::NotFinite { node, value });
            }
            largest = largest.max(value.abs());
        }
    }
    Ok(if largest > 0.0 { largest } else { 1.0 })
}
