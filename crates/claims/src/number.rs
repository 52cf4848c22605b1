//! A number as far as it is known, and whether that decides what is claimed of it.
//!
//! A number has a standard error, or is known from one side only, as an onset below the sweep is. A claim
//! with a tolerance is judged by the value where the error is within that tolerance. Otherwise the claim
//! holds if it does for every value that the number may have, within two standard errors, differs if it
//! does for none, and cannot be judged otherwise. What was looked for and is not there differs; what was
//! not computed cannot be judged.

use eigensync::numbers::with_error;
use std::fmt;

use serde_json::{Value, json};

use crate::Trend;
use crate::answer::Answer;

/// A number may be so many standard errors off.
const ERRORS: f64 = 2.0;

/// An error below this share of a bound is small beside it, as in a golden comparison.
const SHARE_OF_BOUND: f64 = 0.25;

/// A number of which something is claimed.
#[derive(Clone, Debug, PartialEq)]
pub enum Number {
    /// A value with its standard error, 0 where it is exact.
    Known {
        /// The value.
        value: f64,
        /// Its standard error.
        error: f64,
    },
    /// Between the least and the most that it can be, in these words.
    Between {
        /// The least.
        least: f64,
        /// The most.
        most: f64,
        /// How that is said.
        words: String,
    },
    /// Looked for up to here, where it was not, in these words.
    NoneUpTo {
        /// Up to where.
        limit: f64,
        /// How that is said.
        words: String,
    },
    /// There is none.
    None,
    /// It was not computed, for this reason.
    Unknown(String),
}

impl Number {
    /// One that has no error.
    pub fn exactly(value: f64) -> Self {
        Self::Known { value, error: 0.0 }
    }

    /// One of which only an upper bound is known.
    pub fn at_most(limit: f64) -> Self {
        let words = format!("at most {limit}");
        Self::Between { least: f64::NEG_INFINITY, most: limit, words }
    }

    /// One of which only a lower bound is known.
    pub fn at_least(limit: f64) -> Self {
        let words = format!("at least {limit}");
        Self::Between { least: limit, most: f64::INFINITY, words }
    }

    /// Whether it lies between two numbers, these included.
    pub fn is_within(&self, low: f64, high: f64) -> Answer {
        match self {
            Self::Known { value, error } if *error <= accuracy_asked(low, high) => {
                (low <= *value && *value <= high).into()
            }
            Self::NoneUpTo { limit, .. } if high <= *limit => Answer::Differs,
            _ => self.decides(|[least, most]| {
                if low <= least && most <= high {
                    Some(true)
                } else if most < low || high < least || least.is_nan() {
                    Some(false)
                } else {
                    None
                }
            }),
        }
    }

    /// What is to be decided for the least and the most that it can be, if that decides it.
    fn decides(&self, of: impl Fn([f64; 2]) -> Option<bool>) -> Answer {
        match (self.range(), self) {
            (Some(range), _) => match of(range) {
                Some(answer) => answer.into(),
                None => Answer::CannotBeJudged(format!("the number is only known to be {self}")),
            },
            (None, Self::None) => Answer::Differs,
            (None, _) => Answer::CannotBeJudged(self.to_string()),
        }
    }

    /// The least and the most that it can be.
    fn range(&self) -> Option<[f64; 2]> {
        match self {
            Self::Known { value, error } => Some([value - ERRORS * error, value + ERRORS * error]),
            Self::Between { least, most, .. } => Some([*least, *most]),
            Self::NoneUpTo { .. } | Self::None | Self::Unknown(_) => None,
        }
    }

    /// As a summary has it: a number, words, or null.
    pub fn shown(&self) -> Value {
        match self {
            Self::Known { value, .. } => json!(value),
            Self::Between { .. } | Self::NoneUpTo { .. } => json!(self.to_string()),
            Self::None | Self::Unknown(_) => Value::Null,
        }
    }
}

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Known { value, error: 0.0 } => write!(f, "{value}"),
            Self::Known { value, error } => f.write_str(&with_error(*value, *error)),
            Self::Between { words, .. } | Self::NoneUpTo { words, .. } => f.write_str(words),
            Self::None => f.write_str("none"),
            Self::Unknown(why) => f.write_str(why),
        }
    }
}

/// The standard error with which a number decides whether it lies between two: half of their distance
/// or, of a single bound, a share of it.
fn accuracy_asked(low: f64, high: f64) -> f64 {
    match (low.is_finite(), high.is_finite()) {
        (true, true) => 0.5 * (high - low),
        (true, false) => SHARE_OF_BOUND * low.abs(),
        (false, true) => SHARE_OF_BOUND * high.abs(),
        (false, false) => f64::INFINITY,
    }
}

/// Whether a claim holds of every one of some numbers, of which there must be some.
pub fn all(numbers: &[Number], holds: impl Fn(usize, &Number) -> Answer) -> Answer {
    Answer::of_all(numbers.iter().enumerate().map(|(at, number)| holds(at, number)))
}

