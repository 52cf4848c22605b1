//! The states of an isolated oscillator, step by step, to be looked at one by one.

use crate::isolated_orbit::IsolatedOrbit;
use crate::{DynamicsError, NodeDynamics};

/// States of an isolated orbit from the initial state of a seed on, `[step][component]`, as far as they are
/// within the radius of escape.
///
/// - `step`: of RK4, in model time units; 1 for a map.
///
/// # Errors
/// [`DynamicsError::BadStep`] for a step that makes no sense.
pub fn isolated_states(
    dynamics: &dyn NodeDynamics,
    step: f64,
    n_steps: usize,
    seed: u64,
) -> Result<Vec<Vec<f64>>, DynamicsError> {
    if !(step.is_finite() && step > 0.0) {
        return Err(DynamicsError::BadStep { step });
    }
    let mut orbit = IsolatedOrbit::begin(dynamics, step, seed);
    let mut states = vec![orbit.state().to_vec()];
    for _ in 0..n_steps {
        orbit.advance();
        match orbit.bounded() {
            Ok(state) => states.push(state.to_vec()),
            Err(_) => break,
        }
    }
    Ok(states)
}
