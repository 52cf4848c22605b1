//! The slowest time in which an isolated oscillator comes back: an average of its errors over less
//! than this is of a stretch, and not of the orbit.
//!
//! The observed component x crosses its mean upwards once in a cycle. Between cycles of one pace these
//! crossings are a period apart; where the orbit waits, as bursting neurons do between bursts or the
//! Lorenz system on one of its wings, they are further apart. The slow time is the longest interval
//! between two upward crossings in a stretch of orbit at least [`CYCLES`] times as long: the period of
//! a limit cycle, the longest pause of a burster.
//!
//! An autocorrelation time would not do: its integral is small wherever x oscillates fast within a
//! burst, whatever the pauses between bursts.

use crate::error::check_times;
use crate::isolated_orbit::IsolatedOrbit;
use crate::{DynamicsError, NodeDynamics};

/// The stretch of orbit is this many slow times long, unless these are too long for it.
const CYCLES: f64 = 20.0;
/// Steps of the first stretch and of the longest one; each is preceded by one half as long.
const STRETCH: [usize; 2] = [1 << 16, 1 << 22];
/// A component that varies by no more than this, relative to its size, is at rest.
const AT_REST: f64 = 1e-6;
/// An orbit whose range shrinks by more than this from one half of a stretch to the next is settling.
const SETTLED: f64 = 0.8;

/// The longest interval between upward crossings of the mean of one component of an isolated orbit, in
/// model time units; none where the orbit comes to rest.
///
/// - `component`: counted from 0.
/// - `step`: of RK4, in model time units.
/// - `seed`: of the orbit's initial state.
///
/// # Errors
/// [`DynamicsError::BadStep`] for a step that makes no sense; [`DynamicsError::Escaped`] when the orbit
/// leaves the ball of radius [`crate::ESCAPE_RADIUS`].
pub fn slow_time(
    dynamics: &dyn NodeDynamics,
    component: usize,
    step: f64,
    seed: u64,
) -> Result<Option<f64>, DynamicsError> {
    check_times(step, &[], f64::INFINITY)?;
    let mut orbit = IsolatedOrbit::begin(dynamics, step, seed);
    let mut n_steps = STRETCH[0];
    loop {
        let mut stretch = Vec::with_capacity(n_steps);
        for number in 0..n_steps + n_steps / 2 {
            orbit.advance();
            let state = orbit.bounded()?;
            if number >= n_steps / 2 {
                stretch.push(state[component]);
            }
        }
        let (first, second) = stretch.split_at(n_steps / 2);
        let settled = extent(second) >= SETTLED * extent(first);
        let is_last = n_steps >= STRETCH[1];
        let size = stretch.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
        if extent(&stretch) <= AT_REST * (1.0 + size) || (is_last && !settled) {
            return Ok(None);
        }
        let longest = longest_interval(&stretch);
        if is_last || (settled && longest as f64 * CYCLES <= n_steps as f64) {
            return Ok(Some(longest as f64 * step));
        }
        n_steps *= 2;
    }
}

/// Largest less smallest value.
fn extent(values: &[f64]) -> f64 {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least
}

/// Steps of the longest interval between upward crossings of the mean, those counted that reach to
/// either end.
fn longest_interval(values: &[f64]) -> usize {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let (mut longest, mut before) = (0, 0);
    for at in 1..values.len() {
        if values[at - 1] < mean && values[at] >= mean {
            (longest, before) = (longest.max(at - before), at);
        }
    }
    longest.max(values.len() - before)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{HindmarshRose, Lorenz, Model, Rossler};

    fn slow(model: Model) -> Option<f64> {
        slow_time(&model, 0, 0.01, 1).unwrap()
    }

    #[test]
    fn the_slow_time_of_a_limit_cycle_is_its_period() {
        // Hindmarsh–Rose at I = 4 spikes once in 20.1279 (by the return of the orbit to a section).
        let tonic =
            Model::HindmarshRose(HindmarshRose { current: 4.0, ..HindmarshRose::default() });
        let period = slow(tonic).unwrap();
        assert!((period - 20.128).abs() < 0.05, "{period}");
    }

    #[test]
    fn the_slow_time_of_a_burster_is_that_between_bursts_and_not_between_spikes() {
        let pause = slow(Model::HindmarshRose(HindmarshRose::default())).unwrap();
        assert!((50.0..500.0).contains(&pause), "{pause}");
    }

    #[test]
    fn chaotic_oscillators_of_one_pace_come_back_after_a_few_turns() {
        // A turn of Rössler's takes about 2π; Lorenz' x changes sign when the orbit changes wings.
        let turn = slow(Model::Rossler(Rossler::default())).unwrap();
        assert!((5.5..9.0).contains(&turn), "{turn}");
        let wing = slow(Model::Lorenz(Lorenz::default())).unwrap();
        assert!((1.0..20.0).contains(&wing), "{wing}");
    }

    #[test]
    fn an_orbit_at_rest_has_no_slow_time() {
        assert_eq!(slow(Model::Lorenz(Lorenz { r: 10.0, ..Lorenz::default() })), None);
        assert_eq!(slow(Model::Rossler(Rossler { a: -0.1, b: 0.2, c: 5.0 })), None);
    }

    #[test]
    fn an_orbit_that_escapes_is_an_error() {
        let model = Model::Rossler(Rossler { a: 0.5, b: 0.2, c: -9.0 });
        let escaped = slow_time(&model, 0, 0.01, 1);
        assert!(matches!(escaped, Err(DynamicsError::Escaped { .. })), "{escaped:?}");
    }
}
