//! The file `journal`: records that are only ever added, each written at once and soon flushed.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::{Error, ErrorKind, Result, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::record::{self, Found};
use crate::{Key, Kind};

/// Records that follow one another faster than this are flushed together: the system keeps what a
/// killed program has written, and only where the machine itself stops can those of this time be lost.
const BETWEEN_FLUSHES: Duration = Duration::from_millis(100);

/// The open journal.
pub struct Log {
    path: PathBuf,
    /// None before the first record: an empty file is nothing to go on from.
    file: Option<File>,
    /// What is in it, by key; of two records with one key the later.
    index: HashMap<Key, Found>,
    /// The runs that began it and went on with it, in their order.
    runs: Vec<Found>,
    /// Where the next record goes.
    end: u64,
    flushed: Instant,
}

/// What was found wrong when a journal was opened.
#[derive(Debug, PartialEq)]
pub enum Damage {
    /// So many bytes at the end were no whole record, and were cut off.
    CutOff(u64),
    /// So many records, or more, are damaged, and were skipped.
    Skipped(usize),
}

impl Log {
    /// Opens a journal, or begins one, and drops what is not whole.
    pub fn open(path: &Path) -> Result<(Self, Vec<Damage>)> {
        let new = |file, records: Vec<Found>, end| {
            let runs = records.iter().filter(|found| found.kind == Kind::Begun).copied().collect();
            let index = records.into_iter().map(|found| (found.key, found)).collect();
            Self { path: path.to_owned(), file, index, runs, end, flushed: Instant::now() }
        };
        let mut file = match plainly().read(true).write(true).open(path) {
            Err(error) if error.kind() == ErrorKind::NotFound => {
                return Ok((new(None, Vec::new(), 0), Vec::new()));
            }
            file => file?,
        };
        let n_bytes = file.metadata()?.len();
        check_alone(&file)?;
        let contents = record::scan(&mut file, n_bytes)?;
        let mut damage = Vec::new();
        if contents.damaged > 0 {
            damage.push(Damage::Skipped(contents.damaged));
        }
        if contents.end < n_bytes {
            file.set_len(contents.end)?;
            damage.push(Damage::CutOff(n_bytes - contents.end));
        }
        Ok((new(Some(file), contents.records, contents.end), damage))
    }

    /// What is known by a key.
    pub fn find(&self, key: &Key) -> Option<Found> {
        self.index.get(key).copied()
    }

    /// The run that wrote a record, among those that were there when the journal was opened.
    pub fn run_of(&self, found: &Found) -> Option<Found> {
        let before = self.runs.partition_point(|begun| begun.at < found.at);
        before.checked_sub(1).map(|last| self.runs[last])
    }

    pub fn payload(&mut self, found: &Found) -> Result<Vec<u8>> {
        let file = self.file.as_mut().ok_or_else(|| Error::from(ErrorKind::NotFound))?;
        record::payload(file, found)
    }

    /// Adds a record. After an error the journal is as it was before.
    pub fn append(&mut self, kind: Kind, key: &Key, payload: &[u8]) -> Result<()> {
        let file = match &mut self.file {
            Some(file) => file,
            none => none.insert(create(&self.path)?),
        };
        file.seek(SeekFrom::Start(self.end))?;
        let n_bytes = match record::write(&mut *file, kind, key, payload) {
            Ok(n_bytes) => n_bytes,
            Err(error) => {
                file.set_len(self.end)?;
                return Err(error);
            }
        };
        let length = payload.len() as u64;
        let at = self.end + record::HEAD as u64;
        self.index.insert(*key, Found { kind, key: *key, at, length });
        self.end += n_bytes;
        if self.flushed.elapsed() < BETWEEN_FLUSHES { Ok(()) } else { self.flush() }
    }

    /// Removes a journal that holds nothing but trifles.
    pub fn discard_if(&mut self, is_trifle: impl Fn(Kind) -> bool) -> Result<()> {
        if self.file.is_none() || !self.index.values().all(|found| is_trifle(found.kind)) {
            return Ok(());
        }
        self.file = None;
        self.index.clear();
        self.runs.clear();
        self.end = 0;
        std::fs::remove_file(&self.path)
    }

    /// Sees to it that all records outlast the machine.
    pub fn flush(&mut self) -> Result<()> {
        self.flushed = Instant::now();
        self.file.as_ref().map_or(Ok(()), File::sync_data)
    }
}

/// Options that follow no link: what a link leads to is not ours.
fn plainly() -> OpenOptions {
    use std::os::unix::fs::OpenOptionsExt;
    let no_follow = rustix::fs::OFlags::NOFOLLOW.bits();
    let mut options = OpenOptions::new();
    options.custom_flags(i32::try_from(no_follow).unwrap_or_default());
    options
}

/// Refuses a file that has another name elsewhere, before it is cut to what is whole in it.
fn check_alone(file: &File) -> Result<()> {
    use std::os::unix::fs::MetadataExt;
    let found = file.metadata()?;
    if found.is_file() && found.nlink() == 1 {
        return Ok(());
    }
    Err(Error::new(ErrorKind::InvalidData, "it is no plain file of its own"))
}

/// Begins a journal, and flushes the folder, since a file without a name is lost as well.
fn create(path: &Path) -> Result<File> {
    let file = OpenOptions::new().read(true).write(true).create_new(true).open(path)?;
    if let Some(folder) = path.parent() {
        // Not every system can open a folder; where it cannot, it flushes names with files.
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
    }
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_added_is_there_when_the_journal_is_opened_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("journal");
        let key = |byte| Key([byte; 32]);
        let (mut log, _) = Log::open(&path).unwrap();
        log.append(Kind::Curve, &key(1), b"curve").unwrap();
        log.append(Kind::Replica, &key(2), b"first").unwrap();
        log.append(Kind::Replica, &key(2), b"second").unwrap();
        let read = |log: &mut Log, byte| {
            let found = log.find(&key(byte))?;
            Some(log.payload(&found).unwrap())
        };
        for mut log in [log, Log::open(&path).unwrap().0] {
            assert_eq!(read(&mut log, 1), Some(b"curve".to_vec()));
            assert_eq!(read(&mut log, 2), Some(b"second".to_vec()));
            assert_eq!(read(&mut log, 3), None);
        }
    }

    #[test]
    fn a_torn_tail_is_cut_off_and_what_is_added_then_is_found() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("journal");
        let key = |byte| Key([byte; 32]);
        let (mut log, damage) = Log::open(&path).unwrap();
        assert_eq!(damage, []);
        log.append(Kind::Curve, &key(1), b"curve").unwrap();
        log.append(Kind::Replica, &key(2), b"torn").unwrap();
        let length = std::fs::metadata(&path).unwrap().len();
        OpenOptions::new().write(true).open(&path).unwrap().set_len(length - 1).unwrap();
        let (mut log, damage) = Log::open(&path).unwrap();
        assert!(matches!(damage[..], [Damage::CutOff(_)]), "{damage:?}");
        assert!(log.find(&key(1)).is_some() && log.find(&key(2)).is_none());
        log.append(Kind::Replica, &key(3), b"new").unwrap();
        let (log, damage) = Log::open(&path).unwrap();
        assert_eq!(damage, []);
        assert!(log.find(&key(1)).is_some() && log.find(&key(3)).is_some());
    }
}
