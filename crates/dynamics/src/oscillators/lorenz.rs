//! The Lorenz oscillator: ẋ = α(y − x), ẏ = x(r − z) − y, ż = xy − bz.
//!
//! Source: E. N. Lorenz, J. Atmos. Sci. 20, 130 (1963); with the names of Fan, Wang & Wang (2023),
//! Sec. III A.

use serde::{Deserialize, Serialize};

use crate::{Oscillator, Scalar};

/// Lorenz's convection model. Defaults: (α, r, b) = (10, 35, 8/3), as in Fan, Wang & Wang (2023).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Lorenz {
    /// Prandtl number α.
    pub alpha: f64,
    /// Reduced Rayleigh number r.
    pub r: f64,
    /// Geometric factor b.
    pub b: f64,
}

impl Default for Lorenz {
    fn default() -> Self {
        Self { alpha: 10.0, r: 35.0, b: 8.0 / 3.0 }
    }
}

impl Oscillator<3> for Lorenz {
    const COMPONENTS: [&'static str; 3] = ["x", "y", "z"];
    const START: [[f64; 2]; 3] = [[-10.0, 10.0], [-10.0, 10.0], [10.0, 30.0]];

    #[inline(always)]
    fn flow<S: Scalar>(&self, [x, y, z]: [S; 3]) -> [S; 3] {
        [(y - x) * self.alpha, x * (S::from(self.r) - z) - y, x * y - z * self.b]
    }
}
