//! Λ(σ) on a grid, with standard errors, and what follows from it.

use std::sync::Arc;

use dynamics::lyapunov::{Tangent, Times, master_exponents_with};
use dynamics::{Coupling, Estimate, InstructionSet, NodeDynamics, Progress};

use crate::attractors::{self, Attractor, Column};
use crate::between;
use crate::isolated::Isolated;
use crate::refinement::{Advance, Refinement};
use crate::step::{Step, is_certain, with_shift};
use crate::zero::Zero;
use crate::zeros::{Finder, Signed, sign};
use crate::{End, Interval, MsfError, StableRegion, origin, rest};

/// The isolated exponent Λ(0) is averaged over this many orbits from different initial states.
pub const ISOLATED_ORBITS: usize = 16;
/// So many of them are run at half the step as well.
const HALVED_ORBITS: usize = 8;

/// An oscillator with the function through which it is coupled.
#[derive(Clone, Debug)]
pub struct Node {
    /// Dynamics F.
    pub dynamics: Arc<dyn NodeDynamics>,
    /// Coupling function H.
    pub coupling: Coupling,
}

/// A grid that begins above 0 is carried on below by so many halvings: a window may lie there.
const HALVINGS: i32 = 8;

/// What to compute.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Request {
    /// Grid of σ ≥ 0, ascending.
    pub sigma: Vec<f64>,
    /// Times of every exponent.
    pub times: Times,
    /// How well zeros must be known.
    pub refinement: Refinement,
    /// Seed from which all orbits' seeds follow.
    pub seed: u64,
    /// Vector instructions to use; results do not depend on them, and so they are left out where a
    /// request is written down.
    #[serde(skip)]
    pub instruction_set: InstructionSet,
}

impl Request {
    /// The σ that are looked at: the grid, and where that begins above 0 its first σ halved eight
    /// times, ascending.
    pub fn looked_at(&self) -> Vec<f64> {
        let first = self.sigma.first().copied().filter(|&first| first > 0.0);
        let halved = |first: f64| (1..=HALVINGS).rev().map(move |k| first * 0.5f64.powi(k));
        first.into_iter().flat_map(halved).chain(self.sigma.iter().copied()).collect()
    }

    /// Steps of tangent vectors, about: those of the curve and of two zeros, besides those with half the
    /// step.
    pub fn steps(&self) -> u64 {
        (self.looked_at().len() as u64 + 16 + 64 + 2 * (8 + 16)) * self.times.steps()
    }
}

/// The master stability function as computed.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MasterStability {
    /// The σ that were looked at: [`Request::looked_at`].
    pub sigma: Vec<f64>,
    /// Λ at each σ, per unit of model time.
    pub lambda: Vec<Estimate>,
    /// Λ(0): the largest Lyapunov exponent of the isolated oscillator. What half the step changes is
    /// in its standard error where that is more than chance.
    pub isolated: Estimate,
    /// By how much half the step of the integrator changes Λ(0), with the standard error of that; 0 for
    /// a map, which has no step.
    pub isolated_step_shift: Estimate,
    /// What Λ(0) says.
    pub state: Isolated,
    /// How many isolated oscillators, of those tried, end in each of the states in which they come to
    /// rest, the most frequent first; none where Λ(0) is not below 0.
    pub rests: Vec<usize>,
    /// How many σ were looked at between these, where a window might have been missed.
    pub between: usize,
    /// Gaps between neighbouring σ in which Λ comes so near zero that a window may still be hidden.
    pub doubtful: Vec<[f64; 2]>,
    /// The stable set {Λ < 0} as far as was looked; of several attractors, what is stable on each.
    pub stable: StableRegion,
    /// Each of them, the one of most orbits first, where orbits settle on several attractors; the
    /// curve and Λ(0) are then those of the first.
    pub attractors: Vec<Attractor>,
}

impl MasterStability {
    /// What half the step changes of Λ(0), where that is more than chance.
    pub fn certain_isolated_step_shift(&self) -> Option<Estimate> {
        is_certain(self.isolated_step_shift).then_some(self.isolated_step_shift)
    }
}

/// Computes Λ on the grid, the isolated exponent, and every zero to the accuracy asked for, or as
/// well as the allowed rounds of refinement give; each zero carries the standard error it has. Where
/// orbits settle on different attractors each has a curve of its own, and no average is taken.
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
    master_stability_with(node, request, progress, &|_| ())
}

