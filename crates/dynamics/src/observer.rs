//! What a long simulation tells while it runs, and what it is told: how far it has come, which
//! replicas have ended, states from which it can be resumed, and whether to go on.
//!
//! A replica is a function of its simulation, ε and seed alone, and so is its state after any sample.
//! A [`Snapshot`] holds that state, whatever lanes and threads it was made in, and goes on in any
//! others to the same bits.

use serde::{Deserialize, Serialize};

use crate::{Outcome, Progress, Record, Replica};

/// Follows a simulation; called from any thread. Every method does nothing unless it is written.
pub trait Observer: Sync {
    /// Some replicas, by their places in the list that is run, have come one sample further, all of
    /// them together by so many steps. Asked at every sample of every batch, so answer at once.
    fn advanced(&self, replicas: &[usize], steps: u64) -> Next {
        let _ = (replicas, steps);
        Next::GoOn
    }

    /// A replica has ended.
    fn finished(&self, replica: usize, outcome: &Outcome) {
        let _ = (replica, outcome);
    }

    /// The next record of a replica, where the simulation has a [`crate::Series`]; those of one replica
    /// come in their order, that of a sample before the snapshot after it, and none from the sample on
    /// at which an orbit is seen to have escaped. A replica that goes on from a snapshot tells of the
    /// samples after it: what an earlier run told of these comes again, with the same numbers and to
    /// the same bits.
    fn recorded(&self, replica: usize, record: &Record<'_>) {
        let _ = (replica, record);
    }

    /// The state of a replica that goes on, for which [`Next::Snapshot`] asked.
    fn snapshot(&self, replica: usize, snapshot: Snapshot) {
        let _ = (replica, snapshot);
    }
}

/// What an observer wants of the replicas that it has been told of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Next {
    /// That they go on.
    GoOn,
    /// That they hand over their states, and go on.
    Snapshot,
    /// That they stop: the call returns [`crate::DynamicsError::Cancelled`].
    Stop,
}

/// A replica after some sample: its state and the sums of its observables so far. The generator of
/// its kicks is not among it, since the number of the sample tells where in its sequence that stands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// Samples done, those of the transient among them.
    pub(crate) sample: u64,
    /// `[component][node]`.
    pub(crate) state: Vec<f64>,
    /// Three numbers a quantity, in the order of [`crate::Errors`]; none within the transient.
    pub(crate) sums: Vec<f64>,
}

impl Snapshot {
    /// Samples done.
    pub fn sample(&self) -> u64 {
        self.sample
    }
}

/// Where a replica begins.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// What to run.
    pub replica: Replica,
    /// From where: its initial state unless a snapshot is given.
    pub from: Option<Snapshot>,
}

impl Start {
    /// Samples that are done already.
    pub(crate) fn sample(&self) -> u64 {
        self.from.as_ref().map_or(0, |snapshot| snapshot.sample)
    }
}

impl From<Replica> for Start {
    fn from(replica: Replica) -> Self {
        Self { replica, from: None }
    }
}

/// The observer that only counts steps.
pub(crate) struct Counting<'a>(pub(crate) Progress<'a>);

impl Observer for Counting<'_> {
    fn advanced(&self, _: &[usize], steps: u64) -> Next {
        if (self.0)(steps).is_break() { Next::Stop } else { Next::GoOn }
    }
}
