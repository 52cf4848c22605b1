//! What each operation makes of single numbers: the rule that folding constants and running programs
//! share, so that both give the same bits.

use crate::elementary;
use crate::names::{Comparison, Unary};

/// An operation of a program, apart from what it is done on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Code {
    Add,
    Subtract,
    Multiply,
    Divide,
    Negate,
    Unary(Unary),
    Power,
    Min,
    Max,
    Atan2,
    /// Conditions are 1 or 0.
    Compare(Comparison),
    And,
    Or,
    Not,
    /// The second number where the first is not 0, and the third elsewhere.
    Select,
}

impl Code {
    /// Numbers that it is done on.
    pub(crate) fn operands(self) -> usize {
        match self {
            Self::Negate | Self::Unary(_) | Self::Not => 1,
            Self::Select => 3,
            _ => 2,
        }
    }

    /// Whether the order of its operands cannot change bits.
    pub(crate) fn commutes(self) -> bool {
        matches!(self, Self::Add | Self::Multiply | Self::And | Self::Or)
    }

    /// What comes out of single numbers; operands that it has not are not looked at.
    pub(crate) fn of(self, [a, b, c]: [f64; 3]) -> f64 {
        match self {
            Self::Add => a + b,
            Self::Subtract => a - b,
            Self::Multiply => a * b,
            Self::Divide => a / b,
            Self::Negate => -a,
            Self::Unary(function) => unary(function, a),
            Self::Power => elementary::pow(a, b),
            Self::Min => elementary::min(a, b),
            Self::Max => elementary::max(a, b),
            Self::Atan2 => libm::atan2(a, b),
            Self::Compare(comparison) => elementary::compare(comparison, a, b),
            Self::And => a * b,
            Self::Or => elementary::max(a, b),
            Self::Not => 1.0 - a,
            Self::Select => select(a, b, c),
        }
    }
}

/// The second number where the first is not 0, and the third elsewhere.
#[inline(always)]
pub(crate) fn select(condition: f64, a: f64, b: f64) -> f64 {
    if condition == 0.0 { b } else { a }
}

fn unary(function: Unary, x: f64) -> f64 {
    match function {
        Unary::Abs => x.abs(),
        Unary::Sign => elementary::sign(x),
        Unary::Floor => elementary::floor(x),
        Unary::Sqrt => x.sqrt(),
        Unary::Exp => elementary::exp(x),
        Unary::Log => elementary::log(x),
        Unary::Sin => elementary::sin_of_any(x),
        Unary::Cos => elementary::cos_of_any(x),
        Unary::Tan => libm::tan(x),
        Unary::Asin => libm::asin(x),
        Unary::Acos => libm::acos(x),
        Unary::Atan => libm::atan(x),
        Unary::Sinh => libm::sinh(x),
        Unary::Cosh => libm::cosh(x),
        Unary::Tanh => elementary::tanh(x),
    }
}
