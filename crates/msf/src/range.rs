//! How far and from where on to look at Λ(σ) when nobody says: as far as the step of the integrator is
//! sound, from where coupling hardly matters, by factors.

use dynamics::lyapunov::Times;
use dynamics::{LinearSteps, Method, StepVerdict};

use crate::{MsfError, Node};

/// The largest σ of a look at a flow whose step would go further, and at a map: beyond it few of
/// DF − σ DH contract.
const FLOWS: f64 = 4096.0;
const MAPS: f64 = 32.0;
/// The largest σ of a look at orbits that close, which need no step: multipliers are right at any.
pub(crate) const CLOSED: f64 = 1024.0;
/// The smallest σ of a look at a flow and at a map.
const FROM: f64 = 1.0 / 1024.0;
/// σ in a factor of two.
const PER_OCTAVE: i32 = 3;

/// 0, and σ up to the last by constant factors.
pub(crate) fn by_factors(last: f64) -> Vec<f64> {
    let n = (f64::from(PER_OCTAVE) * (last / FROM).log2()).ceil().max(1.0);
    #[expect(clippy::cast_possible_truncation, reason = "a few dozen")]
    let n = n as i32;
    let sigma = |k: i32| last * 0.5f64.powf(f64::from(n - k) / f64::from(PER_OCTAVE));
    [0.0].into_iter().chain((0..=n).map(sigma)).collect()
}

/// The largest σ at which the step takes the leading direction at its rate: within a fifth. Where that is
/// nowhere, half of that up to which the step damps what the equations damp.
pub(crate) fn furthest(node: &Node, times: &Times, seed: u64) -> Result<f64, MsfError> {
    if node.dynamics.is_map() {
        return Ok(MAPS);
    }
    let step = times.step;
    let steps = LinearSteps::along_orbit(node.dynamics.as_ref(), &node.coupling, step, seed)?;
    let is_sound = |sigma: f64| steps.judge(sigma, (Method::Rk4, step)) == StepVerdict::Sound;
    let mut sigma = FLOWS;
    while sigma > 1.0 {
        if is_sound(sigma) {
            return Ok(sigma);
        }
        sigma /= 1.2;
    }
    Ok(0.5 * steps.stable_up_to(FLOWS, (Method::Rk4, step)))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use dynamics::{Coupling, Lorenz, Model};

    use dynamics::lyapunov::Integrator;

    use super::*;

    #[test]
    fn a_look_begins_at_zero_and_ends_where_the_step_does() {
        let times = Times {
            integrator: Integrator::Rk4,
            step: 0.01,
            transient: 100.0,
            average: 1000.0,
            renormalise: 0.5,
        };
        let dynamics = Arc::new(Model::Lorenz(Lorenz::default()));
        let node = Node { dynamics, coupling: Coupling::pair(1, 1) };
        // The fast rate is 1 + σ, and RK4 ends at 2.785 over the step.
        let last = furthest(&node, &times, 1).unwrap();
        assert!((150.0..280.0).contains(&last), "{last}");
        let sigma = by_factors(last);
        assert_eq!((sigma[0], sigma[sigma.len() - 1]), (0.0, last));
        assert!(sigma[1] <= FROM && sigma.windows(2).skip(1).all(|pair| pair[1] < 1.27 * pair[0]));
    }
}
