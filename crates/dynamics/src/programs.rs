//! Programs run on runs of numbers, with the vector instructions that are asked for.

use std::cell::RefCell;

use equations::{Program, Registers};

use crate::InstructionSet;
use crate::instruction_set::Work;
use crate::linearised::{Linearised, LinearisedMut};

thread_local! {
    /// Room for programs to run in, which serves all of a thread's.
    static REGISTERS: RefCell<Registers> = const { RefCell::new(Registers::new()) };
}

/// What a program makes of every number.
pub(crate) fn evaluate(
    program: &Program,
    set: InstructionSet,
    x: &[&[f64]],
    to: &mut [&mut [f64]],
) {
    REGISTERS.with_borrow_mut(|registers| set.run(Evaluated { program, registers, x, to }));
}

/// The same with what it makes of tangents.
pub(crate) fn linearise(
    program: &Program,
    set: InstructionSet,
    at: Linearised<'_>,
    to: LinearisedMut<'_, '_>,
) {
    REGISTERS.with_borrow_mut(|registers| set.run(WithTangents { program, registers, at, to }));
}

struct Evaluated<'a, 'b> {
    program: &'a Program,
    registers: &'a mut Registers,
    x: &'a [&'a [f64]],
    to: &'a mut [&'b mut [f64]],
}

impl Work for Evaluated<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.program.evaluate(self.registers, self.x, self.to);
    }
}

struct WithTangents<'a, 'b, 'c> {
    program: &'a Program,
    registers: &'a mut Registers,
    at: Linearised<'a>,
    to: LinearisedMut<'b, 'c>,
}

impl Work for WithTangents<'_, '_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { program, registers, at, to } = self;
        program.linearise(registers, [at.value, at.tangent], [to.value, to.tangent]);
    }
}
