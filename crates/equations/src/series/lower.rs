//! From operations to rules for coefficients. Sums of sums are taken together, since nothing but the
//! series is asked for here, and functions bring others that their derivatives need.

use std::collections::HashMap;

use super::rules::{Rate, Register, Rule, Series, Slope, SlopeValue};
use crate::assemble::Assembled;
use crate::builder::{Builder, Step, Value};
use crate::names::Unary;
use crate::scalar::Code;
use crate::tangent::jacobian;

impl Series {
    /// The series of equations with their Jacobian; none of equations with pieces.
    pub(crate) fn new(assembled: &mut Assembled) -> Option<Self> {
        let jacobian = jacobian(assembled);
        let entries = jacobian.iter().map(|entry| entry.slope);
        let wanted: Vec<Value> = assembled.outputs.iter().copied().chain(entries).collect();
        let mut lowering = Lowering::new(&assembled.builder, assembled.inputs, &wanted);
        let outputs: Option<Vec<Register>> =
            assembled.outputs.iter().map(|output| lowering.register(*output)).collect();
        let slope = |entry: &crate::tangent::Entry| {
            let value = match entry.slope {
                Value::Constant(value) => SlopeValue::Constant(value),
                value => SlopeValue::Series(lowering.register(value)?),
            };
            Some(Slope { output: entry.output, input: entry.input, value })
        };
        let slopes = jacobian.iter().map(slope).collect::<Option<Vec<_>>>()?;
        Some(Self { n_inputs: assembled.inputs, rules: lowering.rules, outputs: outputs?, slopes })
    }
}

/// constant + Σ factor a.
#[derive(Clone, Default)]
struct Sum {
    constant: f64,
    terms: Vec<(f64, Register)>,
}

struct Lowering<'a> {
    builder: &'a Builder,
    n_inputs: usize,
    rules: Vec<Rule>,
    /// How often each step is read.
    reads: Vec<usize>,
    register_of: HashMap<usize, Register>,
    constants: HashMap<u64, Register>,
    functions: HashMap<(Unary, Register), Register>,
}

impl<'a> Lowering<'a> {
    fn new(builder: &'a Builder, n_inputs: usize, wanted: &[Value]) -> Self {
        let mut reads = vec![0; builder.steps.len()];
        let operands = builder.steps.iter().flat_map(Step::operands);
        for value in operands.chain(wanted) {
            if let Value::Step(step) = value {
                reads[*step] += 1;
            }
        }
        Self {
            builder,
            n_inputs,
            rules: Vec::new(),
            reads,
            register_of: HashMap::new(),
            constants: HashMap::new(),
            functions: HashMap::new(),
        }
    }

    fn push(&mut self, rule: Rule) -> Register {
        self.rules.push(rule);
        self.n_inputs + self.rules.len() - 1
    }

    /// Where a value is; none where that has no series.
    fn register(&mut self, value: Value) -> Option<Register> {
        match value {
            Value::Input(input) => Some(input),
            Value::Constant(constant) => Some(self.constant(constant)),
            Value::Step(step) => {
                if let Some(register) = self.register_of.get(&step) {
                    return Some(*register);
                }
                let register = self.step(step)?;
                self.register_of.insert(step, register);
                Some(register)
            }
        }
    }

    fn constant(&mut self, constant: f64) -> Register {
        if let Some(register) = self.constants.get(&constant.to_bits()) {
            return *register;
        }
        let register = self.push(Rule::Combination { constant, terms: Vec::new() });
        self.constants.insert(constant.to_bits(), register);
        register
    }

    fn combination(&mut self, constant: f64, terms: Vec<(f64, Register)>) -> Register {
        self.push(Rule::Combination { constant, terms })
    }

    fn step(&mut self, index: usize) -> Option<Register> {
        let step = self.builder.steps[index];
        let operands = step.operands().to_vec();
        if let Some(sum) = self.sum_of(&step)? {
            return Some(self.combination(sum.constant, sum.terms));
        }
        Some(match (step.code, operands.as_slice()) {
            (Code::Multiply, [a, b]) => {
                let [a, b] = [self.register(*a)?, self.register(*b)?];
                self.push(if a == b { Rule::Square(a) } else { Rule::Product(a, b) })
            }
            (Code::Divide, [a, b]) => {
                let [a, b] = [self.register(*a)?, self.register(*b)?];
                self.push(Rule::Quotient(a, b))
            }
            (Code::Unary(function), [a]) => {
                let a = self.register(*a)?;
                self.function(function, a)?
            }
            (Code::Power, [a, b]) => self.power(*a, *b)?,
            (Code::Atan2, [y, x]) => {
                let [y, x] = [self.register(*y)?, self.register(*x)?];
                let [y_2, x_2] = [self.push(Rule::Square(y)), self.push(Rule::Square(x))];
                let square = self.combination(0.0, vec![(1.0, x_2), (1.0, y_2)]);
                let along_y = self.push(Rule::Quotient(x, square));
                let across = self.push(Rule::Quotient(y, square));
                let along_x = self.combination(0.0, vec![(-1.0, across)]);
                let rates = vec![Rate { u: y, g: along_y }, Rate { u: x, g: along_x }];
                self.push(Rule::Function { code: Code::Atan2, at: [y, x], rates })
            }
            _ => return None,
        })
    }

