//! The stages of the work on one experiment: whoever watches is told of them, and how long each took is
//! kept.

use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use crate::{Bar, Progress, Stage, Watch};

/// Runs stages of one experiment, one after another.
pub struct Stages {
    id: String,
    watch: Arc<dyn Watch>,
    took: Mutex<Vec<(String, Duration)>>,
}

impl Stages {
    /// Of an experiment that is called so.
    pub fn new(id: &str, watch: Arc<dyn Watch>) -> Self {
        Self { id: id.to_owned(), watch, took: Mutex::default() }
    }

    /// Who watches.
    pub fn watch(&self) -> &Arc<dyn Watch> {
        &self.watch
    }

    /// The stages so far, in order, with their times; what was done in parts is one stage.
    pub fn took(&self) -> Vec<(String, Duration)> {
        self.took.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Time of all stages so far.
    pub fn total(&self) -> Duration {
        self.took().iter().map(|(_, took)| *took).sum()
    }

    /// Runs a stage whose length is not known beforehand.
    pub fn unmeasured<T>(&self, name: &str, work: impl FnOnce() -> T) -> T {
        self.told(name, |_| work())
    }

    /// Runs a stage whose length is not known beforehand; it tells in words how far it has come, and
    /// learns whether to go on.
    pub fn told<T>(
        &self,
        name: &str,
        work: impl FnOnce(&(dyn Fn(&str) -> ControlFlow<()> + Sync)) -> T,
    ) -> T {
        self.stage((name, None), |bar| {
            work(&|words| {
                bar.said(words);
                self.goes_on()
            })
        })
    }

    /// Runs a stage of about so many steps; it reports the steps it has done.
    pub fn measured<T>(&self, name: &str, steps: u64, work: impl FnOnce(Progress<'_>) -> T) -> T {
        self.extended(name, steps, |progress, _| work(progress))
    }

    /// The same where it turns out on the way how many steps are ahead: it says so, and in words why.
    pub fn extended<T>(
        &self,
        name: &str,
        steps: u64,
        work: impl FnOnce(Progress<'_>, &dyn Fn(u64, &str)) -> T,
    ) -> T {
        self.stage((name, Some(steps)), |bar| {
            work(&|done| self.advanced(bar, done), &|steps, why| bar.ahead(steps, why))
        })
    }

    /// Runs a stage of which an earlier run has done some steps, and which leaves its states when told
    /// to stop.
    pub fn resumed<T>(
        &self,
        name: &str,
        (steps, done): (u64, u64),
        work: impl FnOnce(Progress<'_>) -> T,
    ) -> T {
        let stage = Stage { id: &self.id, name, steps: Some(steps), done, leaves_states: true };
        self.timed(&stage, |bar| work(&|done| self.advanced(bar, done)))
    }

    fn stage<T>(&self, (name, steps): (&str, Option<u64>), work: impl FnOnce(&dyn Bar) -> T) -> T {
        let stage = Stage { id: &self.id, name, steps, done: 0, leaves_states: false };
        self.timed(&stage, work)
    }

    fn timed<T>(&self, stage: &Stage<'_>, work: impl FnOnce(&dyn Bar) -> T) -> T {
        let bar = self.watch.begins(stage);
        let started = Instant::now();
        let result = work(&*bar);
        let elapsed = started.elapsed();
        drop(bar);
        let mut took = self.took.lock().unwrap_or_else(PoisonError::into_inner);
        match took.iter_mut().find(|(name, _)| name == stage.name) {
            Some((_, so_far)) => *so_far += elapsed,
            None => took.push((stage.name.to_owned(), elapsed)),
        }
        result
    }

    fn advanced(&self, bar: &dyn Bar, steps: u64) -> ControlFlow<()> {
        bar.advanced(steps);
        self.goes_on()
    }

    fn goes_on(&self) -> ControlFlow<()> {
        match self.watch.wants_to_stop() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
}
