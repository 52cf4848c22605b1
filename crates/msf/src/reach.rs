//! How far a grid of σ should reach when nobody says: beyond the last change of sign of Λ, found by a
//! coarse look at powers of two.

use dynamics::lyapunov::{Tangent, Times, master_exponents};
use dynamics::{Estimate, Progress};

use crate::{MsfError, Node};

/// σ of the look are the largest times powers of 1/2, down to where coupling hardly matters. The largest
/// is half the step's inverse, where RK4 still damps as it should.
const POWERS: i32 = 16;

/// The largest σ of the look at a map, times two: beyond, few of DF − σ DH contract.
const MAPS: f64 = 64.0;

/// A sign counts when Λ is this many standard errors away from zero.
const CERTAIN: f64 = 3.0;

/// Twice the σ behind the last certain change of sign of Λ; the largest σ looked at where Λ keeps
/// its sign, so that a grid up to there shows it.
///
/// # Errors
/// [`MsfError::Dynamics`] for an orbit that escapes and times that make no sense.
pub fn reach(
    node: &Node,
    times: &Times,
    seed: u64,
    progress: Progress<'_>,
) -> Result<f64, MsfError> {
    let beyond = if node.dynamics.is_map() { MAPS } else { 1.0 / times.step };
    let sigma: Vec<f64> = (1..=POWERS).rev().map(|power| 0.5f64.powi(power) * beyond).collect();
    let tangents: Vec<Tangent> = sigma.iter().map(|&sigma| Tangent { sigma, seed }).collect();
    let lambda =
        master_exponents(node.dynamics.as_ref(), &node.coupling, times, &tangents, progress)?;
    Ok(last_change(&sigma, &lambda).map_or(sigma[sigma.len() - 1], |sigma| 2.0 * sigma))
}

/// The σ behind the last change between two certain signs.
fn last_change(sigma: &[f64], lambda: &[Estimate]) -> Option<f64> {
    let certain: Vec<(f64, bool)> = sigma
        .iter()
        .zip(lambda)
        .filter(|(_, lambda)| lambda.mean.abs() > CERTAIN * lambda.standard_error)
        .map(|(&sigma, lambda)| (sigma, lambda.mean < 0.0))
        .collect();
    let mut changes = certain.windows(2).filter(|pair| pair[0].1 != pair[1].1);
    changes.next_back().map(|pair| pair[1].0)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use dynamics::{Coupling, HindmarshRose, Lorenz, Model, Rossler};

    use super::*;

    const TIMES: Times = Times { step: 0.01, transient: 500.0, average: 4000.0, renormalise: 0.5 };

    fn reach_of(model: Model, from: usize, to: usize) -> f64 {
        let node = Node { dynamics: Arc::new(model), coupling: Coupling::pair(from, to) };
        reach(&node, &TIMES, 1, dynamics::QUIET).unwrap()
    }

    #[test]
    fn the_last_zero_lies_between_a_quarter_and_a_half_of_the_reach() {
        // σ = 8.17 (Lorenz, x into y), 0.94 (Hindmarsh–Rose, x into x), 4.61 (Rössler, x into x).
        let reached = [
            (reach_of(Model::Lorenz(Lorenz::default()), 0, 1), 8.17),
            (reach_of(Model::HindmarshRose(HindmarshRose::default()), 0, 0), 0.943),
            (reach_of(Model::Rossler(Rossler::default()), 0, 0), 4.61),
        ];
        for (reach, zero) in reached {
            assert!((2.0 * zero..=4.0 * zero).contains(&reach), "{reach} for {zero}");
        }
    }

    #[test]
    fn a_sign_that_never_changes_is_shown_up_to_the_largest_sigma() {
        // x of Rössler into z does not damp at any σ.
        let estimates = [1.0, 0.5, 0.2].map(|mean| Estimate { mean, standard_error: 0.01 });
        assert_eq!(last_change(&[1.0, 2.0, 4.0], &estimates), None);
    }

    #[test]
    fn signs_in_doubt_are_passed_over() {
        let estimates = [(1.0, 0.1), (-0.1, 0.2), (-1.0, 0.1)]
            .map(|(mean, standard_error)| Estimate { mean, standard_error });
        assert_eq!(last_change(&[1.0, 2.0, 4.0], &estimates), Some(4.0));
    }
}
