//! The states on the way of those replicas of a sweep of which they are asked for: kept as they come, in
//! files that a run which goes on continues.

use std::io::{Error, Result};
use std::sync::{Mutex, OnceLock, PoisonError};

use dynamics::{Record, Schedule, Series, Snapshot};
use eigensync::Sweep;
use journal::{Key, Kind, Trajectory};

use crate::Work;

/// The states of all replicas of a sweep; of most of them none are asked for.
pub struct Trajectories<'a> {
    of: Vec<Option<Mutex<Trajectory>>>,
    series: Option<&'a Series>,
    schedule: Schedule,
    /// What first kept states from being written: from then on nothing is worth the time.
    failed: OnceLock<Error>,
}

impl<'a> Trajectories<'a> {
    /// Those that an earlier run has left, and room for the others. `keys` are those of the replicas.
    pub fn of(work: &Work<'a>, sweep: &'a Sweep, keys: &[Key]) -> Self {
        let recorded = work.plan.recorded.iter().flat_map(|recorded| &recorded.replicas);
        // Both stand in one order.
        let mut asked = recorded.peekable();
        let of = sweep.replicas().into_iter().zip(keys).map(|(replica, key)| {
            asked.next_if(|asked| **asked == replica)?;
            Some(Mutex::new(work.journal.trajectory(&states(work, sweep, key))))
        });
        Self {
            of: of.collect(),
            series: sweep.series.as_ref(),
            schedule: sweep.schedule,
            failed: OnceLock::new(),
        }
    }

    /// None of so many replicas.
    #[cfg(test)]
    pub fn none(n_replicas: usize) -> Self {
        let schedule = Schedule { step: 0.01, transient: 0.0, average: 1.0, stride: 1 };
        let of = (0..n_replicas).map(|_| None).collect();
        Self { of, series: None, schedule, failed: OnceLock::new() }
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
    pub fn add(&self, replica: usize, &Record { number, time, states, .. }: &Record<'_>) {
        self.try_with(replica, |trajectory| trajectory.add(number, time, states));
    }

    /// Writes what is gathered of a replica, before its state is kept from which it can go on.
    pub fn write(&self, replica: usize) {
        self.try_with(replica, Trajectory::write);
    }

    /// A replica has ended; whether all its states are there.
    pub fn finish(&self, replica: usize) -> bool {
        self.try_with(replica, Trajectory::finish);
        self.are_whole(replica)
    }

    /// Whether states could not be written. Asked at every sample.
    pub fn have_failed(&self) -> bool {
        self.failed.get().is_some()
    }

    /// Why they could not, if they could not.
    pub fn failure(self) -> Option<Error> {
        self.failed.into_inner()
    }

    fn try_with(&self, replica: usize, work: impl FnOnce(&mut Trajectory) -> Result<()>) {
        if let Some(Err(error)) = self.with(replica, work) {
            let _ = self.failed.set(error);
        }
    }

    fn with<T>(&self, replica: usize, work: impl FnOnce(&mut Trajectory) -> T) -> Option<T> {
        let trajectory = self.of[replica].as_ref()?;
        Some(work(&mut trajectory.lock().unwrap_or_else(PoisonError::into_inner)))
    }
}

/// What the states of a replica with this key are known by.
pub fn states(work: &Work<'_>, sweep: &Sweep, key: &Key) -> Key {
    work.journal.key(Kind::States, &(key.0, &sweep.series))
}
