//! log x = k ln 2 + log m with x = 2^k m, √½ ≤ m < √2, and log m = 2 artanh s with s = (m − 1) / (m + 1).
//!
//! Source of the order of its sums: `e_log.c` of fdlibm, Sun Microsystems (1993).

use super::constants::{INTEGERS, LN_2};
use super::two;

/// The bits of √½.
const SMALLEST: u64 = 0x3fe6_a09e_667f_3bcd;

/// The bits of a double behind its exponent.
const MANTISSA: u64 = (1 << 52) - 1;

/// Natural logarithm.
#[inline(always)]
pub(crate) fn log(x: f64) -> f64 {
    let (k, f) = parts(x);
    let s = f / (2.0 + f);
    let z = s * s;
    let half = 0.5 * f * f;
    // 2 artanh s = f − ½f² + s (½f² + R), of which the first term is exact.
    let log = k * LN_2[0] - ((half - (s * (half + z * series(z)) + k * LN_2[1])) - f);
    special(x, log)
}

/// Natural logarithm in two parts, of a number that is positive and finite.
#[inline(always)]
pub(super) fn log_in_two(x: f64) -> (f64, f64) {
    /// What ⅓ as a double lacks.
    const THIRD: f64 = 1.850_371_707_708_594e-17;
    let (k, f) = parts(x);
    let (d, d_low) = two::ordered_sum(2.0, f);
    let s = f / d;
    let (p, p_low) = two::product(s, d);
    let s_low = (((f - p) - p_low) - s * d_low) / d;
    let (z, z_low) = two::product(s, s);
    let z_low = z_low + 2.0 * s * s_low;
    // log m = 2s (1 + z (1/3 + t)).
    let t = z * fifth(z);
    let (w, w_low) = two::ordered_sum(1.0 / 3.0, t);
    let w_low = w_low + (THIRD + z_low * 0.2);
    let (v, v_low) = two::product(z, w);
    let v_low = v_low + (z * w_low + z_low * w);
    let (g, g_low) = two::ordered_sum(1.0, v);
    let g_low = g_low + v_low;
    let (l, l_low) = two::product(2.0 * s, g);
    let l_low = l_low + 2.0 * (s * g_low + s_low * g);
    let (high, low) = two::sum(k * LN_2[0], l);
    two::ordered_sum(high, low + (l_low + k * LN_2[1]))
}

/// k and m − 1.
#[inline(always)]
fn parts(x: f64) -> (f64, f64) {
    const TINY: f64 = 18_014_398_509_481_984.0; // 2^54
    let subnormal = x < f64::MIN_POSITIVE;
    let bits = if subnormal { x * TINY } else { x }.to_bits();
    let offset = if subnormal { 1023.0 + 54.0 } else { 1023.0 };
    // The exponent counts from √½ on.
    let moved = bits.wrapping_add((1023 << 52) - SMALLEST);
    let exponent = f64::from_bits((moved >> 52) | INTEGERS.to_bits()) - INTEGERS;
    let m = f64::from_bits((moved & MANTISSA) + SMALLEST);
    (exponent - offset, m - 1.0)
}

/// 2 (artanh s − s) / (s z).
#[inline(always)]
fn series(z: f64) -> f64 {
    2.0 / 3.0 + 2.0 * z * fifth(z)
}

/// (artanh s − s − s³/3) / (s z²).
#[inline(always)]
fn fifth(z: f64) -> f64 {
    const C: [f64; 10] = [
        1.0 / 5.0,
        1.0 / 7.0,
        1.0 / 9.0,
        1.0 / 11.0,
        1.0 / 13.0,
        1.0 / 15.0,
        1.0 / 17.0,
        1.0 / 19.0,
        1.0 / 21.0,
        1.0 / 23.0,
    ];
    let z_2 = z * z;
    let first = (C[0] + C[1] * z) + (C[2] + C[3] * z) * z_2;
    let second = (C[4] + C[5] * z) + (C[6] + C[7] * z) * z_2;
    let z_4 = z_2 * z_2;
    first + (second + (C[8] + C[9] * z) * z_4) * z_4
}

/// The logarithm, where x has none that is finite.
#[inline(always)]
fn special(x: f64, log: f64) -> f64 {
    let log = if x == 0.0 { f64::NEG_INFINITY } else { log };
    let log = if x == f64::INFINITY { x } else { log };
    if (x < 0.0) | x.is_nan() { f64::NAN } else { log }
}
