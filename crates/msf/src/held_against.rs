//! What a zero is held against once it is found: exponents there at half the step of the integrator, and of
//! orbits that were left to settle for longer by the time of an average. What these change beyond chance
//! is part of its error, and so is what all exponents may be off alike.

use dynamics::Estimate;

use crate::MsfError;
use crate::step::{Step, with_shift};
use crate::zero::Zero;
use crate::zeros::{Finder, mean_of};

/// Exponents at half the step, each at twice the cost.
const HALVED: usize = 16;
/// Exponents after a longer transient, each at about twice the cost.
const LATER: usize = 8;

impl<M: FnMut(&[f64], Step) -> Result<Vec<Estimate>, MsfError>> Finder<'_, M> {
    /// A zero with what is known against it, from Λ there and its slope.
    pub fn held_against(&mut self, zero: Zero, slope: f64) -> Result<Zero, MsfError> {
        let later = self.shift((zero, slope), LATER, Step::Later)?;
        let step_shift = match self.has_step {
            true => Some(self.shift((zero, slope), HALVED, Step::Halved)?),
            false => None,
        };
        let unknown = zero.standard_error.hypot(self.bias / slope);
        let standard_error = with_shift(unknown, later);
        let standard_error = step_shift.map_or(standard_error, |by| with_shift(standard_error, by));
        let is_good = standard_error <= self.refinement.relative_error * zero.sigma;
        Ok(Zero { standard_error, refined: zero.refined && is_good, step_shift, ..zero })
    }

    /// By how much other exponents at a zero move it.
    fn shift(
        &mut self,
        (zero, slope): (Zero, f64),
        n: usize,
        step: Step,
    ) -> Result<Estimate, MsfError> {
        let other = mean_of(&(self.measure)(&vec![zero.sigma; n], step)?);
        let standard_error = (other.standard_error / slope).hypot(zero.standard_error);
        Ok(Estimate { mean: -other.mean / slope, standard_error })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Advance, Refinement};

    /// A zero at 1 of a line of slope −1, which is at another place in some respect.
    fn held(halved: f64, later: f64, bias: f64) -> Zero {
        let refinement = Refinement { relative_error: 0.02, max_rounds: 10 };
        let advance: &dyn Fn(Advance) = &|_| ();
        let measure = |sigmas: &[f64], step| {
            let zero = match step {
                Step::Asked => 1.0,
                Step::Halved => halved,
                Step::Later => later,
            };
            // Scatter that has no mean.
            let noise = |k: usize| if k.is_multiple_of(2) { 1e-3 } else { -1e-3 };
            let exponent = |(k, sigma): (usize, &f64)| Estimate {
                mean: zero - sigma + noise(k),
                standard_error: 1e-3,
            };
            Ok(sigmas.iter().enumerate().map(exponent).collect())
        };
        let mut finder = Finder {
            refinement: &refinement,
            advance,
            floor: 0.0,
            measure,
            split: None,
            has_step: true,
            bias,
        };
        let zero = Zero { standard_error: 1e-3, ..Zero::exact(1.0, true) };
        finder.held_against(zero, -1.0).unwrap()
    }

    #[test]
    fn what_nothing_moves_keeps_its_error() {
        let zero = held(1.0, 1.0, 0.0);
        assert!(zero.standard_error == 1e-3 && zero.refined, "{zero:?}");
    }

    #[test]
    fn what_a_longer_transient_or_half_the_step_moves_is_as_uncertain_as_that() {
        for zero in [held(1.05, 1.0, 0.0), held(1.0, 0.95, 0.0)] {
            assert!((zero.standard_error - 0.05).abs() < 1e-3 && !zero.refined, "{zero:?}");
        }
        assert!(held(1.05, 1.0, 0.0).certain_step_shift().is_some());
    }

    #[test]
    fn what_all_exponents_share_is_in_the_error() {
        let zero = held(1.0, 1.0, 3e-3);
        assert!((zero.standard_error - 1e-3f64.hypot(3e-3)).abs() < 1e-12, "{zero:?}");
    }
}
