//! What a reader must know beside a number, as data.

use serde::Serialize;

/// A doubt about a number, or a thing about the input that changes what numbers mean.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Warning {
    /// What it concerns, by the names of results and settings, such as `msf.zeros`.
    pub about: &'static str,
    /// One sentence without a full stop.
    pub message: String,
}

/// Warnings in the order in which they come up, each told at once.
pub struct Warnings<'a> {
    tell: &'a dyn Fn(&Warning),
    list: Vec<Warning>,
}

impl<'a> Warnings<'a> {
    /// None yet; whoever listens is told of each.
    pub fn new(tell: &'a dyn Fn(&Warning)) -> Self {
        Self { tell, list: Vec::new() }
    }

    /// Tells a warning and keeps it.
    pub fn add(&mut self, about: &'static str, message: impl Into<String>) {
        let warning = Warning { about, message: message.into() };
        (self.tell)(&warning);
        self.list.push(warning);
    }

    /// All of them.
    pub fn into_list(self) -> Vec<Warning> {
        self.list
    }
}
