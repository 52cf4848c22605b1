//! The journal of one run: what it takes over, keeps, and says of both.

use std::collections::HashSet;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, SystemTime};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use user::{Problem, Result, Watch};

use crate::cache::Cache;
use crate::log::{Damage, Log};
use crate::snapshots::{self, Snapshots};
use crate::trajectory::{self, Trajectory};
use crate::{Held, Key, Kind};

/// The file in the hidden folder.
const JOURNAL: &str = "journal";

/// Whether a file in a hidden folder is called as what a journal consists of.
pub fn is_its(name: &str) -> bool {
    name == JOURNAL || snapshots::is_one(name) || trajectory::is_one(name)
}

/// A run that began.
#[derive(Serialize, Deserialize)]
struct Begun {
    /// Seconds since 1970.
    at: u64,
    /// What computed.
    program: String,
}

/// The journal of one run.
pub struct Journal {
    folder: PathBuf,
    id: String,
    program: String,
    watch: Arc<dyn Watch>,
    log: Mutex<Log>,
    snapshots: Snapshots,
    state: Mutex<State>,
    cache: Option<Cache>,
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
    /// What another program has computed is not taken over.
    ///
    /// # Errors
    /// Where the file cannot be read and written.
    pub fn open(
        folder: &Path,
        id: &str,
        program: &str,
        fresh: bool,
        watch: Arc<dyn Watch>,
    ) -> Result<Self> {
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
            trajectory::clear(folder);
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
                Damage::CutOff(bytes) => watch.noted(&format!(
                    "{id}: the last {bytes} bytes of the journal were not written to their end and \
                     are cut off"
                )),
                Damage::Skipped(records) => watch.warned(&format!(
                    "{id}: the journal is damaged in {records} places; what stood there is computed \
                     again"
                )),
            }
        }
        Ok(Self {
            folder: folder.to_owned(),
            id: id.to_owned(),
            program: program.to_owned(),
            watch,
            log: Mutex::new(log),
            snapshots,
            state: Mutex::default(),
            cache: None,
        })
    }

    /// The same beside a cache, from which it takes what it does not have and in which it keeps what other
    /// runs may want.
    #[must_use]
    pub fn with_cache(self, cache: Option<Cache>) -> Self {
        Self { cache, ..self }
    }

    /// The key of a kind of work that depends on some content, done by this program.
    pub fn key(&self, kind: Kind, content: &impl Serialize) -> Key {
        Key::of(&self.program, kind, content)
    }

    /// What was computed under a key, if it is there.
    pub fn take<T: DeserializeOwned>(&self, kind: Kind, key: &Key) -> Option<T> {
        self.take_own(kind, key).or_else(|| {
            let payload = self.cache_for(kind)?.get(kind, key)?;
            postcard::from_bytes(&payload).ok()
        })
    }

    fn cache_for(&self, kind: Kind) -> Option<&Cache> {
        self.cache.as_ref().filter(|_| Cache::is_for(kind))
    }

    fn take_own<T: DeserializeOwned>(&self, kind: Kind, key: &Key) -> Option<T> {
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
        if let Some(cache) = self.cache_for(kind)
            && let Ok(payload) = postcard::to_stdvec(value)
            && let Err(error) = cache.put(kind, key, &payload)
        {
            let text = "the curve cannot be kept for other runs in";
            let folder = cache.folder().display();
            self.watch.noted(&format!("{}: {text} {folder}: {error}", self.id));
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

    /// The states of a replica on the way, as far as an earlier run has left them.
    pub fn trajectory(&self, key: &Key) -> Trajectory {
        Trajectory::open(&self.folder, key)
    }

    /// Goes through all states on the way of a replica that has ended, each with its time.
    ///
    /// # Errors
    /// Where they are not all there, or cannot be read, or whoever takes them fails.
    pub fn states(
        &self,
        key: &Key,
        each: impl FnMut(f64, &[f64]) -> std::io::Result<()>,
    ) -> std::io::Result<()> {
        trajectory::read(&self.folder, key, each)
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
        self.watch.noted(&format!("{text}; `--fresh` computes all anew"));
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
        work().map_err(|problem| {
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
        let begun = Begun { at: now.as_secs(), program: self.program.clone() };
        self.append(Kind::Begun, &self.key(Kind::Begun, &(begun.at, std::process::id())), &begun);
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
            self.watch.warned(&format!(
                "{}: what is computed cannot be kept for a later run: {error}; this run goes on",
                self.id
            ));
        }
    }
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
    fn times_are_told_by_their_largest_unit() {
        let of = |time| ago(seconds(time));
        assert_eq!(
            [of(0), of(1), of(61), of(7300), of(200_000)],
            ["0 seconds", "1 second", "1 minute", "2 hours", "2 days"]
        );
    }

    #[test]
    fn results_of_any_size_come_back_to_the_last_bit() {
        let folder = tempfile::tempdir().unwrap();
        let numbers = [0.1, -0.0, f64::MIN_POSITIVE / 8.0, f64::INFINITY, f64::NAN, 1.0 / 3.0];
        let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        let open =
            |fresh| Journal::open(folder.path(), "tiny", "program", fresh, Arc::new(())).unwrap();
        let key = open(false).key(Kind::Curve, &1);
        open(false).keep(Kind::Curve, &key, &numbers);
        let journal = open(false);
        let taken: [f64; 6] = journal.take(Kind::Curve, &key).unwrap();
        assert_eq!(bits(&taken), bits(&numbers));
        assert_eq!(journal.taken(), Held { curve: true, curves: 1, ..Held::default() });
        assert_eq!(journal.take::<[f64; 6]>(Kind::Replica, &key), None, "it is of another kind");
        let fresh = open(true);
        assert_eq!(fresh.take::<[f64; 6]>(Kind::Curve, &key), None);
    }
}
