//! Puts operations in a row, none of them twice, and none on constants alone.
//!
//! Nothing here changes a bit: operations on constants are done beforehand by the code that would do
//! them later, an operation that was done before on the same numbers is not done again, sums and
//! products may swap their two operands, a product with 1 is its other factor, and a selection
//! between equals is none. Nothing is reassociated, and no two roundings become one.

use std::collections::HashMap;

use crate::names::{Binary, Comparison, Unary};
use crate::scalar::Code;

/// Up to this size an integer power is a product: x^2 = x x, x^3 = x^2 x, x^4 = x^2 x^2, and so on with
/// x^(2n) = x^n x^n and x^(2n+1) = x^(2n) x, x^-n = 1 / x^n, x^0 = 1.
pub const LARGEST_PRODUCT: u32 = 16;

/// A number of a program that is being made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Value {
    Constant(f64),
    Input(usize),
    /// What comes out of a step.
    Step(usize),
}

/// An operation and what it is done on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    pub code: Code,
    operands: [Value; 3],
}

impl Step {
    /// Numbers that it is done on.
    pub(crate) fn operands(&self) -> &[Value] {
        &self.operands[..self.code.operands()]
    }
}

/// What makes two values the same: zeros of different sign are not.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Key {
    Input(usize),
    Step(usize),
    Constant(u64),
}

impl From<Value> for Key {
    fn from(value: Value) -> Self {
        match value {
            Value::Constant(value) => Self::Constant(value.to_bits()),
            Value::Input(input) => Self::Input(input),
            Value::Step(step) => Self::Step(step),
        }
    }
}

/// Operations in a row.
#[derive(Default)]
pub(crate) struct Builder {
    pub steps: Vec<Step>,
    known: HashMap<(Code, [Key; 3]), usize>,
}

impl Builder {
    pub(crate) fn unary(&mut self, function: Unary, a: Value) -> Value {
        self.push(Code::Unary(function), [a; 3])
    }

    pub(crate) fn negate(&mut self, a: Value) -> Value {
        self.push(Code::Negate, [a; 3])
    }

    pub(crate) fn not(&mut self, a: Value) -> Value {
        self.push(Code::Not, [a; 3])
    }

    pub(crate) fn and(&mut self, a: Value, b: Value) -> Value {
        self.push(Code::And, [a, b, b])
    }

    pub(crate) fn or(&mut self, a: Value, b: Value) -> Value {
        self.push(Code::Or, [a, b, b])
    }

    pub(crate) fn compare(&mut self, comparison: Comparison, a: Value, b: Value) -> Value {
        self.push(Code::Compare(comparison), [a, b, b])
    }

    pub(crate) fn binary(&mut self, operation: Binary, a: Value, b: Value) -> Value {
        let code = match operation {
            Binary::Add => Code::Add,
            Binary::Subtract => Code::Subtract,
            Binary::Multiply => Code::Multiply,
            Binary::Divide => Code::Divide,
            Binary::Power => return self.power(a, b),
            Binary::Min => Code::Min,
            Binary::Max => Code::Max,
            Binary::Atan2 => Code::Atan2,
        };
        self.push(code, [a, b, b])
    }

    pub(crate) fn add(&mut self, a: Value, b: Value) -> Value {
        self.push(Code::Add, [a, b, b])
    }

    pub(crate) fn subtract(&mut self, a: Value, b: Value) -> Value {
        self.push(Code::Subtract, [a, b, b])
    }

    pub(crate) fn multiply(&mut self, a: Value, b: Value) -> Value {
        self.push(Code::Multiply, [a, b, b])
    }

    pub(crate) fn divide(&mut self, a: Value, b: Value) -> Value {
        self.push(Code::Divide, [a, b, b])
    }

    pub(crate) fn select(&mut self, condition: Value, a: Value, b: Value) -> Value {
        match condition {
            _ if Key::from(a) == Key::from(b) => a,
            Value::Constant(condition) => {
                if condition == 0.0 {
                    b
                } else {
                    a
                }
            }
            _ => self.push(Code::Select, [condition, a, b]),
        }
    }

    /// x^y, as a product where y is a small integer.
    pub(crate) fn power(&mut self, x: Value, y: Value) -> Value {
        match y {
            Value::Constant(y) if y == y.round() && y.abs() <= f64::from(LARGEST_PRODUCT) => {
                let product = self.product(x, y.abs() as u32);
                if y < 0.0 { self.divide(Value::Constant(1.0), product) } else { product }
            }
            _ => self.push(Code::Power, [x, y, y]),
        }
    }

    fn product(&mut self, x: Value, n: u32) -> Value {
        match n {
            0 => Value::Constant(1.0),
            1 => x,
            _ if n.is_multiple_of(2) => {
                let root = self.product(x, n / 2);
                self.multiply(root, root)
            }
            _ => {
                let even = self.product(x, n - 1);
                self.multiply(even, x)
            }
        }
    }

    fn push(&mut self, code: Code, mut operands: [Value; 3]) -> Value {
        if let [Value::Constant(a), Value::Constant(b), Value::Constant(c)] = operands {
            return Value::Constant(code.of([a, b, c]));
        }
        if let (Code::Multiply, [a, b, _]) = (code, operands) {
            match (a, b) {
                (Value::Constant(1.0), other) | (other, Value::Constant(1.0)) => return other,
                _ => {}
            }
        }
        if code.commutes() && Key::from(operands[0]) > Key::from(operands[1]) {
            operands = [operands[1], operands[0], operands[0]];
        }
        let steps = &mut self.steps;
        let step = *self.known.entry((code, operands.map(Key::from))).or_insert_with(|| {
            steps.push(Step { code, operands });
            steps.len() - 1
        });
        Value::Step(step)
    }
}
