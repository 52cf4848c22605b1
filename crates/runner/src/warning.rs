//! What a reader must know beside a number, said when it is found and kept with the results.

use eigensync::Warning;

use user::Watch;
use user::text::{one_line, readable};

/// Says a warning of an experiment to whoever watches it.
pub fn say(id: &str, warning: &Warning, watch: &dyn Watch) {
    watch.warned(&format!("{id}: {}", readable(&one_line(&warning.message))));
}

/// A warning as it is kept, in one line of a length that is read.
pub fn kept(Warning { about, message }: &Warning) -> Warning {
    Warning { about, message: readable(&one_line(message)) }
}
