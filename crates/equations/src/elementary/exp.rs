//! exp x = 2^k exp r with x = k ln 2 + r, |r| ≤ ½ ln 2.

use super::constants::{LN_2, TO_INTEGER};
use super::two;

/// From here on exp is infinite.
const LARGEST: f64 = 710.0;

/// Below, exp is zero.
const SMALLEST: f64 = -746.0;

/// 1 / ln 2.
const PER_LN_2: f64 = std::f64::consts::LOG2_E;

/// Exponential function.
#[inline(always)]
pub(crate) fn exp(x: f64) -> f64 {
    exp_of_two(x, 0.0)
}

/// exp(x + rest), the rest being small beside x.
#[inline(always)]
pub(super) fn exp_of_two(x: f64, rest: f64) -> f64 {
    let above = x > LARGEST;
    let below = x < SMALLEST;
    let rest = if above | below { 0.0 } else { rest };
    let x = if above { LARGEST } else { x };
    let x = if below { SMALLEST } else { x };
    let shifted = x * PER_LN_2 + TO_INTEGER;
    let (r, tail) = reduced(x, rest, shifted - TO_INTEGER);
    let (one, rounded) = two::ordered_sum(1.0, r);
    // 2^k in two factors: neither over- nor underflows where the product does not.
    let half = (shifted - TO_INTEGER) * 0.5 + TO_INTEGER;
    let other = (shifted - TO_INTEGER) - (half - TO_INTEGER) + TO_INTEGER;
    (one + (rounded + tail)) * power_of_two(half) * power_of_two(other)
}

/// r and t with exp(x + rest − k ln 2) = 1 + r + t.
#[inline(always)]
pub(super) fn reduced(x: f64, rest: f64, k: f64) -> (f64, f64) {
    let high = x - k * LN_2[0];
    let (r, low) = two::sum(high, rest - k * LN_2[1]);
    (r, series(r) + (low + low * r))
}

/// exp r − 1 − r.
#[inline(always)]
fn series(r: f64) -> f64 {
    const C: [f64; 12] = [
        1.0 / 2.0,
        1.0 / 6.0,
        1.0 / 24.0,
        1.0 / 120.0,
        1.0 / 720.0,
        1.0 / 5_040.0,
        1.0 / 40_320.0,
        1.0 / 362_880.0,
        1.0 / 3_628_800.0,
        1.0 / 39_916_800.0,
        1.0 / 479_001_600.0,
        1.0 / 6_227_020_800.0,
    ];
    let r_2 = r * r;
    let r_4 = r_2 * r_2;
    let first = (C[0] + C[1] * r) + (C[2] + C[3] * r) * r_2;
    let second = (C[4] + C[5] * r) + (C[6] + C[7] * r) * r_2;
    let third = (C[8] + C[9] * r) + (C[10] + C[11] * r) * r_2;
    (first + (second + third * r_4) * r_4) * r_2
}

/// 2^k of k + 1.5 · 2^52, for −1023 < k < 1024.
#[inline(always)]
pub(super) fn power_of_two(shifted: f64) -> f64 {
    f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52)
}
