//! Numbers in two parts: a sum a + b of doubles that nothing was rounded away from, |b| being at most
//! half a unit in the last place of a.

/// a + b and what its rounding takes away. Source: D. E. Knuth, The Art of Computer Programming,
/// vol. 2, sec. 4.2.2.
#[inline(always)]
pub(super) fn sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// The same where |a| is not below |b|.
#[inline(always)]
pub(super) fn ordered_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// a b and what its rounding takes away, up to 2^-106 of it.
#[inline(always)]
pub(super) fn product(a: f64, b: f64) -> (f64, f64) {
    let ((a_1, a_2), (b_1, b_2)) = (halves(a), halves(b));
    let product = a * b;
    (product, (((a_1 * b_1 - product) + a_1 * b_2) + a_2 * b_1) + a_2 * b_2)
}

/// The first 26 bits and the others.
#[inline(always)]
fn halves(a: f64) -> (f64, f64) {
    let first = f64::from_bits(a.to_bits() & !0x07ff_ffff);
    (first, a - first)
}
