//! Where isolated oscillators have come to after a time, each from an initial state of its own.

use rayon::prelude::*;

use crate::error::{check_times, whole};
use crate::integrators::rk4;
use crate::oscillators::with_oscillator;
use crate::random::initial_states;
use crate::slow_time::Isolated;
use crate::{DynamicsError, ESCAPE_RADIUS, Model, Oscillator};

/// The states of isolated oscillators after this time, component by component, in the order of their
/// seeds.
///
/// - `step`: of RK4, in model time units, as is `time`.
/// - `seeds`: of the initial states, the same as those of [`crate::lyapunov::Tangent`].
///
/// Runs on the current rayon pool.
///
/// # Errors
/// [`DynamicsError::BadStep`] and [`DynamicsError::BadTime`] for times that make no sense;
/// [`DynamicsError::Escaped`] when an orbit leaves the ball of radius [`ESCAPE_RADIUS`].
pub fn settled(
    model: Model,
    step: f64,
    time: f64,
    seeds: &[u64],
) -> Result<Vec<Vec<f64>>, DynamicsError> {
    check_times(step, &[("time", time)], f64::INFINITY)?;
    with_oscillator!(model, oscillator => {
        seeds.par_iter().map(|&seed| of(oscillator, step, whole(time / step), seed)).collect()
    })
}

fn of<O: Oscillator<D>, const D: usize>(
    oscillator: O,
    step: f64,
    n_steps: u64,
    seed: u64,
) -> Result<Vec<f64>, DynamicsError> {
    let mut state = initial_states::<O, D>(1, seed)[0];
    for number in 1..=n_steps {
        state = rk4::step(&Isolated(oscillator), state, step);
        if !state.iter().all(|x| x.abs() <= ESCAPE_RADIUS) {
            return Err(DynamicsError::Escaped { time: number as f64 * step });
        }
    }
    Ok(state.to_vec())
}
