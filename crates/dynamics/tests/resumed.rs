//! Simulations that are followed, stopped and resumed.

mod common;

use std::sync::Arc;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use dynamics::{
    Adaptive, AdaptiveOrder, Coupling, DynamicsError, InstructionSet, Lorenz, Method, Model, Next,
    Observables, Observer, Outcome, ROUNDING_KICK, Record, Replica, Rossler, Schedule, Simulation,
    SparseMatrix, Start,
};

use common::{Interruption, on_threads, replicas};

/// A ring with a chord; links of equal weights are summed otherwise than those of different ones.
fn ring(n_nodes: usize, weight: impl Fn(usize) -> f64) -> SparseMatrix {
    let mut entries = sprs::TriMatI::<f64, u32>::new((n_nodes, n_nodes));
    let mut link = |i: usize, j: usize, weight: f64| {
        for (from, to) in [(i, j), (j, i)] {
            entries.add_triplet(from, to, weight);
            entries.add_triplet(from, from, -weight);
        }
    };
    (0..n_nodes).for_each(|i| link(i, (i + 1) % n_nodes, weight(i)));
    link(0, n_nodes / 2, weight(n_nodes));
    entries.to_csr()
}

/// Lorenz oscillators with every observable there is: 50 samples of transient, 100 of average, kicks
/// at every tenth.
fn lorenz(matrix: &SparseMatrix) -> Simulation<'_> {
    Simulation {
        dynamics: Arc::new(Model::Lorenz(Lorenz::default())),
        coupling: Coupling::pair(0, 1),
        matrix,
        method: Method::Rk4,
        schedule: Schedule { step: 0.01, transient: 5.0, average: 10.0, stride: 10 },
        observables: Observables {
            component: 0,
            pairs: true,
            reference: Some(2),
            clusters: vec![vec![0, 1, 4], vec![2, 3]],
        },
        series: None,
        kick: ROUNDING_KICK,
        instruction_set: InstructionSet::best(),
    }
}

fn dopri5() -> Method {
    let order = AdaptiveOrder::Five;
    Method::Adaptive(Adaptive { order, relative_tolerance: 1e-6, absolute_tolerance: 1e-6 })
}

/// Outcomes of a simulation that is interrupted again and again, and how often it was.
fn interrupted(simulation: &Simulation<'_>, replicas: &[Replica]) -> (Vec<Outcome>, u64) {
    common::interrupted(simulation, replicas, |_, _| {}, |_, _| {})
}

#[test]
fn interrupted_runs_go_on_to_the_bits_of_undisturbed_ones_in_any_lanes_and_threads() {
    for matrix in [ring(5, |_| 1.0), ring(19, |i| 1.0 + 0.1 * i as f64)] {
        let simulation = lorenz(&matrix);
        let replicas = replicas(21);
        let undisturbed: Vec<Outcome> = simulation
            .run(&replicas, dynamics::QUIET)
            .unwrap()
            .into_iter()
            .map(|run| run.outcome)
            .collect();
        let (outcomes, interruptions) = interrupted(&simulation, &replicas);
        assert!(interruptions > 4, "only {interruptions} interruptions");
        assert_eq!(outcomes, undisturbed);
    }
}

#[test]
fn interrupted_runs_of_the_adaptive_integrator_go_on_to_the_same_bits() {
    let matrix = ring(5, |_| 1.0);
    let simulation = Simulation { method: dopri5(), ..lorenz(&matrix) };
    let replicas = replicas(4);
    let undisturbed: Vec<Outcome> = simulation
        .run(&replicas, dynamics::QUIET)
        .unwrap()
        .into_iter()
        .map(|run| run.outcome)
        .collect();
    let (outcomes, interruptions) = interrupted(&simulation, &replicas);
    assert!(interruptions > 4, "only {interruptions} interruptions");
    assert_eq!(outcomes, undisturbed);
}

#[test]
fn a_snapshot_of_another_shape_is_told_from_those_of_the_simulation() {
    let matrix = ring(5, |_| 1.0);
    let simulation = lorenz(&matrix);
    let nothing = |_: usize, _: &Record<'_>| {};
    let observer = Interruption::after(90, 10, &[0], &nothing);
    let stopped = simulation.run_observed(vec![replicas(1)[0].into()], &observer);
    assert_eq!(stopped, Err(DynamicsError::Cancelled));
    let snapshot = &observer.snapshots.into_inner().unwrap()[&0];
    assert_eq!(snapshot.sample(), 81);
    assert!(simulation.can_start_from(snapshot));
    let other = ring(6, |_| 1.0);
    assert!(!lorenz(&other).can_start_from(snapshot));
    let fewer = Observables { pairs: false, ..simulation.observables.clone() };
    assert!(!Simulation { observables: fewer, ..simulation.clone() }.can_start_from(snapshot));
    let shorter = Schedule { transient: 0.0, average: 8.0, ..simulation.schedule };
    assert!(!Simulation { schedule: shorter, ..simulation.clone() }.can_start_from(snapshot));
}

