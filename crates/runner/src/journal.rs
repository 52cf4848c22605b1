//! What a run has computed so far, kept so that it is computed once: finished replicas, the curve, the
//! spectrum, each appended to the file `journal` in the hidden folder of the run as it ends.
//!
//! Every piece goes by a key of all that it depends on (`key`), so that the next run, of the same file
//! or of one that was edited, takes over exactly what it would compute again, to the same bits. What
//! cannot be kept, as where a disk is full, costs time at the next run and nothing at this one.
//!
//! `record` is the form of the records, `log` the file, `snapshots` the states of what still runs.

mod key;
mod log;
mod record;
mod snapshots;

use std::collections::HashSet;
use std::fmt::Write;
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, SystemTime};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::output::tell;
use crate::problem::{Problem, Result};
use crate::signals;

pub use key::Key;
use log::{Damage, Log};
use snapshots::Snapshots;

/// The file in the hidden folder.
const JOURNAL: &str = "journal";

/// Bytes a second at which a disk surely writes, and the part of a computation that keeping its result
/// may cost.
const DISK: f64 = 2e8;
const WORTH: f64 = 0.05;
/// So many bytes are kept whatever they cost.
const FEW_BYTES: f64 = 1e6;

/// Whether a file in a hidden folder is called as what a journal consists of.
pub fn is_its(name: &str) -> bool {
    name == JOURNAL || snapshots::is_one(name)
}

/// Kinds of records. Their numbers stand in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Kind {
    /// A run that began: what comes after it is its work.
    Begun = 1,
    /// The first look of `predict` at Λ.
    Look = 2,
    /// Λ(σ) with its zeros.
    Curve = 3,
    /// Eigenvalues and eigenvectors.
    Spectrum = 4,
    /// The outcome of one replica.
    Replica = 5,
    /// The state of a replica that still runs; in files of their own.
    Snapshot = 6,
    /// What the step of the integrator does to simulated errors.
    StepEffects = 7,
}

impl Kind {
    const ALL: [Self; 7] = [
        Self::Begun,
        Self::Look,
        Self::Curve,
        Self::Spectrum,
        Self::Replica,
        Self::Snapshot,
        Self::StepEffects,
    ];

    fn of(number: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| *kind as u8 == number)
    }
}

/// A run that began.
#[derive(Serialize, Deserialize)]
struct Begun {
    /// Seconds since 1970.
    at: u64,
    /// What computed.
    program: String,
}

/// How much of a run's work is in its journal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Held {
    /// The curve Λ(σ).
    pub curve: bool,
    /// The spectrum.
    pub spectrum: bool,
    /// Replicas.
    pub replicas: usize,
    /// States of replicas that had not ended.
    pub states: usize,
}

impl Held {
    fn count(&mut self, kind: Kind) {
        match kind {
            Kind::Curve => self.curve = true,
            Kind::Spectrum => self.spectrum = true,
            Kind::Replica => self.replicas += 1,
            Kind::Begun | Kind::Look | Kind::Snapshot | Kind::StepEffects => {}
        }
    }

    /// In words, replicas as a part of all; empty for nothing.
    fn words(&self, all: usize) -> String {
        let mut parts = Vec::new();
        if self.replicas > 0 {
            parts.push(format!("{} of {all} replicas", self.replicas));
        }
        if self.states > 0 {
            let others = if self.replicas > 0 { "others" } else { "replicas" };
            parts.push(format!("the states of {} {others}", self.states));
        }
        parts.extend(self.curve.then(|| "the curve".to_owned()));
        parts.extend(self.spectrum.then(|| "the spectrum".to_owned()));
        match &parts[..] {
            [] => String::new(),
            [first] => first.clone(),
            [first, last] => format!("{first} and {last}"),
            [first, rest @ .., last] => format!("{first}, {} and {last}", rest.join(", ")),
        }
    }
}

/// The journal of one run.
pub struct Journal {
    id: String,
    log: Mutex<Log>,
    snapshots: Snapshots,
    state: Mutex<State>,
}

/// What has become of it in this run.
#[derive(Default)]
struct State {
    taken: Held,
    /// Taken or kept.
    held: Held,
    /// Replicas of which there is a state.
    running: HashSet<Key>,
    /// Replicas of the sweep.
    replicas: usize,
    /// When the run began from which the first piece was taken.
    begun: Option<u64>,
    /// Whether this run has said that it began.
    has_begun: bool,
    /// Whether it was said that nothing can be kept.
    full: bool,
}

