//! Networks and what couples their oscillators: sparse adjacency, readers of network formats, and
//! the coupling matrix W of `dx_i/dt = F(x_i) + ε Σ_j w_ij H(x_j)`.
//!
//! Knows nothing of oscillators, spectra or paths: readers take any [`std::io::Read`].

mod coupling_matrix;
mod error;
pub mod formats;
pub mod generators;
mod network;
mod nodes;
pub mod prepare;
mod raw_network;

pub use coupling_matrix::{CouplingMatrix, Normalization, SymmetricForm, Symmetry};
pub use error::{CouplingError, GeneratorError, GraphError, PrepareError};
pub use network::Network;
pub use nodes::{Group, numbered_labels};
pub use raw_network::RawNetwork;

/// Sparse matrix in compressed-row form with 32-bit column indices.
///
/// Half the index traffic of the default `usize`: products on it are 2 to 3 times faster in cache.
pub type SparseMatrix = sprs::CsMatI<f64, u32, usize>;
