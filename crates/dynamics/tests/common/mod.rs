//! Simulations that are interrupted again and again, and what tests of them share.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use dynamics::{
    DynamicsError, Next, Observer, Outcome, Record, Replica, Simulation, Snapshot, Start,
};

pub fn replicas(n: u64) -> Vec<Replica> {
    (0..n).map(|k| Replica { epsilon: 0.3 * k as f64, seed: 1 + k % 5 }).collect()
}

pub fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

/// Stops a simulation at some sample of some batch, and keeps what it was told.
pub struct Interruption<'a, R> {
    /// Of each start, its place in the list of all replicas.
    places: &'a [usize],
    /// Samples of all batches together until it stops, and between snapshots before.
    samples_left: AtomicU64,
    between_snapshots: u64,
    outcomes: Mutex<BTreeMap<usize, Outcome>>,
    pub snapshots: Mutex<BTreeMap<usize, Snapshot>>,
    /// Is told of each record, with the place of its replica.
    recorded: &'a R,
}

impl<'a, R> Interruption<'a, R> {
    /// After so many samples of all batches together, with snapshots after so many before.
    pub fn after(
        samples: u64,
        between_snapshots: u64,
        places: &'a [usize],
        recorded: &'a R,
    ) -> Self {
        Self {
            places,
            samples_left: AtomicU64::new(samples),
            between_snapshots,
            outcomes: Mutex::default(),
            snapshots: Mutex::default(),
            recorded,
        }
    }
}

impl<R: Fn(usize, &Record<'_>) + Sync> Observer for Interruption<'_, R> {
    fn advanced(&self, _: &[usize], _: u64) -> Next {
        let left = self.samples_left.fetch_sub(1, Ordering::Relaxed);
        // Counts wrap below zero, where everything has to stop.
        if left == 0 || left > u64::MAX / 2 {
            Next::Stop
        } else if left.is_multiple_of(self.between_snapshots) {
            Next::Snapshot
        } else {
            Next::GoOn
        }
    }

    fn recorded(&self, replica: usize, record: &Record<'_>) {
        (self.recorded)(self.places[replica], record);
    }

    fn finished(&self, replica: usize, outcome: &Outcome) {
        let earlier = self.outcomes.lock().unwrap().insert(self.places[replica], outcome.clone());
        assert_eq!(earlier, None, "a replica ends once");
    }

    fn snapshot(&self, replica: usize, snapshot: Snapshot) {
        self.snapshots.lock().unwrap().insert(self.places[replica], snapshot);
    }
}

/// Outcomes of a simulation that is interrupted again and again, and resumed on another number of
/// threads from what is left of its snapshots; and how often it was. `begins` is told from where a
/// replica goes on each time, `recorded` of every record.
pub fn interrupted(
    simulation: &Simulation<'_>,
    replicas: &[Replica],
    mut begins: impl FnMut(usize, Option<&Snapshot>),
    recorded: impl Fn(usize, &Record<'_>) + Sync,
) -> (Vec<Outcome>, u64) {
    let mut outcomes: BTreeMap<usize, Outcome> = BTreeMap::new();
    let mut snapshots: BTreeMap<usize, Snapshot> = BTreeMap::new();
    for round in 0.. {
        let places: Vec<usize> =
            (0..replicas.len()).filter(|place| !outcomes.contains_key(place)).collect();
        let start = |&place: &usize| {
            let from = snapshots.get(&place).cloned();
            begins(place, from.as_ref());
            Start { replica: replicas[place], from }
        };
        let starts: Vec<Start> = places.iter().map(start).collect();
        let (samples, between) = (61 + 37 * (round % 4), 13 + round % 3);
        let observer = Interruption::after(samples, between, &places, &recorded);
        let threads = 1 + round as usize % 3;
        let run = on_threads(threads, || simulation.run_observed(starts, &observer));
        outcomes.append(&mut observer.outcomes.into_inner().unwrap());
        snapshots.append(&mut observer.snapshots.into_inner().unwrap());
        // Some are lost, so that those of one batch part and their replicas begin anew.
        snapshots.retain(|place, _| !(place + round as usize).is_multiple_of(7));
        match run {
            Ok(_) => return (outcomes.into_values().collect(), round),
            Err(error) => assert_eq!(error, DynamicsError::Cancelled),
        }
    }
    unreachable!("rounds go on until the simulation has ended")
}
