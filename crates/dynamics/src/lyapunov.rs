//! Lyapunov exponents: the largest of the master equation, and the whole spectrum of one oscillator.
//!
//! The master equation `δẏ = [DF(s) − σ DH] δy` (Fan, Wang & Wang 2023, Eq. (4)) is integrated with
//! its orbit `ṡ = F(s)` as one system on dual numbers: s is the value, δy the tangent. At σ = 0 its
//! exponent is the largest Lyapunov exponent of the isolated oscillator.
//!
//! Method: G. Benettin et al., Meccanica 15, 9 (1980): tangents are renormalised at intervals and
//! the logarithms of their growth averaged.

mod master_equation;
mod tiles;

use std::ops::ControlFlow;

use rayon::prelude::*;

pub(crate) use master_equation::fused;
use tiles::Tiles;
pub(crate) use tiles::by_flow;

use crate::error::{check_times, whole};
use crate::statistics::BLOCKS;
use crate::{Coupling, DynamicsError, Estimate, InstructionSet, NodeDynamics, Progress, QUIET};

/// The most tangents advanced together.
const MAX_LANES: usize = 16;

/// From this many tangents on an orbit is worth computing for them alone, as a plain number.
const SHARED_ORBIT: usize = 4;

/// Times of an average over an orbit, in model time units, with a fixed RK4 step.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Times {
    /// Step of the integrator.
    pub step: f64,
    /// Time in which the orbit settles and the tangent turns into its direction of fastest growth.
    pub transient: f64,
    /// Time of the average, rounded to [`BLOCKS`] blocks of whole intervals.
    pub average: f64,
    /// Interval between renormalisations.
    pub renormalise: f64,
}

/// One exponent to compute: σ of the master equation, and the seed of the orbit's initial state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tangent {
    /// Generic coupling strength σ = −ελ.
    pub sigma: f64,
    /// Seed of s(0).
    pub seed: u64,
}

/// Tangents of the master equation that are advanced together, at most sixteen.
pub struct Tangents<'a> {
    coupling: &'a Coupling,
    plan: &'a Plan,
    tangents: &'a [Tangent],
    progress: Progress<'a>,
}

/// Largest Lyapunov exponents Λ(σ) of the master equation, one for each tangent, per unit of model
/// time, with standard errors over [`BLOCKS`] blocks. Tangents with one seed have one orbit, and are
/// cheaper for it; their errors are then correlated.
///
/// Runs on the current rayon pool; results come in the order of `tangents` and do not depend on how
/// these are grouped into lanes or threads.
///
/// # Errors
/// [`DynamicsError::BadStep`], [`DynamicsError::BadTime`], [`DynamicsError::TooFewSamples`] for times
/// that make no sense; [`DynamicsError::Escaped`] when an orbit leaves the ball of radius
/// [`crate::ESCAPE_RADIUS`].
pub fn master_exponents(
    dynamics: &dyn NodeDynamics,
    coupling: &Coupling,
    times: &Times,
    tangents: &[Tangent],
    progress: Progress<'_>,
) -> Result<Vec<Estimate>, DynamicsError> {
    master_exponents_with(InstructionSet::best(), dynamics, coupling, times, tangents, progress)
}

/// [`master_exponents`] with given vector instructions, on which the results do not depend.
///
/// # Errors
/// As [`master_exponents`].
///
/// # Panics
/// When this processor does not have the instructions.
pub fn master_exponents_with(
    instruction_set: InstructionSet,
    dynamics: &dyn NodeDynamics,
    coupling: &Coupling,
    times: &Times,
    tangents: &[Tangent],
    progress: Progress<'_>,
) -> Result<Vec<Estimate>, DynamicsError> {
    let plan = Plan::new(times)?;
    let mut order: Vec<usize> = (0..tangents.len()).collect();
    order.sort_by_key(|&index| tangents[index].seed);
    let (shared, alone): (Vec<_>, Vec<_>) = order
        .chunk_by(|&a, &b| tangents[a].seed == tangents[b].seed)
        .partition(|of_one_seed| of_one_seed.len() >= SHARED_ORBIT);
    let alone = alone.concat();
    let batches: Vec<&[usize]> = shared
        .iter()
        .flat_map(|of_one_seed| of_one_seed.chunks(MAX_LANES))
        .chain(alone.chunks(MAX_LANES))
        .collect();
    let run = |&batch: &&[usize]| {
        let tangents: Vec<Tangent> = batch.iter().map(|&index| tangents[index]).collect();
        let tangents = Tangents { coupling, plan: &plan, tangents: &tangents, progress };
        dynamics.exponents(instruction_set, &tangents)
    };
    let exponents: Vec<_> =
        batches.par_iter().with_max_len(1).map(run).collect::<Result<_, _>>()?;
    let mut in_order = vec![Estimate::default(); tangents.len()];
    for (&index, exponent) in batches.iter().copied().flatten().zip(exponents.concat()) {
        in_order[index] = exponent;
    }
    Ok(in_order)
}

