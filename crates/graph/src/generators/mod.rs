//! Random networks from a seed, one file a family.
//!
//! A seed means the same network for ever: on every platform, and in every later version. So the
//! conversion from random bits, the logarithm, and the order of the draws are our own or fixed, and
//! tests pin networks of each family.

mod blocks;
mod communities;
mod hierarchical;
mod trials;

pub use communities::{LinkProbability, communities, expected_links};
pub use hierarchical::{expected_hierarchical_links, hierarchical};
