//! What a file asks for: an experiment or an atlas, which are run, checked and listed alike.

use std::path::Path;

use dynamics::InstructionSet;

use super::{AtlasPlan, Plan};

/// What a file asks for.
pub enum Planned {
    /// An experiment.
    Experiment(Box<Plan>),
    /// An atlas of master stability functions.
    Atlas(Box<AtlasPlan>),
}

impl Planned {
    /// What it is called.
    pub fn id(&self) -> &str {
        match self {
            Self::Experiment(plan) => &plan.id,
            Self::Atlas(plan) => &plan.id,
        }
    }

    /// Its file.
    pub fn file(&self) -> &Path {
        match self {
            Self::Experiment(plan) => &plan.file,
            Self::Atlas(plan) => &plan.file,
        }
    }

    /// Takes these vector instructions.
    pub fn use_instructions(&mut self, set: InstructionSet) {
        match self {
            Self::Experiment(plan) => plan.study.msf.instruction_set = set,
            Self::Atlas(plan) => plan.use_instructions(set),
        }
    }
}
