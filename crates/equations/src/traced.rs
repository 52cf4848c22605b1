//! Equations in Rust as operations: numbers that write down what is done with them.

use std::cell::RefCell;
use std::ops::{Add, Mul, Neg, Sub};

use crate::assemble::Assembled;
use crate::builder::{Builder, Value};
use crate::names::Binary;

/// A number that writes down what is done with it, see [`crate::Program::trace`].
#[derive(Clone, Copy)]
pub struct Traced<'a> {
    value: Value,
    /// Where; none of a constant that has not met an input.
    recorder: Option<&'a RefCell<Builder>>,
}

/// What equations do with as many inputs.
pub(crate) fn trace(
    n_inputs: usize,
    equations: impl for<'a> FnOnce(&[Traced<'a>]) -> Vec<Traced<'a>>,
) -> Assembled {
    let recorder = RefCell::default();
    let input = |c| Traced { value: Value::Input(c), recorder: Some(&recorder) };
    let inputs: Vec<Traced<'_>> = (0..n_inputs).map(input).collect();
    let outputs = equations(&inputs).into_iter().map(|output| output.value).collect();
    Assembled { builder: recorder.into_inner(), inputs: n_inputs, outputs }
}

impl Traced<'_> {
    fn record(self, operation: impl FnOnce(&mut Builder) -> Value) -> Self {
        let value = match self.recorder {
            Some(recorder) => operation(&mut recorder.borrow_mut()),
            // What is done with constants alone leaves no trace.
            None => operation(&mut Builder::default()),
        };
        Self { value, ..self }
    }

    fn binary(self, operation: Binary, other: Self) -> Self {
        let recorder = self.recorder.or(other.recorder);
        Self { recorder, ..self }
            .record(|builder| builder.binary(operation, self.value, other.value))
    }
}

impl From<f64> for Traced<'_> {
    fn from(value: f64) -> Self {
        Self { value: Value::Constant(value), recorder: None }
    }
}

impl Neg for Traced<'_> {
    type Output = Self;

    fn neg(self) -> Self {
        self.record(|builder| builder.negate(self.value))
    }
}

macro_rules! recorded {
    ($($operator:ident $method:ident $operation:ident),*) => {$(
        impl $operator for Traced<'_> {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                self.binary(Binary::$operation, other)
            }
        }

        impl $operator<f64> for Traced<'_> {
            type Output = Self;

            fn $method(self, other: f64) -> Self {
                self.binary(Binary::$operation, other.into())
            }
        }
    )*};
}
recorded!(Add add Add, Sub sub Subtract, Mul mul Multiply);
