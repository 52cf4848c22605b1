//! Networks and what couples their oscillators: sparse adjacency, readers of network formats, and
//! the coupling matrix W of `dx_i/dt = F(x_i) + ε Σ_j w_ij H(x_j)`.
//!
//! Knows nothing of oscillators, spectra or paths: readers take any [`std::io::Read`].

mod components;
mod coupling_matrix;
mod error;
pub mod formats;
pub mod generators;
mod names;
mod network;
mod nodes;
pub mod prepare;
mod raw_network;
mod sparse_matrix;
mod unit_interval;

pub use components::Components;
pub use coupling_matrix::{CouplingMatrix, Normalization, SymmetricForm, Symmetry};
pub use error::{CouplingError, GeneratorError, GraphError, NameError, PrepareError};
pub use names::Names;
pub use network::Network;
pub use nodes::{Group, numbered_labels};
pub use raw_network::RawNetwork;
pub use sparse_matrix::SparseMatrix;
pub use unit_interval::unit_interval;
