//! States of replicas that are still running, a file each, so that a kill costs a minute of them and
//! not hours. A file is replaced as a whole, and is a single record of a journal, so that one that was
//! not written to its end is none. It is not flushed: where the machine itself stops, an older state
//! or none is there, and costs time, never bits.

use std::collections::HashSet;
use std::fs::{self, File};
use std::path::{Path, PathBuf};

use dynamics::Snapshot;

use crate::{Key, Kind, record};

/// What the names of the files begin with.
const PREFIX: &str = "snapshot-";

/// The snapshots in the hidden folder of a run.
pub struct Snapshots {
    folder: PathBuf,
    /// Files that an earlier run has left.
    left: HashSet<PathBuf>,
}

/// Whether a file is called as a snapshot is, or one that is being written.
pub fn is_one(name: &str) -> bool {
    name.starts_with(PREFIX)
}

impl Snapshots {
    pub fn new(folder: &Path) -> Self {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        // A pipe would be waited for, and a link leads to what is not ours.
        let is_ours = |entry: &fs::DirEntry| {
            is_one(&entry.file_name().to_string_lossy())
                && entry.file_type().is_ok_and(|kind| kind.is_file())
        };
        let left = entries.filter(is_ours).map(|entry| entry.path()).collect();
        Self { folder: folder.to_owned(), left }
    }

    /// Keeps a state in place of an older one of the same replica.
    pub fn keep(&self, key: &Key, snapshot: &Snapshot) -> std::io::Result<()> {
        let payload = postcard::to_stdvec(snapshot).map_err(std::io::Error::other)?;
        let place = self.place(key);
        let new = place.with_extension("new");
        record::write(File::create(&new)?, Kind::Snapshot, key, &payload)?;
        fs::rename(new, place)
    }

    /// The last state of a replica, if one was kept.
    pub fn take(&self, key: &Key) -> Option<Snapshot> {
        let mut file = File::open(self.left.get(&self.place(key))?).ok()?;
        let n_bytes = file.metadata().ok()?.len();
        let contents = record::scan(&mut file, n_bytes).ok()?;
        let found = contents.records.iter().find(|found| found.key == *key)?;
        postcard::from_bytes(&record::payload(&mut file, found).ok()?).ok()
    }

    /// Drops the state of a replica that has ended.
    pub fn drop_of(&self, key: &Key) {
        let _ = fs::remove_file(self.place(key));
    }

    /// Drops all that an earlier run has left.
    pub fn clear(&mut self) {
        for path in self.left.drain() {
            let _ = fs::remove_file(path);
        }
    }

    fn place(&self, key: &Key) -> PathBuf {
        self.folder.join(format!("{PREFIX}{key}"))
    }
}

#[cfg(test)]
mod tests {
    use rustix::fs::{CWD, FileType, Mode, mknodat};

    use super::*;

    #[test]
    fn a_pipe_called_as_a_snapshot_is_not_waited_for() {
        let folder = tempfile::tempdir().unwrap();
        let key = Key([1; 32]);
        let pipe = folder.path().join(format!("{PREFIX}{key}"));
        mknodat(CWD, pipe, FileType::Fifo, Mode::RUSR | Mode::WUSR, 0).unwrap();
        assert!(Snapshots::new(folder.path()).take(&key).is_none());
    }
}
