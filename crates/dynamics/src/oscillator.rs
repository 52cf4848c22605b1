//! What an oscillator is: the equations `dx/dt = F(x)` of an isolated node.

use crate::Scalar;

/// An oscillator with `D` components.
pub trait Oscillator<const D: usize>: Copy + Send + Sync {
    /// Names of the components, in order, as experiment files call them.
    const COMPONENTS: [&'static str; D];

    /// A box `[from, to]` for each component, from which initial states are drawn uniformly: inside
    /// the basin of the attractor.
    const START: [[f64; 2]; D];

    /// Whether F gives the next state, `x(n + 1) = F(x(n))`.
    const IS_MAP: bool = false;

    /// F(x), in the oscillator's own units of state per unit of model time.
    fn flow<S: Scalar>(&self, state: [S; D]) -> [S; D];
}
