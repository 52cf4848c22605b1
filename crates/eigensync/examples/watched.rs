//! A study that is watched, and stopped in its sweep after a second.
//!
//! `cargo run --release -p eigensync --example watched`

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use eigensync::dynamics::{Coupling, Native, Rossler};
use eigensync::graph::Normalization;
use eigensync::graph::formats::edge_list;
use eigensync::{Error, Node, Observer, Study, Sweep, Warning, find};

/// Counts steps, and stops a second after the sweep has begun.
struct Watch {
    steps: AtomicU64,
    sweep: std::sync::OnceLock<Instant>,
}

impl Observer for Watch {
    fn begins(&self, stage: &str, n_steps: Option<u64>) {
        println!("{stage} begins, {n_steps:?} steps");
        if stage == "sweep" {
            self.sweep.get_or_init(Instant::now);
        }
    }

    fn advanced(&self, n_steps: u64) {
        self.steps.fetch_add(n_steps, Ordering::Relaxed);
    }

    fn warned(&self, warning: &Warning) {
        println!("{}: {}", warning.about, warning.message);
    }

    fn wants_to_stop(&self) -> bool {
        self.sweep.get().is_some_and(|since| since.elapsed() > Duration::from_secs(1))
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let network = edge_list::read("a b\nb c\nc d\nd a".as_bytes())?;
    let rossler = Arc::new(Native::new(Rossler::default()));
    let node = Node { dynamics: rossler, coupling: Coupling::pair(0, 0) };
    let mut study = Study::new(network, Normalization::Laplacian, node);
    study.msf.times.average = 1e3;
    let mut sweep = Sweep::over(vec![0.1, 0.5, 1.0]);
    sweep.schedule.average = 1e7;
    study.sweep = Some(sweep);

    let watch = Watch { steps: AtomicU64::new(0), sweep: std::sync::OnceLock::new() };
    match find(&study, &watch) {
        Err(Error::Cancelled) => println!("stopped after {} steps", watch.steps.into_inner()),
        Err(error) => return Err(error.into()),
        Ok(_) => println!("finished"),
    }
    Ok(())
}
