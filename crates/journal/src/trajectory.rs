//! States of one replica on the way, in a file of their own, so that neither memory nor the journal holds
//! them. A file is a sequence of records as those of a journal, each a run of states: what was not
//! written to its end is none, and a run that goes on knows from where on they are missing. It is not
//! flushed to the disk: where the machine itself stops, states may be missing, which costs time.

use std::fs::{self, File, OpenOptions};
use std::io::{Error, ErrorKind, Result};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::{Key, Kind, record};

/// What the names of the files begin with.
const PREFIX: &str = "series-";

/// Numbers that are gathered before they are written.
const GATHERED: usize = 1 << 15;

/// Whether a file is called as one of states is.
pub fn is_one(name: &str) -> bool {
    name.starts_with(PREFIX)
}

/// A run of states.
#[derive(Default, Serialize, Deserialize)]
struct Chunk {
    /// Number of the first one.
    first: u64,
    times: Vec<f64>,
    /// One after another, each of as many numbers.
    states: Vec<f64>,
    /// Whether the replica ended after them.
    is_last: bool,
}

/// The states of one replica.
pub struct Trajectory {
    path: PathBuf,
    key: Key,
    /// States that are there, from the first one without a gap; those gathered count.
    n_states: u64,
    is_whole: bool,
    gathered: Chunk,
    /// Whether states could not be written: whatever comes after them is not joined to the others.
    has_failed: bool,
}

impl Trajectory {
    /// Goes on with what an earlier run has left, if anything.
    pub fn open(folder: &Path, key: &Key) -> Self {
        let path = file(folder, key);
        let (n_states, is_whole) = go_through(&path, key, |_, _| Ok(())).unwrap_or_default();
        let gathered = Chunk { first: n_states, ..Chunk::default() };
        Self { path, key: *key, n_states, is_whole, gathered, has_failed: false }
    }

    /// How many states are there, from the first one on.
    pub fn n_states(&self) -> u64 {
        self.n_states
    }

    /// Whether these are all of them.
    pub fn is_whole(&self) -> bool {
        self.is_whole
    }

    /// Adds the state of this number, unless it is there; states come in their order.
    ///
    /// # Errors
    /// Where what was gathered cannot be written.
    pub fn add(&mut self, number: u64, time: f64, state: &[f64]) -> Result<()> {
        if number < self.n_states {
            return Ok(());
        }
        self.gathered.times.push(time);
        self.gathered.states.extend(state);
        self.n_states = number + 1;
        if self.gathered.states.len() >= GATHERED { self.write() } else { Ok(()) }
    }

    /// Writes what is gathered.
    ///
    /// # Errors
    /// Where it cannot be written.
    pub fn write(&mut self) -> Result<()> {
        let next = Chunk { first: self.n_states, ..Chunk::default() };
        let chunk = std::mem::replace(&mut self.gathered, next);
        if chunk.times.is_empty() && !chunk.is_last {
            return Ok(());
        }
        let written = append(&self.path, &self.key, &chunk);
        self.has_failed |= written.is_err();
        written
    }

    /// The replica has ended: these were all.
    ///
    /// # Errors
    /// Where they cannot be written.
    pub fn finish(&mut self) -> Result<()> {
        if !self.is_whole {
            self.gathered.is_last = true;
            self.write()?;
            self.is_whole = !self.has_failed;
        }
        Ok(())
    }
}

/// Goes through all states of a replica that has ended, each with its time.
///
/// # Errors
/// Where they are not all there, or cannot be read, or whoever takes them fails.
pub fn read(folder: &Path, key: &Key, each: impl FnMut(f64, &[f64]) -> Result<()>) -> Result<()> {
    match go_through(&file(folder, key), key, each)? {
        (_, true) => Ok(()),
        (_, false) => Err(Error::new(ErrorKind::InvalidData, "not all states are there")),
    }
}

fn file(folder: &Path, key: &Key) -> PathBuf {
    folder.join(format!("{PREFIX}{key}"))
}

