//! Folders put in place in one step, and flushed, so that neither a kill nor a power cut can leave
//! half of it. Where the system cannot exchange two names in one step, two renames take its place,
//! the first of which is undone if the second fails.

use std::fs::{self, File};
use std::io::{ErrorKind, Result, Write};
use std::path::Path;

use rustix::fs::{CWD, RenameFlags, renameat_with};
use rustix::io::Errno;

use crate::standing::Identity;

/// Does in a folder all that will be done in the end: writes and flushes a file, makes folders and
/// exchanges them.
pub fn try_out(hidden: &Path) -> Result<()> {
    let trial = hidden.join("trial");
    clear(&trial)?;
    let [new, old, aside] = ["new", "old", "aside"].map(|name| trial.join(name));
    fs::create_dir(&trial)
        .and_then(|()| fs::create_dir(&new))
        .and_then(|()| fs::create_dir(&old))?;
    let mut file = File::create(new.join("file"))?;
    file.write_all(&[b' '; 4096]).and_then(|()| file.sync_all())?;
    swap(&new, &old, &aside, Identity::at(&old)?)?;
    flush(hidden)?;
    clear(&trial)
}

/// Whether a file system is mounted at a path, or a folder or file from elsewhere: it can be neither
/// renamed nor removed.
pub fn is_mount(path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let device = |path: &Path| fs::symlink_metadata(path).map(|found| found.dev());
    let is_other = matches!((device(path), device(parent(path))), (Ok(a), Ok(b)) if a != b);
    is_other || is_mount_root(path)
}

/// Whether the system says so; what is bound here from the same file system shows in nothing else.
#[cfg(target_os = "linux")]
fn is_mount_root(path: &Path) -> bool {
    use rustix::fs::{AtFlags, StatxAttributes, StatxFlags, statx};
    let found = statx(CWD, path, AtFlags::SYMLINK_NOFOLLOW, StatxFlags::empty());
    found.is_ok_and(|found| found.stx_attributes.contains(StatxAttributes::MOUNT_ROOT))
}

#[cfg(not(target_os = "linux"))]
fn is_mount_root(_: &Path) -> bool {
    false
}

/// Gives a new folder the mode and the owner of the one that it replaces, as far as that is allowed.
pub fn resemble(old: &Path, new: &Path) {
    use std::os::unix::fs::{MetadataExt, chown};
    let Ok(found) = fs::metadata(old) else { return };
    // A folder of another mode or owner is no reason to fail; the results are whole all the same.
    let _ = chown(new, Some(found.uid()), Some(found.gid()));
    let _ = fs::set_permissions(new, found.permissions());
}

/// Puts a folder where nothing is.
pub fn put(from: &Path, to: &Path) -> Result<()> {
    match renameat_with(CWD, from, CWD, to, RenameFlags::NOREPLACE) {
        Err(error) if is_unknown(error) => {
            if to.symlink_metadata().is_ok() {
                return Err(ErrorKind::AlreadyExists.into());
            }
            fs::rename(from, to)?;
        }
        done => done?,
    }
    flush_parent(to)
}

/// Exchanges a new folder for the one in place, which must still be the one that was looked at:
/// another is left there, with the error `AlreadyExists`. The old one is afterwards where the new one
/// was, or aside.
pub fn swap(new: &Path, place: &Path, aside: &Path, old: Identity) -> Result<()> {
    match renameat_with(CWD, new, CWD, place, RenameFlags::EXCHANGE) {
        Ok(()) if Identity::at(new)? != old => {
            renameat_with(CWD, new, CWD, place, RenameFlags::EXCHANGE)?;
            return Err(ErrorKind::AlreadyExists.into());
        }
        Err(error) if is_unknown(error) => in_two_steps(new, place, aside, old)?,
        done => done?,
    }
    flush_parent(place)
}

fn in_two_steps(new: &Path, place: &Path, aside: &Path, old: Identity) -> Result<()> {
    fs::rename(place, aside)?;
    let placed = match Identity::at(aside)? == old {
        true => fs::rename(new, place),
        false => Err(ErrorKind::AlreadyExists.into()),
    };
    placed.inspect_err(|_| {
        // The error that is told is the first one; the next run tries this again.
        let _ = fs::rename(aside, place);
    })
}

/// Whether the system or the file system does not know this kind of rename.
fn is_unknown(error: Errno) -> bool {
    [Errno::INVAL, Errno::NOSYS, Errno::NOTSUP].contains(&error)
}

/// Flushes the names in a folder.
pub fn flush(folder: &Path) -> Result<()> {
    match File::open(folder)?.sync_all() {
        // Some file systems cannot flush a folder and say so.
        Err(error) if error.kind() == ErrorKind::InvalidInput => Ok(()),
        done => done,
    }
}

fn flush_parent(path: &Path) -> Result<()> {
    flush(parent(path))
}

/// The folder that something is in, whose name may be all there is of its path.
pub fn parent(path: &Path) -> &Path {
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty());
    parent.unwrap_or(Path::new("."))
}

/// Removes a folder that is ours alone, if it is there.
pub fn clear(folder: &Path) -> std::io::Result<()> {
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}
