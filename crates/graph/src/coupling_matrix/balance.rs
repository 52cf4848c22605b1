//! Whether a matrix is similar to a symmetric one by a diagonal matrix: d_i w_ij = d_j w_ji for all i, j.
//!
//! Then S = D^{1/2} W D^{-1/2} has s_ij = ±√(w_ij w_ji) = s_ji. D follows link by link from any node of a
//! component, and exists when all links around every cycle agree (Kolmogorov's criterion).

use crate::SparseMatrix;

/// Around a cycle d_i w_ij and d_j w_ji may differ by this share: rounding of products along it.
const BALANCED: f64 = 1e-12;

/// S and D^{-1/2}; none for a matrix that is symmetric itself.
pub(super) type Similar = Option<(SparseMatrix, Vec<f64>)>;

/// What W, in compressed rows, is similar to, or two nodes that nothing balances.
pub(super) fn balance(matrix: &SparseMatrix) -> Result<Similar, (usize, usize)> {
    let transposed = |i: usize, j: usize| matrix.get(j, i).copied().unwrap_or(0.0);
    if matrix.iter().all(|(&w, (i, j))| transposed(i as usize, j as usize) == w) {
        return Ok(None);
    }
    let weights = weights(matrix)?;
    let size =
        |i: usize, j: usize, w: f64| (w.abs().sqrt() * transposed(i, j).abs().sqrt()).copysign(w);
    let entries = matrix.iter().map(|(&w, (i, j))| {
        let (i, j) = (i as usize, j as usize);
        if i == j { w } else { size(i, j, w) }
    });
    let (starts, columns) = (matrix.proper_indptr().into_owned(), matrix.indices().to_vec());
    let symmetric = SparseMatrix::new(matrix.shape(), starts, columns, entries.collect());
    Ok(Some((symmetric, weights.iter().map(|d| 1.0 / d.sqrt()).collect())))
}

/// d, 1 at the first node of each component.
fn weights(matrix: &SparseMatrix) -> Result<Vec<f64>, (usize, usize)> {
    let mut weights = vec![0.0; matrix.rows()];
    let mut reached = Vec::new();
    for first in 0..matrix.rows() {
        if weights[first] != 0.0 {
            continue;
        }
        weights[first] = 1.0;
        reached.push(first);
        while let Some(i) = reached.pop() {
            let row = matrix.outer_view(i).expect("a node has a row");
            for (j, &w) in row.iter().filter(|&(j, _)| j != i) {
                let back = matrix.get(j, i).copied().unwrap_or(0.0);
                // Not a number, negative or without end where only one of the two is there.
                let found = weights[i] * (w / back);
                let is_new = weights[j] == 0.0;
                if is_new {
                    weights[j] = found;
                    reached.push(j);
                }
                let is_balanced = (found / weights[j] - 1.0).abs() <= BALANCED;
                if !(is_balanced && found > 0.0 && found.is_finite()) {
                    return Err((i, j));
                }
            }
        }
    }
    Ok(weights)
}
