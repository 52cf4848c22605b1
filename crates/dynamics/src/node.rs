//! The contract of node dynamics: the equations `dx/dt = F(x)` of an isolated node, evaluated on runs of
//! numbers, so that whatever uses them need not be compiled anew for every model.
//!
//! Numbers are laid out component by component. Which node or replica one of them belongs to the
//! equations never know, and each goes through the same operations whatever its neighbours are.

use std::fmt;

use crate::lyapunov::Tangents;
use crate::stage::Stage;
use crate::{DynamicsError, Estimate, InstructionSet};

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

    /// F(x) of every number: `x[c]` and `slope[c]` are as many numbers of component c.
    fn flow(&self, set: InstructionSet, x: &[&[f64]], slope: &mut [&mut [f64]]);

    /// F(x) and DF(x) δ of every number, in the same layout.
    fn tangent_flow(&self, set: InstructionSet, at: Linearised<'_>, slope: LinearisedMut<'_, '_>);

    /// The same equations without what goes through memory, where there are such.
    fn fused(&self) -> Option<&dyn Fused> {
        None
    }
}

/// What compiled equations do in one go. It gives the bits that [`NodeDynamics::flow`] and
/// [`NodeDynamics::tangent_flow`] give.
pub trait Fused {
    /// Takes one state a step of RK4 forward.
    fn advance(&self, state: &mut [f64], h: f64);

    /// One stage of the step of a network.
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

/// States with a tangent each, component by component.
#[derive(Clone, Copy)]
pub struct Linearised<'a> {
    /// The states.
    pub value: &'a [&'a [f64]],
    /// The tangents.
    pub tangent: &'a [&'a [f64]],
}

/// Where slopes of states and of their tangents go, component by component.
pub struct LinearisedMut<'a, 'b> {
    /// F(x).
    pub value: &'a mut [&'b mut [f64]],
    /// DF(x) δ.
    pub tangent: &'a mut [&'b mut [f64]],
}
