//! The terminal, told how the work goes on.

use std::sync::Arc;

use indicatif::ProgressBar;
use user::{Bar, Stage, Watch};

use crate::output::tell;
use crate::{bar, signals};

/// Shows stages, notes and warnings on standard error, and stops when a signal says so.
struct Terminal;

/// The terminal as whoever watches.
pub fn watch() -> Arc<dyn Watch> {
    Arc::new(Terminal)
}

impl Watch for Terminal {
    fn begins(&self, stage: &Stage<'_>) -> Box<dyn Bar> {
        if stage.leaves_states {
            signals::running();
        }
        Box::new(Shown { bar: bar::shown(stage), leaves_states: stage.leaves_states })
    }

    fn noted(&self, note: &str) {
        tell!("{note}");
    }

    fn warned(&self, warning: &str) {
        tell!("warning: {warning}");
    }

    fn wants_to_stop(&self) -> bool {
        signals::is_stopping()
    }
}

/// A stage that is shown.
struct Shown {
    bar: ProgressBar,
    leaves_states: bool,
}

impl Bar for Shown {
    /// A stage that turns out longer than planned stretches its bar.
    fn advanced(&self, steps: u64) {
        if self.bar.position() + steps > self.bar.length().unwrap_or(u64::MAX) {
            self.bar.inc_length(steps);
        }
        self.bar.inc(steps);
    }

    fn ahead(&self, steps: u64, why: &str) {
        self.bar.set_length(self.bar.position() + steps);
        self.bar.set_message(why.to_owned());
    }

    fn said(&self, words: &str) {
        self.bar.set_message(words.to_owned());
    }
}

impl Drop for Shown {
    /// Of a stage that was stopped nothing comes after: what it left is there, and the end is near.
    fn drop(&mut self) {
        self.bar.finish_and_clear();
        if signals::is_stopping() {
            signals::leave();
        }
        if self.leaves_states {
            signals::has_run();
        }
    }
}
