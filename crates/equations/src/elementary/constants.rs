//! Numbers that several functions need.

/// 1.5 · 2^52: added to a number below 2^51 it leaves the nearest integer in the last bits.
pub(super) const TO_INTEGER: f64 = 6_755_399_441_055_744.0;

/// 2^52: from here on doubles are integers.
pub(super) const INTEGERS: f64 = 4_503_599_627_370_496.0;

/// ln 2 in two parts, of which the first has 32 bits: its product with an exponent is exact.
pub(super) const LN_2: [f64; 2] =
    [f64::from_bits(0x3fe6_2e42_fee0_0000), 1.908_214_929_270_587_7e-10];
