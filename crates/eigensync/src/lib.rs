//! Which oscillators of a network synchronise into clusters, at which coupling strength and in which
//! order, from the eigenvectors of the coupling matrix and the master stability function; and whether
//! simulations agree.
//!
//! # A tour
//!
//! A network comes from a file in any of the [`graph::formats`], or from links
//! ([`graph::Network::undirected`]). Here, six nodes with two pairs that are each other's mirror images:
//!
//! ```
//! use eigensync::graph::formats::edge_list;
//!
//! let links = "1 2 1\n1 4 1\n1 6 1\n2 3 1\n3 4 1\n4 5 1\n5 6 1\n2 6 1.5\n3 5 1.5";
//! let network = edge_list::read(links.as_bytes())?;
//! assert_eq!((network.n_nodes(), network.n_links()), (6, 9));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! An oscillator has its equations F and the function H through which it drives others. From there to
//! predicted clusters, and to a sweep of simulations with its agreement, it is one call:
//!
//! ```
//! # use eigensync::graph::formats::edge_list;
//! # let links = "1 2 1\n1 4 1\n1 6 1\n2 3 1\n3 4 1\n4 5 1\n5 6 1\n2 6 1.5\n3 5 1.5";
//! use std::sync::Arc;
//!
//! use eigensync::dynamics::{Coupling, Lorenz, Native};
//! use eigensync::graph::Normalization;
//! use eigensync::{Node, Study, Sweep, find};
//!
//! let network = edge_list::read(links.as_bytes())?;
//! let lorenz = Arc::new(Native::new(Lorenz::default()));
//! let node = Node { dynamics: lorenz, coupling: Coupling::pair(0, 1) };
//! let mut study = Study::new(network, Normalization::Laplacian, node);
//! study.sweep = Some(Sweep::over(vec![3.0, 4.5]));
//! // Short times: with the default ones, and a release build, it takes half a minute.
//! study.msf.times.average = 500.0;
//! study.msf.refinement.relative_error = 0.01;
//! study.sweep.as_mut().unwrap().schedule.average = 100.0;
//! let found = find(&study, &())?;
//!
//! // Where Λ(σ) = 0, and from there where each mode loses stability.
//! let sigma_c = found.msf.stable.sigma_c().expect("stable beyond one zero");
//! assert!((sigma_c.sigma - 8.17).abs() < 0.1 + 4.0 * sigma_c.standard_error);
//! assert_eq!(found.transitions.len(), 5);
//!
//! // The states over ε, from strong coupling down: all together, then two clusters of three.
//! assert_eq!(found.cascade[0].clusters.clusters(), [[0, 1, 2, 3, 4, 5]]);
//! assert_eq!(found.predicted_at(3.0).unwrap().clusters(), [[0, 1, 5], [2, 3, 4]]);
//!
//! // The simulations at the two couplings of the sweep show the same clusters.
//! let simulated = found.simulated.as_ref().expect("a sweep was asked for");
//! assert_eq!(simulated.clusters(0).unwrap().clusters(), [[0, 1, 5], [2, 3, 4]]);
//! assert_eq!(found.agreement[0].rand_index, Some(1.0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Results are plain data with public fields, and what must be known beside a number is among them:
//! [`Findings::warnings`]. Nothing here knows a path, a clock or a terminal.
//!
//! # Your own oscillator
//!
//! Anything that implements [`dynamics::Oscillator`], its equations stated once over
//! [`dynamics::Scalar`], is as good as a built-in one; a coupling may be a whole matrix:
//!
//! ```
//! use std::sync::Arc;
//!
//! use eigensync::Node;
//! use eigensync::dynamics::{Coupling, Native, Oscillator, Scalar};
//!
//! /// Van der Pol: ẋ = y, ẏ = μ (1 − x²) y − x.
//! #[derive(Clone, Copy, Debug)]
//! struct VanDerPol {
//!     mu: f64,
//! }
//!
//! impl Oscillator<2> for VanDerPol {
//!     const COMPONENTS: [&'static str; 2] = ["x", "y"];
//!     const START: [[f64; 2]; 2] = [[-2.0, 2.0], [-2.0, 2.0]];
//!
//!     fn flow<S: Scalar>(&self, [x, y]: [S; 2]) -> [S; 2] {
//!         [y, (S::from(1.0) - x * x) * y * self.mu - x]
//!     }
//! }
//!
//! let both = Coupling::matrix(&[vec![1.0, 0.0], vec![0.0, 1.0]]);
//! let node = Node { dynamics: Arc::new(Native::new(VanDerPol { mu: 1.0 })), coupling: both };
//! # let _ = node;
//! ```
//!
//! # Watching, and stopping
//!
//! An [`Observer`] is told of stages, steps and warnings, and may stop a study:
//!
//! ```
//! use eigensync::{Observer, Warning};
//!
//! struct Terminal;
//!
//! impl Observer for Terminal {
//!     fn begins(&self, stage: &str, n_steps: Option<u64>) {
//!         eprintln!("{stage}: {n_steps:?} steps");
//!     }
//!
//!     fn warned(&self, warning: &Warning) {
//!         eprintln!("{}: {}", warning.about, warning.message);
//!     }
//! }
//! # let _ = Terminal;
//! ```
//!
//! # Trajectories
//!
//! A sweep with a [`dynamics::Series`] tells the observer of the states of some nodes at every k-th
//! sample, as they come; [`simulate`] runs it without a prediction. Here the x of two nodes of a pair,
//! above the coupling from which on they are equal, from their initial states on:
//!
//! ```
//! # use eigensync::graph::formats::edge_list;
//! # let links = "1 2 1\n1 4 1\n1 6 1\n2 3 1\n3 4 1\n4 5 1\n5 6 1\n2 6 1.5\n3 5 1.5";
//! # let network = edge_list::read(links.as_bytes())?;
//! use std::sync::{Arc, Mutex};
//!
//! use eigensync::dynamics::{Coupling, Lorenz, Native, Record, Replica, Series};
//! use eigensync::graph::Normalization;
//! use eigensync::{Node, Observer, Study, Sweep, simulate};
//!
//! /// Times, and x of both nodes.
//! struct Plot(Mutex<Vec<(f64, [f64; 2])>>);
//!
//! impl Observer for Plot {
//!     fn recorded(&self, _: Replica, record: &Record<'_>) {
//!         let [x_2, x_6] = record.states else { panic!("one component of two nodes") };
//!         self.0.lock().unwrap().push((record.time, [*x_2, *x_6]));
//!     }
//! }
//!
//! let node =
//!     Node { dynamics: Arc::new(Native::new(Lorenz::default())), coupling: Coupling::pair(0, 1) };
//! let study = Study::new(network, Normalization::Laplacian, node);
//! let series = Series {
//!     components: Some(vec![0]),
//!     from: Some(0.0),
//!     every: 5,
//!     ..Series::of(vec![1, 5])
//! };
//! let sweep = Sweep { seeds: vec![1], series: Some(series), ..Sweep::over(vec![4.5]) };
//! # let mut sweep = sweep;
//! # (sweep.schedule.transient, sweep.schedule.average) = (50.0, 20.0);
//! let plot = Plot(Mutex::default());
//! simulate(&study, &sweep, &plot)?;
//!
//! let plotted = plot.0.into_inner()?;
//! let (first, last) = (plotted[0], plotted[plotted.len() - 1]);
//! assert_eq!((first.0, plotted[1].0), (0.0, 0.5));
//! assert!((first.1[0] - first.1[1]).abs() > 0.1);
//! assert!((last.1[0] - last.1[1]).abs() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Keeping finished work
//!
//! Whoever keeps finished work implements [`Compute`], through which every long piece goes, and calls
//! [`find_by`]. `examples/` has whole programs: the six nodes, an oscillator of one's own, a study that
//! is watched.

mod agreement;
mod bound;
mod compute;
mod doubts;
mod error;
mod find;
mod findings;
mod modes;
pub mod numbers;
mod observer;
mod prediction;
mod simulated;
mod stability;
mod step_effect;
mod study;
mod synchrony;
mod warning;

pub use clustering;
pub use dynamics;
pub use graph;
pub use msf::{self, Node};
pub use spectra;

pub use agreement::{Agreement, Predicted, Regions, StandardErrors};
pub use bound::Bound;
pub use compute::Compute;
pub use error::Error;
pub use find::{EQUITABLE, curve_by, find, find_by, simulate};
pub use findings::Findings;
pub use modes::{ALL_MODES, Wanted, WantedModes, misnamed_modes};
pub use observer::Observer;
pub use simulated::end::{End, Group, Known};
pub use simulated::range::Seen;
pub use simulated::{Apart, MeanPairs, OverSeeds, Simulated, completed, observed};
pub use stability::word;
pub use step_effect::{Probe, StepEffect, looked_at as step_effects_looked_at};
pub use study::{ALL_PAIRS, RegionBounds, Study, Sweep};
pub use synchrony::{EpsilonRange, Synchrony, looked};
pub use warning::{Warning, Warnings};