/// Asks every batch to stop at once.
struct StopAtOnce {
    steps: AtomicU64,
}

impl Observer for StopAtOnce {
    fn advanced(&self, _: &[usize], steps: u64) -> Next {
        self.steps.fetch_add(steps, Ordering::Relaxed);
        Next::Stop
    }

    fn finished(&self, replica: usize, _: &Outcome) {
        panic!("replica {replica} has not ended");
    }
}

#[test]
fn a_simulation_that_is_told_to_stop_begins_no_other_batch() {
    let matrix = ring(5, |_| 1.0);
    for method in [Method::Rk4, dopri5()] {
        let simulation = Simulation { method, ..lorenz(&matrix) };
        let observer = StopAtOnce { steps: AtomicU64::new(0) };
        let starts = replicas(200).into_iter().map(Start::from).collect();
        let run = on_threads(1, || simulation.run_observed(starts, &observer));
        assert_eq!(run, Err(DynamicsError::Cancelled));
        // One sample of one batch of at most 16 lanes.
        assert!(observer.steps.into_inner() <= 16 * 10);
    }
}

/// Counts the samples after which each replica was told to have ended.
#[derive(Default)]
struct Ends {
    samples: AtomicU64,
    ends: Mutex<Vec<(u64, usize, Outcome)>>,
}

impl Observer for Ends {
    fn advanced(&self, _: &[usize], _: u64) -> Next {
        self.samples.fetch_add(1, Ordering::Relaxed);
        Next::GoOn
    }

    fn finished(&self, replica: usize, outcome: &Outcome) {
        let samples = self.samples.load(Ordering::Relaxed);
        self.ends.lock().unwrap().push((samples, replica, outcome.clone()));
    }
}

#[test]
fn every_replica_is_told_once_as_its_batch_ends_and_one_that_escapes_as_it_does() {
    // Negative coupling drives two Rössler oscillators to infinity.
    let matrix = ring(2, |_| 1.0);
    let simulation = Simulation {
        dynamics: Arc::new(Model::Rossler(Rossler::default())),
        coupling: Coupling::pair(0, 0),
        observables: Observables { pairs: true, ..Observables::default() },
        ..lorenz(&matrix)
    };
    let mut replicas = replicas(40);
    replicas[5].epsilon = -5.0;
    let ends = Ends::default();
    let starts = replicas.iter().map(|&replica| replica.into()).collect();
    let runs = on_threads(1, || simulation.run_observed(starts, &ends)).unwrap();
    let mut ends = ends.ends.into_inner().unwrap();
    assert_eq!((ends[0].1, ends.len()), (5, 40));
    assert!(ends[0].0 < 150, "it was told after {} samples", ends[0].0);
    assert!(ends[1].0 < ends[39].0, "batches end one after the other");
    ends.sort_by_key(|end| end.1);
    for (run, (_, _, outcome)) in runs.iter().zip(&ends) {
        assert_eq!(&run.outcome, outcome);
    }
}

#[test]
fn a_coupling_that_cannot_be_integrated_is_an_outcome_and_leaves_the_others_alone() {
    // At ε = 10⁷ two nodes are so stiff that an explicit method gives up.
    let matrix = ring(2, |_| 1.0);
    let simulation = Simulation {
        method: dopri5(),
        coupling: Coupling::pair(0, 0),
        observables: Observables { pairs: true, ..Observables::default() },
        ..lorenz(&matrix)
    };
    let replica = |epsilon| Replica { epsilon, seed: 1 };
    let runs = simulation.run(&[5.0, 1e7, 10.0].map(replica), dynamics::QUIET).unwrap();
    for (run, epsilon) in [(&runs[0], 5.0), (&runs[2], 10.0)] {
        assert!(matches!(run.outcome, Outcome::Completed(_)), "{run:?}");
        assert_eq!(*run, simulation.run(&[replica(epsilon)], dynamics::QUIET).unwrap()[0]);
    }
    match &runs[1].outcome {
        Outcome::Failed { time, reason } => {
            assert!(*time > 0.0 && *time < 0.1, "{time}");
            assert_eq!(reason, "the equations are too stiff for an explicit method");
        }
        other => panic!("{other:?}"),
    }
}
