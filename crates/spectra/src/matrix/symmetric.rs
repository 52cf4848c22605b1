//! What the solvers take: matrices similar to symmetric ones, with positive links.
//!
//! Then all eigenvalues are real, none exceeds 0 (Gershgorin), and those equal to 0 are as many as the
//! network has components.

use graph::{CouplingMatrix, SymmetricForm, Symmetry};

use crate::error::SpectraError;

/// The symmetric form of W.
pub(crate) fn symmetric_form(w: &CouplingMatrix) -> Result<SymmetricForm<'_>, SpectraError> {
    let entry = |i, j| w.matrix().get(i, j).copied().unwrap_or(0.0);
    let Some(form) = w.symmetric_form() else {
        let Symmetry::Neither { at: (row, column) } = w.symmetry() else {
            unreachable!("only a matrix without symmetry lacks a symmetric form");
        };
        let (value, transposed) = (entry(row, column), entry(column, row));
        return Err(SpectraError::NotSymmetric { row, column, value, transposed });
    };
    let negative = |&(value, (i, j)): &(&f64, (u32, u32))| i != j && *value < 0.0;
    match w.matrix().iter().find(negative) {
        Some((&value, (i, j))) => {
            Err(SpectraError::NegativeLink { row: i as usize, column: j as usize, value })
        }
        None => Ok(form),
    }
}
