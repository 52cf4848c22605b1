//! An isolated oscillator, ẋ = F(x), followed step by step with RK4.

use crate::integrators::rk4;
use crate::random::initial_states;
use crate::{DynamicsError, ESCAPE_RADIUS, NodeDynamics};

/// An isolated oscillator on its way from the initial state of a seed.
pub(crate) struct IsolatedOrbit<'a> {
    dynamics: &'a dyn NodeDynamics,
    step: f64,
    steps: u64,
    state: Vec<f64>,
}

impl<'a> IsolatedOrbit<'a> {
    /// At the initial state of a seed.
    pub(crate) fn begin(dynamics: &'a dyn NodeDynamics, step: f64, seed: u64) -> Self {
        let state = initial_states(dynamics.start(), 1, seed);
        Self { dynamics, step, steps: 0, state }
    }

    /// Where it is.
    pub(crate) fn state(&self) -> &[f64] {
        &self.state
    }

    /// Goes on by one step, wherever that leads.
    pub(crate) fn advance(&mut self) {
        match self.dynamics.fused() {
            Some(fused) => fused.advance(&mut self.state, self.step),
            None => rk4::advance(self.dynamics, &mut self.state, self.step),
        }
        self.steps += 1;
    }

    /// The state, unless it has left the ball of radius [`ESCAPE_RADIUS`].
    pub(crate) fn bounded(&self) -> Result<&[f64], DynamicsError> {
        if self.state.iter().all(|x| x.abs() <= ESCAPE_RADIUS) {
            return Ok(&self.state);
        }
        Err(self.escaped())
    }

    /// The error of an orbit that is found to have escaped here.
    pub(crate) fn escaped(&self) -> DynamicsError {
        DynamicsError::Escaped { time: self.steps as f64 * self.step }
    }
}
