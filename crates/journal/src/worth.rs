//! Whether a result is worth the time that writing it takes.

use std::time::Duration;

/// Bytes a second at which a disk surely writes, and the part of a computation that keeping its result
/// may cost.
const DISK: f64 = 2e8;
const WORTH: f64 = 0.05;
/// So many bytes are kept whatever they cost.
const FEW_BYTES: f64 = 1e6;

/// Whether a result of so many bytes, computed in some time, is worth being kept: writing it should
/// cost a few hundredths of that at most.
pub fn is_worth_keeping(bytes: f64, took: Duration) -> bool {
    bytes < FEW_BYTES || bytes / DISK < WORTH * took.as_secs_f64()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_result_is_kept_where_writing_it_costs_little_of_computing_it() {
        assert!(is_worth_keeping(1e3, Duration::ZERO));
        assert!(is_worth_keeping(1.6e8, Duration::from_secs(60)));
        assert!(!is_worth_keeping(3.2e7, Duration::from_secs(2)));
    }
}
