//! x^y = exp(y log x), the logarithm and its product with y in two parts.

use super::constants::INTEGERS;
use super::exp::exp_of_two;
use super::log::log_in_two;
use super::two;

/// From here on y makes every power but that of 1 zero or infinite.
const LARGEST: f64 = 36_893_488_147_419_103_232.0; // 2^65

/// x^y; where x is negative, y has to be an integer. Special values are those of IEEE 754: 1 for
/// y = 0 and for x = 1, whatever the other one.
#[inline(always)]
pub(crate) fn pow(x: f64, y: f64) -> f64 {
    let size = x.abs();
    let (is_integer, is_odd) = parity(y);
    let bounded = if y > LARGEST { LARGEST } else { y };
    let bounded = if bounded < -LARGEST { -LARGEST } else { bounded };
    let (log, log_low) = log_in_two(size);
    let (z, z_low) = two::product(bounded, log);
    let power = exp_of_two(z, z_low + bounded * log_low);
    let power = at_the_ends(size, y, power);
    let negative = x.is_sign_negative();
    let power = if negative & is_odd { -power } else { power };
    let outside = (x < 0.0) & !is_integer & (size < f64::INFINITY);
    let power = if outside | x.is_nan() | y.is_nan() { f64::NAN } else { power };
    if (y == 0.0) | (x == 1.0) { 1.0 } else { power }
}

/// |x|^y where |x| is 0, 1 or infinite.
#[inline(always)]
fn at_the_ends(size: f64, y: f64, power: f64) -> f64 {
    let zero_or_infinite = if (size == 0.0) == (y < 0.0) { f64::INFINITY } else { 0.0 };
    let power = if (size == 0.0) | (size == f64::INFINITY) { zero_or_infinite } else { power };
    if size == 1.0 { 1.0 } else { power }
}

/// Whether y is an integer, and whether it is an odd one.
#[inline(always)]
fn parity(y: f64) -> (bool, bool) {
    let size = y.abs();
    let shifted = size + INTEGERS;
    let all_integers = size >= INTEGERS;
    let is_integer = all_integers | (shifted - INTEGERS == size);
    let last = if all_integers { size } else { shifted }.to_bits() & 1;
    let is_odd = is_integer & (last == 1) & (size < 2.0 * INTEGERS);
    (is_integer, is_odd)
}
