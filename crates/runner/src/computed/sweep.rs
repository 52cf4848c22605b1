//! The replicas of a sweep: those that the journal has are taken over, those of which it has a state go
//! on from it, and every other begins at its initial state. Which of the three, no bit depends on.

use eigensync::{Error, Probe, Simulated, StepEffect, Sweep};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use dynamics::{
    DynamicsError, Next, Observer, Outcome, Progress, Record, Replica, Run, Schedule, Snapshot,
    Start,
};

use crate::Work;
use journal::{Journal, Key, Kind};

use super::failure::Failure;
use super::trajectories::{Trajectories, states};

/// How long a batch runs before it leaves its states, and between one time and the next: what a kill
/// costs, and long against the time that writing takes.
const BETWEEN_SNAPSHOTS: Duration = Duration::from_secs(60);

/// All replicas of the sweep of a plan.
pub fn runs(work: &Work<'_>, sweep: &Sweep) -> Result<Vec<Run>, Failure> {
    let &Work { plan, journal, stages } = work;
    let simulation = plan.study.simulation(sweep);
    let replicas = sweep.replicas();
    let keys = keys(work, sweep, &replicas);
    journal.expect_replicas(replicas.len());
    let trajectories = Trajectories::of(work, sweep, &keys);
    let take = |(at, key): (usize, &Key)| {
        let outcome = journal.take::<Outcome>(Kind::Replica, key);
        outcome.filter(|_| trajectories.are_whole(at))
    };
    let mut outcomes: Vec<Option<Outcome>> = keys.iter().enumerate().map(take).collect();
    let left: Vec<usize> = (0..replicas.len()).filter(|&at| outcomes[at].is_none()).collect();
    let from = |at: usize| {
        let state = journal.snapshot(&keys[at]).filter(|state| simulation.can_start_from(state));
        state.filter(|state| trajectories.reach(at, state))
    };
    let start = |&at: &usize| Start { replica: replicas[at], from: from(at) };
    let starts: Vec<Start> = left.iter().map(start).collect();
    journal.tell_taken();
    let steps = (sweep.steps(), steps_done(sweep, &starts));
    let ran = stages.resumed("sweep", steps, |progress| {
        let replicas = left.iter().map(|&at| (at, keys[at])).collect();
        let following = Following::new(journal, replicas, &trajectories, progress);
        simulation.run_observed(starts, &following)
    });
    if let Some(error) = trajectories.failure() {
        return Err(Failure::States(error));
    }
    let ran = ran.map_err(|error| Failure::Study(Error::Sweep(error)))?;
    for (at, run) in left.into_iter().zip(ran) {
        outcomes[at] = Some(run.outcome);
    }
    let run = |(replica, outcome): (Replica, Option<Outcome>)| Run {
        replica,
        outcome: outcome.expect("every replica was taken over or has run"),
    };
    Ok(replicas.into_iter().zip(outcomes).map(run).collect())
}

/// What the states on the way of some replicas are known by.
pub fn states_of(work: &Work<'_>, sweep: &Sweep, replicas: &[Replica]) -> Vec<Key> {
    keys(work, sweep, replicas).iter().map(|key| states(work, sweep, key)).collect()
}

/// What replicas of a sweep are known by.
fn keys(work: &Work<'_>, sweep: &Sweep, replicas: &[Replica]) -> Vec<Key> {
    let Work { plan, journal, .. } = work;
    let shared = (work.matrix(), &plan.node, sweep.method, sweep.schedule);
    let shared = journal.key(Kind::Replica, &(shared, &sweep.observables, sweep.kick));
    let key =
        |replica: &Replica| journal.key(Kind::Replica, &(shared.0, replica.epsilon, replica.seed));
    replicas.iter().map(key).collect()
}

/// What the step of the integrator does at some couplings of a sweep, all of it one piece of work.
pub fn effects_of_step(
    work: &Work<'_>,
    sweep: &Sweep,
    simulated: &Simulated,
) -> Result<Vec<StepEffect>, DynamicsError> {
    let &Work { plan, journal, stages } = work;
    let Some(probe) = Probe::of(sweep, simulated) else { return Ok(Vec::new()) };
    let bound = |replica: &Replica| {
        simulated.position(replica.epsilon).map_or(0.0, |position| simulated.bound(position))
    };
    let replicas: Vec<(f64, u64, f64)> =
        probe.replicas.iter().map(|run| (run.epsilon, run.seed, bound(run))).collect();
    let of = (work.matrix(), &plan.node, sweep.method, probe.schedules, replicas);
    let key = journal.key(Kind::StepEffects, &(of, &sweep.observables, sweep.kick));
    journal.once((Kind::StepEffects, key), || {
        let at = |schedule: Schedule| {
            let steps = probe.replicas.len() as u64 * schedule.steps();
            let simulation = plan.study.probing(sweep, schedule);
            let run = |progress: Progress<'_>| simulation.run(&probe.replicas, progress);
            stages.measured("half step", steps, run)
        };
        let [at_step, at_half] = probe.schedules.map(at);
        Ok(probe.effects(simulated, [&at_step?, &at_half?]))
    })
}

