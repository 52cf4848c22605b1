//! Runs a program on numbers, sixteen of each component at a time.
//!
//! All of it is inlined into whoever calls it, so that it is compiled for the vector instructions of
//! the caller; the sixteen numbers of a register are as many lanes, none of which knows of the others.

use crate::elementary::{self, REDUCED};
use crate::names::{Comparison, Unary};
use crate::scalar::select;
use crate::tape::{Operation, Tape};

/// Numbers in a register.
const TILE: usize = 16;

type Tile = [f64; TILE];

/// Room for a program to run in, which may serve any programs one after another.
#[derive(Clone, Debug, Default)]
pub struct Registers(Vec<Tile>);

impl Registers {
    /// Room that grows with the first run.
    pub const fn new() -> Self {
        Self(Vec::new())
    }
}

impl Tape {
    /// What comes out of as many inputs as it has, in two groups each.
    #[inline(always)]
    pub(crate) fn run(
        &self,
        registers: &mut Registers,
        inputs: [&[&[f64]]; 2],
        outputs: [&mut [&mut [f64]]; 2],
    ) {
        let registers = self.room(registers);
        let [first, second] = outputs;
        let length = first.first().map_or(0, |output| output.len());
        let fixed = self.inputs + self.constants.len();
        for start in (0..length).step_by(TILE) {
            let count = TILE.min(length - start);
            for (register, input) in registers.iter_mut().zip(inputs.into_iter().flatten()) {
                load(register, &input[start..][..count]);
            }
            self.execute(registers, fixed);
            let outputs = first.iter_mut().chain(second.iter_mut());
            for (register, output) in self.outputs.iter().zip(outputs) {
                store(&registers[*register as usize], &mut output[start..][..count]);
            }
        }
    }

    /// Registers, the constants in theirs.
    #[inline(always)]
    fn room<'a>(&self, registers: &'a mut Registers) -> &'a mut [Tile] {
        let count = self.registers();
        if registers.0.len() < count {
            registers.0.resize(count, [0.0; TILE]);
        }
        let registers = &mut registers.0[..count];
        for (register, constant) in registers[self.inputs..].iter_mut().zip(&self.constants) {
            *register = [*constant; TILE];
        }
        registers
    }

    #[inline(always)]
    fn execute(&self, registers: &mut [Tile], fixed: usize) {
        for (place, operation) in self.operations.iter().enumerate() {
            let (known, to) = registers.split_at_mut(fixed + place);
            let at = |register: u32| &known[register as usize];
            let to = &mut to[0];
            match *operation {
                Operation::Add(a, b) => zip(to, at(a), at(b), |a, b| a + b),
                Operation::AddConstant(a, b) => map(to, at(a), |a| a + b),
                Operation::Subtract(a, b) => zip(to, at(a), at(b), |a, b| a - b),
                Operation::SubtractConstant(a, b) => map(to, at(a), |a| a - b),
                Operation::SubtractFrom(a, b) => map(to, at(b), |b| a - b),
                Operation::Multiply(a, b) => zip(to, at(a), at(b), |a, b| a * b),
                Operation::MultiplyConstant(a, b) => map(to, at(a), |a| a * b),
                Operation::Divide(a, b) => zip(to, at(a), at(b), |a, b| a / b),
                Operation::DivideByConstant(a, b) => map(to, at(a), |a| a / b),
                Operation::ConstantOver(a, b) => map(to, at(b), |b| a / b),
                Operation::Negate(a) => map(to, at(a), |a| -a),
                Operation::Unary(function, a) => unary(function, to, at(a)),
                Operation::Power(a, b) => zip(to, at(a), at(b), elementary::pow),
                Operation::Min(a, b) => zip(to, at(a), at(b), elementary::min),
                Operation::Max(a, b) | Operation::Or(a, b) => {
                    zip(to, at(a), at(b), elementary::max);
                }
                Operation::Atan2(a, b) => zip(to, at(a), at(b), libm::atan2),
                Operation::Compare(by, a, b) => compare(by, to, at(a), at(b)),
                Operation::And(a, b) => zip(to, at(a), at(b), |a, b| a * b),
                Operation::Not(a) => map(to, at(a), |a| 1.0 - a),
                Operation::Select(condition, a, b) => {
                    let (condition, a, b) = (at(condition), at(a), at(b));
                    for lane in 0..TILE {
                        to[lane] = select(condition[lane], a[lane], b[lane]);
                    }
                }
            }
        }
    }
}

