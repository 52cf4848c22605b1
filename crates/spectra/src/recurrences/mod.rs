//! Polynomials of S by three-term recurrences: Lanczos', which finds its own, and Chebyshev's.

pub(crate) mod chebyshev;
pub(crate) mod lanczos;
pub(crate) mod spectral_density;
