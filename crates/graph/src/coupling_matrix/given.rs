//! A coupling matrix from any W, directed and signed ones included.

use super::balance::balance;
use super::{CouplingMatrix, Form};
use crate::{CouplingError, SparseMatrix};

/// A row sums to zero when its sum is smaller than this share of Σ_j |w_ij|: rounding of as many
/// digits as a file can hold.
const ZERO_SUM: f64 = 1e-12;

impl CouplingMatrix {
    /// W itself, w_ij the strength with which j drives i; it may be directed, and links negative.
    ///
    /// Zeros are no links. What rounding leaves of the sum of a row goes to its diagonal, which then
    /// is w_ii = −Σ_j w_ij as in a laplacian. O(L log k) for L links, at most k at a node.
    ///
    /// # Errors
    /// [`CouplingError::Empty`], [`CouplingError::NotSquare`], [`CouplingError::NotFinite`], and
    /// [`CouplingError::RowSum`] for a row whose sum is more than 1e-12 of its Σ_j |w_ij|.
    pub fn as_given(matrix: &SparseMatrix) -> Result<Self, CouplingError> {
        let rows = matrix.to_csr();
        let entries = rows.outer_iterator().map(|row| row.iter().map(|(j, &w)| (j, w)).collect());
        from_entries(entries, matrix.shape())
    }

    /// The same from its rows in full.
    ///
    /// # Errors
    /// Those of [`Self::as_given`], [`CouplingError::NotSquare`] for a row of another length.
    pub fn from_rows(rows: &[impl AsRef<[f64]>]) -> Result<Self, CouplingError> {
        let n_nodes = rows.len();
        let other = rows.iter().map(|row| row.as_ref().len()).find(|&length| length != n_nodes);
        let entries = rows.iter().map(|row| row.as_ref().iter().copied().enumerate().collect());
        from_entries(entries, (n_nodes, other.unwrap_or(n_nodes)))
    }
}

/// W from the entries of each row, columns ascending.
fn from_entries(
    rows: impl Iterator<Item = Vec<(usize, f64)>>,
    (n_rows, n_columns): (usize, usize),
) -> Result<CouplingMatrix, CouplingError> {
    if n_rows == 0 {
        return Err(CouplingError::Empty);
    }
    if n_rows != n_columns || u32::try_from(n_rows).is_err() {
        return Err(CouplingError::NotSquare { rows: n_rows, columns: n_columns });
    }
    let (mut starts, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
    for (row, entries) in rows.enumerate() {
        let sum = checked_sum(row, &entries)?;
        let others = entries.iter().filter(|&&(j, w)| j != row && w != 0.0);
        let diagonal = entries.iter().find(|&&(j, _)| j == row).map_or(0.0, |&(_, w)| w);
        let place = columns.len() + others.clone().filter(|&&(j, _)| j < row).count();
        columns.extend(others.clone().map(|&(j, _)| j as u32));
        values.extend(others.map(|&(_, w)| w));
        columns.insert(place, row as u32);
        values.insert(place, diagonal - sum);
        starts.push(columns.len());
    }
    let matrix = SparseMatrix::new((n_rows, n_rows), starts, columns, values);
    let form = match balance(&matrix) {
        Ok(None) => Form::Symmetric { scale: vec![1.0; n_rows] },
        Ok(Some((symmetric, scale))) => Form::Similar { symmetric, scale },
        Err(at) => Form::Neither { at },
    };
    Ok(CouplingMatrix { matrix, form })
}

/// The sum of a row, zero up to rounding.
fn checked_sum(row: usize, entries: &[(usize, f64)]) -> Result<f64, CouplingError> {
    let bad = entries.iter().find(|(_, value)| !value.is_finite());
    if let Some(&(column, value)) = bad {
        return Err(CouplingError::NotFinite { row, column, value });
    }
    let sum: f64 = entries.iter().map(|(_, value)| value).sum();
    let size: f64 = entries.iter().map(|(_, value)| value.abs()).sum();
    if sum.abs() <= ZERO_SUM * size {
        Ok(sum)
    } else {
        Err(CouplingError::RowSum { row, sum, size })
    }
}