/// All Lyapunov exponents of the isolated oscillator, descending, per unit of model time.
///
/// As many tangents as components are carried along one orbit and re-orthogonalised at every interval (QR
/// by modified Gram–Schmidt).
///
/// # Errors
/// As [`master_exponents`].
pub fn spectrum(
    dynamics: &dyn NodeDynamics,
    times: &Times,
    seed: u64,
) -> Result<Vec<Estimate>, DynamicsError> {
    let plan = Plan::new(times)?;
    let mut tiles = Tiles::axes(dynamics, InstructionSet::best(), seed);
    Ok(estimates(&plan.block_means(&mut tiles, QUIET)?, dynamics.start().len()))
}

impl Times {
    /// Steps of one tangent from its start to its end.
    pub fn steps(&self) -> u64 {
        whole((self.transient + self.average) / self.step)
    }
}

/// Times in whole steps.
struct Plan {
    step: f64,
    steps_per_interval: u64,
    transient_intervals: u64,
    intervals_per_block: u64,
}

impl Plan {
    fn new(times: &Times) -> Result<Self, DynamicsError> {
        let steps_per_interval = (times.renormalise / times.step).round().max(1.0);
        let interval = steps_per_interval * times.step;
        let named = [
            ("transient", times.transient),
            ("average", times.average),
            ("renormalise", times.renormalise),
        ];
        check_times(times.step, &named, times.average / interval)?;
        Ok(Self {
            step: times.step,
            steps_per_interval: whole(steps_per_interval),
            transient_intervals: whole(times.transient / interval),
            intervals_per_block: whole(times.average / interval / BLOCKS as f64),
        })
    }

    fn interval(&self) -> f64 {
        self.steps_per_interval as f64 * self.step
    }

    /// Runs tangents through the transient and all blocks, scaled anew after every interval; returns
    /// block means of the exponents, `[block][lane]`.
    #[inline(always)]
    fn block_means<const L: usize>(
        &self,
        tangents: &mut impl Growing<L>,
        progress: impl Fn(u64) -> ControlFlow<()>,
    ) -> Result<Vec<[f64; L]>, DynamicsError> {
        let in_blocks = self.intervals_per_block * BLOCKS as u64;
        let mut blocks = Vec::with_capacity(BLOCKS);
        let mut growth = [0.0; L];
        for interval in 1..=self.transient_intervals + in_blocks {
            tangents.advance(self.steps_per_interval, self.step);
            if !tangents.is_bounded() {
                return Err(DynamicsError::Escaped { time: interval as f64 * self.interval() });
            }
            for (sum, log) in growth.iter_mut().zip(tangents.renormalise()) {
                *sum += log;
            }
            if progress(self.steps_per_interval).is_break() {
                return Err(DynamicsError::Cancelled);
            }
            let Some(averaged) = interval.checked_sub(self.transient_intervals) else { continue };
            if averaged.is_multiple_of(self.intervals_per_block) {
                let time = self.intervals_per_block as f64 * self.interval();
                // At its end the transient has been one block, and is forgotten.
                if averaged > 0 {
                    blocks.push(growth.map(|sum| sum / time));
                }
                growth = [0.0; L];
            }
        }
        Ok(blocks)
    }
}

/// Tangents that grow along their orbits, in `L` lanes.
trait Growing<const L: usize> {
    /// Takes orbits and tangents some steps h forward.
    fn advance(&mut self, n_steps: u64, h: f64);

    /// Whether every orbit is within [`crate::ESCAPE_RADIUS`]; a NaN is not.
    fn is_bounded(&self) -> bool;

    /// Scales the tangents to unit length, or makes them orthonormal; gives the logarithms of their
    /// growth.
    fn renormalise(&mut self) -> [f64; L];
}

/// The logarithm of a length, rounded alike on every machine as the platform's own need not be.
#[inline(always)]
fn log(length: f64) -> f64 {
    libm::log(length)
}

