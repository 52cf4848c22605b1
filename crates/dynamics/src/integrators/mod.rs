//! Integrators, one file a method.

pub(crate) mod adaptive;
mod dop853;
pub(crate) mod fixed;
mod iterate;
pub(crate) mod rk4;
pub(crate) mod rk4_in_slots;
pub(crate) mod step;

use serde::Serialize;

use fixed::Fixed;

/// How the equations of a network are integrated; those of a map are iterated.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub enum Method {
    /// Classical fourth-order Runge–Kutta with a fixed step, advanced in lanes.
    Rk4,
    /// Dormand–Prince of order 8 with a fixed step, advanced in lanes.
    Dop853,
    /// None: a map gives its next state, in steps of 1, in lanes.
    Iterate,
    /// Adaptive Dormand–Prince through `ode_solvers`, one replica at a time: the independent check.
    Adaptive(Adaptive),
}

/// Order of the adaptive method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum AdaptiveOrder {
    /// Dormand–Prince 5(4).
    Five,
    /// Dormand–Prince 8(5,3).
    Eight,
}

/// An adaptive method with its tolerances on the local error of each component.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Adaptive {
    /// Which of the two.
    pub order: AdaptiveOrder,
    /// Relative tolerance.
    pub relative_tolerance: f64,
    /// Absolute tolerance, in the units of the components.
    pub absolute_tolerance: f64,
}

impl Method {
    /// What advances lanes, or the method that chooses its own steps.
    pub(crate) fn fixed(self) -> Result<Fixed, Adaptive> {
        match self {
            Self::Rk4 => Ok(Fixed::Rk4),
            Self::Dop853 => Ok(Fixed::Dop853),
            Self::Iterate => Ok(Fixed::Iterate),
            Self::Adaptive(adaptive) => Err(adaptive),
        }
    }
}
