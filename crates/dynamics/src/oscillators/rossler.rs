//! The Rössler oscillator: ẋ = −y − z, ẏ = x + ay, ż = b + z(x − c).
//!
//! Source: O. E. Rössler, Phys. Lett. A 57, 397 (1976).

use serde::{Deserialize, Serialize};

use crate::{Oscillator, Scalar};

/// Rössler's spiral chaos. Defaults: (a, b, c) = (0.2, 0.2, 9), whose MSF for x into x is known to
/// have a bounded window: L. Huang et al., Phys. Rev. E 80, 036204 (2009).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Rossler {
    /// Growth rate a of the spiral.
    pub a: f64,
    /// Source b of the reinjection.
    pub b: f64,
    /// Threshold c of the reinjection.
    pub c: f64,
}

impl Default for Rossler {
    fn default() -> Self {
        Self { a: 0.2, b: 0.2, c: 9.0 }
    }
}

impl Oscillator<3> for Rossler {
    const COMPONENTS: [&'static str; 3] = ["x", "y", "z"];
    const START: [[f64; 2]; 3] = [[-5.0, 5.0], [-5.0, 5.0], [0.0, 0.5]];

    #[inline(always)]
    fn flow<S: Scalar>(&self, [x, y, z]: [S; 3]) -> [S; 3] {
        [-(y + z), x + y * self.a, z * (x - self.c) + self.b]
    }
}
