//! Progress of the stages of a run on the terminal, with an estimate of the time left; silent when
//! standard error is not a terminal. How long each stage took is kept.

use std::cell::RefCell;
use std::io::{Read, Seek, SeekFrom};
use std::ops::ControlFlow;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use crate::output::printable;

/// The bar on the terminal, for whoever has to clear it from another thread.
static SHOWN: Mutex<Option<ProgressBar>> = Mutex::new(None);

/// Clears the line of the bar, if there is one.
pub fn clear() {
    if let Some(bar) = SHOWN.lock().unwrap_or_else(PoisonError::into_inner).take() {
        bar.finish_and_clear();
    }
}

/// Shows the stages of one experiment.
#[derive(Default)]
pub struct Stages {
    id: String,
    took: RefCell<Vec<(String, Duration)>>,
}

impl Stages {
    pub fn new(id: &str) -> Self {
        Self { id: id.to_owned(), took: RefCell::default() }
    }

    /// The stages so far, in order, with their times; what was done in parts is one stage.
    pub fn took(&self) -> Vec<(String, Duration)> {
        self.took.borrow().clone()
    }

    /// Time of all stages so far.
    pub fn total(&self) -> Duration {
        self.took.borrow().iter().map(|(_, took)| *took).sum()
    }

    /// Runs a stage whose length is not known beforehand.
    pub fn unmeasured<T>(&self, stage: &str, work: impl FnOnce() -> T) -> T {
        let bar = self.bar(stage, "{prefix} {spinner} {elapsed}", None);
        let result = self.timed(stage, work);
        bar.finish_and_clear();
        result
    }

    /// Runs a stage whose length is not known beforehand; it tells in words how far it has come.
    pub fn told<T>(&self, stage: &str, work: impl FnOnce(&(dyn Fn(&str) + Sync)) -> T) -> T {
        let bar = self.bar(stage, "{prefix} {spinner} {elapsed}  {msg}", None);
        let result = self.timed(stage, || work(&|words| bar.set_message(words.to_owned())));
        bar.finish_and_clear();
        result
    }

    /// Runs a stage of about so many steps; it reports the steps it has done.
    pub fn measured<T>(
        &self,
        stage: &str,
        steps: u64,
        work: impl FnOnce(dynamics::Progress<'_>) -> T,
    ) -> T {
        self.resumed(stage, steps, 0, work)
    }

    /// The same where some of the steps were done by an earlier run.
    pub fn resumed<T>(
        &self,
        stage: &str,
        steps: u64,
        done: u64,
        work: impl FnOnce(dynamics::Progress<'_>) -> T,
    ) -> T {
        let template = "{prefix} [{bar:30}] {percent:>3} %  {elapsed} so far, about {eta} left";
        let bar = self.bar(stage, template, Some(steps));
        bar.set_position(done);
        bar.reset_eta();
        let report = |done| {
            // A stage that turns out longer than planned stretches its bar.
            if bar.position() + done > bar.length().unwrap_or(u64::MAX) {
                bar.inc_length(done);
            }
            bar.inc(done);
            ControlFlow::Continue(())
        };
        let result = self.timed(stage, || work(&report));
        bar.finish_and_clear();
        result
    }

    fn timed<T>(&self, stage: &str, work: impl FnOnce() -> T) -> T {
        let started = Instant::now();
        let result = work();
        let elapsed = started.elapsed();
        let mut took = self.took.borrow_mut();
        match took.iter_mut().find(|(name, _)| name == stage) {
            Some((_, so_far)) => *so_far += elapsed,
            None => took.push((stage.to_owned(), elapsed)),
        }
        result
    }

    fn bar(&self, stage: &str, template: &str, steps: Option<u64>) -> ProgressBar {
        let bar = steps.map_or_else(ProgressBar::new_spinner, ProgressBar::new);
        let style = ProgressStyle::with_template(template).expect("the template is a constant");
        bar.set_style(style.progress_chars("=> "));
        bar.set_prefix(format!("{} {stage}", printable(&self.id)));
        bar.enable_steady_tick(Duration::from_millis(200));
        *SHOWN.lock().unwrap_or_else(PoisonError::into_inner) = Some(bar.clone());
        bar
    }
}

/// A source that reports the bytes taken from it.
pub struct Watched<'a, R> {
    pub source: R,
    pub progress: dynamics::Progress<'a>,
}

impl<R: Read> Read for Watched<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let n_bytes = self.source.read(buffer)?;
        let _ = (self.progress)(n_bytes as u64);
        Ok(n_bytes)
    }
}

impl<R: Seek> Seek for Watched<'_, R> {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.source.seek(to)
    }
}
