//! How well a zero of Λ must be known, how far its refinement has come, and how long it will take: an
//! error falls as the root of the number of exponents.

/// How far the refinement of a zero has come, told after each of its rounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Advance {
    /// Where the zero is so far.
    pub sigma: f64,
    /// Its standard error so far.
    pub standard_error: f64,
    /// The standard error asked for.
    pub wanted: f64,
    /// About how many exponents it will still take: an error falls as the root of their number.
    pub exponents_ahead: usize,
}

/// How well a zero of Λ must be known.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Refinement {
    /// Standard error of σ at which a zero is good enough, relative to σ.
    pub relative_error: f64,
    /// Rounds of 32 exponents after which a zero is left as well known as it then is.
    pub max_rounds: usize,
}

impl Default for Refinement {
    fn default() -> Self {
        Self { relative_error: 1e-3, max_rounds: 24 }
    }
}

/// About how many rounds follow those that were spent, where the error is so many times what is asked.
pub(crate) fn rounds_ahead(times: f64, spent: usize, left: usize) -> usize {
    let rounds = (spent as f64 * (times * times - 1.0)).ceil();
    // A window that is still too wide takes another round in any case.
    (rounds.clamp(1.0, left.max(1) as f64)) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_refinement_still_takes_follows_the_root_of_the_number_of_exponents() {
        assert_eq!(rounds_ahead(2.0, 3, 20), 9, "half the error takes four times as many in all");
        assert_eq!([rounds_ahead(0.5, 3, 20), rounds_ahead(100.0, 3, 20)], [1, 20]);
    }
}
