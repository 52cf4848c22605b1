//! Which modes are wanted, and when enough of the spectrum is known to hand them over.

use crate::error::SpectraError;
use crate::plan::grouping::end_of_eigenspace;

/// Which modes are wanted: whole eigenspaces down to the one that holds the last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Wanted {
    /// At least the first `modes`, and at most `max_extra` more.
    Leading { modes: usize, max_extra: usize },
    /// All above `cutoff`, and at most `max_modes`.
    Above { cutoff: f64, max_modes: usize },
}

impl Wanted {
    /// How many of these modes to keep, where that is known: `next` is the largest eigenvalue, or a
    /// bound on it, that is not among them. Eigenvalues descend; those within `grouping` are equal.
    pub fn complete(&self, values: &[f64], next: f64, grouping: f64) -> Option<usize> {
        let n_asked = match *self {
            Self::Leading { modes, .. } => (values.len() >= modes).then_some(modes)?,
            Self::Above { cutoff, .. } => {
                (next <= cutoff + grouping).then(|| count_above(values, cutoff + grouping))?
            }
        };
        let n_whole = if n_asked == 0 { 0 } else { end_of_eigenspace(values, n_asked, grouping) };
        let is_apart = n_whole == 0 || next < values[n_whole - 1] - grouping;
        is_apart.then_some(n_whole)
    }

    /// The same for modes that have been found in descending order, as soon as any can be kept.
    ///
    /// The last one found bounds what follows more tightly than one that has not converged.
    pub fn complete_of_found(&self, found: &[f64], next: f64, grouping: f64) -> Option<usize> {
        let without_last = || {
            let (&last, before) = found.split_last()?;
            self.complete(before, last, grouping)
        };
        self.complete(found, next, grouping).or_else(without_last).filter(|&n| n > 0)
    }

    /// Modes known to be wanted, given the leading ones as far as they are known.
    pub fn known(&self, values: &[f64], grouping: f64) -> usize {
        let n_asked = match *self {
            Self::Leading { modes, .. } => modes,
            Self::Above { cutoff, .. } => count_above(values, cutoff + grouping),
        };
        match n_asked {
            0 => 0,
            n if n > values.len() => n,
            n => end_of_eigenspace(values, n, grouping),
        }
    }

    /// Refuses more modes than are allowed; `values` are eigenvalues for certain.
    pub fn check(&self, values: &[f64], grouping: f64) -> Result<(), SpectraError> {
        match *self {
            Self::Leading { modes: requested, max_extra } if values.len() >= requested => {
                let found = end_of_eigenspace(values, requested, grouping);
                if found > requested.saturating_add(max_extra) {
                    let eigenvalue = values[requested - 1];
                    return Err(SpectraError::EigenspaceTooLarge {
                        requested,
                        eigenvalue,
                        found,
                        max_extra,
                    });
                }
            }
            Self::Above { cutoff, max_modes } => {
                let found = self.known(values, grouping);
                if found > max_modes {
                    return Err(SpectraError::TooManyAbove { cutoff, found, max_modes });
                }
            }
            Self::Leading { .. } => {}
        }
        Ok(())
    }

    /// Below which number nothing is asked of the completeness of modes whose last eigenvalue is
    /// `last`.
    pub fn limit(&self, last: f64, grouping: f64) -> f64 {
        match *self {
            Self::Leading { .. } => last,
            Self::Above { cutoff, .. } => last.min(cutoff + grouping),
        }
    }

    /// An eigenvalue above this that is not among the modes found is missing.
    pub fn missing_from(&self, last: f64, grouping: f64) -> f64 {
        match *self {
            Self::Leading { .. } => last - grouping,
            Self::Above { cutoff, .. } => cutoff + grouping,
        }
    }

    /// The cutoff, where there is one.
    pub fn cutoff(&self) -> Option<f64> {
        match *self {
            Self::Leading { .. } => None,
            Self::Above { cutoff, .. } => Some(cutoff),
        }
    }

    /// Modes asked for in the first place, at least one.
    pub fn at_least(&self) -> usize {
        match *self {
            Self::Leading { modes, .. } => modes,
            Self::Above { .. } => 1,
        }
    }
}

fn count_above(values: &[f64], cutoff: f64) -> usize {
    values.iter().take_while(|&&value| value > cutoff).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    const VALUES: [f64; 5] = [0.0, -1.0, -1.0, -1.0, -2.0];

    #[test]
    fn leading_modes_wait_for_the_end_of_their_eigenspace() {
        let wanted = Wanted::Leading { modes: 2, max_extra: 2 };
        assert_eq!(wanted.complete(&VALUES[..1], -1.0, 1e-9), None);
        assert_eq!(wanted.complete(&VALUES[..4], -1.0, 1e-9), None);
        assert_eq!(wanted.complete(&VALUES[..4], -1.5, 1e-9), Some(4));
        assert_eq!(wanted.complete(&VALUES, -2.0, 1e-9), Some(4));
    }

    #[test]
    fn a_cutoff_at_an_eigenvalue_leaves_its_eigenspace_out() {
        let above = |cutoff| Wanted::Above { cutoff, max_modes: 9 };
        assert_eq!(above(-1.0).complete(&VALUES[..1], -1.0, 1e-9), Some(1));
        assert_eq!(above(-1.0 - 1e-8).complete(&VALUES[..1], -1.0, 1e-9), None);
        assert_eq!(above(-1.0 - 1e-8).complete(&VALUES[..4], -2.0, 1e-9), Some(4));
        assert_eq!(above(0.0).complete(&[], 0.0, 1e-9), Some(0));
    }

    #[test]
    fn more_modes_than_allowed_are_refused_with_numbers() {
        let leading = Wanted::Leading { modes: 2, max_extra: 1 };
        assert_eq!(
            leading.check(&VALUES, 1e-9),
            Err(SpectraError::EigenspaceTooLarge {
                requested: 2,
                eigenvalue: -1.0,
                found: 4,
                max_extra: 1
            })
        );
        let above = Wanted::Above { cutoff: -1.5, max_modes: 3 };
        assert_eq!(
            above.check(&VALUES, 1e-9),
            Err(SpectraError::TooManyAbove { cutoff: -1.5, found: 4, max_modes: 3 })
        );
    }
}
