//! From eigenpairs of S to modes of W.

pub(crate) mod node_space;
mod slow_modes;
