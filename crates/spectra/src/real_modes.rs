//! A real spectrum mode by mode, as who sums over modes reads it.

use std::ops::Range;

use crate::spectrum::Spectrum;

/// Modes k = 0, 1, … of a real spectrum, λ descending.
#[derive(Clone, Debug)]
pub struct RealModes<'a> {
    /// λ of each.
    pub eigenvalues: Vec<f64>,
    /// v of each, length N.
    pub eigenvectors: Vec<&'a [f64]>,
    /// ‖W v − λ v‖ of each.
    pub residuals: Vec<f64>,
    /// The modes of each eigenspace, which cover all in order.
    pub eigenspaces: Vec<Range<usize>>,
    /// As in [`Spectrum::tolerance`].
    pub tolerance: f64,
    /// As in [`Spectrum::cutoff`].
    pub cutoff: Option<f64>,
}

impl RealModes<'_> {
    /// How far eigenvalue λ_k, counted from 0, may be off. An eigenvalue lies within the residual of it.
    /// Those within [`Self::tolerance`] of 0 are Rayleigh quotients found by differences, and off by
    /// r²/gap only, r the residual and gap the distance to all others (Parlett, The Symmetric Eigenvalue
    /// Problem (1980), Sec. 11.7).
    pub fn error(&self, k: usize) -> f64 {
        let (lambda, residual) = (self.eigenvalues[k], self.residuals[k]);
        let is_slow = |lambda: &f64| lambda.abs() <= self.tolerance;
        match self.eigenvalues.iter().find(|lambda| !is_slow(lambda)) {
            Some(next) if is_slow(&lambda) => residual.min(residual * residual / next.abs()),
            _ => residual,
        }
    }
}

impl Spectrum {
    /// The spectrum mode by mode.
    ///
    /// # Panics
    /// Where an eigenvalue is not real, which no matrix has that is similar to a symmetric one.
    pub fn real_modes(&self) -> RealModes<'_> {
        let spaces = || self.eigenspaces.iter();
        let values = spaces().flat_map(|space| &space.values);
        let mut end = 0;
        let range = |dimension| {
            end += dimension;
            end - dimension..end
        };
        RealModes {
            eigenvalues: values
                .map(|value| {
                    assert!(value.is_real(), "λ = {value} where eigenvalues are to be real");
                    value.re
                })
                .collect(),
            eigenvectors: spaces().flat_map(|space| &space.basis).map(Vec::as_slice).collect(),
            residuals: spaces().flat_map(|space| &space.residuals).copied().collect(),
            eigenspaces: spaces().map(|space| space.basis.len()).map(range).collect(),
            tolerance: self.tolerance,
            cutoff: self.cutoff,
        }
    }

    /// λ of every mode, descending.
    ///
    /// # Panics
    /// As [`Self::real_modes`] does.
    pub fn real_eigenvalues(&self) -> Vec<f64> {
        self.real_modes().eigenvalues
    }
}
