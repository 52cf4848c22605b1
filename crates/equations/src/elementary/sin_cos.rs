//! sin and cos by x = n π/2 + r, |r| ≤ π/4, with r in two parts.
//!
//! Up to [`REDUCED`] n π/2 is taken away in four parts, of which the first three have 33 bits and so
//! exact products with n; beyond, [`super::huge`] does it number by number.
//!
//! Source: W. J. Cody & W. Waite, Software Manual for the Elementary Functions (1980).

use super::constants::TO_INTEGER;
use super::reduced::Reduced;
use super::{huge, two};

/// Up to this size of x, [`sin`] and [`cos`] are right.
pub(crate) const REDUCED: f64 = 1_048_576.0;

/// Below, sin x is x.
const SMALLEST: f64 = 1e-8;

/// π/2 in four parts.
const HALF_PI: [f64; 4] = [
    f64::from_bits(0x3ff9_21fb_5440_0000),
    f64::from_bits(0x3dd0_b461_1a60_0000),
    f64::from_bits(0x3ba3_198a_2e00_0000),
    f64::from_bits(0x397b_839a_2520_49c1),
];

/// Sine of an x up to [`REDUCED`].
#[inline(always)]
pub(crate) fn sin(x: f64) -> f64 {
    sin_of(x, reduced(x))
}

/// Cosine of an x up to [`REDUCED`].
#[inline(always)]
pub(crate) fn cos(x: f64) -> f64 {
    quarter(advanced(reduced(x)))
}

/// Sine of any x.
pub(crate) fn sin_of_any(x: f64) -> f64 {
    sin_of(x, if x.abs() <= REDUCED { reduced(x) } else { huge::reduced(x) })
}

/// Cosine of any x.
pub(crate) fn cos_of_any(x: f64) -> f64 {
    quarter(advanced(if x.abs() <= REDUCED { reduced(x) } else { huge::reduced(x) }))
}

#[inline(always)]
fn reduced(x: f64) -> Reduced {
    let shifted = x * std::f64::consts::FRAC_2_PI + TO_INTEGER;
    let n = shifted - TO_INTEGER;
    let first = x - n * HALF_PI[0];
    let (second, low_2) = two::sum(first, -(n * HALF_PI[1]));
    let (third, low_3) = two::sum(second, -(n * HALF_PI[2]));
    let (r, r_low) = two::sum(third, (low_2 + low_3) - n * HALF_PI[3]);
    Reduced { n: shifted.to_bits(), r, r_low }
}

#[inline(always)]
fn sin_of(x: f64, reduced: Reduced) -> f64 {
    let sin = quarter(reduced);
    if x.abs() < SMALLEST { x } else { sin }
}

/// By a quarter of a circle.
#[inline(always)]
fn advanced(reduced: Reduced) -> Reduced {
    Reduced { n: reduced.n.wrapping_add(1), ..reduced }
}

/// sin(n π/2 + r).
#[inline(always)]
fn quarter(reduced: Reduced) -> f64 {
    let value = if reduced.n & 1 == 0 { sin_near_zero(reduced) } else { cos_near_zero(reduced) };
    f64::from_bits(value.to_bits() ^ ((reduced.n & 2) << 62))
}

#[inline(always)]
fn sin_near_zero(Reduced { r, r_low, .. }: Reduced) -> f64 {
    const C: [f64; 8] = [
        -1.0 / 6.0,
        1.0 / 120.0,
        -1.0 / 5_040.0,
        1.0 / 362_880.0,
        -1.0 / 39_916_800.0,
        1.0 / 6_227_020_800.0,
        -1.0 / 1_307_674_368_000.0,
        1.0 / 355_687_428_096_000.0,
    ];
    let z = r * r;
    let z_2 = z * z;
    let first = (C[0] + C[1] * z) + (C[2] + C[3] * z) * z_2;
    let second = (C[4] + C[5] * z) + (C[6] + C[7] * z) * z_2;
    // sin(r + l) = r + (l cos r + r z (…)).
    r + (r * z * (first + second * (z_2 * z_2)) + (r_low - 0.5 * z * r_low))
}

#[inline(always)]
fn cos_near_zero(Reduced { r, r_low, .. }: Reduced) -> f64 {
    const C: [f64; 7] = [
        1.0 / 24.0,
        -1.0 / 720.0,
        1.0 / 40_320.0,
        -1.0 / 3_628_800.0,
        1.0 / 479_001_600.0,
        -1.0 / 87_178_291_200.0,
        1.0 / 20_922_789_888_000.0,
    ];
    let z = r * r;
    let z_2 = z * z;
    let first = (C[0] + C[1] * z) + (C[2] + C[3] * z) * z_2;
    let second = (C[4] + C[5] * z) + C[6] * z_2;
    let half = 0.5 * z;
    let (high, low) = two::ordered_sum(1.0, -half);
    high + (low + (z_2 * (first + second * (z_2 * z_2)) - r * r_low))
}
