//! tanh x = E / (E + 2) with E = exp 2|x| − 1, in two parts.

use super::constants::TO_INTEGER;
use super::exp::{power_of_two, reduced};
use super::two;

/// From here on tanh is ±1.
const LARGEST: f64 = 20.0;

/// Below, tanh x is x.
const SMALLEST: f64 = 1e-9;

/// 2 / ln 2.
const PER_HALF_LN_2: f64 = 2.0 * std::f64::consts::LOG2_E;

/// Hyperbolic tangent.
#[inline(always)]
pub(crate) fn tanh(x: f64) -> f64 {
    let size = x.abs();
    let size = if size > LARGEST { LARGEST } else { size };
    let shifted = size * PER_HALF_LN_2 + TO_INTEGER;
    let (r, tail) = reduced(2.0 * size, 0.0, shifted - TO_INTEGER);
    let scale = power_of_two(shifted);
    // E = (2^k − 1) + 2^k (r + t).
    let (e, e_low) = two::sum(scale - 1.0, scale * r);
    let (e, e_low) = two::ordered_sum(e, e_low + scale * tail);
    let (d, d_low) = two::sum(e, 2.0);
    let d_low = d_low + e_low;
    let quotient = e / d;
    let (p, p_low) = two::product(quotient, d);
    let rest = (((e - p) - p_low) + e_low) - quotient * d_low;
    let tanh = (quotient + rest / d).copysign(x);
    if x.abs() < SMALLEST { x } else { tanh }
}
