//! States of which a study tells on request.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use eigensync::dynamics::{Coupling, Native, Record, Replica, Rossler, Series};
use eigensync::graph::Normalization;
use eigensync::graph::formats::edge_list;
use eigensync::{Node, Observer, Study, Sweep, completed, find, simulate};

/// Four Rössler oscillators on a ring, with a short sweep of two couplings and two seeds.
fn study() -> (Study, Sweep) {
    let network = edge_list::read("a b\nb c\nc d\nd a".as_bytes()).unwrap();
    let rossler = Arc::new(Native::new(Rossler::default()));
    let node = Node { dynamics: rossler, coupling: Coupling::pair(0, 0) };
    let mut study = Study::new(network, Normalization::Laplacian, node);
    study.msf.sigma = vec![0.0, 1.0, 2.0];
    study.msf.times.average = 200.0;
    study.msf.refinement.max_rounds = 4;
    let mut sweep = Sweep::over(vec![0.1, 0.5]);
    sweep.seeds = vec![3, 4];
    sweep.schedule.transient = 10.0;
    sweep.schedule.average = 20.0;
    (study, sweep)
}

/// Times and states that were told of one replica.
type Told = Vec<(f64, Vec<f64>)>;

/// Those of each replica, by the bits of its ε and its seed.
#[derive(Default)]
struct Plot(Mutex<BTreeMap<(u64, u64), Told>>);

impl Observer for Plot {
    fn recorded(&self, replica: Replica, record: &Record<'_>) {
        let mut all = self.0.lock().unwrap();
        let records = all.entry((replica.epsilon.to_bits(), replica.seed)).or_default();
        assert_eq!(record.number, records.len() as u64, "records come once, in their order");
        records.push((record.time, record.states.to_vec()));
    }
}

#[test]
fn a_sweep_tells_the_states_of_every_replica_and_not_of_those_at_half_the_step() {
    let (mut study, mut sweep) = study();
    sweep.series = Some(Series { every: 20, components: Some(vec![0]), ..Series::of(vec![2, 0]) });
    study.sweep = Some(sweep.clone());
    let plot = Plot::default();
    let found = find(&study, &plot).unwrap();
    assert!(!found.step_effects.is_empty(), "the same couplings were tried at half the step");
    let plotted = plot.0.into_inner().unwrap();
    let expected: Vec<(u64, u64)> =
        sweep.replicas().iter().map(|replica| (replica.epsilon.to_bits(), replica.seed)).collect();
    assert_eq!(plotted.keys().copied().collect::<Vec<_>>(), expected);
    for records in plotted.values() {
        let times: Vec<f64> = records.iter().map(|record| record.0).collect();
        assert_eq!(times, (0..=10).map(|n| 10.0 + 2.0 * f64::from(n)).collect::<Vec<_>>());
        assert!(records.iter().all(|record| record.1.len() == 2));
    }
}

#[test]
fn errors_of_a_simulation_without_a_prediction_are_those_of_its_states() {
    let (study, mut sweep) = study();
    sweep.series = Some(Series { components: Some(vec![0]), ..Series::of(vec![1, 3]) });
    let plot = Plot::default();
    let simulated = simulate(&study, &sweep, &plot).unwrap();
    for run in &simulated.runs {
        let records = &plot.0.lock().unwrap()[&(run.replica.epsilon.to_bits(), run.replica.seed)];
        // After the state that the transient leaves.
        let differences = records[1..].iter().map(|(_, x)| (x[0] - x[1]).abs());
        let mean = differences.sum::<f64>() / 200.0;
        let told = completed(run).unwrap().pair(1, 3, 4);
        assert!((told - mean).abs() < 1e-13 * mean.max(1.0), "{told} and {mean}");
    }
}
