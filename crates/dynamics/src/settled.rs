//! Where isolated oscillators have come to after a time, each from an initial state of its own.

use rayon::prelude::*;

use crate::error::{check_times, whole};
use crate::isolated_orbit::IsolatedOrbit;
use crate::{DynamicsError, NodeDynamics};

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
/// [`DynamicsError::Escaped`] when an orbit leaves the ball of radius [`crate::ESCAPE_RADIUS`].
pub fn settled(
    dynamics: &dyn NodeDynamics,
    step: f64,
    time: f64,
    seeds: &[u64],
) -> Result<Vec<Vec<f64>>, DynamicsError> {
    check_times(step, &[("time", time)], f64::INFINITY)?;
    seeds.par_iter().map(|&seed| of(dynamics, step, whole(time / step), seed)).collect()
}

fn of(
    dynamics: &dyn NodeDynamics,
    step: f64,
    n_steps: u64,
    seed: u64,
) -> Result<Vec<f64>, DynamicsError> {
    let mut orbit = IsolatedOrbit::begin(dynamics, step, seed);
    for _ in 0..n_steps {
        orbit.advance();
        orbit.bounded()?;
    }
    Ok(orbit.state().to_vec())
}
