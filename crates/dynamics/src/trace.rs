//! Compiled equations as a program: evaluated once on numbers that write down what is done with them.

use equations::{Program, Traced};

use crate::{Oscillator, Scalar};

impl Scalar for Traced<'_> {}

/// The equations of an oscillator, with the values that its parameters have now, as the program that
/// is made of the same operations written as text.
pub fn trace<const D: usize>(oscillator: &impl Oscillator<D>) -> Program {
    Program::trace(D, |x| oscillator.flow(std::array::from_fn(|c| x[c])).to_vec())
}
