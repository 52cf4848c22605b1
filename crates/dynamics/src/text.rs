//! Equations that were read as text, as node dynamics.
//!
//! A program runs where compiled equations would: on runs of numbers, with the vector instructions that
//! are asked for, and with the bits that the same operations written in Rust have.

use equations::{Kind, Program, System};

use crate::programs::{evaluate, linearise};
use crate::{InstructionSet, Linearised, LinearisedMut, NodeDynamics};

/// The component that is time, behind the others.
const TIME: &str = "t";

/// A flow or a map that was read as text.
#[derive(Clone, Debug, PartialEq)]
pub struct Text {
    program: Program,
    components: Vec<String>,
    start: Vec<[f64; 2]>,
    is_map: bool,
    has_clock: bool,
}

impl Text {
    /// Of a system with the values that its parameters have now, and a box `[from, to]` of initial
    /// states for each of its components.
    ///
    /// # Panics
    /// When there are not as many intervals as components, or when the system is what a node sends and
    /// no dynamics.
    pub fn new(system: &System, mut start: Vec<[f64; 2]>) -> Self {
        let mut components: Vec<String> = system.components().map(ToOwned::to_owned).collect();
        assert_eq!(start.len(), components.len(), "an interval for each component");
        let is_map = match system.kind() {
            Kind::Flow => false,
            Kind::Map => true,
            Kind::Coupling => panic!("what a node sends is no dynamics"),
        };
        let has_clock = system.has_time();
        if has_clock {
            components.push(TIME.to_owned());
            start.push([0.0; 2]);
        }
        Self { program: Program::new(system), components, start, is_map, has_clock }
    }
}

impl NodeDynamics for Text {
    fn components(&self) -> Vec<&str> {
        self.components.iter().map(String::as_str).collect()
    }

    fn start(&self) -> &[[f64; 2]] {
        &self.start
    }

    fn is_map(&self) -> bool {
        self.is_map
    }

    fn has_clock(&self) -> bool {
        self.has_clock
    }

    fn program(&self) -> Option<Program> {
        Some(self.program.clone())
    }

    fn flow(&self, set: InstructionSet, x: &[&[f64]], slope: &mut [&mut [f64]]) {
        evaluate(&self.program, set, x, slope);
    }

    fn tangent_flow(&self, set: InstructionSet, at: Linearised<'_>, slope: LinearisedMut<'_, '_>) {
        linearise(&self.program, set, at, slope);
    }
}
