//! Λ(σ) on a grid, with standard errors, and what follows from it.

use dynamics::lyapunov::{Tangent, Times, master_exponents_with};
use dynamics::{Coupling, Estimate, InstructionSet, Model, Progress};

use crate::zeros::{self, Refinement, Zero};
use crate::{End, Interval, MsfError, StableRegion};

/// The isolated exponent Λ(0) is averaged over this many orbits from different initial states.
const ISOLATED_ORBITS: u64 = 16;

/// An oscillator with the function through which it is coupled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Dynamics F.
    pub model: Model,
    /// Coupling function H.
    pub coupling: Coupling,
}

/// What to compute.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// Grid of σ ≥ 0, ascending.
    pub sigma: Vec<f64>,
    /// Times of every exponent.
    pub times: Times,
    /// How well zeros must be known.
    pub refinement: Refinement,
    /// Seed from which all orbits' seeds follow.
    pub seed: u64,
    /// Vector instructions to use; results do not depend on them.
    pub instruction_set: InstructionSet,
}

/// The master stability function as computed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MasterStability {
    /// Grid of σ.
    pub sigma: Vec<f64>,
    /// Λ at each σ, per unit of model time.
    pub lambda: Vec<Estimate>,
    /// Λ(0): the largest Lyapunov exponent of the isolated oscillator.
    pub isolated: Estimate,
    /// The stable set {Λ < 0} as far as was looked.
    pub stable: StableRegion,
}

/// Computes Λ on the grid, the isolated exponent, and every zero to the accuracy asked for, or as
/// well as the allowed rounds of refinement give; each zero carries the standard error it has.
///
/// Runs on the current rayon pool; the result does not depend on the number of threads.
///
/// # Errors
/// [`MsfError::BadGrid`]; an orbit that escapes or times that make no sense as [`MsfError::Dynamics`].
pub fn master_stability(
    node: &Node,
    request: &Request,
    progress: Progress<'_>,
) -> Result<MasterStability, MsfError> {
    let ascending = request.sigma.windows(2).all(|pair| pair[0] < pair[1]);
    let from_zero = request.sigma.first().is_some_and(|&sigma| sigma >= 0.0);
    if request.sigma.len() < 2 || !ascending || !from_zero {
        return Err(MsfError::BadGrid);
    }
    let exponents = |tangents: &[Tangent]| {
        let (times, set) = (&request.times, request.instruction_set);
        master_exponents_with(set, node.model, node.coupling, times, tangents, progress)
    };
    let mut seeds = Seeds { next: request.seed.wrapping_mul(1 << 32) };
    let isolated: Vec<_> =
        (0..ISOLATED_ORBITS).map(|_| Tangent { sigma: 0.0, seed: seeds.next() }).collect();
    let isolated: Vec<f64> = exponents(&isolated)?.iter().map(|estimate| estimate.mean).collect();
    // One orbit serves the whole grid. Zeros are found from orbits of their own, since their standard
    // errors come from the scatter of independent exponents.
    let seed = seeds.next();
    let grid: Vec<_> = request.sigma.iter().map(|&sigma| Tangent { sigma, seed }).collect();
    let curve = MasterStability {
        sigma: request.sigma.clone(),
        lambda: exponents(&grid)?,
        isolated: Estimate::from_independent(&isolated),
        ..MasterStability::default()
    };
    let (zeros, initially_stable) =
        zeros::find(&curve, &request.refinement, |sigmas: &[f64]| {
            let tangents: Vec<_> =
                sigmas.iter().map(|&sigma| Tangent { sigma, seed: seeds.next() }).collect();
            Ok(exponents(&tangents)?.iter().map(|estimate| estimate.mean).collect())
        })?;
    let stable = region(&curve.sigma, &zeros, initially_stable);
    Ok(MasterStability { stable, ..curve })
}

/// The intervals between zeros, open at the ends of the grid where these are stable.
fn region(sigma: &[f64], zeros: &[Zero], initially_stable: bool) -> StableRegion {
    let looked = |sigma: Option<&f64>| End::Looked { sigma: sigma.copied().unwrap_or_default() };
    let mut open = initially_stable.then(|| match sigma.first() {
        Some(&sigma) if sigma > 0.0 => looked(Some(&sigma)),
        _ => End::Origin { included: false },
    });
    let mut intervals = Vec::new();
    for &zero in zeros {
        match (zero.falling, open) {
            (true, None) => open = Some(End::Zero(zero)),
            (false, Some(from)) => {
                intervals.push(Interval { from, to: End::Zero(zero) });
                open = None;
            }
            // Zeros alternate, since each is a change of sign.
            (true, Some(_)) | (false, None) => {}
        }
    }
    intervals.extend(open.map(|from| Interval { from, to: looked(sigma.last()) }));
    StableRegion { intervals }
}

/// Seeds that follow one another, so that no two orbits of a computation are the same.
struct Seeds {
    next: u64,
}

impl Seeds {
    fn next(&mut self) -> u64 {
        self.next = self.next.wrapping_add(1);
        self.next
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stable(initially_stable: bool, zeros: &[(f64, bool)]) -> Vec<(f64, Option<f64>)> {
        let zeros: Vec<_> =
            zeros.iter().map(|&(sigma, falling)| Zero::exact(sigma, falling)).collect();
        let region = region(&[0.0, 10.0], &zeros, initially_stable);
        region.intervals.iter().map(|interval| (interval.lower(), interval.upper())).collect()
    }

    #[test]
    fn the_stable_set_opens_at_falling_zeros_and_closes_at_rising_ones() {
        assert_eq!(stable(false, &[]), []);
        assert_eq!(stable(true, &[]), [(0.0, None)]);
        assert_eq!(stable(false, &[(8.0, true)]), [(8.0, None)]);
        assert_eq!(stable(false, &[(0.2, true), (4.6, false)]), [(0.2, Some(4.6))]);
        let twice = [(1.0, false), (2.0, true), (3.0, false), (4.0, true)];
        assert_eq!(stable(true, &twice), [(0.0, Some(1.0)), (2.0, Some(3.0)), (4.0, None)]);
    }
}
