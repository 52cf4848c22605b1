//! Classes of master stability functions: Γ_k has k zeros at finite σ > 0.
//!
//! That of a chaotic oscillator begins above zero: Γ0 is stable nowhere, Γ1 above its zero, Γ2 in a window
//! bounded on both sides, Γ3 in a window and above a third zero, and so on. One that is stable from σ = 0
//! on, as of periodic orbits or of oscillators at rest, has one end more that is no zero, which is said.
//!
//! Source: L. Huang, Q. Chen, Y.-C. Lai & L. M. Pecora, Phys. Rev. E 80, 036204 (2009).

use std::fmt;

use crate::{End, StableRegion};

/// The class of a master stability function, as far as was looked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Class {
    /// Zeros that bound the stable set.
    pub n_zeros: usize,
    /// Whether it begins at σ = 0.
    pub from_origin: bool,
}

impl StableRegion {
    /// The class of a function that has this stable set.
    pub fn class(&self) -> Class {
        let first = self.intervals.first().map(|interval| interval.from);
        let from_origin = matches!(first, Some(End::Origin { .. }));
        Class { n_zeros: self.zeros().count(), from_origin }
    }
}

impl fmt::Display for Class {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let begins = if self.from_origin { ", stable from 0" } else { "" };
        write!(f, "Γ{}{begins}", self.n_zeros)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Interval;

    #[test]
    fn a_class_counts_zeros_and_tells_where_the_stable_set_begins_without_one() {
        let class = |ends: &[(f64, Option<f64>)]| {
            let intervals = ends.iter().map(|&(from, to)| Interval::known(from, to)).collect();
            StableRegion { intervals }.class().to_string()
        };
        assert_eq!(class(&[]), "Γ0");
        assert_eq!(class(&[(1.0, None)]), "Γ1");
        assert_eq!(class(&[(1.0, Some(2.0))]), "Γ2");
        assert_eq!(class(&[(1.0, Some(2.0)), (3.0, None)]), "Γ3");
        assert_eq!(class(&[(0.0, None)]), "Γ0, stable from 0");
        assert_eq!(class(&[(0.0, Some(2.0))]), "Γ1, stable from 0");
    }
}