/// Steps of a sweep that an earlier run has done.
fn steps_done(sweep: &Sweep, starts: &[Start]) -> u64 {
    let stride = u64::from(sweep.schedule.stride);
    let samples = |start: &Start| start.from.as_ref().map_or(0, Snapshot::sample);
    let to_do: u64 =
        starts.iter().map(|start| sweep.schedule.steps() - samples(start) * stride).sum();
    sweep.steps() - to_do
}

/// Keeps what replicas leave, when they end and on the way.
struct Following<'a> {
    journal: &'a Journal,
    /// Their places in the sweep, and what they are known by.
    replicas: Vec<(usize, Key)>,
    trajectories: &'a Trajectories<'a>,
    progress: Progress<'a>,
    started: Instant,
    /// Of each replica, what is known of the batch of which it is the first.
    batches: Vec<Batch>,
}

#[derive(Default)]
struct Batch {
    samples: AtomicU64,
    /// Milliseconds from the start to when it began or last left its states; 0 before, [`LEFT`] when
    /// it has left them for good.
    looked: AtomicU64,
}

const LEFT: u64 = u64::MAX;

/// Samples from one look at the clock to the next, which costs as much as a small network's step.
const BETWEEN_LOOKS: u64 = 16;

impl<'a> Following<'a> {
    fn new(
        journal: &'a Journal,
        replicas: Vec<(usize, Key)>,
        trajectories: &'a Trajectories<'a>,
        progress: Progress<'a>,
    ) -> Self {
        let batches = replicas.iter().map(|_| Batch::default()).collect();
        Self { journal, replicas, trajectories, progress, started: Instant::now(), batches }
    }

    fn milliseconds(&self) -> u64 {
        u64::try_from(self.started.elapsed().as_millis()).unwrap_or(LEFT - 1) + 1
    }
}

impl Observer for Following<'_> {
    fn advanced(&self, replicas: &[usize], steps: u64) -> Next {
        let wants_to_stop = (self.progress)(steps).is_break();
        if self.trajectories.have_failed() {
            return Next::Stop;
        }
        let Batch { samples, looked } = &self.batches[replicas[0]];
        if wants_to_stop {
            // One that has just begun has nothing to leave.
            let has_left = matches!(looked.swap(LEFT, Ordering::Relaxed), 0 | LEFT);
            return if has_left { Next::Stop } else { Next::Snapshot };
        }
        if !samples.fetch_add(1, Ordering::Relaxed).is_multiple_of(BETWEEN_LOOKS) {
            return Next::GoOn;
        }
        let now = self.milliseconds();
        match looked.load(Ordering::Relaxed) {
            0 => looked.store(now, Ordering::Relaxed),
            before if u128::from(now - before) >= BETWEEN_SNAPSHOTS.as_millis() => {
                looked.store(now, Ordering::Relaxed);
                return Next::Snapshot;
            }
            _ => {}
        }
        Next::GoOn
    }

    fn finished(&self, replica: usize, outcome: &Outcome) {
        let (at, key) = &self.replicas[replica];
        // One whose states are missing is as one that has not run.
        if self.trajectories.finish(*at) {
            self.journal.keep(Kind::Replica, key, outcome);
        }
        self.journal.drop_snapshot(key);
    }

    fn recorded(&self, replica: usize, record: &Record<'_>) {
        self.trajectories.add(self.replicas[replica].0, record);
    }

    fn snapshot(&self, replica: usize, snapshot: Snapshot) {
        let (at, key) = &self.replicas[replica];
        self.trajectories.write(*at);
        self.journal.keep_snapshot(key, &snapshot);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;

    #[test]
    fn a_batch_leaves_its_states_once_it_has_run_for_a_minute() {
        let folder = tempfile::tempdir().unwrap();
        let journal = Journal::open(folder.path(), "tiny", "program", false, Arc::new(())).unwrap();
        let keys = (0..3).map(|k| (k, journal.key(Kind::Replica, &k))).collect();
        let none = Trajectories::none(3);
        let mut following = Following::new(&journal, keys, &none, dynamics::QUIET);
        let snapshots = |following: &Following<'_>, batch: &[usize]| {
            let samples = 0..10 * BETWEEN_LOOKS;
            samples.filter(|_| following.advanced(batch, 10) == Next::Snapshot).count()
        };
        assert_eq!(snapshots(&following, &[0, 2]), 0);
        // A minute passes.
        following.started = following.started.checked_sub(BETWEEN_SNAPSHOTS).unwrap();
        assert_eq!(snapshots(&following, &[1]), 0, "another has just begun");
        assert_eq!(snapshots(&following, &[0, 2]), 1);
        assert_eq!(snapshots(&following, &[1]), 0);
    }
}