/// The same, telling how far the refinement of each zero has come, which no one knows beforehand.
///
/// # Errors
/// As [`master_stability`].
pub fn master_stability_with(
    node: &Node,
    request: &Request,
    progress: Progress<'_>,
    advance: &dyn Fn(Advance),
) -> Result<MasterStability, MsfError> {
    let ascending = request.sigma.windows(2).all(|pair| pair[0] < pair[1]);
    let from_zero = request.sigma.first().is_some_and(|&sigma| sigma >= 0.0);
    if request.sigma.len() < 2 || !ascending || !from_zero {
        return Err(MsfError::BadGrid);
    }
    let work = Work { node, request, progress, advance };
    let mut seeds = Seeds::new(request.seed);
    let (curve, split) = work.curve(&mut seeds)?;
    let mut curve = match split {
        Some(sigma) => work.on_each_attractor(curve, sigma, &mut seeds)?,
        None => curve,
    };
    curve.rests = work.rests(&curve)?;
    if curve.rests.len() > 1 {
        curve.stable.exclude_origin();
        curve.attractors.iter_mut().for_each(|attractor| attractor.stable.exclude_origin());
    }
    Ok(curve)
}

/// One computation.
struct Work<'a> {
    node: &'a Node,
    request: &'a Request,
    progress: Progress<'a>,
    advance: &'a dyn Fn(Advance),
}

impl Work<'_> {
    fn exponents(&self, tangents: &[Tangent], step: Step) -> Result<Vec<Estimate>, MsfError> {
        let (node, mut times, set) = (self.node, self.request.times, self.request.instruction_set);
        if step == Step::Halved {
            times.step *= 0.5;
        }
        let (dynamics, coupling) = (node.dynamics.as_ref(), &node.coupling);
        Ok(master_exponents_with(set, dynamics, coupling, &times, tangents, self.progress)?)
    }

    /// What an average over this time does not know of an exponent in any case: the length of a
    /// tangent varies along the orbit by a factor of order one.
    fn floor(&self) -> f64 {
        1.0 / self.request.times.average
    }

    /// Where the orbits of Λ(0) come to rest.
    fn rests(&self, curve: &MasterStability) -> Result<Vec<usize>, MsfError> {
        if curve.state != Isolated::AtRest {
            return Ok(Vec::new());
        }
        let seeds: Vec<u64> = Seeds::new(self.request.seed).orbits().collect();
        let Times { step, transient, .. } = self.request.times;
        rest::counts(self.node.dynamics.as_ref(), (step, transient), curve.isolated.mean, &seeds)
    }

    /// The curve of the orbits that the seeds give, and a σ at which these differ in kind.
    fn curve(&self, seeds: &mut Seeds) -> Result<(MasterStability, Option<f64>), MsfError> {
        let (sigma, floor) = (self.request.looked_at(), self.floor());
        let orbits = seeds.orbits().map(|seed| Tangent { sigma: 0.0, seed }).collect::<Vec<_>>();
        let isolated = self.exponents(&orbits, Step::Asked)?;
        let split = attractors::split(&[Column { sigma: 0.0, exponents: &isolated }], floor);
        let isolated = estimate_of(&isolated);
        let has_step = !self.node.dynamics.is_map();
        let isolated_step_shift = if has_step {
            let halved = &orbits[..orbits.len().min(HALVED_ORBITS)];
            difference(&self.exponents(halved, Step::Halved)?, isolated)
        } else {
            Estimate::default()
        };
        let isolated = Estimate {
            standard_error: with_shift(isolated.standard_error, isolated_step_shift),
            ..isolated
        };
        // One orbit serves the whole grid. Zeros are found from orbits of their own, since their
        // standard errors come from the scatter of independent exponents.
        let seed = seeds.next();
        let grid: Vec<_> = sigma.iter().map(|&sigma| Tangent { sigma, seed }).collect();
        let lambda = self.exponents(&grid, Step::Asked)?;
        let state = match sign(isolated, floor) {
            Some(true) => Isolated::AtRest,
            Some(false) => Isolated::Chaotic,
            None => Isolated::Periodic,
        };
        let measure = |sigmas: &[f64], step| {
            let tangents: Vec<_> =
                sigmas.iter().map(|&sigma| Tangent { sigma, seed: seeds.next() }).collect();
            self.exponents(&tangents, step)
        };
        let (refinement, advance) = (&self.request.refinement, self.advance);
        let mut finder = Finder { refinement, advance, floor, measure, split, has_step };
        let positive: Vec<(f64, Estimate)> =
            sigma.iter().copied().zip(lambda.iter().copied()).filter(|p| p.0 > 0.0).collect();
        let mut certain = finder.settle(&positive)?;
        let curve = [&[(0.0, isolated)], &positive[..]].concat();
        let on_orbit = |sigmas: &[f64]| {
            let tangents: Vec<_> = sigmas.iter().map(|&sigma| Tangent { sigma, seed }).collect();
            self.exponents(&tangents, Step::Asked)
        };
        let between = between::look((&curve, &certain), floor, on_orbit)?;
        certain.extend(between.signs);
        certain.sort_by(|a, b| a.sigma.total_cmp(&b.sigma));
        let (certain, from) = origin::with(state, certain, &mut finder)?;
        let found = finder.zeros(&certain)?;
        let stable = region(&certain, &found.zeros, from);
        let (rests, attractors) = (Vec::new(), Vec::new());
        let curve = MasterStability {
            sigma,
            lambda,
            isolated,
            isolated_step_shift,
            state,
            rests,
            between: between.n_points,
            doubtful: between.doubtful,
            stable,
            attractors,
        };
        Ok((curve, found.split))
    }

    /// The curve of each attractor. Orbits belong to one by their exponents where these differ.
    fn on_each_attractor(
        &self,
        mixed: MasterStability,
        sigma: f64,
        seeds: &mut Seeds,
    ) -> Result<MasterStability, MsfError> {
        let seeds: Vec<u64> = seeds.orbits().collect();
        let probes: Vec<_> = seeds.iter().map(|&seed| Tangent { sigma, seed }).collect();
        let exponents = self.exponents(&probes, Step::Asked)?;
        let groups = attractors::groups(&exponents, self.floor());
        // Orbits that are all alike now were not for good, or a rare attractor does not come again.
        if groups.len() < 2 {
            return Ok(mixed);
        }
        let mut curves = Vec::new();
        let mut attractors = Vec::new();
        for group in groups {
            let of_group: Vec<Estimate> = group.iter().map(|&orbit| exponents[orbit]).collect();
            let mut orbits = Seeds::again(group.iter().map(|&orbit| seeds[orbit]).collect());
            let (curve, _) = self.curve(&mut orbits)?;
            attractors.push(Attractor {
                orbits: group.len(),
                of: seeds.len(),
                told_at: sigma,
                lambda: estimate_of(&of_group),
                isolated: curve.isolated,
                state: curve.state,
                stable: curve.stable.clone(),
            });
            curves.push(curve);
        }
        let stable = attractors
            .iter()
            .skip(1)
            .fold(attractors[0].stable.clone(), |all, next| all.intersection(&next.stable));
        Ok(MasterStability { stable, attractors, ..curves.swap_remove(0) })
    }
}

