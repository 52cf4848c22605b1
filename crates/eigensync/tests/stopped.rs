//! A study that is to be stopped stops soon, in whatever stage it is.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use eigensync::dynamics::{Coupling, Native, Rossler};
use eigensync::graph::Normalization;
use eigensync::graph::formats::edge_list;
use eigensync::spectra::Solver;
use eigensync::{Error, Node, Observer, Study, Sweep, Wanted, WantedModes, find};

/// Wants to stop a moment after a stage has begun.
struct StopIn {
    stage: &'static str,
    since: Mutex<Option<Instant>>,
}

const MOMENT: Duration = Duration::from_millis(20);

impl Observer for StopIn {
    fn begins(&self, stage: &str, _: Option<u64>) {
        if stage == self.stage {
            self.since.lock().unwrap().get_or_insert(Instant::now());
        }
    }

    fn wants_to_stop(&self) -> bool {
        self.since.lock().unwrap().is_some_and(|since| since.elapsed() > MOMENT)
    }
}

/// A study of hours.
fn endless() -> Study {
    let network = edge_list::read("a b\nb c\nc d\nd a".as_bytes()).unwrap();
    let rossler = Arc::new(Native::new(Rossler::default()));
    let node = Node { dynamics: rossler, coupling: Coupling::pair(0, 0) };
    let mut study = Study::new(network, Normalization::Laplacian, node);
    study.msf.sigma = vec![0.0, 1.0, 2.0];
    study.msf.times.average = 200.0;
    study.msf.refinement.max_rounds = 4;
    let mut sweep = Sweep::over(vec![0.1, 0.5, 1.0]);
    sweep.schedule.average = 1e8;
    study.sweep = Some(sweep);
    study
}

/// A network of 4000 nodes without small separators, of which an iterative solver takes seconds to find
/// 200 modes.
fn entangled(solver: Solver) -> Study {
    let n_nodes = 4000;
    let other = |node: usize, k: usize| (node * (2 * k + 3) + 97 * k + 1) % n_nodes;
    let all = (0..n_nodes).flat_map(|node| (0..6).map(move |k| (node, other(node, k))));
    let ordered = all.filter(|(i, j)| i != j).map(|(i, j)| (i.min(j), i.max(j)));
    let links: BTreeSet<_> = ordered.collect();
    let text: String = links.into_iter().map(|(i, j)| format!("{i} {j}\n")).collect();
    let network = edge_list::read(text.as_bytes()).unwrap();
    let study = endless();
    let size = (n_nodes, 1);
    let modes = WantedModes::new(size, Some(Wanted::Leading(200)), Some(solver), None);
    let entangled = Study::new(network, Normalization::Laplacian, study.node);
    Study { modes, msf: study.msf, ..entangled }
}

#[test]
fn a_study_stops_within_a_second_in_every_long_stage() {
    let mut endless_curve = endless();
    endless_curve.msf.times.average = 1e8;
    let mut endless_look = endless();
    endless_look.msf.sigma.clear();
    endless_look.msf.times.average = 1e8;
    let mut stages = vec![
        ("msf", endless_look),
        ("msf", endless_curve),
        ("sweep", endless()),
        ("spectrum", entangled(Solver::Chebyshev)),
    ];
    if Solver::Arpack.is_built() {
        stages.push(("spectrum", entangled(Solver::Arpack)));
    }
    for (stage, study) in stages {
        let observer = StopIn { stage, since: Mutex::new(None) };
        let found = find(&study, &observer);
        let since = observer.since.lock().unwrap().expect("the stage has begun");
        assert!(
            since.elapsed() < MOMENT + Duration::from_secs(1),
            "{stage}: {:?}",
            since.elapsed()
        );
        assert!(matches!(found, Err(Error::Cancelled)), "{stage}: {:?}", found.err());
    }
}

/// Wants to stop as soon as a stage begins.
struct StopAt {
    stage: &'static str,
    has_come: AtomicBool,
}

impl Observer for StopAt {
    fn begins(&self, stage: &str, _: Option<u64>) {
        self.has_come.fetch_or(stage == self.stage, Ordering::Relaxed);
    }

    fn wants_to_stop(&self) -> bool {
        self.has_come.load(Ordering::Relaxed)
    }
}

#[test]
fn a_prediction_stops_from_one_state_to_the_next() {
    for stage in ["clusters", "labels"] {
        let study = Study { sweep: None, ..endless() };
        let stopped = find(&study, &StopAt { stage, has_come: AtomicBool::new(false) });
        assert!(matches!(stopped, Err(Error::Cancelled)), "{stage}");
    }
}
