//! Runs a program on numbers, some tiles of sixteen of each component at a time.
//!
//! All of it is inlined into whoever calls it, so that it is compiled for the vector instructions of
//! the caller; the numbers of a register are as many lanes, none of which knows of the others. An
//! operation is looked up once for all tiles of a block; inputs are read and outputs written where
//! they stand, wherever there is a whole block of them.

use std::ops::Range;

use crate::elementary::{self, REDUCED};
use crate::names::{Comparison, Unary};
use crate::scalar::select;
use crate::tape::{Instruction, NO_OUTPUT, Operation, Tape};

/// Numbers that are read, computed and written together.
const TILE: usize = 16;

type Tile = [f64; TILE];

/// Tiles of a register, if there are as many numbers.
const BLOCK: usize = 8;

/// Registers of so many tiles stay in the nearest cache; programs with more do tile by tile.
const MOST_IN_BLOCKS: usize = 64;

/// Numbers in a line of the cache, which no vector shall straddle.
const LINE: usize = 8;

/// Writes what comes of each lane of some registers. Tiles are copied first, and a macro rather than
/// a function of a closure does it, so that the compiler sees one loop without aliases.
macro_rules! each {
    ($to:expr, [$($lane:ident),*] = [$($register:expr),*], $value:expr) => {{
        let registers = ($($register,)*);
        for (part, to) in $to.iter_mut().enumerate() {
            let tiles = each!(at registers part [$($lane)*]);
            let mut values = [0.0; TILE];
            for lane in 0..TILE {
                let ($($lane,)*) = each!(at tiles lane [$($lane)*]);
                values[lane] = $value;
            }
            *to = values;
        }
    }};
    (at $of:ident $at:ident [$a:ident]) => { ($of.0[$at],) };
    (at $of:ident $at:ident [$a:ident $b:ident]) => { ($of.0[$at], $of.1[$at]) };
    (at $of:ident $at:ident [$a:ident $b:ident $c:ident]) => {
        ($of.0[$at], $of.1[$at], $of.2[$at])
    };
}

/// Room for a program to run in, which may serve any programs one after another.
#[derive(Clone, Debug, Default)]
pub struct Registers(Vec<f64>);

impl Registers {
    /// Room that grows with the first run.
    pub const fn new() -> Self {
        Self(Vec::new())
    }

    #[inline(always)]
    fn of<const P: usize>(&mut self, count: usize) -> &mut [[Tile; P]] {
        let numbers = count * P * TILE;
        if self.0.len() < numbers + LINE {
            self.0.resize(numbers + LINE, 0.0);
        }
        let skipped = self.0.as_ptr().align_offset(LINE * size_of::<f64>()).min(LINE);
        let tiles = self.0[skipped..][..numbers].as_chunks_mut().0;
        tiles.as_chunks_mut().0
    }
}

impl Tape {
    /// What comes out of as many inputs as it has, in two groups each.
    #[inline(always)]
    pub(crate) fn run(
        &self,
        registers: &mut Registers,
        inputs: [&[&[f64]]; 2],
        [first, second]: [&mut [&mut [f64]]; 2],
    ) {
        let length = first.first().map_or(0, |output| output.len());
        let mut done = 0;
        if length >= BLOCK * TILE && self.registers() <= MOST_IN_BLOCKS {
            done = length - length % (BLOCK * TILE);
            self.run_by::<BLOCK>(registers, inputs, [&mut *first, &mut *second], 0..done);
        }
        if done < length {
            self.run_by::<1>(registers, inputs, [first, second], done..length);
        }
    }

    /// Runs block by block; the last one may lack numbers.
    #[inline(always)]
    fn run_by<const P: usize>(
        &self,
        registers: &mut Registers,
        inputs: [&[&[f64]]; 2],
        [first, second]: [&mut [&mut [f64]]; 2],
        numbers: Range<usize>,
    ) {
        let registers = self.room::<P>(registers);
        for start in numbers.clone().step_by(P * TILE) {
            let count = (P * TILE).min(numbers.end - start);
            let is_whole = count == P * TILE;
            if !is_whole {
                for (register, input) in registers.iter_mut().zip(inputs.into_iter().flatten()) {
                    pad(register.as_flattened_mut(), &input[start..][..count]);
                }
            }
            let inputs = Inputs { groups: inputs, start, in_place: is_whole };
            self.execute(registers, inputs, [&mut *first, &mut *second]);
            let places = self.outputs.iter().zip(first.iter_mut().chain(second.iter_mut()));
            for (place, output) in places.filter(|(place, _)| !(is_whole && place.is_direct)) {
                let register = place.register as usize;
                let is_input = is_whole && register < self.inputs;
                let block = if is_input { inputs.block(register) } else { &registers[register] };
                output[start..][..count].copy_from_slice(&block.as_flattened()[..count]);
            }
        }
    }

