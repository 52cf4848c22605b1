//! The coupling matrix as solvers use it: its products, and its null space, which the links tell.

pub(crate) mod null_space;
pub(crate) mod product;
pub(crate) mod symmetric;
