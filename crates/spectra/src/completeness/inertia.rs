//! How many eigenvalues of S exceed a number c, by Sylvester's law of inertia.
//!
//! S − c·1 = L D Lᵀ has as many positive eigenvalues as D has positive entries. Without pivoting the
//! factors can be inaccurate; they are the exact ones of S − c·1 + E with
//! |E| ≤ γ_k |L| |D| |Lᵀ|, γ_k = k u / (1 − k u), k the longest row of L (Higham, Accuracy and
//! Stability of Numerical Algorithms, 2nd ed. (SIAM, 2002), Theorem 10.3 in its form for L D Lᵀ). We
//! compute that bound, so a count says for certain how many eigenvalues lie above c, give or take
//! those within ‖E‖ of it (Weyl).

use crate::factorisation::factors::{Factors, Panel};
use crate::factorisation::symbolic::Symbolic;

/// The number of eigenvalues above a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Count {
    pub above: usize,
    /// Eigenvalues no nearer than this to the number are counted rightly.
    pub uncertainty: f64,
}

/// Counts the eigenvalues above c; none when a pivot is zero.
pub(crate) fn count_above(symbolic: &Symbolic<'_>, c: f64) -> Option<Count> {
    let factors = symbolic.factors(c)?;
    let positive =
        |panel: &Panel<'_>| (0..panel.width).filter(|&k| panel.column(k)[0] > 0.0).count();
    let above = factors.panels().map(|panel| positive(&panel)).sum();
    let uncertainty = rounding(&factors);
    uncertainty.is_finite().then_some(Count { above, uncertainty })
}

/// γ_k ‖ |L| |D| |Lᵀ| ‖_∞, a bound on ‖E‖ because the matrix is symmetric.
fn rounding(factors: &Factors<'_>) -> f64 {
    // |D| |Lᵀ| 1: each component needs one column of L. Then |L| times that.
    let mut image = vec![0.0; factors.n_rows()];
    let mut lengths = vec![1usize; factors.n_rows()];
    for panel in factors.panels() {
        for k in 0..panel.width {
            let (pivot, below) = panel.column(k).split_first().expect("a column holds its pivot");
            let weight = pivot.abs() * (1.0 + below.iter().map(|l_ij| l_ij.abs()).sum::<f64>());
            image[panel.row(k)] += weight;
            for (r, l_ij) in (k + 1..).zip(below) {
                image[panel.row(r)] += l_ij.abs() * weight;
                lengths[panel.row(r)] += 1;
            }
        }
    }
    let longest = lengths.into_iter().max().unwrap_or(1) as f64;
    let unit = 0.5 * f64::EPSILON;
    // The subtraction of c rounds the diagonal once more; two more terms cover it and the sum itself.
    let gamma = (longest + 2.0) * unit / (1.0 - (longest + 2.0) * unit);
    gamma * image.into_iter().fold(0.0, f64::max)
}
