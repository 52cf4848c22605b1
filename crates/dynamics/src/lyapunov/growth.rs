//! What tangents of one batch share: their times in whole steps, the averages of their growth over
//! blocks.

use std::ops::ControlFlow;

use crate::error::{check_times, whole};
use crate::statistics::BLOCKS;
use crate::{Coupling, DynamicsError, Estimate, Progress};

/// How the master equation of a flow is integrated.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub enum Integrator {
    /// Classical fourth-order Runge–Kutta with the fixed step of [`Times::step`].
    Rk4,
    /// Taylor series, in steps as long as they may be. Equations that have no series, since they have
    /// pieces or are not known as a program, go by RK4.
    Taylor {
        /// Local error of a step, relative to the state or to the box of initial states, whichever is larger.
        tolerance: f64,
    },
    /// Taylor series where they are the faster of the two, and RK4 elsewhere.
    Auto {
        /// As of [`Integrator::Taylor`].
        tolerance: f64,
    },
}

/// Times of an average over an orbit, in model time units; of a map, in iterations, and the step is 1.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Times {
    /// The integrator.
    pub integrator: Integrator,
    /// Step of RK4, and the unit in which progress is told.
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
    pub(super) coupling: &'a Coupling,
    pub(super) plan: &'a Plan,
    pub(super) tangents: &'a [Tangent],
    pub(super) escape_radius: f64,
    pub(super) progress: Progress<'a>,
}

/// Below this tolerance nothing but rounding is left of a local error.
const LEAST_TOLERANCE: f64 = 1e-15;

impl Times {
    /// The same with half the step and a thousandth of the tolerance, by which to judge these.
    #[must_use]
    pub fn finer(self) -> Self {
        let finer = |tolerance: f64| (1e-3 * tolerance).max(LEAST_TOLERANCE);
        let integrator = match self.integrator {
            Integrator::Rk4 => Integrator::Rk4,
            Integrator::Taylor { tolerance } => Integrator::Taylor { tolerance: finer(tolerance) },
            Integrator::Auto { tolerance } => Integrator::Auto { tolerance: finer(tolerance) },
        };
        Self { integrator, step: 0.5 * self.step, ..self }
    }

    /// Steps of one tangent from its start to its end.
    pub fn steps(&self) -> u64 {
        whole((self.transient + self.average) / self.step)
    }
}

/// Times in whole steps.
pub(super) struct Plan {
    step: f64,
    steps_per_interval: u64,
    transient_intervals: u64,
    intervals_per_block: u64,
}

impl Plan {
    pub(super) fn new(times: &Times) -> Result<Self, DynamicsError> {
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

    /// The time before the average, and of a block of it.
    pub(super) fn transient_and_block(&self) -> [f64; 2] {
        [self.transient_intervals, self.intervals_per_block].map(|n| n as f64 * self.interval())
    }

    /// Steps of RK4 up to a time.
    pub(super) fn steps_until(&self, time: f64) -> u64 {
        whole(time / self.step)
    }

    /// Runs tangents through the transient and all blocks, scaled anew after every interval; returns
    /// block means of the exponents, `[block][lane]`.
    #[inline(always)]
    pub(super) fn block_means<const L: usize>(
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
pub(super) trait Growing<const L: usize> {
    /// Takes orbits and tangents some steps h forward.
    fn advance(&mut self, n_steps: u64, h: f64);

    /// Whether every orbit is within the radius of escape; a NaN is not.
    fn is_bounded(&self) -> bool;

    /// Scales the tangents to unit length, or makes them orthonormal; gives the logarithms of their
    /// growth.
    fn renormalise(&mut self) -> [f64; L];
}

/// Squares within these bounds are neither lost nor too large.
const SQUARES: std::ops::Range<f64> = 1e-280..1e280;

/// Length of a tangent.
#[inline(always)]
pub(super) fn length(components: impl Iterator<Item = f64> + Clone) -> f64 {
    let squares = components.clone().map(|x| x * x).sum::<f64>();
    if SQUARES.contains(&squares) {
        return squares.sqrt();
    }
    let largest = components.clone().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    if largest == 0.0 {
        return squares;
    }
    components.map(|x| x / largest).map(|x| x * x).sum::<f64>().sqrt() * largest
}

/// The logarithm of a length, rounded alike on every machine as the platform's own need not be. A tangent
/// that has [`vanished`] counts as long as the smallest number.
#[inline(always)]
pub(super) fn log(length: f64) -> f64 {
    libm::log(if vanished(length) { f64::MIN_POSITIVE } else { length })
}

/// Whether nothing is left of a tangent, as where DF = σ DH: it then begins anew.
#[inline(always)]
pub(super) fn vanished(length: f64) -> bool {
    length < f64::MIN_POSITIVE
}

pub(super) fn estimates<const L: usize>(blocks: &[[f64; L]], lanes: usize) -> Vec<Estimate> {
    let of_lane = |lane: usize| blocks.iter().map(|block| block[lane]).collect::<Vec<_>>();
    (0..lanes).map(|lane| Estimate::from_independent(&of_lane(lane))).collect()
}