    /// Registers, the constants in theirs.
    #[inline(always)]
    fn room<'a, const P: usize>(&self, registers: &'a mut Registers) -> &'a mut [[Tile; P]] {
        let registers = registers.of::<P>(self.registers());
        for (register, constant) in registers[self.inputs..].iter_mut().zip(&self.constants) {
            *register = [[*constant; TILE]; P];
        }
        registers
    }

    /// All operations on a block. Outputs that nothing else reads are written where they belong, if
    /// inputs are read so.
    #[inline(always)]
    fn execute<const P: usize>(
        &self,
        registers: &mut [[Tile; P]],
        inputs: Inputs<'_>,
        [first, second]: [&mut [&mut [f64]]; 2],
    ) {
        let fixed = self.inputs + self.constants.len();
        let n_in_place = if inputs.in_place { self.inputs } else { 0 };
        for (place, Instruction { operation, output }) in self.instructions.iter().enumerate() {
            let (known, rest) = registers.split_at_mut(fixed + place);
            let at = |register: u32| {
                let register = register as usize;
                if register < n_in_place { inputs.block(register) } else { &known[register] }
            };
            let output = *output as usize;
            let to = if !inputs.in_place || output == NO_OUTPUT as usize {
                &mut rest[0]
            } else if output < first.len() {
                block_at_mut(first[output], inputs.start)
            } else {
                block_at_mut(second[output - first.len()], inputs.start)
            };
            match *operation {
                Operation::Add(a, b) => each!(to, [x, y] = [at(a), at(b)], x + y),
                Operation::AddConstant(a, b) => each!(to, [x] = [at(a)], x + b),
                Operation::Subtract(a, b) => each!(to, [x, y] = [at(a), at(b)], x - y),
                Operation::SubtractConstant(a, b) => each!(to, [x] = [at(a)], x - b),
                Operation::SubtractFrom(a, b) => each!(to, [y] = [at(b)], a - y),
                Operation::Multiply(a, b) => each!(to, [x, y] = [at(a), at(b)], x * y),
                Operation::MultiplyConstant(a, b) => each!(to, [x] = [at(a)], x * b),
                Operation::Divide(a, b) => each!(to, [x, y] = [at(a), at(b)], x / y),
                Operation::DivideByConstant(a, b) => each!(to, [x] = [at(a)], x / b),
                Operation::ConstantOver(a, b) => each!(to, [y] = [at(b)], a / y),
                Operation::MultiplyAdd(a, b, c) => {
                    each!(to, [x, y, z] = [at(a), at(b), at(c)], x * y + z);
                }
                Operation::MultiplySubtract(a, b, c) => {
                    each!(to, [x, y, z] = [at(a), at(b), at(c)], x * y - z);
                }
                Operation::SubtractProduct(a, b, c) => {
                    each!(to, [x, y, z] = [at(a), at(b), at(c)], z - x * y);
                }
                Operation::MultiplyConstantAdd(a, b, c) => {
                    each!(to, [x, z] = [at(a), at(c)], x * b + z);
                }
                Operation::MultiplyConstantSubtract(a, b, c) => {
                    each!(to, [x, z] = [at(a), at(c)], x * b - z);
                }
                Operation::SubtractConstantProduct(a, b, c) => {
                    each!(to, [x, z] = [at(a), at(c)], z - x * b);
                }
                Operation::Negate(a) => each!(to, [x] = [at(a)], -x),
                Operation::Unary(function, a) => unary(function, to, at(a)),
                Operation::Power(a, b) => {
                    each!(to, [x, y] = [at(a), at(b)], elementary::pow(x, y));
                }
                Operation::Min(a, b) => each!(to, [x, y] = [at(a), at(b)], elementary::min(x, y)),
                Operation::Max(a, b) | Operation::Or(a, b) => {
                    each!(to, [x, y] = [at(a), at(b)], elementary::max(x, y));
                }
                Operation::Atan2(a, b) => each!(to, [y, x] = [at(a), at(b)], libm::atan2(y, x)),
                Operation::Compare(by, a, b) => compare(by, to, at(a), at(b)),
                Operation::And(a, b) => each!(to, [x, y] = [at(a), at(b)], x * y),
                Operation::Not(a) => each!(to, [x] = [at(a)], 1.0 - x),
                Operation::Select(c, a, b) => {
                    each!(to, [c, x, y] = [at(c), at(a), at(b)], select(c, x, y));
                }
            }
        }
    }
}

