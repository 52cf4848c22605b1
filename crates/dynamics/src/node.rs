//! The contract of node dynamics: the equations of an isolated node, `dx/dt = F(x)` of a flow or
//! `x(n + 1) = F(x(n))` of a map, evaluated on runs of numbers, so that whatever uses them need not be
//! compiled anew for every model.
//!
//! Numbers are laid out component by component. Which node or replica one of them belongs to the
//! equations never know, and each goes through the same operations whatever its neighbours are.

use std::fmt;

use equations::Program;

use crate::linearised::{Linearised, LinearisedMut};
use crate::lyapunov::Tangents;
use crate::stage::Stage;
use crate::{DynamicsError, ESCAPE_RADIUS, Estimate, InstructionSet};

/// Node dynamics F, chosen at run time: a [`crate::Native`] oscillator, a [`crate::Model`], or any other
/// evaluation of equations.
///
/// [`Self::flow`] and [`Self::tangent_flow`] say all; [`Self::fused`] is for equations that can be
/// faster than these.
pub trait NodeDynamics: fmt::Debug + Send + Sync {
    /// Names of the components, in order; at most [`crate::MAX_COMPONENTS`].
    fn components(&self) -> Vec<&str>;

    /// A box `[from, to]` for each component, from which initial states are drawn uniformly: inside
    /// the basin of the attractor.
    fn start(&self) -> &[[f64; 2]];

    /// Whether F gives the next state rather than the rate of change: time then goes in steps of 1.
    fn is_map(&self) -> bool {
        false
    }

    /// Whether the last component is time, as in equations that are forced: it is the same at every
    /// node, so that it is neither coupled nor perturbed, and it may grow for ever.
    fn has_clock(&self) -> bool {
        false
    }

    /// An orbit has escaped when a component exceeds this size.
    fn escape_radius(&self) -> f64 {
        ESCAPE_RADIUS
    }

    /// Components that tell how a node is, all but a clock: the first of them.
    fn n_free(&self) -> usize {
        self.start().len() - usize::from(self.has_clock())
    }

    /// F(x) of every number: `x[c]` and `slope[c]` are as many numbers of component c.
    fn flow(&self, set: InstructionSet, x: &[&[f64]], slope: &mut [&mut [f64]]);

    /// F(x) and DF(x) δ of every number, in the same layout.
    fn tangent_flow(&self, set: InstructionSet, at: Linearised<'_>, slope: LinearisedMut<'_, '_>);

    /// The same equations as a program, where they can be had so: of it there are series in time. A map
    /// needs none.
    fn program(&self) -> Option<Program> {
        None
    }

    /// The same equations without what goes through memory, where there are such; a map and equations
    /// with a clock have none.
    fn fused(&self) -> Option<&dyn Fused> {
        None
    }
}

/// What compiled equations do in one go. It gives the bits that [`NodeDynamics::flow`] and
/// [`NodeDynamics::tangent_flow`] give.
pub trait Fused {
    /// Takes one state a step of RK4 forward.
    fn advance(&self, state: &mut [f64], h: f64);

    /// One stage of a step of RK4 of a network.
    fn stage(&self, set: InstructionSet, stage: &mut Stage<'_, '_>);

    /// Largest Lyapunov exponents of some tangents of the master equation.
    ///
    /// # Errors
    /// [`DynamicsError::Escaped`] when an orbit escapes.
    fn exponents(
        &self,
        set: InstructionSet,
        tangents: &Tangents<'_>,
    ) -> Result<Vec<Estimate>, DynamicsError>;
}
