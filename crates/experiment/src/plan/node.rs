//! The node of a plan: what a journal knows it by, and the equations that follow.

use std::sync::Arc;

use dynamics::{Coupling, Model};
use serde::Serialize;

/// An oscillator with the function through which it is coupled.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Node {
    /// The oscillator with its parameters.
    pub model: Model,
    /// H(x) = B h(x).
    pub coupling: Coupling,
}

impl Node {
    /// The same as the library takes it.
    pub fn equations(&self) -> msf::Node {
        msf::Node { dynamics: Arc::new(self.model), coupling: self.coupling.clone() }
    }
}