impl Journal {
    /// Opens the journal in the hidden folder of an experiment, or begins one; always anew if wanted so.
    pub fn open(folder: &Path, id: &str, fresh: bool) -> Result<Arc<Self>> {
        let path = folder.join(JOURNAL);
        let failed = |error: std::io::Error| {
            // A folder is none of ours, and stays whatever is wanted.
            let hint = match path.is_dir() {
                true => "move the folder away; a run leaves a file of this name",
                false => "`--fresh` begins anew",
            };
            Problem::from_error("the journal cannot be opened", error).in_file(&path).hint(hint)
        };
        let mut snapshots = Snapshots::new(folder);
        if fresh {
            snapshots.clear();
            match std::fs::remove_file(&path) {
                Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                    return Err(failed(error));
                }
                _ => {}
            }
        }
        let (log, damage) = Log::open(&path).map_err(failed)?;
        for damage in damage {
            match damage {
                Damage::CutOff(bytes) => tell!(
                    "{id}: the last {bytes} bytes of the journal were not written to their end and \
                     are cut off"
                ),
                Damage::Skipped(records) => tell!(
                    "warning: {id}: the journal is damaged in {records} places; what stood there is \
                     computed again"
                ),
            }
        }
        let (id, log) = (id.to_owned(), Mutex::new(log));
        let journal = Arc::new(Self { id, log, snapshots, state: Mutex::default() });
        let kept = journal.clone();
        signals::keep_in_mind(Arc::new(move || {
            kept.flush();
            kept.what_is_kept()
        }));
        Ok(journal)
    }

    /// What was computed under a key, if it is there.
    pub fn take<T: DeserializeOwned>(&self, kind: Kind, key: &Key) -> Option<T> {
        let mut log = lock(&self.log);
        let found = log.find(key).filter(|found| found.kind == kind)?;
        let value = postcard::from_bytes(&log.payload(&found).ok()?).ok()?;
        let run = log.run_of(&found);
        let mut state = lock(&self.state);
        state.taken.count(kind);
        state.held.count(kind);
        if state.begun.is_none()
            && let Some(run) = run
        {
            let begun = log.payload(&run).ok();
            let begun = begun.and_then(|bytes| postcard::from_bytes::<Begun>(&bytes).ok());
            state.begun = begun.map(|begun| begun.at);
        }
        Some(value)
    }

    /// Keeps what was computed under a key.
    pub fn keep(&self, kind: Kind, key: &Key, value: &impl Serialize) {
        self.begin();
        if self.append(kind, key, value) {
            lock(&self.state).held.count(kind);
        }
    }

    /// Takes what was computed under a key, or computes and keeps it.
    pub fn once<T: Serialize + DeserializeOwned, E>(
        &self,
        (kind, key): (Kind, Key),
        compute: impl FnOnce() -> std::result::Result<T, E>,
    ) -> std::result::Result<T, E> {
        if let Some(value) = self.take(kind, &key) {
            return Ok(value);
        }
        let value = compute()?;
        self.keep(kind, &key, &value);
        Ok(value)
    }

    /// The last state of a replica that was still running.
    pub fn snapshot(&self, key: &Key) -> Option<dynamics::Snapshot> {
        let snapshot = self.snapshots.take(key)?;
        let mut state = lock(&self.state);
        state.taken.states += 1;
        state.running.insert(*key);
        Some(snapshot)
    }

    /// Keeps the state of a replica that is still running.
    pub fn keep_snapshot(&self, key: &Key, snapshot: &dynamics::Snapshot) {
        match self.snapshots.keep(key, snapshot) {
            Ok(()) => _ = lock(&self.state).running.insert(*key),
            Err(error) => self.cannot_be_kept(&error),
        }
    }

    /// Drops the state of a replica that has ended.
    pub fn drop_snapshot(&self, key: &Key) {
        if lock(&self.state).running.remove(key) {
            self.snapshots.drop_of(key);
        }
    }

    /// Says how many replicas the sweep has.
    pub fn expect_replicas(&self, replicas: usize) {
        lock(&self.state).replicas = replicas;
    }

    /// What was taken over so far.
    pub fn taken(&self) -> Held {
        lock(&self.state).taken
    }

    /// Says what was taken over, if anything was.
    pub fn tell_taken(&self) {
        let state = lock(&self.state);
        let words = state.taken.words(state.replicas);
        if words.is_empty() {
            return;
        }
        let mut text = format!("{}: took over {words}", self.id);
        if let Some(begun) = state.begun {
            let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH + seconds(begun));
            write!(text, " from the run begun {} ago", ago(since.unwrap_or_default()))
                .expect("a string takes every text");
        }
        tell!("{text}; `--fresh` computes all anew");
    }

    /// What a run that stops here leaves, in words.
    pub fn what_is_kept(&self) -> String {
        let words = self.held();
        if words.is_empty() {
            return format!("nothing of {} was finished yet", self.id);
        }
        format!(
            "{} keeps {words}: run it again with the same options to go on from there; `--fresh` \
             begins anew",
            self.id
        )
    }

    /// What there is to go on from, in words.
    fn held(&self) -> String {
        let state = lock(&self.state);
        Held { states: state.running.len(), ..state.held }.words(state.replicas)
    }

    /// Does all that the journal is for, and says after a failure what is kept of it.
    pub fn until<T>(&self, work: impl FnOnce() -> Result<T>) -> Result<T> {
        let result = work();
        signals::forget();
        result.map_err(|problem| {
            self.flush();
            if !self.held().is_empty() {
                return problem.kept(self.what_is_kept());
            }
            // A network that was refused leaves nothing behind; whether this works is all the same.
            let is_trifle = |kind| matches!(kind, Kind::Begun | Kind::Look);
            let _ = lock(&self.log).discard_if(is_trifle);
            problem
        })
    }

    /// Sees to it that all that was kept outlasts the machine.
    pub fn flush(&self) {
        if let Err(error) = lock(&self.log).flush() {
            self.cannot_be_kept(&error);
        }
    }

    /// Writes down that this run began, once there is something to keep of it.
    fn begin(&self) {
        if std::mem::replace(&mut lock(&self.state).has_begun, true) {
            return;
        }
        let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
        let begun = Begun { at: now.as_secs(), program: key::program().to_owned() };
        self.append(Kind::Begun, &Key::of(Kind::Begun, &(begun.at, std::process::id())), &begun);
    }

    /// Whether a record could be added.
    fn append(&self, kind: Kind, key: &Key, value: &impl Serialize) -> bool {
        let payload = postcard::to_stdvec(value).map_err(std::io::Error::other);
        let added = payload.and_then(|payload| lock(&self.log).append(kind, key, &payload));
        if let Err(error) = &added {
            self.cannot_be_kept(error);
        }
        added.is_ok()
    }

    fn cannot_be_kept(&self, error: &std::io::Error) {
        if !std::mem::replace(&mut lock(&self.state).full, true) {
            tell!(
                "warning: {}: what is computed cannot be kept for a later run: {error}; this run goes \
                 on",
                self.id
            );
        }
    }
}

