//! The states on the way of those replicas of a sweep of which they are asked for: kept as they come, in
//! files that a run which goes on continues.

use std::sync::{Mutex, PoisonError};

use dynamics::{Record, Replica, Schedule, Series, Snapshot};
use eigensync::Sweep;
use journal::{Key, Kind, Trajectory};

use crate::Work;

/// The states of all replicas of a sweep; of most of them none are asked for.
pub struct Trajectories<'a> {
    of: Vec<Option<Mutex<Trajectory>>>,
    series: Option<&'a Series>,
    schedule: Schedule,
    /// What first kept states from being written: from then on nothing is worth the time.
    failed: Mutex<Option<std::io::Error>>,
}

impl<'a> Trajectories<'a> {
    /// Those that an earlier run has left, and room for the others. `keys` are those of the replicas.
    pub fn of(work: &Work<'a>, sweep: &'a Sweep, keys: &[Key]) -> Self {
        let of = sweep.replicas().into_iter().zip(keys);
        let of = of.map(|(replica, key)| trajectory(work, sweep, replica, key).map(Mutex::new));
        Self {
            of: of.collect(),
            series: sweep.series.as_ref(),
            schedule: sweep.schedule,
            failed: Mutex::default(),
        }
    }

    /// None of so many replicas.
    #[cfg(test)]
    pub fn none(n_replicas: usize) -> Self {
        let schedule = Schedule { step: 0.01, transient: 0.0, average: 1.0, stride: 1 };
        let of = (0..n_replicas).map(|_| None).collect();
        Self { of, series: None, schedule, failed: Mutex::default() }
    }

    /// Whether all that is asked for of a replica is there.
    pub fn are_whole(&self, replica: usize) -> bool {
        self.with(replica, |trajectory| trajectory.is_whole()).unwrap_or(true)
    }

    /// Whether a replica can go on from a state: what it told before that is there.
    pub fn reach(&self, replica: usize, snapshot: &Snapshot) -> bool {
        let Some(series) = self.series else { return true };
        let told = series.n_records_by(&self.schedule, snapshot.sample());
        self.with(replica, |trajectory| trajectory.n_states() >= told).unwrap_or(true)
    }

    /// Keeps a state of a replica.
    pub fn add(&self, replica: usize, record: &Record<'_>) {
        self.with(replica, |trajectory| trajectory.add(record.number, record.time, record.states));
    }

    /// Writes what is gathered of a replica, before its state is kept from which it can go on.
    pub fn write(&self, replica: usize) {
        self.with(replica, Trajectory::write);
    }

    /// A replica has ended; whether all its states are there.
    pub fn finish(&self, replica: usize) -> bool {
        let is_whole = self.with(replica, |trajectory| {
            trajectory.finish();
            trajectory.is_whole()
        });
        is_whole.unwrap_or(true)
    }

    /// Whether states could not be written.
    pub fn have_failed(&self) -> bool {
        self.failed.lock().unwrap_or_else(PoisonError::into_inner).is_some()
    }

    /// Why they could not, if they could not.
    pub fn failure(self) -> Option<std::io::Error> {
        self.failed.into_inner().unwrap_or_else(PoisonError::into_inner)
    }

    fn with<T>(&self, replica: usize, work: impl FnOnce(&mut Trajectory) -> T) -> Option<T> {
        let trajectory = self.of[replica].as_ref()?;
        let mut trajectory = trajectory.lock().unwrap_or_else(PoisonError::into_inner);
        let result = work(&mut trajectory);
        if let Some(error) = trajectory.take_failure() {
            self.failed.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
        }
        Some(result)
    }
}

/// The states of a replica with this key, if they are asked for.
pub fn trajectory(
    work: &Work<'_>,
    sweep: &Sweep,
    replica: Replica,
    key: &Key,
) -> Option<Trajectory> {
    let recorded = work.plan.recorded.as_ref()?;
    let is_asked = recorded.replicas.contains(&replica);
    let key = work.journal.key(Kind::States, &(key.0, &sweep.series));
    is_asked.then(|| work.journal.trajectory(&key))
}
