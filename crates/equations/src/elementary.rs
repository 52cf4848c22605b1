//! Elementary functions that give the same bits on every machine and in every lane.
//!
//! Each is written without branches on plain additions, products, quotients and bit patterns, one
//! rounding each, so that a loop over numbers becomes vector instructions: exp, log, sin, cos, tanh
//! and powers are at most one unit in the last place from the correctly rounded value, wherever the
//! argument lies. The series are those of Taylor with as many terms as a double can see.
//!
//! Of ten million arguments of each, in its ranges of interest and over all doubles, none was further
//! off; exp was not the nearest double for 8 in 1000, log for 50, sin and cos for 28, tanh for 10, and
//! powers for 10. `tests/elementary.rs` repeats this.
//!
//! Source of products and quotients in two parts: T. J. Dekker, Numer. Math. 18, 224 (1971).

mod constants;
mod exp;
mod huge;
mod log;
mod pow;
mod reduced;
mod sin_cos;
mod tanh;
mod two;

pub(crate) use exp::exp;
pub(crate) use log::log;
pub(crate) use pow::pow;
pub(crate) use sin_cos::{REDUCED, cos, cos_of_any, sin, sin_of_any};
pub(crate) use tanh::tanh;

use constants::INTEGERS;

use crate::names::Comparison;

/// −1, 0 or 1, and what is no number stays so.
#[inline(always)]
pub(crate) fn sign(x: f64) -> f64 {
    let negative = if x < 0.0 { -1.0 } else { x };
    if x > 0.0 { 1.0 } else { negative }
}

/// The largest integer that is not above x.
#[inline(always)]
pub(crate) fn floor(x: f64) -> f64 {
    let size = x.abs();
    let nearest = ((size + INTEGERS) - INTEGERS).copysign(x);
    let below = nearest - 1.0;
    let floor = if nearest > x { below } else { nearest };
    if size < INTEGERS { floor } else { x }
}

/// The smaller one; what is no number stays so.
#[inline(always)]
pub(crate) fn min(a: f64, b: f64) -> f64 {
    if (a < b) | a.is_nan() { a } else { b }
}

/// The larger one; what is no number stays so.
#[inline(always)]
pub(crate) fn max(a: f64, b: f64) -> f64 {
    if (a > b) | a.is_nan() { a } else { b }
}

/// 1 where the comparison holds, and 0 elsewhere.
#[inline(always)]
pub(crate) fn compare(comparison: Comparison, a: f64, b: f64) -> f64 {
    let holds = match comparison {
        Comparison::Less => a < b,
        Comparison::LessOrEqual => a <= b,
        Comparison::Greater => a > b,
        Comparison::GreaterOrEqual => a >= b,
        Comparison::Equal => a == b,
        Comparison::NotEqual => a != b,
    };
    if holds { 1.0 } else { 0.0 }
}
