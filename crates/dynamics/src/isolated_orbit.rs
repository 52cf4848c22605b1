//! An isolated oscillator, ẋ = F(x), followed step by step with RK4, or iterated where
//! it is a map.

use crate::integrators::rk4;
use crate::random::initial_states;
use crate::tile::{MAX_COMPONENTS, slices, slices_mut};
use crate::{DynamicsError, InstructionSet, NodeDynamics};

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
            None if self.dynamics.is_map() => self.iterate(),
            None => rk4::advance(self.dynamics, &mut self.state, self.step),
        }
        self.steps += 1;
    }

    /// The next state of a map.
    fn iterate(&mut self) {
        let n = self.state.len();
        let mut next = [0.0; MAX_COMPONENTS];
        let (at, mut to) = (slices(self.state.chunks(1)), slices_mut(next.chunks_mut(1)));
        self.dynamics.flow(InstructionSet::Baseline, &at[..n], &mut to[..n]);
        self.state.copy_from_slice(&next[..n]);
    }

    /// The state, unless it has left the ball of its radius of escape.
    pub(crate) fn bounded(&self) -> Result<&[f64], DynamicsError> {
        let radius = self.dynamics.escape_radius();
        if self.state.iter().take(self.dynamics.n_free()).all(|x| x.abs() <= radius) {
            return Ok(&self.state);
        }
        Err(self.escaped())
    }

    /// The error of an orbit that is found to have escaped here.
    pub(crate) fn escaped(&self) -> DynamicsError {
        DynamicsError::Escaped { time: self.steps as f64 * self.step }
    }
}
