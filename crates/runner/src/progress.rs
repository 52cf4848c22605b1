//! Progress of the stages of a run on the terminal, with an estimate of the time left; silent when
//! standard error is not a terminal. How long each stage took is kept.

use std::cell::RefCell;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// Shows the stages of one experiment.
pub struct Stages {
    id: String,
    took: RefCell<Vec<(String, Duration)>>,
}

impl Stages {
    pub fn new(id: &str) -> Self {
        Self { id: id.to_owned(), took: RefCell::default() }
    }

    /// The stages so far, in order, with their times.
    pub fn took(&self) -> Vec<(String, Duration)> {
        self.took.borrow().clone()
    }

    /// Runs a stage whose length is not known beforehand.
    pub fn unmeasured<T>(&self, stage: &str, work: impl FnOnce() -> T) -> T {
        let bar = self.bar(stage, "{prefix} {spinner} {elapsed}", None);
        let result = self.timed(stage, work);
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
        let template = "{prefix} [{bar:30}] {percent:>3} %  {elapsed} so far, about {eta} left";
        let bar = self.bar(stage, template, Some(steps));
        let report = |done| {
            // A stage that turns out longer than planned stretches its bar.
            if bar.position() + done > bar.length().unwrap_or(u64::MAX) {
                bar.inc_length(done);
            }
            bar.inc(done);
        };
        let result = self.timed(stage, || work(&report));
        bar.finish_and_clear();
        result
    }

    fn timed<T>(&self, stage: &str, work: impl FnOnce() -> T) -> T {
        let started = Instant::now();
        let result = work();
        self.took.borrow_mut().push((stage.to_owned(), started.elapsed()));
        result
    }

    fn bar(&self, stage: &str, template: &str, steps: Option<u64>) -> ProgressBar {
        let bar = steps.map_or_else(ProgressBar::new_spinner, ProgressBar::new);
        let style = ProgressStyle::with_template(template).expect("the template is a constant");
        bar.set_style(style.progress_chars("=> "));
        bar.set_prefix(format!("{} {stage}", self.id));
        bar.enable_steady_tick(Duration::from_millis(200));
        bar
    }
}
