//! Leading eigenvalues, eigenvectors and eigenspaces of a coupling matrix, with none lost.

mod spectrum;

pub use spectrum::{Solver, Spectrum};
