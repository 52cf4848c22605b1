//! How far a grid of σ should reach when nobody says: to twice the last change of sign of Λ, found by a look
//! as far as the step goes.

use dynamics::Progress;
use dynamics::lyapunov::{Tangent, Times, master_exponents};

use crate::look::{Fineness, Seen, look};
use crate::range::{by_factors, furthest};
use crate::zeros::Signed;
use crate::{MsfError, Node};

/// A look halves gaps down to this share of their σ, and adds no more points than this.
const NARROWEST: f64 = 0.02;
const MOST: usize = 256;

/// How far a grid should reach.
///
/// # Errors
/// [`MsfError::Dynamics`] for an orbit that escapes and times that make no sense.
pub fn reach(
    node: &Node,
    times: &Times,
    seed: u64,
    progress: Progress<'_>,
) -> Result<f64, MsfError> {
    let base = by_factors(furthest(node, times, seed)?);
    let (dynamics, coupling) = (node.dynamics.as_ref(), &node.coupling);
    let seen = on_one_orbit(&base, times, |sigmas| {
        let tangents: Vec<_> = sigmas.iter().map(|&sigma| Tangent { sigma, seed }).collect();
        Ok(master_exponents(dynamics, coupling, times, &tangents, progress)?)
    })?;
    Ok(beyond_last_change(&seen.signs(1.0 / times.average)))
}

/// A look at averages over such times, beginning with some σ.
pub(crate) fn on_one_orbit(
    base: &[f64],
    times: &Times,
    mut measure: impl FnMut(&[f64]) -> Result<Vec<dynamics::Estimate>, MsfError>,
) -> Result<Seen, MsfError> {
    let points = base.iter().copied().zip(measure(base)?).collect();
    let fineness = Fineness { floor: 1.0 / times.average, narrowest: NARROWEST, most: MOST };
    look(points, &fineness, measure)
}

/// Twice the σ behind the last change of sign; the last σ where there is none.
pub(crate) fn beyond_last_change(signs: &[Signed]) -> f64 {
    let last = signs.last().map_or(1.0, |last| last.sigma);
    let mut changes = signs.windows(2).filter(|pair| pair[0].negative != pair[1].negative);
    changes.next_back().map_or(last, |pair| (2.0 * pair[1].sigma).min(last))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use dynamics::{Coupling, HindmarshRose, Lorenz, Model, Rossler};

    use dynamics::lyapunov::Integrator;

    use super::*;

    const TIMES: Times = Times {
        integrator: Integrator::Rk4,
        step: 0.01,
        transient: 500.0,
        average: 4000.0,
        renormalise: 0.5,
    };

    fn reach_of(model: Model, from: usize, to: usize) -> f64 {
        let node = Node { dynamics: Arc::new(model), coupling: Coupling::pair(from, to) };
        reach(&node, &TIMES, 1, dynamics::QUIET).unwrap()
    }

    #[test]
    fn the_last_zero_lies_just_below_half_of_the_reach() {
        // σ = 8.17 (Lorenz, x into y), 0.94 (Hindmarsh–Rose, x into x), 4.61 (Rössler, x into x).
        let reached = [
            (reach_of(Model::Lorenz(Lorenz::default()), 0, 1), 8.17),
            (reach_of(Model::HindmarshRose(HindmarshRose::default()), 0, 0), 0.943),
            (reach_of(Model::Rossler(Rossler::default()), 0, 0), 4.61),
        ];
        for (reach, zero) in reached {
            assert!((2.0 * zero..=2.6 * zero).contains(&reach), "{reach} for {zero}");
        }
    }

    #[test]
    fn a_curve_reaches_to_twice_the_last_change_of_sign() {
        let signs = |text: &[(f64, bool)]| -> Vec<Signed> {
            text.iter().map(|&(sigma, negative)| Signed { sigma, negative }).collect()
        };
        let seen = signs(&[(1.0, false), (2.0, true), (4.0, false), (8.0, false), (64.0, false)]);
        assert_eq!(beyond_last_change(&seen), 8.0);
        assert_eq!(beyond_last_change(&signs(&[(1.0, true), (50.0, true)])), 50.0);
    }
}
