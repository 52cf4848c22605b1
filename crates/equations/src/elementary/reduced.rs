//! What is left of an argument of sin and cos.

/// x as n π/2 + r + r_low; of n the last two bits are right.
#[derive(Clone, Copy)]
pub(super) struct Reduced {
    pub(super) n: u64,
    pub(super) r: f64,
    pub(super) r_low: f64,
}
