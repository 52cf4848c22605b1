//! Simulation of a network, `dx_i/dt = F(x_i) + ε Σ_j w_ij H(x_j)`: Fan, Wang & Wang (2023), Eq. (1).
//!
//! What is asked for and what comes out; the step itself is in [`crate::kernel`].

use rayon::prelude::*;

use crate::batches::{self, Batch};
use crate::error::{check_times, whole};
use crate::integrators::{Method, adaptive};
use crate::observables::{Errors, Observables};
use crate::oscillators::with_oscillator;
use crate::statistics::BLOCKS;
use crate::{Coupling, DynamicsError, InstructionSet, Model, Oscillator, Progress, SparseMatrix};

/// Relative size of kicks of some fifty roundings.
pub const ROUNDING_KICK: f64 = 1e-14;

/// How long to simulate and how often to look. All times in model time units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schedule {
    /// Step of the integrator (the sampling unit of an adaptive one).
    pub step: f64,
    /// Time left for the initial state to be forgotten.
    pub transient: f64,
    /// Time over which errors are averaged, rounded up to [`BLOCKS`] blocks of whole samples.
    pub average: f64,
    /// Steps from one sample to the next.
    pub stride: u32,
}

/// One run of the network: a coupling strength and the seed of its initial state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Replica {
    /// Uniform coupling strength ε.
    pub epsilon: f64,
    /// Seed of the initial state; the same seed gives the same state at every ε.
    pub seed: u64,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// It stayed bounded: its time-averaged errors.
    Completed(Errors),
    /// A component left the ball of radius [`crate::ESCAPE_RADIUS`], seen at this model time.
    Escaped {
        /// Model time of the sample at which it was seen.
        time: f64,
    },
}

/// A replica with its outcome.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// What was run.
    pub replica: Replica,
    /// How it ended.
    pub outcome: Outcome,
}

/// Everything that the replicas of a simulation share.
#[derive(Clone, Debug)]
pub struct Simulation<'a> {
    /// Dynamics F of the isolated node.
    pub model: Model,
    /// Coupling function H.
    pub coupling: Coupling,
    /// Coupling matrix W, shape (N, N).
    pub matrix: &'a SparseMatrix,
    /// Integrator.
    pub method: Method,
    /// Times.
    pub schedule: Schedule,
    /// What to average.
    pub observables: Observables,
    /// Relative size of the random kicks that keep states from being equal to the last bit; 0 for
    /// none. [`ROUNDING_KICK`] is what nothing but rounding would notice.
    pub kick: f64,
    /// Vector instructions to use, of those that this processor has; results do not depend on them.
    pub instruction_set: InstructionSet,
}

impl Simulation<'_> {
    /// Runs all replicas on the current rayon pool; results come in the order of `replicas`.
    ///
    /// # Errors
    /// [`DynamicsError::BadStep`], [`DynamicsError::BadTime`] and [`DynamicsError::TooFewSamples`] for
    /// a schedule that makes no sense; [`DynamicsError::Adaptive`] when the adaptive integrator gives
    /// up. An orbit that escapes is an [`Outcome`], not an error.
    pub fn run(
        &self,
        replicas: &[Replica],
        progress: Progress<'_>,
    ) -> Result<Vec<Run>, DynamicsError> {
        self.schedule.check()?;
        with_oscillator!(self.model, oscillator => {
            let outcomes = match self.method {
                Method::Rk4 => self.run_in_lanes(oscillator, replicas, progress),
                Method::Adaptive(adaptive) => replicas
                    .par_iter()
                    .map(|&replica| adaptive::run(oscillator, self, adaptive, replica, progress))
                    .collect::<Result<Vec<_>, _>>()?,
            };
            Ok(replicas
                .iter()
                .zip(outcomes)
                .map(|(&replica, outcome)| Run { replica, outcome })
                .collect())
        })
    }

    /// Batches of lanes, as many as keep all threads busy.
    fn run_in_lanes<O: Oscillator<D>, const D: usize>(
        &self,
        oscillator: O,
        replicas: &[Replica],
        progress: Progress<'_>,
    ) -> Vec<Outcome> {
        macro_rules! run {
            ($replicas:ident in $lanes:literal lanes, $rows:literal rows) => {
                self.instruction_set.run(Batch::<O, D, $lanes, $rows> {
                    simulation: self,
                    oscillator,
                    replicas: $replicas,
                    progress,
                })
            };
        }
        // Rows side by side: enough sums to hide how long one addition takes.
        let run = |replicas: &[Replica]| match replicas.len() {
            1 => run!(replicas in 1 lanes, 8 rows),
            2 => run!(replicas in 2 lanes, 4 rows),
            3..=4 => run!(replicas in 4 lanes, 4 rows),
            5..=8 => run!(replicas in 8 lanes, 2 rows),
            _ => run!(replicas in 16 lanes, 1 rows),
        };
        let mut left = replicas;
        let batches: Vec<&[Replica]> = batches::sizes(replicas.len(), rayon::current_num_threads())
            .into_iter()
            .map(|size| left.split_off(..size).expect("sizes add up to the replicas"))
            .collect();
        let outcomes: Vec<_> = batches.into_par_iter().with_max_len(1).map(run).collect();
        outcomes.into_iter().flatten().collect()
    }
}

impl Schedule {
    /// Steps of one replica from its initial state to its end.
    pub fn steps(&self) -> u64 {
        (self.transient_samples() + self.samples()) * u64::from(self.stride)
    }

    /// Samples in the averaging time.
    pub fn samples(&self) -> u64 {
        self.samples_per_block() * BLOCKS as u64
    }

    /// Time between two samples.
    pub fn sampling_interval(&self) -> f64 {
        self.step * f64::from(self.stride)
    }

    pub(crate) fn transient_samples(&self) -> u64 {
        whole(self.transient / self.sampling_interval())
    }

    pub(crate) fn samples_per_block(&self) -> u64 {
        whole((self.average / self.sampling_interval() / BLOCKS as f64).max(1.0))
    }

    pub(crate) fn time_of(&self, sample: u64) -> f64 {
        sample as f64 * self.sampling_interval()
    }

    fn check(&self) -> Result<(), DynamicsError> {
        let times = [("transient", self.transient), ("average", self.average)];
        check_times(self.step, &times, self.average / self.sampling_interval())
    }
}
