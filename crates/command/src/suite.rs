//! How far a suite of experiments has come, and about how long the rest will take.

use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// Where a suite of experiments stands, for the bars of its stages.
static SUITE: Mutex<String> = Mutex::new(String::new());

/// Several experiments one after another, of so much work each.
pub struct Suite {
    work: Vec<f64>,
    n_done: usize,
    started: Instant,
}

impl Suite {
    pub fn new(work: Vec<f64>) -> Self {
        Self { work, n_done: 0, started: Instant::now() }
    }

    /// Before each experiment.
    pub fn begin(&self) {
        let left =
            self.left().map_or_else(String::new, |left| format!(", about {left} left in all"));
        let text = match self.work.len() {
            0 | 1 => String::new(),
            all => format!("({} of {all}{left}) ", self.n_done + 1),
        };
        *SUITE.lock().unwrap_or_else(PoisonError::into_inner) = text;
    }

    /// After each experiment: how many are done and how long the others will take, in words that go on.
    pub fn done(&mut self) -> String {
        self.n_done += 1;
        match (self.work.len(), self.left()) {
            (0 | 1, _) => String::new(),
            (all, Some(left)) if self.n_done < all => {
                format!("; {} of {all} done, about {left} left", self.n_done)
            }
            (all, _) => format!("; {} of {all} done", self.n_done),
        }
    }

    /// At the pace so far; none before there is one.
    fn left(&self) -> Option<String> {
        let (done, rest) = self.work.split_at(self.n_done);
        let [done, rest]: [f64; 2] = [done, rest].map(|work| work.iter().sum());
        (done > 0.0).then(|| {
            let seconds = self.started.elapsed().as_secs_f64() * rest / done;
            format!("{} s", seconds.ceil())
        })
    }
}

/// Where the suite stands, in words that the bar of a stage begins with.
pub fn place() -> String {
    SUITE.lock().unwrap_or_else(PoisonError::into_inner).clone()
}