/// What half the step changes.
fn difference(halved: &[Estimate], asked: Estimate) -> Estimate {
    let halved = estimate_of(halved);
    Estimate {
        mean: halved.mean - asked.mean,
        standard_error: halved.standard_error.hypot(asked.standard_error),
    }
}

/// Mean over orbits with its scatter; of a single orbit what its blocks say.
fn estimate_of(exponents: &[Estimate]) -> Estimate {
    match exponents {
        [single] => *single,
        _ => Estimate::from_independent(&exponents.iter().map(|e| e.mean).collect::<Vec<_>>()),
    }
}

/// The intervals between zeros, with what the lowest end is where the curve begins stable.
fn region(certain: &[Signed], zeros: &[Zero], from: Option<End>) -> StableRegion {
    let mut open = from;
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
    let last = certain.last().map_or(0.0, |last| last.sigma);
    intervals.extend(open.map(|from| Interval { from, to: End::Looked { sigma: last } }));
    StableRegion { intervals }
}

/// Seeds of orbits.
enum Seeds {
    /// Ever new ones.
    New { next: u64 },
    /// The same ones over and over, of orbits that are known to be on one attractor.
    Again { seeds: Vec<u64>, next: usize },
}

impl Seeds {
    fn new(seed: u64) -> Self {
        Self::New { next: seed.wrapping_mul(1 << 32) }
    }

    fn again(seeds: Vec<u64>) -> Self {
        Self::Again { seeds, next: 0 }
    }

    fn next(&mut self) -> u64 {
        match self {
            Self::New { next } => {
                *next = next.wrapping_add(1);
                *next
            }
            Self::Again { seeds, next } => {
                *next += 1;
                seeds[(*next - 1) % seeds.len()]
            }
        }
    }

    /// Those for an average over orbits, each once.
    fn orbits(&mut self) -> impl Iterator<Item = u64> {
        let count = match self {
            Self::New { .. } => ISOLATED_ORBITS,
            Self::Again { seeds, .. } => seeds.len(),
        };
        (0..count).map(move |_| self.next())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stable(from: Option<End>, zeros: &[(f64, bool)]) -> Vec<(f64, Option<f64>)> {
        let zeros: Vec<_> =
            zeros.iter().map(|&(sigma, falling)| Zero::exact(sigma, falling)).collect();
        let certain = [Signed { sigma: 10.0, negative: true }];
        let region = region(&certain, &zeros, from);
        region.intervals.iter().map(|interval| (interval.lower(), interval.upper())).collect()
    }

    #[test]
    fn the_stable_set_opens_at_falling_zeros_and_closes_at_rising_ones() {
        let origin = Some(End::Origin { included: false });
        assert_eq!(stable(None, &[]), []);
        assert_eq!(stable(origin, &[]), [(0.0, None)]);
        assert_eq!(stable(None, &[(8.0, true)]), [(8.0, None)]);
        assert_eq!(stable(None, &[(0.2, true), (4.6, false)]), [(0.2, Some(4.6))]);
        let twice = [(1.0, false), (2.0, true), (3.0, false), (4.0, true)];
        assert_eq!(stable(origin, &twice), [(0.0, Some(1.0)), (2.0, Some(3.0)), (4.0, None)]);
    }
}
