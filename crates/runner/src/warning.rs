//! What a reader must know beside a number: said when it is found, kept with the results.

use serde::Serialize;

use crate::output::{one_line, readable, tell};

/// A doubt about a number, or a thing about the input that changes what numbers mean.
#[derive(Clone, Debug, Serialize)]
pub struct Warning {
    /// Key of the summary that it concerns, such as `msf.zeros`.
    pub about: &'static str,
    /// One sentence without a full stop.
    pub message: String,
}

/// The warnings of one run, in the order in which they came up.
pub struct Warnings {
    id: String,
    list: Vec<Warning>,
}

impl Warnings {
    /// None yet, of the experiment of this name.
    pub fn new(id: &str) -> Self {
        Self { id: id.to_owned(), list: Vec::new() }
    }

    /// Says a warning on standard error and keeps it.
    pub fn add(&mut self, about: &'static str, message: impl Into<String>) {
        let message = readable(&one_line(&message.into()));
        tell!("warning: {}: {message}", self.id);
        self.list.push(Warning { about, message });
    }

    /// All of them.
    pub fn into_list(self) -> Vec<Warning> {
        self.list
    }
}
