//! What the coefficients of series are made of.

use crate::scalar::Code;

/// A place for a series. First come inputs.
pub(super) type Register = usize;

/// Equations and their Jacobian as series along a solution.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    pub(super) n_inputs: usize,
    /// What the coefficients of each register behind the inputs are made of.
    pub(super) rules: Vec<Rule>,
    pub(super) outputs: Vec<Register>,
    pub(super) slopes: Vec<Slope>,
}

/// An entry of the Jacobian that is not 0 everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope {
    /// The output whose derivative it is.
    pub output: usize,
    /// The input along which.
    pub input: usize,
    /// What it is.
    pub value: SlopeValue,
}

/// What an entry of the Jacobian is along a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SlopeValue {
    /// The same everywhere.
    Constant(f64),
    /// A series, in this register.
    Series(usize),
}

/// What the coefficients of a register are made of.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Rule {
    /// constant + Σ factor a.
    Combination { constant: f64, terms: Vec<(f64, Register)> },
    /// a b.
    Product(Register, Register),
    /// a².
    Square(Register),
    /// a / b.
    Quotient(Register, Register),
    /// A function of one or two numbers with f' = Σ g u'.
    Function { code: Code, at: [Register; 2], rates: Vec<Rate> },
}

/// A term g u' of the derivative of a function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rate {
    pub u: Register,
    pub g: Register,
}

impl Series {
    /// Components that come in, with time if it enters.
    pub fn n_inputs(&self) -> usize {
        self.n_inputs
    }

    /// Registers that it takes, of which the first are inputs.
    pub fn n_registers(&self) -> usize {
        self.n_inputs + self.rules.len()
    }

    /// The registers of what comes out.
    pub fn outputs(&self) -> &[usize] {
        &self.outputs
    }

    /// The entries of the Jacobian that are not 0 everywhere, output by output.
    pub fn slopes(&self) -> &[Slope] {
        &self.slopes
    }
}
