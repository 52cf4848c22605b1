//! Lanczos' method on the inverse, from a sparse factorisation.

mod ritz;
mod search;

pub(crate) use search::Search;