/// Whether a result of so many bytes, computed in some time, is worth being kept: writing it should
/// cost a few hundredths of that at most.
pub fn is_worth_keeping(bytes: f64, took: Duration) -> bool {
    bytes < FEW_BYTES || bytes / DISK < WORTH * took.as_secs_f64()
}

/// The lock of what is whole at every moment, whoever has panicked holding it.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn seconds(seconds: u64) -> Duration {
    Duration::from_secs(seconds)
}

/// A time that has passed, to one figure that matters.
fn ago(time: Duration) -> String {
    let seconds = time.as_secs();
    let (count, unit) = match seconds {
        0..60 => (seconds, "second"),
        60..3600 => (seconds / 60, "minute"),
        3600..86_400 => (seconds / 3600, "hour"),
        _ => (seconds / 86_400, "day"),
    };
    format!("{count} {unit}{}", if count == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_held_is_said_in_words() {
        let held =
            |replicas, curve, spectrum| Held { curve, spectrum, replicas, states: 0 }.words(80);
        assert_eq!(held(0, false, false), "");
        assert_eq!(held(37, false, false), "37 of 80 replicas");
        assert_eq!(held(0, true, true), "the curve and the spectrum");
        assert_eq!(held(37, true, true), "37 of 80 replicas, the curve and the spectrum");
        let running = Held { replicas: 3, states: 16, ..Held::default() };
        assert_eq!(running.words(80), "3 of 80 replicas and the states of 16 others");
    }

    #[test]
    fn times_are_told_by_their_largest_unit() {
        let of = |time| ago(seconds(time));
        assert_eq!(
            [of(0), of(1), of(61), of(7300), of(200_000)],
            ["0 seconds", "1 second", "1 minute", "2 hours", "2 days"]
        );
    }

    #[test]
    fn a_result_is_kept_where_writing_it_costs_little_of_computing_it() {
        assert!(is_worth_keeping(1e3, Duration::ZERO));
        assert!(is_worth_keeping(1.6e8, seconds(60)));
        assert!(!is_worth_keeping(3.2e7, seconds(2)));
    }

    #[test]
    fn results_of_any_size_come_back_to_the_last_bit() {
        let folder = tempfile::tempdir().unwrap();
        let numbers = [0.1, -0.0, f64::MIN_POSITIVE / 8.0, f64::INFINITY, f64::NAN, 1.0 / 3.0];
        let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        let key = Key::of(Kind::Curve, &1);
        Journal::open(folder.path(), "tiny", false).unwrap().keep(Kind::Curve, &key, &numbers);
        let journal = Journal::open(folder.path(), "tiny", false).unwrap();
        let taken: [f64; 6] = journal.take(Kind::Curve, &key).unwrap();
        assert_eq!(bits(&taken), bits(&numbers));
        assert_eq!(journal.taken(), Held { curve: true, ..Held::default() });
        assert_eq!(journal.take::<[f64; 6]>(Kind::Replica, &key), None, "it is of another kind");
        let fresh = Journal::open(folder.path(), "tiny", true).unwrap();
        assert_eq!(fresh.take::<[f64; 6]>(Kind::Curve, &key), None);
    }
}
