//! Integrators, one file a method.

pub(crate) mod adaptive;
pub(crate) mod rk4;

use serde::Serialize;

pub use adaptive::{Adaptive, AdaptiveOrder};

/// How the equations of a network are integrated.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub enum Method {
    /// Classical fourth-order Runge–Kutta with a fixed step, advanced in lanes.
    Rk4,
    /// Adaptive Dormand–Prince through `ode_solvers`, one replica at a time: the independent check.
    Adaptive(Adaptive),
}