/// Whether each number is above, or below, the one before it. Two that are equal within what is known of
/// them are not known to be in any order; two that are equal exactly are in none.
pub fn follows(numbers: &[Number], trend: Trend) -> Answer {
    let in_order = |pair: &[Number]| {
        let [a, b] = [&pair[0], &pair[1]];
        if [a, b].into_iter().any(|number| *number == Number::None) {
            return Answer::Differs;
        }
        let (Some(first), Some(second)) = (a.range(), b.range()) else {
            let unknown = if a.range().is_none() { a } else { b };
            return Answer::CannotBeJudged(unknown.to_string());
        };
        let [lower, upper] = match trend {
            Trend::Rises => [first, second],
            Trend::Falls => [second, first],
        };
        if lower[1] < upper[0] {
            Answer::Holds
        } else if lower[0] >= upper[1] || lower[0].is_nan() || upper[0].is_nan() {
            Answer::Differs
        } else {
            Answer::CannotBeJudged(format!("of {a} and {b} neither is known to be the larger"))
        }
    };
    Answer::of_all(numbers.windows(2).map(in_order))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exactly(numbers: &[f64]) -> Vec<Number> {
        numbers.iter().map(|&x| Number::exactly(x)).collect()
    }

    fn known(value: f64, error: f64) -> Number {
        Number::Known { value, error }
    }

    fn is_undecided(answer: &Answer) -> bool {
        matches!(answer, Answer::CannotBeJudged(_))
    }

    #[test]
    fn a_claim_about_no_number_never_holds() {
        assert!(matches!(all(&[], |_, _| Answer::Holds), Answer::NothingToJudge));
        assert!(matches!(follows(&[], Trend::Rises), Answer::NothingToJudge));
        assert!(matches!(follows(&exactly(&[1.0]), Trend::Falls), Answer::NothingToJudge));
        assert_eq!(Number::None.is_within(f64::NEG_INFINITY, f64::INFINITY), Answer::Differs);
        assert_eq!(follows(&[Number::None, Number::None], Trend::Rises), Answer::Differs);
    }

    #[test]
    fn what_was_not_computed_cannot_be_judged_and_says_why() {
        let unknown = || Number::Unknown("1 of 2 runs escaped".into());
        let why = Answer::CannotBeJudged("1 of 2 runs escaped".into());
        assert_eq!(unknown().is_within(f64::NEG_INFINITY, f64::INFINITY), why);
        assert_eq!(follows(&[Number::exactly(1.0), unknown()], Trend::Rises), why);
        // A claim that differs in another place differs.
        let numbers = [unknown(), Number::exactly(9.0)];
        assert_eq!(all(&numbers, |_, x| x.is_within(0.0, 1.0)), Answer::Differs);
    }

    #[test]
    fn a_number_known_from_one_side_decides_a_claim_only_where_all_its_values_do() {
        let at_most = Number::at_most(4.0);
        assert_eq!(at_most.is_within(f64::NEG_INFINITY, 4.0), Answer::Holds);
        assert_eq!(at_most.is_within(4.1, 4.3), Answer::Differs);
        assert!(is_undecided(&at_most.is_within(3.9, 4.1)));
        assert!(is_undecided(&at_most.is_within(f64::NEG_INFINITY, 3.0)));
        let at_least = Number::at_least(4.0);
        assert_eq!(at_least.is_within(4.0, f64::INFINITY), Answer::Holds);
        assert_eq!(at_least.is_within(f64::NEG_INFINITY, 3.0), Answer::Differs);
        assert!(is_undecided(&at_least.is_within(3.9, 4.1)));
        let unseen = Number::NoneUpTo { limit: 4.0, words: "not seen".into() };
        assert_eq!(unseen.is_within(2.9, 3.1), Answer::Differs);
        assert!(is_undecided(&unseen.is_within(4.9, 5.1)));
        assert!(is_undecided(&unseen.is_within(3.0, f64::INFINITY)), "it may be nowhere");
    }

    #[test]
    fn an_error_larger_than_the_tolerance_decides_only_what_lies_farther_off() {
        assert_eq!(known(8.2, 0.05).is_within(8.1, 8.3), Answer::Holds);
        assert_eq!(known(8.4, 0.05).is_within(8.1, 8.3), Answer::Differs);
        assert!(is_undecided(&known(8.2, 0.5).is_within(8.1, 8.3)));
        assert!(is_undecided(&known(9.0, 0.5).is_within(8.1, 8.3)));
        assert_eq!(known(9.5, 0.5).is_within(8.1, 8.3), Answer::Differs);
        // Of a bound it counts where it is large beside the bound and the number near to it.
        let below = |number: Number, bound: f64| number.is_within(f64::NEG_INFINITY, bound);
        assert_eq!(below(known(0.93, 0.14), 1.0), Answer::Holds);
        assert!(is_undecided(&below(known(0.93, 0.5), 1.0)));
        assert_eq!(below(known(3e-13, 1e-9), 0.1), Answer::Holds);
        assert!(is_undecided(&below(known(3e-13, 1e-9), 1e-12)), "rounding");
        assert!(is_undecided(&known(2.0 + 1e-15, 2e-15).is_within(2.0, 2.0)), "rounding");
    }

    #[test]
    fn what_is_no_number_holds_no_claim() {
        let nan = Number::exactly(f64::NAN);
        assert_eq!(nan.is_within(f64::NEG_INFINITY, f64::INFINITY), Answer::Differs);
        assert_eq!(follows(&exactly(&[1.0, f64::NAN]), Trend::Rises), Answer::Differs);
    }

    #[test]
    fn numbers_follow_a_trend_one_by_one_as_far_as_their_errors_tell() {
        assert_eq!(follows(&exactly(&[1.0, 2.0, 3.0]), Trend::Rises), Answer::Holds);
        assert_eq!(follows(&exactly(&[1.0, 2.0, 2.0]), Trend::Rises), Answer::Differs);
        assert_eq!(follows(&exactly(&[3.0, 2.0]), Trend::Falls), Answer::Holds);
        let rounding = [known(3e-13, 1e-9), known(1e-13, 1e-9)];
        assert!(is_undecided(&follows(&rounding, Trend::Falls)));
        assert!(is_undecided(&follows(&rounding, Trend::Rises)));
        assert_eq!(follows(&[known(3.0, 0.1), known(1e-13, 1e-9)], Trend::Falls), Answer::Holds);
        assert_eq!(follows(&[known(3.0, 0.1), known(1e-13, 1e-9)], Trend::Rises), Answer::Differs);
    }
}
