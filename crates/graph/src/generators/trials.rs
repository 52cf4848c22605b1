//! Independent trials with equal probability p, at a cost for successes only: the number of
//! failures before the next success is ⌊ln(1 − r) / ln(1 − p)⌋ for r uniform in [0, 1).
//!
//! Source: V. Batagelj & U. Brandes, Phys. Rev. E 71, 036113 (2005), Sec. II; bits from M. E.
//! O'Neill, PCG XSL RR 128/64 (2014).

use rand_core::Rng;
use rand_pcg::Pcg64;

use crate::unit_interval;

/// Keeps the draws apart from those of other parts that are given the same seed.
const STREAM: u128 = 0x6e65_7477_6f72_6b73;

/// A source of random trials.
pub(super) struct Trials(Pcg64);

impl Trials {
    pub(super) fn new(seed: u64) -> Self {
        Self(Pcg64::new(u128::from(seed), STREAM))
    }

    /// The successes among `n_trials` trials, numbered from 0, ascending.
    ///
    /// - `probability`: in [0, 1]. At 0 no bits are drawn.
    pub(super) fn successes(
        &mut self,
        n_trials: u64,
        probability: f64,
    ) -> impl Iterator<Item = u64> {
        // The logarithm is computed in software, so that its last bit is the same everywhere.
        let ln_failure = libm::log1p(-probability);
        let mut next = 0u64;
        std::iter::from_fn(move || {
            if probability == 0.0 || next >= n_trials {
                return None;
            }
            let failures = libm::log(1.0 - unit_interval(self.0.next_u64())) / ln_failure;
            // The conversion rounds down, and towards the largest number where it must.
            let success = next.saturating_add(failures as u64);
            next = success.saturating_add(1);
            (success < n_trials).then_some(success)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_certain_trial_never_fails_and_an_impossible_one_never_succeeds() {
        let mut trials = Trials::new(1);
        assert!(trials.successes(1000, 1.0).eq(0..1000));
        assert_eq!(trials.successes(u64::MAX, 0.0).count(), 0);
        assert_eq!(trials.successes(0, 0.5).count(), 0);
    }

    #[test]
    fn the_next_success_is_geometrically_distributed() {
        // P(first success = k) = p (1 − p)^k; χ² with 6 classes has 5 degrees of freedom.
        let (p, n_draws) = (0.3, 100_000);
        let mut trials = Trials::new(7);
        let mut counts = [0.0; 6];
        for _ in 0..n_draws {
            let first = trials.successes(u64::MAX, p).next().unwrap();
            counts[usize::try_from(first).unwrap().min(5)] += 1.0;
        }
        let tail = |k: i32| (1.0 - p).powi(k);
        let expected = [0, 1, 2, 3, 4].map(|k| f64::from(n_draws) * p * tail(k));
        let expected = expected.into_iter().chain([f64::from(n_draws) * tail(5)]);
        let chi_square: f64 =
            expected.zip(counts).map(|(e, c): (f64, f64)| (c - e).powi(2) / e).sum();
        assert!(chi_square < 20.5, "{chi_square} is beyond the 99.9 % point of χ²₅");
    }

    #[test]
    fn a_vanishing_probability_ends_at_once() {
        for p in [f64::MIN_POSITIVE, 1e-300, 1e-30] {
            assert_eq!(Trials::new(3).successes(1 << 40, p).count(), 0);
        }
    }
}
