//! When a long Lanczos sequence is due in a block search: at first, as long as sequences find modes, and
//! when residuals fall so slowly from block to block that a sequence would be cheaper.

/// Blocks beyond which one long sequence is worth its products.
const MOST_BLOCKS: f64 = 8.0;

/// The residuals of the first Ritz vector that has not converged, block by block.
#[derive(Default)]
pub(crate) struct Stagnation {
    /// Whether a sequence was due the last time.
    after_sequence: bool,
    /// The number of vectors that had converged, and the residual of the next one.
    last: Option<(usize, f64)>,
}

impl Stagnation {
    /// Takes note of a residual.
    pub fn sequence_is_due(&mut self, converged: usize, residual: Option<f64>, bound: f64) -> bool {
        let before = self.last.replace((converged, residual.unwrap_or(0.0)));
        let due = match (before, residual) {
            (None, _) => true,
            (Some((n, _)), _) if n != converged => self.after_sequence,
            (Some((_, from)), Some(to)) => {
                let fallen = (from / to).ln().max(0.0);
                (to / bound).ln() > MOST_BLOCKS * fallen
            }
            (Some(_), None) => false,
        };
        self.after_sequence = due;
        due
    }

    /// Copies of eigenvalues are missing, of which a block finds several at once.
    pub fn continue_in_blocks(&mut self) {
        self.after_sequence = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a sequence is due after each of these, with residuals asked for of 1e-10.
    fn due(residuals: &[(usize, f64)]) -> Vec<bool> {
        let mut stagnation = Stagnation::default();
        residuals.iter().map(|&(n, r)| stagnation.sequence_is_due(n, Some(r), 1e-10)).collect()
    }

    #[test]
    fn sequences_go_on_while_they_find_modes() {
        assert_eq!(due(&[(1, 1.0), (8, 1e-2), (10, 1e-3)]), [true, true, true]);
    }

    #[test]
    fn blocks_go_on_while_residuals_fall_by_a_thousand() {
        assert_eq!(due(&[(0, 1e-1), (0, 1e-4), (0, 1e-7), (1, 1e-2)]), [true, false, false, false]);
    }

    #[test]
    fn residuals_that_halve_call_for_a_sequence() {
        assert_eq!(due(&[(0, 1e-1), (0, 1e-4), (0, 5e-5)]), [true, false, true]);
    }
}
