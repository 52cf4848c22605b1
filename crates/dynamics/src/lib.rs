//! Oscillators, integrators, network simulation and Lyapunov exponents for
//! `dx_i/dt = F(x_i) + ε Σ_j w_ij H(x_j)`.
//!
//! Each oscillator's equations are written once, over [`Scalar`], and serve single values, [`Lanes`]
//! of values side by side and [`Dual`] numbers, whose tangent part is an exact Jacobian–vector
//! product. Nothing here knows where a network comes from or what its eigenvalues are.
//!
//! Arithmetic is the same to the last bit on any x86-64: no fused multiply-add, a fixed order of
//! summation, and logarithms from a library that is itself portable.

mod aligned;
mod batches;
mod block_means;
mod coupling;
mod differences;
mod error;
mod instruction_set;
mod integrators;
mod isolated_orbit;
mod kernel;
mod kicks;
mod linear_step;
mod links;
pub mod lyapunov;
mod native;
mod node;
mod observables;
mod observer;
mod oscillator;
mod oscillators;
mod random;
mod row_sums;
mod scalar;
mod settled;
mod shared_sums;
mod simulation;
mod slow_time;
mod stage;
mod statistics;

pub use coupling::{Coupling, Gain};
pub use error::DynamicsError;
pub use instruction_set::{InstructionSet, Work};
pub use integrators::{Adaptive, AdaptiveOrder, Method};
pub use linear_step::{LinearSteps, StepVerdict};
pub use native::Native;
pub use node::{Linearised, LinearisedMut, MAX_COMPONENTS, NodeDynamics};
pub use observables::{Errors, Observables, pair_index};
pub use observer::{Next, Observer, Snapshot, Start};
pub use oscillator::Oscillator;
pub use oscillators::{HindmarshRose, Lorenz, Model, Rossler};
pub use scalar::{Dual, Lanes, Scalar};
pub use settled::settled;
pub use simulation::{Outcome, ROUNDING_KICK, Replica, Run, Schedule, Simulation};
pub use slow_time::slow_time;
pub use stage::Stage;
pub use statistics::{BLOCKS, Estimate};

use std::ops::ControlFlow;

/// Sparse matrix in compressed-row form with 32-bit column indices.
pub type SparseMatrix = sprs::CsMatI<f64, u32, usize>;

/// Called with the number of steps done since the last call, from any thread; says whether to go on.
pub type Progress<'a> = &'a (dyn Fn(u64) -> ControlFlow<()> + Sync);

/// Nobody is told, and nothing is stopped.
pub const QUIET: Progress<'static> = &|_| ControlFlow::Continue(());

/// An orbit has escaped when a component exceeds this size. Attractors of the oscillators here stay
/// below 10³, in the units of their equations.
pub const ESCAPE_RADIUS: f64 = 1e6;
