//! A program as it runs: a straight list of operations on registers, each of which writes the next one.

use std::collections::{HashMap, HashSet};

use crate::builder::{Builder, Step, Value};
use crate::names::{Comparison, Unary};
use crate::scalar::Code;

/// A place for numbers. First come inputs, then constants, then what each operation writes.
pub(crate) type Register = u32;

/// An operation on registers. Sums, products and quotients with a constant carry it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Operation {
    Add(Register, Register),
    AddConstant(Register, f64),
    Subtract(Register, Register),
    SubtractConstant(Register, f64),
    SubtractFrom(f64, Register),
    Multiply(Register, Register),
    MultiplyConstant(Register, f64),
    Divide(Register, Register),
    DivideByConstant(Register, f64),
    ConstantOver(f64, Register),
    /// a b + c, a b − c and c − a b, two roundings each, of which the product has no register.
    MultiplyAdd(Register, Register, Register),
    MultiplySubtract(Register, Register, Register),
    SubtractProduct(Register, Register, Register),
    /// The same with a constant b.
    MultiplyConstantAdd(Register, f64, Register),
    MultiplyConstantSubtract(Register, f64, Register),
    SubtractConstantProduct(Register, f64, Register),
    Negate(Register),
    Unary(Unary, Register),
    Power(Register, Register),
    Min(Register, Register),
    Max(Register, Register),
    Atan2(Register, Register),
    Compare(Comparison, Register, Register),
    And(Register, Register),
    Or(Register, Register),
    Not(Register),
    Select(Register, Register, Register),
}

/// An operation, and the output that it alone writes and nothing else reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Instruction {
    pub operation: Operation,
    pub output: u32,
}

/// The output of an instruction that has none.
pub(crate) const NO_OUTPUT: u32 = u32::MAX;

/// Where what comes out is found, and whether its instruction writes it by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Output {
    pub register: Register,
    pub is_direct: bool,
}

/// A program.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tape {
    pub inputs: usize,
    pub constants: Vec<f64>,
    pub instructions: Vec<Instruction>,
    pub outputs: Vec<Output>,
}

impl Tape {
    /// What of the operations is needed for some values.
    pub(crate) fn new(builder: &Builder, inputs: usize, outputs: &[Value]) -> Self {
        let steps: Vec<(usize, Step)> = needed(builder, outputs);
        let reads = reads(&steps, outputs, builder.steps.len());
        let product_of = products(&steps, &reads, builder);
        let absorbed: HashSet<usize> = product_of.values().map(|(index, _)| *index).collect();
        let written = || steps.iter().filter(|(index, _)| !absorbed.contains(index));
        let mut constants = Constants { from: inputs, values: Vec::new(), places: HashMap::new() };
        // All constants come before all operations, so they are known first.
        for (_, step) in &steps {
            constants.add_operands(step);
        }
        for output in outputs {
            constants.add(*output);
        }
        let behind = inputs + constants.values.len();
        let mut register_of = vec![None; builder.steps.len()];
        let mut instructions = Vec::with_capacity(steps.len());
        for (place, (index, step)) in written().enumerate() {
            let register = |value: &Value| constants.register(*value, &register_of);
            let operation = match product_of.get(index) {
                Some(product) => with_product(step, product, register),
                None => operation(step, register),
            };
            instructions.push(Instruction { operation, output: NO_OUTPUT });
            register_of[*index] = Some((behind + place) as Register);
        }
        let output = |(number, value): (usize, &Value)| {
            let register = constants.register(*value, &register_of);
            let is_direct = matches!(value, Value::Step(step) if reads[*step] == 1);
            if is_direct {
                instructions[register as usize - behind].output = number as u32;
            }
            Output { register, is_direct }
        };
        let outputs = outputs.iter().enumerate().map(output).collect();
        Self { inputs, constants: constants.values, instructions, outputs }
    }

    /// Registers that it takes.
    pub(crate) fn registers(&self) -> usize {
        self.inputs + self.constants.len() + self.instructions.len()
    }
}

/// Steps from which some values follow, in order.
fn needed(builder: &Builder, outputs: &[Value]) -> Vec<(usize, Step)> {
    let mut is_needed = vec![false; builder.steps.len()];
    let mark = |value: &Value, is_needed: &mut Vec<bool>| {
        if let Value::Step(step) = value {
            is_needed[*step] = true;
        }
    };
    outputs.iter().for_each(|output| mark(output, &mut is_needed));
    for (index, step) in builder.steps.iter().enumerate().rev() {
        if is_needed[index] {
            step.operands().iter().for_each(|operand| mark(operand, &mut is_needed));
        }
    }
    let steps = builder.steps.iter().copied().enumerate();
    steps.filter(|(index, _)| is_needed[*index]).collect()
}

/// How often each step is read, by others or as an output.
fn reads(steps: &[(usize, Step)], outputs: &[Value], n_steps: usize) -> Vec<usize> {
    let mut reads = vec![0; n_steps];
    let operands = steps.iter().flat_map(|(_, step)| step.operands());
    for value in operands.chain(outputs) {
        if let Value::Step(step) = value {
            reads[*step] += 1;
        }
    }
    reads
}

