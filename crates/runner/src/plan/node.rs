//! The node of a plan: what a journal knows it by, and the equations that follow.

use std::sync::Arc;

use dynamics::{Coupling, Model};
use serde::Serialize;

/// An oscillator with the function through which it is coupled.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Node {
    pub model: Model,
    pub coupling: Coupling,
}

impl Node {
    pub fn equations(&self) -> msf::Node {
        msf::Node { dynamics: Arc::new(self.model), coupling: self.coupling.clone() }
    }
}
