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
    /// Those that are known before; whoever listens is told of each of them, and of all that follow.
    pub fn after(before: &[Warning], tell: &'a dyn Fn(&Warning)) -> Self {
        before.iter().for_each(tell);
        Self { tell, list: before.to_vec() }
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
