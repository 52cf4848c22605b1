//! From random bits to numbers, by a rule of our own that no other crate's next version changes.

/// 53 random bits, the upper ones of 64, as a number in [0, 1).
pub fn unit_interval(bits: u64) -> f64 {
    (bits >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_is_half_open() {
        assert_eq!((unit_interval(0), unit_interval(1 << 63)), (0.0, 0.5));
        assert_eq!(unit_interval(u64::MAX), 1.0 - 0.5f64.powi(53));
    }
}
