//! The hidden folder in which one run at a time works on an experiment.
//!
//! The lock is on the file `lock` in it and goes with the process that holds it, however that ends.
//! Whoever gets the lock of a file that was removed in the meantime has got nothing, and tries again.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Read, Seek, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use user::text::shown;
use user::{Problem, Watch};

use crate::name::{FILES, REPLACED, WHOLE};
use crate::standing::{Identity, Origin};

/// The file that is locked.
pub const LOCK: &str = "lock";

/// How often a lock is tried that others remove at the same time.
const TRIES: usize = 1000;

/// A folder that this process alone works in.
pub struct Lock {
    folder: PathBuf,
    /// Kept open, since the lock goes when it is closed.
    _file: File,
}

/// Why a folder cannot be locked.
pub enum Refusal {
    Io(std::io::Error),
    Problem(Problem),
}

impl From<std::io::Error> for Refusal {
    fn from(error: std::io::Error) -> Self {
        Self::Io(error)
    }
}

/// Who works in a folder, for whom else would like to.
#[derive(Serialize, Deserialize)]
struct Holder {
    process: u32,
    host: String,
    #[serde(flatten)]
    origin: Origin,
}

impl Lock {
    /// Locks a folder, which is made if need be.
    pub fn take(folder: &Path, origin: &Origin, watch: &dyn Watch) -> Result<Self, Refusal> {
        for _ in 0..TRIES {
            match fs::create_dir(folder) {
                Err(error) if error.kind() != ErrorKind::AlreadyExists => return Err(error.into()),
                _ => check_ours(folder)?,
            }
            check_plain(&folder.join(LOCK))?;
            let options = OpenOptions::new().read(true).write(true).create(true).clone();
            let file = match options.open(folder.join(LOCK)) {
                Err(error) if error.kind() == ErrorKind::NotFound => continue,
                file => file?,
            };
            if !lock(&file, folder, watch)? {
                return Err(Refusal::Problem(held(folder)));
            }
            if Identity::at(&folder.join(LOCK)).ok() == Some(Identity::of(&file.metadata()?)) {
                return Self::own(folder, file, origin);
            }
        }
        Err(std::io::Error::other("its lock is removed as often as it is taken").into())
    }

    /// Locks a folder that is there and that nobody works in.
    pub fn take_over(folder: &Path) -> Option<Self> {
        if !fs::symlink_metadata(folder).is_ok_and(|found| found.is_dir()) {
            return None;
        }
        let file = open(folder)?;
        file.try_lock().ok()?;
        let is_same =
            Identity::at(&folder.join(LOCK)).ok()? == Identity::of(&file.metadata().ok()?);
        is_same.then(|| Self { folder: folder.to_owned(), _file: file })
    }

    /// Writes down who holds the lock, unless there is work of another experiment to go on from.
    fn own(folder: &Path, mut file: File, origin: &Origin) -> Result<Self, Refusal> {
        let mut text = String::new();
        let earlier = file.read_to_string(&mut text).ok().and_then(|_| holder(&text));
        let other = earlier.filter(|earlier| !earlier.origin.is_same(origin, folder));
        if let Some(other) = other.filter(|_| holds_work(folder)) {
            let message = format!(
                "holds unfinished work of {}, which this would replace",
                other.origin.shown(folder)
            );
            let hint = "run that again to finish it, remove the folder to do without it, or write \
                        elsewhere: `--results FOLDER`";
            return Err(Refusal::Problem(Problem::new(message).in_file(folder).hint(hint)));
        }
        let host = rustix::system::uname().nodename().to_string_lossy().into_owned();
        let holder = Holder { process: std::process::id(), host, origin: origin.clone() };
        file.rewind()?;
        file.set_len(0)?;
        file.write_all(&serde_json::to_vec(&holder).map_err(std::io::Error::other)?)?;
        Ok(Self { folder: folder.to_owned(), _file: file })
    }

    /// The folder that is locked.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Removes what is ours in the folder, then the lock and the folder. The lock stays beside anything
    /// that cannot be removed or is not ours, so that the next run knows the folder. Where another
    /// process has come in between, the folder is its own by then and stays.
    pub fn remove(self, watch: &dyn Watch) {
        let Ok(entries) = fs::read_dir(&self.folder) else { return };
        let mut is_empty = true;
        for entry in entries {
            let Ok(entry) = entry else { return };
            let (path, name) = (entry.path(), entry.file_name());
            if name == LOCK {
                continue;
            }
            let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
            let removed = match (is_made_here(&name.to_string_lossy(), is_folder), is_folder) {
                (false, _) => false,
                (true, true) => fs::remove_dir_all(&path).is_ok(),
                (true, false) => fs::remove_file(&path).is_ok(),
            };
            if !removed {
                let path = shown(&path);
                watch.warned(&format!("{path} stays in the folder of an unfinished run"));
                is_empty = false;
            }
        }
        if is_empty {
            let _ = fs::remove_file(self.folder.join(LOCK));
            let _ = fs::remove_dir(&self.folder);
        }
    }
}