/// Where inputs of a block stand, if not in registers.
#[derive(Clone, Copy)]
struct Inputs<'a> {
    groups: [&'a [&'a [f64]]; 2],
    start: usize,
    in_place: bool,
}

impl<'a> Inputs<'a> {
    #[inline(always)]
    fn block<const P: usize>(self, input: usize) -> &'a [Tile; P] {
        let [first, second] = self.groups;
        let numbers = if input < first.len() { first[input] } else { second[input - first.len()] };
        block_at(numbers, self.start)
    }
}

#[inline(always)]
fn block_at<const P: usize>(numbers: &[f64], start: usize) -> &[Tile; P] {
    let tiles = numbers[start..][..P * TILE].as_chunks().0;
    tiles.try_into().expect("as many numbers as are in a block")
}

#[inline(always)]
fn block_at_mut<const P: usize>(numbers: &mut [f64], start: usize) -> &mut [Tile; P] {
    let tiles = numbers[start..][..P * TILE].as_chunks_mut().0;
    tiles.try_into().expect("as many numbers as are in a block")
}

/// Fills a register; what is beyond the numbers repeats the first of them.
#[inline(always)]
fn pad(register: &mut [f64], numbers: &[f64]) {
    register.fill(numbers[0]);
    register[..numbers.len()].copy_from_slice(numbers);
}

#[inline(always)]
fn compare<const P: usize>(
    comparison: Comparison,
    to: &mut [Tile; P],
    a: &[Tile; P],
    b: &[Tile; P],
) {
    use Comparison::{Equal, Greater, GreaterOrEqual, Less, LessOrEqual, NotEqual};
    match comparison {
        Less => each!(to, [x, y] = [a, b], elementary::compare(Less, x, y)),
        LessOrEqual => each!(to, [x, y] = [a, b], elementary::compare(LessOrEqual, x, y)),
        Greater => each!(to, [x, y] = [a, b], elementary::compare(Greater, x, y)),
        GreaterOrEqual => each!(to, [x, y] = [a, b], elementary::compare(GreaterOrEqual, x, y)),
        Equal => each!(to, [x, y] = [a, b], elementary::compare(Equal, x, y)),
        NotEqual => each!(to, [x, y] = [a, b], elementary::compare(NotEqual, x, y)),
    }
}

#[inline(always)]
fn unary<const P: usize>(function: Unary, to: &mut [Tile; P], a: &[Tile; P]) {
    match function {
        Unary::Abs => each!(to, [x] = [a], x.abs()),
        Unary::Sign => each!(to, [x] = [a], elementary::sign(x)),
        Unary::Floor => each!(to, [x] = [a], elementary::floor(x)),
        Unary::Sqrt => each!(to, [x] = [a], x.sqrt()),
        Unary::Exp => each!(to, [x] = [a], elementary::exp(x)),
        Unary::Log => each!(to, [x] = [a], elementary::log(x)),
        // Few numbers are too large for the vector instructions; these are done one by one. Both
        // ways give the same bits where both are right.
        Unary::Sin => {
            each!(to, [x] = [a], elementary::sin(x));
            if is_any_huge(a) {
                each!(to, [x] = [a], elementary::sin_of_any(x));
            }
        }
        Unary::Cos => {
            each!(to, [x] = [a], elementary::cos(x));
            if is_any_huge(a) {
                each!(to, [x] = [a], elementary::cos_of_any(x));
            }
        }
        Unary::Tan => each!(to, [x] = [a], libm::tan(x)),
        Unary::Asin => each!(to, [x] = [a], libm::asin(x)),
        Unary::Acos => each!(to, [x] = [a], libm::acos(x)),
        Unary::Atan => each!(to, [x] = [a], libm::atan(x)),
        Unary::Sinh => each!(to, [x] = [a], libm::sinh(x)),
        Unary::Cosh => each!(to, [x] = [a], libm::cosh(x)),
        Unary::Tanh => each!(to, [x] = [a], elementary::tanh(x)),
    }
}

#[inline(always)]
fn is_any_huge(a: &[Tile]) -> bool {
    let mut is_any = false;
    for x in a.as_flattened() {
        is_any |= x.abs() > REDUCED;
    }
    is_any
}