/// Fills a register; what is beyond the numbers repeats the first of them.
#[inline(always)]
fn load(register: &mut Tile, numbers: &[f64]) {
    if let Ok(numbers) = <&Tile>::try_from(numbers) {
        *register = *numbers;
    } else {
        *register = [numbers[0]; TILE];
        register[..numbers.len()].copy_from_slice(numbers);
    }
}

#[inline(always)]
fn store(register: &Tile, numbers: &mut [f64]) {
    if let Ok(numbers) = <&mut Tile>::try_from(&mut *numbers) {
        *numbers = *register;
    } else {
        numbers.copy_from_slice(&register[..numbers.len()]);
    }
}

#[inline(always)]
fn zip(to: &mut Tile, a: &Tile, b: &Tile, operation: impl Fn(f64, f64) -> f64) {
    for lane in 0..TILE {
        to[lane] = operation(a[lane], b[lane]);
    }
}

#[inline(always)]
fn map(to: &mut Tile, a: &Tile, operation: impl Fn(f64) -> f64) {
    for lane in 0..TILE {
        to[lane] = operation(a[lane]);
    }
}

#[inline(always)]
fn compare(comparison: Comparison, to: &mut Tile, a: &Tile, b: &Tile) {
    use Comparison::{Equal, Greater, GreaterOrEqual, Less, LessOrEqual, NotEqual};
    match comparison {
        Less => zip(to, a, b, |a, b| elementary::compare(Less, a, b)),
        LessOrEqual => zip(to, a, b, |a, b| elementary::compare(LessOrEqual, a, b)),
        Greater => zip(to, a, b, |a, b| elementary::compare(Greater, a, b)),
        GreaterOrEqual => zip(to, a, b, |a, b| elementary::compare(GreaterOrEqual, a, b)),
        Equal => zip(to, a, b, |a, b| elementary::compare(Equal, a, b)),
        NotEqual => zip(to, a, b, |a, b| elementary::compare(NotEqual, a, b)),
    }
}

#[inline(always)]
fn unary(function: Unary, to: &mut Tile, a: &Tile) {
    match function {
        Unary::Abs => map(to, a, f64::abs),
        Unary::Sign => map(to, a, elementary::sign),
        Unary::Floor => map(to, a, elementary::floor),
        Unary::Sqrt => map(to, a, f64::sqrt),
        Unary::Exp => map(to, a, elementary::exp),
        Unary::Log => map(to, a, elementary::log),
        Unary::Sin => periodic(to, a, elementary::sin, elementary::sin_of_any),
        Unary::Cos => periodic(to, a, elementary::cos, elementary::cos_of_any),
        Unary::Tan => map(to, a, libm::tan),
        Unary::Asin => map(to, a, libm::asin),
        Unary::Acos => map(to, a, libm::acos),
        Unary::Atan => map(to, a, libm::atan),
        Unary::Sinh => map(to, a, libm::sinh),
        Unary::Cosh => map(to, a, libm::cosh),
        Unary::Tanh => map(to, a, elementary::tanh),
    }
}

/// A function that few numbers are too large for; these are done one by one. Both ways give the same
/// bits where both are right.
#[inline(always)]
fn periodic(to: &mut Tile, a: &Tile, near: impl Fn(f64) -> f64, any: impl Fn(f64) -> f64) {
    map(to, a, near);
    if a.iter().any(|x| x.abs() > REDUCED) {
        map(to, a, any);
    }
}
