//! A simulation run: replicas in batches of lanes, or one by one by an adaptive method.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use crate::batches::{self, Batch, Numbered, Size};
use crate::error::check_step;
use crate::integrators::fixed::Fixed;
use crate::integrators::{Method, adaptive};
use crate::links::Links;
use crate::observer::Counting;
use crate::team::{Seat, Team};
use crate::{
    DynamicsError, Observer, Outcome, Progress, Replica, Run, Simulation, Snapshot, Start,
};

impl Simulation<'_> {
    /// Runs all replicas on the current rayon pool; results come in the order of `replicas`.
    ///
    /// # Errors
    /// [`DynamicsError::WrongMethod`] for a map that is not iterated, or a flow that is;
    /// [`DynamicsError::BadStep`], [`DynamicsError::BadTime`] and [`DynamicsError::TooFewSamples`] for
    /// a schedule that makes no sense, [`DynamicsError::NoSuchNode`],
    /// [`DynamicsError::NoSuchComponent`], [`DynamicsError::BadTime`] and
    /// [`DynamicsError::EmptySeries`] for a series that cannot be had. An orbit that escapes, or cannot be integrated, is an
    /// [`Outcome`], not an error.
    pub fn run(
        &self,
        replicas: &[Replica],
        progress: Progress<'_>,
    ) -> Result<Vec<Run>, DynamicsError> {
        let starts = replicas.iter().map(|&replica| Start::from(replica)).collect();
        self.run_observed(starts, &Counting(progress))
    }

    /// The same from initial states or from snapshots, with an observer that is told of every replica
    /// as it ends and may stop the run. The outcomes do not depend on where replicas start.
    ///
    /// # Errors
    /// Those of [`Self::run`], and [`DynamicsError::Cancelled`] when the observer wanted to stop: then
    /// only the outcomes that it was told of are there.
    ///
    /// # Panics
    /// When a snapshot is of another simulation: see [`Self::can_start_from`].
    pub fn run_observed(
        &self,
        starts: Vec<Start>,
        observer: &dyn Observer,
    ) -> Result<Vec<Run>, DynamicsError> {
        self.check_method()?;
        self.schedule.check()?;
        if let Some(series) = &self.series {
            series.check(&self.schedule, (self.matrix.rows(), self.dynamics.start().len()))?;
        }
        for snapshot in starts.iter().filter_map(|start| start.from.as_ref()) {
            assert!(self.can_start_from(snapshot), "a snapshot is of another simulation");
        }
        let replicas: Vec<Replica> = starts.iter().map(|start| start.replica).collect();
        let starts: Vec<Numbered> = starts.into_iter().enumerate().collect();
        let mut outcomes: Vec<Option<Outcome>> = vec![None; replicas.len()];
        let told = match self.method.fixed() {
            Ok(method) => self.run_in_lanes(method, starts, observer),
            Err(method) => {
                let run = |(number, start)| {
                    Some((number, adaptive::run(self, method, (number, start), observer)?))
                };
                run_unless_stopped(starts, rayon::current_num_threads(), run)
            }
        };
        for (number, outcome) in told.ok_or(DynamicsError::Cancelled)? {
            outcomes[number] = Some(outcome);
        }
        let run = |(replica, outcome): (Replica, Option<Outcome>)| Run {
            replica,
            outcome: outcome.expect("every replica is in one batch"),
        };
        Ok(replicas.into_iter().zip(outcomes).map(run).collect())
    }

    /// A map is iterated in steps of 1, and nothing else is.
    fn check_method(&self) -> Result<(), DynamicsError> {
        let is_map = self.dynamics.is_map();
        if is_map != (self.method == Method::Iterate) {
            return Err(DynamicsError::WrongMethod { is_map });
        }
        check_step(is_map, self.schedule.step)
    }

    /// Whether a snapshot has the shape of those of this simulation. Whether it is of the same
    /// equations, matrix, ε and seed, only its keeper can know.
    pub fn can_start_from(&self, snapshot: &Snapshot) -> bool {
        let n_nodes = self.matrix.rows();
        let transient = self.schedule.transient_samples();
        let n_sums = if snapshot.sample > transient { self.observables.n_sums(n_nodes) } else { 0 };
        (1..transient + self.schedule.samples()).contains(&snapshot.sample)
            && snapshot.state.len() == self.dynamics.start().len() * n_nodes
            && snapshot.sums.len() == n_sums
    }

    /// Batches of lanes, as many as keep all threads busy, or several threads on each; none when the
    /// observer wanted to stop.
    fn run_in_lanes(
        &self,
        method: Fixed,
        starts: Vec<Numbered>,
        observer: &dyn Observer,
    ) -> Option<Vec<(usize, Outcome)>> {
        let links = Links::new(self.matrix);
        let size = Size { work: links.work(), n_nodes: links.n_nodes() };
        let cut = batches::of(starts, rayon::current_num_threads(), size);
        macro_rules! run {
            ($starts:ident in $lanes:literal lanes, $rows:literal rows) => {
                together(cut.n_seats, |seat| {
                    self.instruction_set.run(Batch::<$lanes, $rows> {
                        simulation: self,
                        method,
                        links: &links,
                        starts: $starts.clone(),
                        observer,
                        seat,
                    })
                })
            };
        }
        // Rows side by side: enough sums to hide how long one addition takes.
        let run = |starts: Vec<Numbered>| match starts.len() {
            1 => run!(starts in 1 lanes, 8 rows),
            2 => run!(starts in 2 lanes, 4 rows),
            3..=4 => run!(starts in 4 lanes, 4 rows),
            5..=8 => run!(starts in 8 lanes, 2 rows),
            _ => run!(starts in 16 lanes, 1 rows),
        };
        Some(run_unless_stopped(cut.batches, cut.n_teams, run)?.into_iter().flatten().collect())
    }
}

/// Does one piece of work on as many threads as a team has; what the leading one makes of it.
fn together<T>(n_seats: usize, work: impl Fn(Seat<'_>) -> Option<T> + Sync) -> Option<T> {
    let team = Team::of(n_seats);
    let mut seats = team.seats();
    let leading = seats.next().expect("a team has a leading seat");
    // Threads of their own: those of a pool might be busy, and wait for this one meanwhile.
    std::thread::scope(|scope| {
        for seat in seats {
            let work = &work;
            scope.spawn(move || drop(work(seat)));
        }
        work(leading)
    })
}

/// Does all pieces of work, so many at once; begins no other once one has been stopped.
fn run_unless_stopped<W: Send, T: Send>(
    pieces: Vec<W>,
    at_once: usize,
    run: impl Fn(W) -> Option<T> + Sync,
) -> Option<Vec<T>> {
    let stopped = AtomicBool::new(false);
    let left = Mutex::new(pieces.into_iter());
    let next = || left.lock().expect("nothing fails while a piece is taken").next();
    let one_after_the_other = |_| {
        let mut done = Vec::new();
        while !stopped.load(Ordering::Relaxed)
            && let Some(piece) = next()
        {
            match run(piece) {
                Some(result) => done.push(result),
                None => stopped.store(true, Ordering::Relaxed),
            }
        }
        done
    };
    let done = (0..at_once).into_par_iter().with_max_len(1).map(one_after_the_other);
    let done: Vec<T> = done.collect::<Vec<_>>().into_iter().flatten().collect();
    (!stopped.into_inner()).then_some(done)
}
