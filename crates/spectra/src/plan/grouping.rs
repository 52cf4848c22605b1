//! Eigenspaces: runs of eigenvalues that are equal up to what rounding can tell apart.
//!
//! A residual r = ‖S u − λ u‖ of a unit vector puts an eigenvalue of a symmetric S within r of λ
//! (Weyl), so computed copies of one eigenvalue differ by at most 2 r. Grouping allows five times
//! that, and at least 10⁻¹⁰ of the largest |w_ii|.

use std::ops::Range;

/// Largest difference of two neighbouring eigenvalues of one eigenspace.
///
/// - `scale`: max_i |w_ii|.
/// - `residual_bound`: largest ‖S u − λ u‖ of any mode.
pub(crate) fn grouping_tolerance(scale: f64, residual_bound: f64) -> f64 {
    (1e-10 * scale).max(10.0 * residual_bound)
}

/// Where the eigenspace of mode `n_modes` (counted from 1) ends: the number of modes down to its
/// last one. Eigenvalues descend.
pub(crate) fn end_of_eigenspace(eigenvalues: &[f64], n_modes: usize, tolerance: f64) -> usize {
    let rest = eigenvalues[n_modes - 1..].windows(2);
    n_modes + rest.take_while(|pair| pair[0] - pair[1] <= tolerance).count()
}

/// Runs of descending eigenvalues in which neighbours differ by at most `tolerance`.
pub(crate) fn eigenspaces(eigenvalues: &[f64], tolerance: f64) -> Vec<Range<usize>> {
    let mut runs = Vec::new();
    let mut start = 0;
    while start < eigenvalues.len() {
        let end = end_of_eigenspace(eigenvalues, start + 1, tolerance);
        runs.push(start..end);
        start = end;
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenspaces_are_runs_of_neighbours_within_the_tolerance() {
        let eigenvalues = [0.0, -1.0, -1.05, -1.1, -2.0, -3.0, -3.1];
        assert_eq!(eigenspaces(&eigenvalues, 0.06), [0..1, 1..4, 4..5, 5..6, 6..7]);
        assert_eq!(eigenspaces(&[], 0.1), []);
    }

    #[test]
    fn a_cut_eigenspace_is_extended_to_its_end() {
        let eigenvalues = [0.0, -1.0, -1.0, -1.0, -2.0];
        let ends: Vec<_> = (1..=5).map(|m| end_of_eigenspace(&eigenvalues, m, 1e-9)).collect();
        assert_eq!(ends, [1, 4, 4, 4, 5]);
    }

    #[test]
    fn the_grouping_tolerance_follows_scale_and_residuals() {
        assert_eq!(grouping_tolerance(3.0, 1e-14), 3e-10);
        assert_eq!(grouping_tolerance(3.0, 0.0625), 0.625);
    }
}
