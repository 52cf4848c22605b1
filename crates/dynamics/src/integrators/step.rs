//! The contract of a Runge–Kutta step with a fixed length h that goes through memory stage by stage.
//!
//! A stage evaluates the equations at the point in one slot, f(x) being the right-hand side, and puts
//! what follows from that slope into others: the next point, slopes and partial sums that later stages
//! want. In slot 0 stands x, and x(t + h) after the last stage; the
//! next state of a map stands in slot 1.

use crate::Scalar;

/// Slots that a step has at the most.
pub(crate) const MOST_SLOTS: usize = 8;

/// A step, all of whose arithmetic is [`Self::put`].
pub(crate) trait Step {
    /// Of each stage, the slot with the point at which it evaluates the equations.
    const AT: &'static [usize];

    /// Numbers of each component that go from stage to stage, the state among them.
    const SLOTS: usize;

    /// What a stage makes of its slope f, number by number; to be inlined wherever it is used.
    fn put<const STAGE: usize, S: Scalar>(slots: &mut impl Slots<S>, f: S, h: f64);
}

/// The slots of one number.
pub(crate) trait Slots<S> {
    /// What stands there.
    fn get(&self, slot: usize) -> S;

    /// Puts another.
    fn set(&mut self, slot: usize, number: S);
}
