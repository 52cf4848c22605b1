//! The Hindmarsh–Rose neuron: ẋ = y − x³ + 3x² − z + I, ẏ = 1 − 5x² − y, ż = r[s(x + 1.6) − z].
//!
//! Source: J. L. Hindmarsh & R. M. Rose, Proc. R. Soc. B 221, 87 (1984); with the names of Fan,
//! Wang & Wang (2023), Sec. III B.

use serde::{Deserialize, Serialize};

use crate::{Oscillator, Scalar};

/// A bursting neuron. Defaults: (r, s, I) = (0.006, 4, 3.2), as in Fan, Wang & Wang (2023).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct HindmarshRose {
    /// Rate r of the slow adaptation.
    pub r: f64,
    /// Strength s of the adaptation.
    pub s: f64,
    /// External current I.
    pub current: f64,
}

impl Default for HindmarshRose {
    fn default() -> Self {
        Self { r: 0.006, s: 4.0, current: 3.2 }
    }
}

impl Oscillator<3> for HindmarshRose {
    const COMPONENTS: [&'static str; 3] = ["x", "y", "z"];
    const START: [[f64; 2]; 3] = [[-1.5, 1.5], [-8.0, 0.0], [2.8, 3.4]];

    #[inline(always)]
    fn flow<S: Scalar>(&self, [x, y, z]: [S; 3]) -> [S; 3] {
        let x2 = x * x;
        [
            y + x2 * (S::from(3.0) - x) - z + self.current,
            S::from(1.0) - x2 * 5.0 - y,
            ((x + 1.6) * self.s - z) * self.r,
        ]
    }
}