/// Whether a folder or a file in a hidden folder is called as what runs leave there.
fn is_made_here(name: &str, is_folder: bool) -> bool {
    let folders = ["trial", FILES, WHOLE, REPLACED];
    if is_folder { folders.contains(&name) } else { journal::is_its(name) }
}

/// The lock of a folder, if it is one: a pipe would be waited for.
fn open(folder: &Path) -> Option<File> {
    let path = folder.join(LOCK);
    is_plain(&path).filter(|is_plain| *is_plain).and_then(|_| File::open(path).ok())
}

/// Whether a path is a file of its own, neither a link nor known by another name elsewhere, which
/// would be written to as well; none if there is nothing.
fn is_plain(path: &Path) -> Option<bool> {
    use std::os::unix::fs::MetadataExt;
    let found = fs::symlink_metadata(path).ok()?;
    Some(found.is_file() && found.nlink() == 1)
}

/// Refuses a lock that is none of ours, before it is written to.
fn check_plain(path: &Path) -> Result<(), Refusal> {
    if is_plain(path) != Some(false) {
        return Ok(());
    }
    let message = "is where a run says that it is at work, and is no plain file of its own";
    let hint = "move it away, or write elsewhere: `--results FOLDER`";
    Err(Refusal::Problem(Problem::new(message).in_file(path).hint(hint)))
}

/// Whether a run works in a folder at this moment.
pub fn is_held(folder: &Path) -> bool {
    let Some(file) = open(folder) else { return false };
    matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock))
}

/// Whether the lock was free. File systems without locks let everybody in, which is said.
fn lock(file: &File, folder: &Path, watch: &dyn Watch) -> std::io::Result<bool> {
    match file.try_lock() {
        Ok(()) => Ok(true),
        Err(TryLockError::WouldBlock) => Ok(false),
        Err(TryLockError::Error(error)) if knows_no_locks(&error) => {
            watch.warned(&format!(
                "the file system of {} knows no locks ({error}): two runs of one experiment would \
                 disturb each other",
                shown(folder)
            ));
            Ok(true)
        }
        Err(TryLockError::Error(error)) => Err(error),
    }
}

fn knows_no_locks(error: &std::io::Error) -> bool {
    use rustix::io::Errno;
    let of = |errno: Errno| error.raw_os_error() == Some(errno.raw_os_error());
    error.kind() == ErrorKind::Unsupported || of(Errno::NOLCK) || of(Errno::NOTSUP)
}

/// Whether what stands at the name of a hidden folder is one: it has a lock, or nothing but what a run
/// leaves there.
fn check_ours(folder: &Path) -> Result<(), Refusal> {
    let is_folder = fs::symlink_metadata(folder).is_ok_and(|found| found.is_dir());
    let is_ours = || folder.join(LOCK).symlink_metadata().is_ok() || holds_nothing_but_ours(folder);
    // One that has just gone is no reason to refuse; the next try makes it anew.
    if folder.symlink_metadata().is_err() || (is_folder && is_ours()) {
        return Ok(());
    }
    let message = "is where the run would be put together, and was not made by eigensync";
    let hint = "move it away, or write elsewhere: `--results FOLDER`";
    Err(Refusal::Problem(Problem::new(message).in_file(folder).hint(hint)))
}

/// Whether there is nothing else in a folder than what a run leaves that could not clear up.
fn holds_nothing_but_ours(folder: &Path) -> bool {
    let ours = |entry: std::io::Result<fs::DirEntry>| {
        entry.is_ok_and(|entry| {
            let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
            is_made_here(&entry.file_name().to_string_lossy(), is_folder)
        })
    };
    fs::read_dir(folder).is_ok_and(|mut entries| entries.all(ours))
}

fn holder(text: &str) -> Option<Holder> {
    serde_json::from_str(text).ok()
}

fn held(folder: &Path) -> Problem {
    let who = fs::read_to_string(folder.join(LOCK)).ok().and_then(|text| holder(&text));
    let who = who.map_or_else(String::new, |holder| {
        format!(": process {} on {}", holder.process, holder.host)
    });
    let message = format!("another run of the same experiment works here{who}");
    let hint = "wait for it, or write elsewhere: `--results FOLDER`";
    Problem::new(message).in_file(folder).hint(hint)
}

/// Whether there is anything in a hidden folder that a later run could go on from.
pub fn holds_work(hidden: &Path) -> bool {
    let entries = fs::read_dir(hidden).into_iter().flatten().flatten();
    let worthless = ["trial", LOCK, FILES];
    entries.into_iter().any(|entry| !worthless.iter().any(|name| entry.file_name() == *name))
}
