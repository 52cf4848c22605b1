//! Oscillators, integrators, network simulation and Lyapunov exponents for
//! `dx_i/dt = F(x_i) + ε Σ_j w_ij H(x_j)`, and for maps, `x_i(n + 1) = F(x_i(n)) + ε Σ_j w_ij H(x_j(n))`.
//!
//! Each oscillator's equations are written once: in Rust, over [`Scalar`], to serve single values,
//! [`Lanes`] of values side by side and [`Dual`] numbers, whose tangent part is an exact
//! Jacobian–vector product; or as [`Text`], with the same bits. Nothing here knows where a network comes from or what its eigenvalues are.
//!
//! Arithmetic is the same to the last bit on any x86-64: no fused multiply-add, a fixed order of
//! summation, and logarithms from a library that is itself portable.

mod aligned;
mod batches;
mod block_means;
mod closed_orbits;
mod coupling;
mod differences;
mod error;
mod instruction_set;
mod integrators;
mod isolated_orbit;
mod isolated_states;
mod jacobians;
mod kernel;
mod kicks;
mod linear_step;
mod linearised;
mod links;
pub mod lyapunov;
mod native;
mod node;
mod observables;
mod observer;
mod oscillator;
mod oscillators;
mod programs;
mod progress;
mod random;
mod recorder;
mod row_sums;
mod run;
mod scalar;
mod schedule;
mod series;
mod settled;
mod shared_sums;
mod simulation;
mod slow_time;
mod small_eigenvalues;
mod stage;
mod statistics;
mod step_choice;
mod team;
mod text;
mod tile;
mod trace;
mod within;

pub use closed_orbits::{ClosedOrbit, Closes, Settled, closed_orbits};
pub use coupling::{Coupling, Gain};
pub use error::{DynamicsError, ESCAPE_RADIUS};
pub use instruction_set::{InstructionSet, Work};
pub use integrators::{Adaptive, AdaptiveOrder, Method};
pub use isolated_states::isolated_states;
pub use linear_step::{LinearSteps, StepVerdict};
pub use linearised::{Linearised, LinearisedMut};
pub use links::SparseMatrix;
pub use native::Native;
pub use node::{Fused, NodeDynamics};
pub use observables::{Errors, Observables, pair_index};
pub use observer::{Next, Observer, Snapshot, Start};
pub use oscillator::Oscillator;
pub use oscillators::*;
pub use progress::{Progress, QUIET};
pub use random::initial_states;
pub use scalar::{Dual, Lanes, Scalar};
pub use schedule::Schedule;
pub use series::{Record, Series};
pub use settled::settled;
pub use simulation::{Outcome, ROUNDING_KICK, Replica, Run, Simulation};
pub use slow_time::slow_time;
pub use stage::Stage;
pub use statistics::{BLOCKS, Estimate};
pub use step_choice::{StepChoice, choose_step};
pub use text::Text;
pub use tile::MAX_COMPONENTS;
pub use trace::trace;
pub use within::Within;