    /// A step as a sum, if it is one.
    #[allow(clippy::option_option)]
    fn sum_of(&mut self, step: &Step) -> Option<Option<Sum>> {
        use Value::Constant;
        let signs = match (step.code, step.operands()) {
            (Code::Add, _) => [1.0, 1.0],
            (Code::Subtract, _) => [1.0, -1.0],
            (Code::Negate, _) => [-1.0, 0.0],
            (Code::Multiply, [_, Constant(b)]) => [*b, 0.0],
            (Code::Multiply, [Constant(a), _]) => [0.0, *a],
            (Code::Divide, [_, Constant(b)]) => [b.recip(), 0.0],
            _ => return Some(None),
        };
        let mut sum = Sum::default();
        for (operand, sign) in step.operands().to_vec().into_iter().zip(signs) {
            if sign == 0.0 {
                continue;
            }
            let part = self.part(operand)?;
            sum.constant += sign * part.constant;
            sum.terms.extend(part.terms.iter().map(|(factor, of)| (sign * factor, *of)));
        }
        Some(Some(sum))
    }

    /// A value as a part of a sum: a sum that nothing else reads goes into it.
    fn part(&mut self, value: Value) -> Option<Sum> {
        match value {
            Value::Constant(constant) => Some(Sum { constant, terms: Vec::new() }),
            Value::Step(index) if self.reads[index] == 1 => {
                let step = self.builder.steps[index];
                match self.sum_of(&step)? {
                    Some(sum) => Some(sum),
                    None => Some(Sum { constant: 0.0, terms: vec![(1.0, self.register(value)?)] }),
                }
            }
            _ => Some(Sum { constant: 0.0, terms: vec![(1.0, self.register(value)?)] }),
        }
    }

    /// x^y: with a constant y it has the rate y x^y / x, else it is that of exp(y log x).
    fn power(&mut self, x: Value, y: Value) -> Option<Register> {
        let at = [self.register(x)?, self.register(y)?];
        let code = Code::Power;
        if let Value::Constant(exponent) = y {
            let register = self.push(Rule::Function { code, at, rates: Vec::new() });
            let quotient = self.push(Rule::Quotient(register, at[0]));
            let g = self.combination(0.0, vec![(exponent, quotient)]);
            self.grow(register, Rate { u: at[0], g });
            return Some(register);
        }
        let log = self.function(Unary::Log, at[0])?;
        let u = self.push(Rule::Product(at[1], log));
        let register = self.push(Rule::Function { code, at, rates: Vec::new() });
        self.grow(register, Rate { u, g: register });
        Some(register)
    }

    /// States the rate of a function that was pushed without one.
    fn grow(&mut self, register: Register, rate: Rate) {
        if let Rule::Function { rates, .. } = &mut self.rules[register - self.n_inputs] {
            rates.push(rate);
        }
    }

    /// A function of one number, with what its rate is made of behind it.
    fn function(&mut self, function: Unary, u: Register) -> Option<Register> {
        if let Some(register) = self.functions.get(&(function, u)) {
            return Some(*register);
        }
        let code = Code::Unary(function);
        let register = self.push(Rule::Function { code, at: [u; 2], rates: Vec::new() });
        self.functions.insert((function, u), register);
        let one = |lowering: &mut Self| lowering.constant(1.0);
        let g = match function {
            Unary::Abs | Unary::Sign | Unary::Floor => return None,
            Unary::Exp => register,
            Unary::Sqrt => {
                let half = self.constant(0.5);
                self.push(Rule::Quotient(half, register))
            }
            Unary::Log => {
                let one = one(self);
                self.push(Rule::Quotient(one, u))
            }
            Unary::Sin => self.function(Unary::Cos, u)?,
            Unary::Cos => {
                let sin = self.function(Unary::Sin, u)?;
                self.combination(0.0, vec![(-1.0, sin)])
            }
            Unary::Sinh => self.function(Unary::Cosh, u)?,
            Unary::Cosh => self.function(Unary::Sinh, u)?,
            Unary::Tan | Unary::Tanh => {
                let square = self.push(Rule::Square(register));
                let sign = if function == Unary::Tan { 1.0 } else { -1.0 };
                self.combination(1.0, vec![(sign, square)])
            }
            Unary::Atan => {
                let square = self.push(Rule::Square(u));
                let denominator = self.combination(1.0, vec![(1.0, square)]);
                let one = one(self);
                self.push(Rule::Quotient(one, denominator))
            }
            Unary::Asin | Unary::Acos => {
                let square = self.push(Rule::Square(u));
                let rest = self.combination(1.0, vec![(-1.0, square)]);
                let root = self.function(Unary::Sqrt, rest)?;
                let sign = self.constant(if function == Unary::Asin { 1.0 } else { -1.0 });
                self.push(Rule::Quotient(sign, root))
            }
        };
        self.grow(register, Rate { u, g });
        Some(register)
    }
}
