//! ARPACK, asked again and again on the complement of what it has found; a feature of the crate.

#[cfg(feature = "arpack")]
mod deflation;
#[cfg(feature = "arpack")]
mod library;
#[cfg(feature = "arpack")]
mod operator;
#[cfg(feature = "arpack")]
mod rayleigh_ritz;

use crate::solvers::method::{Method, Solve};

/// ARPACK's method.
pub(crate) const METHOD: Method =
    Method { name: "arpack", finds_all: false, rounding: 0.0, factorises: false, solve: SOLVE };

#[cfg(feature = "arpack")]
const SOLVE: Option<Solve> = Some(Solve::Iterative(deflation::leading));
#[cfg(not(feature = "arpack"))]
const SOLVE: Option<Solve> = None;
