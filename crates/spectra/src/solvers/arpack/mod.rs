//! ARPACK, asked again and again on the complement of what it has found.

mod deflation;
mod library;
mod operator;
mod rayleigh_ritz;

pub(crate) use deflation::leading;
