//! Means of correlated series with standard errors from block averages.
//!
//! Source: H. Flyvbjerg & H. G. Petersen, J. Chem. Phys. 91, 461 (1989).

use serde::{Deserialize, Serialize};

/// Number of blocks into which an average is cut: each is far longer than any correlation time when
/// the whole average is worth making.
pub const BLOCKS: usize = 20;

/// A mean with its standard error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// Its standard error (one standard deviation).
    pub standard_error: f64,
}

impl Estimate {
    /// Mean and standard error of independent values, such as block means or replicas.
    ///
    /// The standard error of fewer than two values is infinite: nothing is known of their spread.
    pub fn from_independent(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        if values.len() < 2 {
            return Self { mean, standard_error: f64::INFINITY };
        }
        let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
        Self { mean, standard_error: (squares / (n - 1.0) / n).sqrt() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn standard_error_of_one_two_three_is_one_over_root_three() {
        let estimate = Estimate::from_independent(&[1.0, 2.0, 3.0]);
        assert_eq!(estimate.mean, 2.0);
        assert!((estimate.standard_error - 1.0 / 3f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn one_value_tells_nothing_of_its_error() {
        assert_eq!(Estimate::from_independent(&[4.0]).standard_error, f64::INFINITY);
    }
}
