//! Transitions: ε = σ₀ / |λ|, where the modes of an eigenspace change their stability at a zero σ₀ of Λ.
//!
//! The other ends of the stable set make none: σ = 0 is met at ε = 0 only, and what happens at an end of
//! the look is not known. These bound what is decided: [`crate::Decided`].
//!
//! Source: Fan, Wang & Wang (2023), Sec. II, for the one edge σ_c of an unbounded stable set; bounded
//! windows and unions of intervals follow from the same relation.

use std::ops::Range;

use crate::{StableRegion, Zero};

/// Couplings closer than this, relatively, are one: they differ by rounding.
pub(crate) const SAME_COUPLING: f64 = 1e-12;

/// The transverse modes of one eigenvalue, which change their stability together.
#[derive(Clone, Debug, PartialEq)]
pub struct Eigenspace {
    /// Its modes, counted from 0: mode 0, of λ_1, is the synchronous motion and in none.
    pub modes: Range<usize>,
    /// λ ≤ 0, and exactly 0 for modes of other components, which nothing couples.
    pub lambda: f64,
    /// How far λ may be off.
    pub error: f64,
}

/// A coupling strength at which the modes of an eigenspace change their stability: a critical coupling.
#[derive(Clone, Debug, PartialEq)]
pub struct Transition {
    /// The modes, counted from 0.
    pub modes: Range<usize>,
    /// Their eigenvalue λ.
    pub lambda: f64,
    /// The zero of Λ that they meet. They are damped just above ε where Λ is falling, else just below.
    pub zero: Zero,
    /// ε; infinite when λ = 0, which no coupling stabilises.
    pub epsilon: f64,
    /// Standard error of ε, from those of the zero and of λ.
    pub standard_error: f64,
}

impl Transition {
    fn new(space: &Eigenspace, zero: Zero) -> Self {
        let epsilon = coupling_at(zero.sigma, space.lambda);
        let of_zero = coupling_at(zero.standard_error, space.lambda);
        // λ is uncertain where the links behind it are lost in rounding.
        let of_lambda = epsilon * (space.error / space.lambda.abs());
        Self {
            modes: space.modes.clone(),
            lambda: space.lambda,
            zero,
            epsilon,
            standard_error: if epsilon.is_finite() { of_zero.hypot(of_lambda) } else { of_zero },
        }
    }
}

/// ε at which a mode of eigenvalue λ has this σ = −ελ.
pub fn coupling_at(sigma: f64, lambda: f64) -> f64 {
    sigma / lambda.abs()
}

/// All transitions, eigenspace by eigenspace, and within one by ascending σ.
pub(crate) fn transitions(stable: &StableRegion, eigenspaces: &[Eigenspace]) -> Vec<Transition> {
    let of = |space| stable.zeros().map(move |zero| Transition::new(space, zero));
    eigenspaces.iter().flat_map(of).collect()
}

/// The transition at a coupling strength, the first one if several differ by rounding.
pub fn transition_at(transitions: &[Transition], epsilon: f64) -> Option<&Transition> {
    transitions.iter().find(|t| (t.epsilon - epsilon).abs() <= SAME_COUPLING * epsilon)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{End, Interval};

    fn space(modes: Range<usize>, lambda: f64) -> Eigenspace {
        Eigenspace { modes, lambda, error: 0.0 }
    }

    fn above(zero: Zero) -> StableRegion {
        let interval = Interval { from: End::Zero(zero), to: End::Looked { sigma: 12.0 } };
        StableRegion { intervals: vec![interval] }
    }

    #[test]
    fn couplings_are_the_zeros_over_the_eigenvalues() {
        let zero = Zero { standard_error: 0.02, ..Zero::exact(8.0, true) };
        let spaces = [space(1..2, 0.0), space(2..4, -2.0), space(4..5, -4.0)];
        let found = transitions(&above(zero), &spaces);
        let epsilons: Vec<_> = found.iter().map(|t| (t.modes.start, t.epsilon)).collect();
        assert_eq!(epsilons, [(1, f64::INFINITY), (2, 4.0), (4, 2.0)]);
        assert_eq!((found[1].standard_error, found[2].standard_error), (0.01, 0.005));
        assert!(found.iter().all(|transition| transition.zero == zero));
    }

    #[test]
    fn a_coupling_is_as_uncertain_as_the_zero_and_the_eigenvalue() {
        let zero = Zero { standard_error: 0.3, ..Zero::exact(10.0, true) };
        // 3 % and 4 % of ε = 5.
        let spaces = [Eigenspace { modes: 1..2, lambda: -2.0, error: 0.08 }];
        let found = transitions(&above(zero), &spaces);
        assert!((found[0].standard_error - 0.25).abs() < 1e-15, "{found:?}");
    }

    #[test]
    fn only_zeros_make_transitions() {
        let from_look =
            Interval { from: End::Looked { sigma: 0.5 }, to: End::Looked { sigma: 9.0 } };
        let from_origin = Interval { from: End::Origin { included: true }, ..from_look };
        for interval in [from_look, from_origin] {
            let stable = StableRegion { intervals: vec![interval] };
            assert_eq!(transitions(&stable, &[space(1..3, -1.0)]), []);
        }
    }

    #[test]
    fn both_ends_of_a_window_make_transitions() {
        let window = StableRegion { intervals: vec![Interval::known(1.0, Some(4.0))] };
        let found = transitions(&window, &[space(1..3, -2.0)]);
        let ends: Vec<_> = found.iter().map(|t| (t.epsilon, t.zero.falling)).collect();
        assert_eq!(ends, [(0.5, true), (2.0, false)]);
        assert_eq!(transition_at(&found, 2.0 * (1.0 + 1e-13)), Some(&found[1]));
        assert_eq!(transition_at(&found, 2.0 * (1.0 + 1e-11)), None);
    }
}
