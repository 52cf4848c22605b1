//! Who is told how the work goes on: a terminal, another program, or nobody.

use std::ops::ControlFlow;

/// Takes the steps that were done since it was last called, from any thread; breaks off to stop.
pub type Progress<'a> = &'a (dyn Fn(u64) -> ControlFlow<()> + Sync);

/// One stage of the work on an experiment.
#[derive(Clone, Copy, Debug)]
pub struct Stage<'a> {
    /// The experiment.
    pub id: &'a str,
    /// What is done, such as `msf`.
    pub name: &'a str,
    /// Its steps, where it is known how many there are.
    pub steps: Option<u64>,
    /// Of these, what an earlier run has done.
    pub done: u64,
    /// Whether it leaves, when told to stop, states from which a later run goes on.
    pub leaves_states: bool,
}

/// Is told of one stage, and dropped at its end.
pub trait Bar: Sync {
    /// Steps were done; from any thread.
    fn advanced(&self, steps: u64) {
        let _ = steps;
    }

    /// So many steps are still ahead, it turned out, for this reason.
    fn ahead(&self, steps: u64, why: &str) {
        let _ = (steps, why);
    }

    /// How far it has come, in words; from any thread.
    fn said(&self, words: &str) {
        let _ = words;
    }
}

/// Nobody is told.
impl Bar for () {}

/// Is told of stages, notes and warnings. Every method does nothing by default.
pub trait Watch: Send + Sync {
    /// A stage begins.
    fn begins(&self, stage: &Stage<'_>) -> Box<dyn Bar> {
        let _ = stage;
        Box::new(())
    }

    /// Something happened that is worth a line.
    fn noted(&self, note: &str) {
        let _ = note;
    }

    /// Something must be known beside the results, or beside the files in which they lie.
    fn warned(&self, warning: &str) {
        let _ = warning;
    }

    /// Whether to stop: asked at every step that is told.
    fn wants_to_stop(&self) -> bool {
        false
    }
}

/// Nobody watches.
impl Watch for () {}
