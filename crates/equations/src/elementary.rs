//! Elementary functions that give the same bits on every machine and in every lane.
//!
//! Each is written without branches on plain additions, products, quotients and bit patterns, one
//! rounding each, so that a loop over numbers becomes vector instructions: exp, log, sin, cos, tanh
//! and powers are at most one unit in the last place from the correctly rounded value. The series are
//! those of Taylor with as many terms as a double can see.
//!
//! Source of the methods: P. T. P. Tang, ACM Trans. Math. Softw. 15, 144 (1989) and 16, 378 (1990); T. J. Dekker,
//! Numer. Math. 18, 224 (1971) for products in two parts.

mod exp;
mod huge;
mod log;
mod pow;
mod sin_cos;
mod tanh;
mod two;

pub(crate) use exp::exp;
pub(crate) use log::log;
pub(crate) use pow::pow;
pub(crate) use sin_cos::{REDUCED, cos, cos_of_any, sin, sin_of_any};
pub(crate) use tanh::tanh;

use crate::names::Comparison;

/// 1.5 · 2^52: added to a number below 2^51 it leaves the nearest integer in the last bits.
const TO_INTEGER: f64 = 6_755_399_441_055_744.0;

/// 2^52: from here on doubles are integers.
const INTEGERS: f64 = 4_503_599_627_370_496.0;

/// ln 2 in two parts, of which the first has 32 bits: its product with an exponent is exact.
const LN_2: [f64; 2] = [f64::from_bits(0x3fe6_2e42_fee0_0000), 1.908_214_929_270_587_7e-10];

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
    if prefers_min(a, b) { a } else { b }
}

/// The larger one; what is no number stays so.
#[inline(always)]
pub(crate) fn max(a: f64, b: f64) -> f64 {
    if (a > b) | a.is_nan() { a } else { b }
}

#[inline(always)]
fn prefers_min(a: f64, b: f64) -> bool {
    (a < b) | a.is_nan()
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
