//! Sparse factorisations S − c·1 = L D Lᵀ: their pattern and order, their factors, and solutions by them.

mod dissection;
pub(crate) mod factors;
pub(crate) mod inverse;
mod separator;
pub(crate) mod symbolic;
