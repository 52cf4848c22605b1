//! Simulation of a network, `dx_i/dt = F(x_i) + ε Σ_j w_ij H(x_j)`: Fan, Wang & Wang (2023), Eq. (1).
//!
//! The state is laid out `[component][node][lane]`. Lanes are replicas (couplings, seeds) advanced
//! side by side, so that each w_ij multiplies a contiguous run of numbers. Every lane goes through
//! the same operations in the same order whatever its neighbours are: results do not depend on the
//! number of lanes, of threads, or on the machine.

use rayon::prelude::*;

use crate::error::{check_times, whole};
use crate::integrators::{Method, adaptive, rk4::NetworkRk4};
use crate::kicks::Kicks;
use crate::observables::{ErrorSums, Errors, Observables};
use crate::oscillators::with_oscillator;
use crate::random::initial_states;
use crate::statistics::BLOCKS;
use crate::{
    Coupling, DynamicsError, ESCAPE_RADIUS, Lanes, Model, Oscillator, Progress, Scalar,
    SparseMatrix,
};

/// The most lanes advanced together: 16 doubles fill two AVX-512 or eight SSE2 registers.
const MAX_LANES: usize = 16;

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
    /// A component left the ball of radius [`ESCAPE_RADIUS`], seen at this model time.
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
            let flow = NetworkFlow { oscillator, coupling: self.coupling, matrix: self.matrix };
            let outcomes = match self.method {
                Method::Rk4 => self.run_in_lanes(&flow, replicas, progress),
                Method::Adaptive(adaptive) => replicas
                    .par_iter()
                    .map(|&replica| adaptive::run(&flow, self, adaptive, replica, progress))
                    .collect::<Result<Vec<_>, _>>()?,
            };
            Ok(replicas
                .iter()
                .zip(outcomes)
                .map(|(&replica, outcome)| Run { replica, outcome })
                .collect())
        })
    }

    /// Batches of at most [`MAX_LANES`] replicas, small enough that every thread has one.
    fn run_in_lanes<O: Oscillator<D>, const D: usize>(
        &self,
        flow: &NetworkFlow<'_, O, D>,
        replicas: &[Replica],
        progress: Progress<'_>,
    ) -> Vec<Outcome> {
        let batch = replicas.len().div_ceil(rayon::current_num_threads()).clamp(1, MAX_LANES);
        let batches: Vec<Vec<Outcome>> = replicas
            .par_chunks(batch)
            .map(|batch| match batch.len() {
                1 => self.run_batch::<O, D, 1>(flow, batch, progress),
                2..=4 => self.run_batch::<O, D, 4>(flow, batch, progress),
                5..=8 => self.run_batch::<O, D, 8>(flow, batch, progress),
                _ => self.run_batch::<O, D, MAX_LANES>(flow, batch, progress),
            })
            .collect();
        batches.into_iter().flatten().collect()
    }

    fn run_batch<O: Oscillator<D>, const D: usize, const L: usize>(
        &self,
        flow: &NetworkFlow<'_, O, D>,
        batch: &[Replica],
        progress: Progress<'_>,
    ) -> Vec<Outcome> {
        // Lanes beyond the batch repeat its last replica and are never read.
        let replica = |lane: usize| batch[lane.min(batch.len() - 1)];
        let epsilon = Lanes(std::array::from_fn(|lane| replica(lane).epsilon));
        let seeds: [u64; L] = std::array::from_fn(|lane| replica(lane).seed);
        let mut network = NetworkRk4::new(initial_lanes::<O, D, L>(flow.n_nodes(), seeds));
        let schedule = &self.schedule;
        let mut sums =
            ErrorSums::new(&self.observables, flow.n_nodes(), schedule.samples_per_block());
        let replicas = std::array::from_fn(replica);
        let mut kicks = Kicks::new(self.kick, schedule.sampling_interval(), replicas);
        let mut escaped_at = [None; L];
        for sample in 1..=schedule.transient_samples() + schedule.samples() {
            for _ in 0..schedule.stride {
                network.step(flow, epsilon, schedule.step);
            }
            for (escaped_at, bounded) in escaped_at.iter_mut().zip(bounded(network.state())) {
                if escaped_at.is_none() && !bounded {
                    *escaped_at = Some(schedule.time_of(sample));
                }
            }
            if escaped_at.iter().all(Option::is_some) {
                break;
            }
            if sample > schedule.transient_samples() {
                sums.sample(network.state());
            }
            if kicks.due(sample) {
                network.state_mut().iter_mut().flatten().for_each(|x| kicks.apply(x));
            }
            progress(u64::from(schedule.stride) * batch.len() as u64);
        }
        (0..batch.len())
            .map(|lane| match escaped_at[lane] {
                Some(time) => Outcome::Escaped { time },
                None => Outcome::Completed(sums.errors(lane)),
            })
            .collect()
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

/// The right-hand side, node by node.
pub(crate) struct NetworkFlow<'a, O, const D: usize> {
    oscillator: O,
    coupling: Coupling,
    matrix: &'a SparseMatrix,
}

impl<O: Oscillator<D>, const D: usize> NetworkFlow<'_, O, D> {
    pub(crate) fn n_nodes(&self) -> usize {
        self.matrix.rows()
    }

    /// F(x_i) + ε Σ_j w_ij H(x_j) at one node, summed over j in ascending order.
    #[inline(always)]
    pub(crate) fn at<S: Scalar>(&self, node: usize, state: [&[S]; D], epsilon: S) -> [S; D] {
        let mut slope = self.oscillator.flow(std::array::from_fn(|c| state[c][node]));
        let source = state[self.coupling.from];
        let starts = self.matrix.indptr();
        let row = starts.outer_inds_sz(node);
        let mut input = S::from(0.0);
        for (&j, &w) in self.matrix.indices()[row.clone()].iter().zip(&self.matrix.data()[row]) {
            input = input + source[j as usize] * w;
        }
        for (c, slope) in slope.iter_mut().enumerate() {
            if c == self.coupling.to {
                *slope = *slope + input * epsilon;
            }
        }
        slope
    }
}

/// Initial states laid out `[component][node][lane]`.
pub(crate) fn initial_lanes<O: Oscillator<D>, const D: usize, const L: usize>(
    n_nodes: usize,
    seeds: [u64; L],
) -> [Vec<Lanes<L>>; D] {
    let drawn = seeds.map(|seed| initial_states::<O, D>(n_nodes, seed));
    std::array::from_fn(|c| {
        (0..n_nodes).map(|node| Lanes(std::array::from_fn(|lane| drawn[lane][node][c]))).collect()
    })
}

/// Lane by lane, whether every component of every node is within [`ESCAPE_RADIUS`]; a NaN is not.
#[inline(always)]
pub(crate) fn bounded<const L: usize, const D: usize>(state: [&[Lanes<L>]; D]) -> [bool; L] {
    let mut bounded = [true; L];
    for x in state.into_iter().flatten() {
        for (bounded, x) in bounded.iter_mut().zip(x.0) {
            *bounded &= x.abs() < ESCAPE_RADIUS;
        }
    }
    bounded
}