/// Removes what an earlier run has left.
pub fn clear(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if is_file && is_one(&entry.file_name().to_string_lossy()) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

fn append(path: &Path, key: &Key, chunk: &Chunk) -> Result<()> {
    let payload = postcard::to_stdvec(chunk).map_err(Error::other)?;
    let file = OpenOptions::new().append(true).create(true).open(path)?;
    record::write(file, Kind::States, key, &payload).map(drop)
}

/// Goes through the states of a file from the first one, as far as there is no gap. Gives how many these
/// are, and whether they are all.
fn go_through(
    path: &Path,
    key: &Key,
    mut each: impl FnMut(f64, &[f64]) -> Result<()>,
) -> Result<(u64, bool)> {
    // A pipe would be waited for, and a link leads to what is not ours.
    if !fs::symlink_metadata(path)?.is_file() {
        return Err(Error::new(ErrorKind::InvalidInput, "it is no file"));
    }
    let mut file = File::open(path)?;
    let n_bytes = file.metadata()?.len();
    let contents = record::scan(&mut file, n_bytes)?;
    let is_ours = |found: &&record::Found| found.kind == Kind::States && found.key == *key;
    let (mut n_states, mut is_whole) = (0, false);
    for found in contents.records.iter().filter(is_ours) {
        let payload = record::payload(&mut file, found)?;
        let chunk: Chunk = postcard::from_bytes(&payload).map_err(Error::other)?;
        let end = chunk.first + chunk.times.len() as u64;
        if chunk.first > n_states || end < n_states {
            continue;
        }
        let width = chunk.states.len() / chunk.times.len().max(1);
        let skipped = usize::try_from(n_states - chunk.first).map_err(Error::other)?;
        let states = chunk.states.chunks_exact(width.max(1));
        chunk.times.iter().zip(states).skip(skipped).try_for_each(|(&t, state)| each(t, state))?;
        (n_states, is_whole) = (end, chunk.is_last);
    }
    Ok((n_states, is_whole))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key() -> Key {
        Key::of("program", Kind::States, &1)
    }

    fn state(number: u64) -> (f64, [f64; 2]) {
        let x = number as f64;
        (0.1 * x, [x.sin(), -x])
    }

    fn add(trajectory: &mut Trajectory, numbers: std::ops::Range<u64>) {
        for number in numbers {
            let (time, state) = state(number);
            trajectory.add(number, time, &state).unwrap();
        }
    }

    fn all_of(folder: &Path) -> Result<Vec<(f64, [f64; 2])>> {
        let mut all = Vec::new();
        read(folder, &key(), |time, state| {
            all.push((time, [state[0], state[1]]));
            Ok(())
        })?;
        Ok(all)
    }

    #[test]
    fn states_come_back_as_they_were_told_wherever_a_run_was_stopped() {
        let folder = tempfile::tempdir().unwrap();
        let all: Vec<_> = (0..300).map(state).collect();
        let mut first = Trajectory::open(folder.path(), &key());
        add(&mut first, 0..100);
        first.write().unwrap();
        add(&mut first, 100..170);
        // Killed with seventy states gathered: they are lost, and told again from the last snapshot on.
        drop(first);
        let mut second = Trajectory::open(folder.path(), &key());
        assert_eq!((second.n_states(), second.is_whole()), (100, false));
        add(&mut second, 60..300);
        second.finish().unwrap();
        assert_eq!(all_of(folder.path()).unwrap(), all);
        let third = Trajectory::open(folder.path(), &key());
        assert_eq!((third.n_states(), third.is_whole()), (300, true));
    }

    #[test]
    fn a_run_of_states_that_is_damaged_is_missing_until_it_is_told_again() {
        let folder = tempfile::tempdir().unwrap();
        let mut first = Trajectory::open(folder.path(), &key());
        for part in [0..10, 10..20, 20..30] {
            add(&mut first, part);
            first.write().unwrap();
        }
        first.finish().unwrap();
        let mut bytes = fs::read(&first.path).unwrap();
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        fs::write(&first.path, bytes).unwrap();
        assert!(all_of(folder.path()).is_err(), "what is missing is not passed over");
        let mut second = Trajectory::open(folder.path(), &key());
        assert_eq!((second.n_states(), second.is_whole()), (10, false));
        add(&mut second, 0..30);
        second.finish().unwrap();
        assert_eq!(all_of(folder.path()).unwrap(), (0..30).map(state).collect::<Vec<_>>());
    }
}
