//! An isolated oscillator, ẋ = F(x), followed step by step with RK4.

use crate::integrators::rk4::{self, Flow};
use crate::random::initial_states;
use crate::{DynamicsError, ESCAPE_RADIUS, Oscillator};

/// An isolated oscillator on its way from the initial state of a seed.
pub(crate) struct IsolatedOrbit<O, const D: usize> {
    flow: Isolated<O>,
    step: f64,
    steps: u64,
    state: [f64; D],
}

/// The flow of an oscillator by itself.
struct Isolated<O>(O);

impl<O: Oscillator<D>, const D: usize> Flow<f64, D> for Isolated<O> {
    fn at(&self, state: [f64; D]) -> [f64; D] {
        self.0.flow(state)
    }
}

impl<O: Oscillator<D>, const D: usize> IsolatedOrbit<O, D> {
    /// At the initial state of a seed.
    pub(crate) fn begin(oscillator: O, step: f64, seed: u64) -> Self {
        let state = initial_states::<O, D>(1, seed)[0];
        Self { flow: Isolated(oscillator), step, steps: 0, state }
    }

    /// Where it is.
    pub(crate) fn state(&self) -> [f64; D] {
        self.state
    }

    /// Goes on by one step, wherever that leads.
    pub(crate) fn advance(&mut self) {
        self.state = rk4::step(&self.flow, self.state, self.step);
        self.steps += 1;
    }

    /// The state, unless it has left the ball of radius [`ESCAPE_RADIUS`].
    pub(crate) fn bounded(&self) -> Result<[f64; D], DynamicsError> {
        if self.state.iter().all(|x| x.abs() <= ESCAPE_RADIUS) {
            return Ok(self.state);
        }
        Err(self.escaped())
    }

    /// The error of an orbit that is found to have escaped here.
    pub(crate) fn escaped(&self) -> DynamicsError {
        DynamicsError::Escaped { time: self.steps as f64 * self.step }
    }
}