/// Constants that need registers, each once.
struct Constants {
    from: usize,
    values: Vec<f64>,
    /// Where a constant of these bits is among them.
    places: HashMap<u64, usize>,
}

impl Constants {
    fn add(&mut self, value: Value) {
        if let Value::Constant(constant) = value {
            let values = &mut self.values;
            self.places.entry(constant.to_bits()).or_insert_with(|| {
                values.push(constant);
                values.len() - 1
            });
        }
    }

    /// Those operands that the operation does not carry.
    fn add_operands(&mut self, step: &Step) {
        if !carries_constants(step.code) {
            step.operands().iter().for_each(|operand| self.add(*operand));
        }
    }

    fn register(&self, value: Value, register_of: &[Option<Register>]) -> Register {
        match value {
            Value::Input(input) => input as Register,
            Value::Step(step) => register_of[step].expect("a step comes after its operands"),
            Value::Constant(constant) => (self.from + self.places[&constant.to_bits()]) as Register,
        }
    }
}

/// Products that nothing but one sum or difference of registers reads, by the step that does: their steps
/// and their factors.
fn products(
    steps: &[(usize, Step)],
    reads: &[usize],
    builder: &Builder,
) -> HashMap<usize, (usize, [Value; 2])> {
    let product = |value: &Value| match value {
        Value::Step(index) if reads[*index] == 1 => match builder.steps[*index] {
            step if step.code == Code::Multiply => {
                Some((*index, [step.operands()[0], step.operands()[1]]))
            }
            _ => None,
        },
        _ => None,
    };
    let of = |(index, step): &(usize, Step)| {
        let is_sum = matches!(step.code, Code::Add | Code::Subtract);
        let is_of_registers = step.operands().iter().all(|o| !matches!(o, Value::Constant(_)));
        let found = step.operands().iter().find_map(product);
        found.filter(|_| is_sum && is_of_registers).map(|product| (*index, product))
    };
    steps.iter().filter_map(of).collect()
}

/// A sum or difference of which one side is a product that has no register.
fn with_product(
    step: &Step,
    (index, factors): &(usize, [Value; 2]),
    register: impl Fn(&Value) -> Register,
) -> Operation {
    let [first, second] = step.operands() else { unreachable!("a sum has two sides") };
    let is_first = *first == Value::Step(*index);
    let other = register(if is_first { second } else { first });
    let a = register(&factors[0]);
    match (factors[1], step.code, is_first) {
        (Value::Constant(b), Code::Add, _) => Operation::MultiplyConstantAdd(a, b, other),
        (Value::Constant(b), _, true) => Operation::MultiplyConstantSubtract(a, b, other),
        (Value::Constant(b), _, false) => Operation::SubtractConstantProduct(a, b, other),
        (b, Code::Add, _) => Operation::MultiplyAdd(a, register(&b), other),
        (b, _, true) => Operation::MultiplySubtract(a, register(&b), other),
        (b, _, false) => Operation::SubtractProduct(a, register(&b), other),
    }
}

fn carries_constants(code: Code) -> bool {
    matches!(code, Code::Add | Code::Subtract | Code::Multiply | Code::Divide)
}

fn operation(step: &Step, register: impl Fn(&Value) -> Register) -> Operation {
    use Value::Constant;
    match (step.code, step.operands()) {
        (Code::Add, [a, Constant(b)]) => Operation::AddConstant(register(a), *b),
        (Code::Add, [a, b]) => Operation::Add(register(a), register(b)),
        (Code::Subtract, [a, Constant(b)]) => Operation::SubtractConstant(register(a), *b),
        (Code::Subtract, [Constant(a), b]) => Operation::SubtractFrom(*a, register(b)),
        (Code::Subtract, [a, b]) => Operation::Subtract(register(a), register(b)),
        (Code::Multiply, [a, Constant(b)]) => Operation::MultiplyConstant(register(a), *b),
        (Code::Multiply, [a, b]) => Operation::Multiply(register(a), register(b)),
        (Code::Divide, [a, Constant(b)]) => Operation::DivideByConstant(register(a), *b),
        (Code::Divide, [Constant(a), b]) => Operation::ConstantOver(*a, register(b)),
        (Code::Divide, [a, b]) => Operation::Divide(register(a), register(b)),
        (Code::Negate, [a]) => Operation::Negate(register(a)),
        (Code::Unary(function), [a]) => Operation::Unary(function, register(a)),
        (Code::Power, [a, b]) => Operation::Power(register(a), register(b)),
        (Code::Min, [a, b]) => Operation::Min(register(a), register(b)),
        (Code::Max, [a, b]) => Operation::Max(register(a), register(b)),
        (Code::Atan2, [a, b]) => Operation::Atan2(register(a), register(b)),
        (Code::Compare(by), [a, b]) => Operation::Compare(by, register(a), register(b)),
        (Code::And, [a, b]) => Operation::And(register(a), register(b)),
        (Code::Or, [a, b]) => Operation::Or(register(a), register(b)),
        (Code::Not, [a]) => Operation::Not(register(a)),
        (Code::Select, [a, b, c]) => Operation::Select(register(a), register(b), register(c)),
        (code, operands) => unreachable!("{code:?} of {} operands", operands.len()),
    }
}