fn estimates<const L: usize>(blocks: &[[f64; L]], lanes: usize) -> Vec<Estimate> {
    let of_lane = |lane: usize| blocks.iter().map(|block| block[lane]).collect::<Vec<_>>();
    (0..lanes).map(|lane| Estimate::from_independent(&of_lane(lane))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Lorenz, Model, Rossler};

    const TIMES: Times = Times { step: 0.01, transient: 100.0, average: 5000.0, renormalise: 0.5 };

    fn within(estimate: Estimate, expected: f64, slack: f64) {
        let allowed = 4.0 * estimate.standard_error + slack;
        assert!(
            (estimate.mean - expected).abs() < allowed,
            "{estimate:?} against {expected} ± {allowed}"
        );
    }

    #[test]
    fn a_component_that_decays_by_itself_decays_faster_by_sigma() {
        // z into z of Lorenz at a stable fixed point: r < 1 makes the origin attract, where the
        // Jacobian is triangular and the z direction decays at b + σ, apart from x and y.
        let model = Model::Lorenz(Lorenz { alpha: 1.0, r: 0.0, b: 0.5 });
        let z = Coupling::pair(2, 2);
        let tangents = [0.0, 0.25, 2.0].map(|sigma| Tangent { sigma, seed: 1 });
        let exponents = master_exponents(&model, &z, &TIMES, &tangents, QUIET).unwrap();
        // At r = 0, α = 1 the x–y block has the double rate −1; the slowest rate wins.
        for (exponent, expected) in exponents.iter().zip([-0.5, -0.75, -1.0]) {
            assert!((exponent.mean - expected).abs() < 2e-3, "{exponent:?} against {expected}");
        }
    }

    #[test]
    fn lyapunov_exponents_of_lorenz_sum_to_its_divergence() {
        let lorenz = Lorenz::default();
        let exponents = spectrum(&Model::Lorenz(lorenz), &TIMES, 1).unwrap();
        let sum: f64 = exponents.iter().map(|e| e.mean).sum();
        let divergence = -(lorenz.alpha + 1.0 + lorenz.b);
        assert!((sum - divergence).abs() < 1e-3, "{sum} against {divergence}");
        within(exponents[1], 0.0, 1e-3);
    }

    #[test]
    fn the_largest_exponent_agrees_between_one_tangent_and_qr() {
        for model in [Model::Lorenz(Lorenz::default()), Model::Rossler(Rossler::default())] {
            let coupling = Coupling::pair(0, 0);
            let tangent = [Tangent { sigma: 0.0, seed: 7 }];
            let one = master_exponents(&model, &coupling, &TIMES, &tangent, QUIET).unwrap()[0];
            let qr = spectrum(&model, &TIMES, 8).unwrap()[0];
            within(one, qr.mean, 4.0 * qr.standard_error);
        }
    }

    #[test]
    fn exponents_have_the_same_bits_in_any_lane() {
        let model = Model::Lorenz(Lorenz::default());
        let coupling = Coupling::pair(0, 1);
        let times = Times { average: 100.0, ..TIMES };
        let tangents: Vec<_> =
            (0..11u32).map(|k| Tangent { sigma: f64::from(k), seed: u64::from(k % 3) }).collect();
        let together = master_exponents(&model, &coupling, &times, &tangents, QUIET).unwrap();
        let alone: Vec<_> = tangents
            .iter()
            .map(|&t| master_exponents(&model, &coupling, &times, &[t], QUIET).unwrap()[0])
            .collect();
        assert_eq!(together, alone);
    }

    #[test]
    fn exponents_have_the_same_bits_for_every_instruction_set() {
        let model = Model::Rossler(Rossler::default());
        let (coupling, times) = (Coupling::pair(0, 0), Times { average: 100.0, ..TIMES });
        let tangents: Vec<_> = (0..20u32)
            .map(|k| Tangent { sigma: f64::from(k) / 4.0, seed: u64::from(k.saturating_sub(15)) })
            .collect();
        let exponents =
            |set| master_exponents_with(set, &model, &coupling, &times, &tangents, QUIET).unwrap();
        let baseline = exponents(InstructionSet::Baseline);
        for set in InstructionSet::available() {
            assert_eq!(exponents(set), baseline, "{}", set.name());
        }
    }

    #[test]
    fn an_orbit_that_escapes_is_an_error_with_its_time() {
        // With c < 0 the Rössler oscillator has no bounded attractor.
        let model = Model::Rossler(Rossler { a: 0.5, b: 0.2, c: -9.0 });
        let error = spectrum(&model, &TIMES, 1).unwrap_err();
        assert!(matches!(error, DynamicsError::Escaped { time } if time > 0.0), "{error:?}");
    }

    #[test]
    fn times_that_make_no_sense_are_refused() {
        let refused = |times| spectrum(&Model::Lorenz(Lorenz::default()), &times, 1).unwrap_err();
        assert_eq!(refused(Times { step: -0.01, ..TIMES }), DynamicsError::BadStep { step: -0.01 });
        assert_eq!(
            refused(Times { average: 0.0, ..TIMES }),
            DynamicsError::TooFewSamples { samples: 0, needed: 20 }
        );
    }
}
