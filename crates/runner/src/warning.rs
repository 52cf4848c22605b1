//! What a reader must know beside a number, said when it is found and kept with the results.

use eigensync::Warning;

use crate::output::{one_line, readable, tell};

/// Says a warning of an experiment on standard error.
pub fn say(id: &str, warning: &Warning) {
    tell!("warning: {id}: {}", readable(&one_line(&warning.message)));
}

/// A warning as it is kept, in one line of a length that is read.
pub fn kept(Warning { about, message }: &Warning) -> Warning {
    Warning { about, message: readable(&one_line(message)) }
}
