//! The same equations with another radius of escape.

use std::sync::Arc;

use equations::Program;

use crate::{Fused, InstructionSet, Linearised, LinearisedMut, NodeDynamics};

/// Node dynamics whose orbits have escaped when a component exceeds a radius of one's own.
#[derive(Clone, Debug)]
pub struct Within {
    dynamics: Arc<dyn NodeDynamics>,
    escape_radius: f64,
}

impl Within {
    /// The same equations, in the units of which the radius is.
    pub fn new(dynamics: Arc<dyn NodeDynamics>, escape_radius: f64) -> Self {
        Self { dynamics, escape_radius }
    }
}

impl NodeDynamics for Within {
    fn components(&self) -> Vec<&str> {
        self.dynamics.components()
    }

    fn start(&self) -> &[[f64; 2]] {
        self.dynamics.start()
    }

    fn is_map(&self) -> bool {
        self.dynamics.is_map()
    }

    fn has_clock(&self) -> bool {
        self.dynamics.has_clock()
    }

    fn escape_radius(&self) -> f64 {
        self.escape_radius
    }

    fn flow(&self, set: InstructionSet, x: &[&[f64]], slope: &mut [&mut [f64]]) {
        self.dynamics.flow(set, x, slope);
    }

    fn tangent_flow(&self, set: InstructionSet, at: Linearised<'_>, slope: LinearisedMut<'_, '_>) {
        self.dynamics.tangent_flow(set, at, slope);
    }

    fn program(&self) -> Option<Program> {
        self.dynamics.program()
    }

    fn fused(&self) -> Option<&dyn Fused> {
        self.dynamics.fused()
    }
}
