//! The block method with Chebyshev filters and long Lanczos sequences.

mod amplifier;
mod long_sequence;
mod search;
mod search_space;
mod stagnation;

pub(crate) use amplifier::Amplifier;
pub(crate) use search::Search;
