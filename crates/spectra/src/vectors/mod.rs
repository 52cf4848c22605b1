//! Vectors over nodes: one by one, in blocks, and in bases that grow; small dense matrices of their
//! scalar products.

pub(crate) mod basis;
pub(crate) mod block;
pub(crate) mod column;
pub(crate) mod projection;
pub(crate) mod random;
pub(crate) mod small_eigen;
