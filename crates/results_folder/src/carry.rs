//! What a user put into a folder of results, or edited in it, comes along to the new one.
//!
//! Before the exchange it is linked into the new folder, so that it is in place at every moment;
//! afterwards what could not be linked is moved. A name that is taken in the new folder gets `.kept`
//! before its ending, which is said. The old folder is then emptied file by file and never removed
//! with anything in it that has not come along.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::io::{Error, ErrorKind, Result};
use std::path::Path;

use rustix::fs::{Access, access};

use user::text::shown;
use user::{Problem, Watch};

use crate::exchange::{self, flush};
use crate::manifest::{Manifest, Owner};
use crate::standing::{ALL_ACCESS, Identity, SUMMARY};

/// How an entry gets into the new folder.
#[derive(Clone, Copy, PartialEq)]
enum By {
    Link,
    Move,
}

/// Refuses what could not come along or could not be told from a user's: folders that we may not write
/// to, files of ours that we may not read, and whatever is mounted here.
pub fn check(folder: &Path) -> user::Result<()> {
    let manifest = Manifest::of(folder).ok();
    for name in names(folder).unwrap_or_default() {
        let file = folder.join(&name);
        let is_ours = manifest.as_ref().is_some_and(|manifest| manifest.lists(&name));
        if is_ours
            && !is_folder(&file)
            && let Err(error) = access(&file, Access::READ_OK)
        {
            return Err(refused(&file, "cannot be told from an edited file", &error.to_string()));
        }
    }
    check_movable(folder)
}

fn check_movable(folder: &Path) -> user::Result<()> {
    for name in names(folder).unwrap_or_default() {
        let inner = folder.join(name);
        if exchange::is_mount(&inner) {
            return Err(refused(&inner, STAYS, "a file system is mounted there"));
        }
        if is_folder(&inner) {
            access(&inner, ALL_ACCESS)
                .map_err(|error| refused(&inner, STAYS, &error.to_string()))?;
            check_movable(&inner)?;
        }
    }
    Ok(())
}

fn refused(place: &Path, what: &str, why: &str) -> Problem {
    let hint = "move it away, or write elsewhere: `--results FOLDER`";
    Problem::new(format!("{what}: {why}")).in_file(place).hint(hint)
}

const STAYS: &str = "could not come along when the results around it are replaced";

/// Links what is a user's into the new folder. What cannot be linked is moved later.
pub fn link_along(old: &Path, new: &Path, watch: &dyn Watch) {
    for (name, owner) in owned(old, new).unwrap_or_default() {
        if let Ok(owner @ (Owner::Edited | Owner::User)) = owner {
            // Whatever goes wrong here is tried again, and told, when the rest is moved.
            let _ = lodge(&old.join(&name), new, &name, owner == Owner::Edited, By::Link, watch);
        }
    }
    let _ = flush(new);
}

/// Moves what has not come along yet and removes the old folder.
pub fn move_rest(old: &Path, new: &Path, watch: &dyn Watch) -> Result<()> {
    let (ours, others): (Vec<_>, Vec<_>) =
        owned(old, new)?.into_iter().partition(|(_, owner)| matches!(owner, Ok(Owner::Ours)));
    let mut unknown = None;
    for (name, owner) in &others {
        match owner {
            Ok(owner) => {
                lodge(&old.join(name), new, name, *owner == Owner::Edited, By::Move, watch)?;
            }
            Err(error) => unknown = Some(Error::new(error.kind(), error.to_string())),
        }
    }
    if !others.is_empty() {
        flush(new)?;
    }
    if let Some(error) = unknown {
        return Err(error);
    }
    // The summary goes last: without it, a later run could not tell the others from a user's.
    let (summary, files): (Vec<_>, Vec<_>) =
        ours.iter().map(|(name, _)| name).partition(|name| *name == SUMMARY);
    files.iter().chain(&summary).try_for_each(|name| fs::remove_file(old.join(name)))?;
    fs::remove_dir(old)
}

/// What is in a folder of results, and whose, where that can be told. What keeps its own name in the
/// new folder comes first, so that nothing that needs another one takes it.
fn owned(folder: &Path, new: &Path) -> Result<Vec<(OsString, Result<Owner>)>> {
    let (manifest, others) = (Manifest::of(folder)?, Manifest::of(new)?);
    let of = |name: OsString| {
        let owner = manifest.owner(folder, &name);
        (name, owner)
    };
    let mut all: Vec<_> = names(folder)?.into_iter().map(of).collect();
    let needs_another = |name: &OsStr, owner: &Result<Owner>| {
        matches!(owner, Ok(Owner::Edited)) || others.lists(name)
    };
    all.sort_by_cached_key(|(name, owner)| (needs_another(name, owner), name.clone()));
    Ok(all)
}

fn names(folder: &Path) -> Result<Vec<OsString>> {
    fs::read_dir(folder)?.map(|entry| Ok(entry?.file_name())).collect()
}

/// Brings one entry into a folder, under its own name or the next that is free.
fn lodge(
    from: &Path,
    folder: &Path,
    name: &OsStr,
    was_edited: bool,
    by: By,
    watch: &dyn Watch,
) -> Result<()> {
    for number in usize::from(was_edited).. {
        let to = folder.join(kept(name, number));
        if to.symlink_metadata().is_err() {
            bring(from, &to, by)?;
        } else if is_same(from, &to)? {
            if by == By::Move {
                fs::remove_file(from)?;
            }
            return Ok(());
        } else if is_folder(from) && is_folder(&to) && (number == 0 || is_part(&to, from)?) {
            // Linked before, or made by a run that was killed while it was linking.
            for inner in names(from)? {
                lodge(&from.join(&inner), &to, &inner, false, by, watch)?;
            }
            return if by == By::Move { fs::remove_dir(from) } else { Ok(()) };
        } else {
            continue;
        }
        if number > 0 {
            let why = if was_edited { "was edited since it was written" } else { "is in the way" };
            let kept = shown(to.file_name().unwrap_or_default());
            watch.noted(&format!("{} {why}; it is kept as {kept}", shown(name)));
        }
        return Ok(());
    }
    Err(ErrorKind::AlreadyExists.into())
}

fn bring(from: &Path, to: &Path, by: By) -> Result<()> {
    let kind = fs::symlink_metadata(from)?.file_type();
    match by {
        By::Move => fs::rename(from, to),
        By::Link if kind.is_file() => fs::hard_link(from, to),
        By::Link if kind.is_dir() => {
            fs::create_dir(to)?;
            for inner in names(from)? {
                bring(&from.join(&inner), &to.join(&inner), by)?;
            }
            fs::set_permissions(to, fs::metadata(from)?.permissions())?;
            flush(to)
        }
        By::Link if kind.is_symlink() => std::os::unix::fs::symlink(fs::read_link(from)?, to),
        By::Link => Err(Error::from(ErrorKind::Unsupported)),
    }
}

/// Whether an entry has come along already: the same file, or a link to the same.
fn is_same(a: &Path, b: &Path) -> Result<bool> {
    let is_link = |path: &Path| fs::symlink_metadata(path).map(|found| found.is_symlink());
    if is_link(a)? && is_link(b)? {
        return Ok(fs::read_link(a)? == fs::read_link(b)?);
    }
    Ok(Identity::at(a)? == Identity::at(b)?)
}

/// Whether a folder holds nothing but what another one holds, in part or whole.
fn is_part(folder: &Path, of: &Path) -> Result<bool> {
    for name in names(folder)? {
        let (a, b) = (folder.join(&name), of.join(&name));
        let is_there = b.symlink_metadata().is_ok();
        if !is_there || !(is_same(&a, &b)? || (is_folder(&a) && is_folder(&b) && is_part(&a, &b)?))
        {
            return Ok(false);
        }
    }
    Ok(true)
}

fn is_folder(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|found| found.is_dir())
}

/// The name itself, or with `.kept`, `.kept-2`, … before its ending.
fn kept(name: &OsStr, number: usize) -> OsString {
    let path = Path::new(name);
    let (Some(stem), true) = (path.file_stem(), number > 0) else { return name.to_owned() };
    let mut kept = stem.to_owned();
    kept.push(".kept");
    if number > 1 {
        kept.push(format!("-{number}"));
    }
    if let Some(ending) = path.extension() {
        kept.push(".");
        kept.push(ending);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    const SUMMARY_TEXT: &str = "{\n  \"a\": 0.1,\n  \"provenance\": {\n    \"seed\": 1\n  }\n}\n";

    #[test]
    fn a_taken_name_is_kept_beside() {
        let of = |name: &str, number| kept(OsStr::new(name), number).into_string().unwrap();
        assert_eq!(of("sweep.csv", 0), "sweep.csv");
        assert_eq!(of("sweep.csv", 1), "sweep.kept.csv");
        assert_eq!(of("sweep.csv", 2), "sweep.kept-2.csv");
        assert_eq!(of(".notes", 1), ".notes.kept");
    }

    #[test]
    fn what_is_a_users_is_in_the_new_folder_before_and_after_the_old_one_goes() {
        let place = tempfile::tempdir().unwrap();
        let [old, new] = ["old", "new"].map(|name| place.path().join(name));
        for folder in [&old, &new] {
            fs::create_dir(folder).unwrap();
            fs::write(folder.join("msf.csv"), "ours").unwrap();
            fs::write(folder.join("sweep.csv"), "ours").unwrap();
            fs::write(folder.join("summary.json"), SUMMARY_TEXT).unwrap();
            crate::manifest::seal(folder).unwrap();
        }
        fs::write(old.join("sweep.csv"), "edited").unwrap();
        let summary = fs::read_to_string(old.join("summary.json")).unwrap();
        fs::write(old.join("summary.json"), summary.replace("0.1", "0.2")).unwrap();
        fs::create_dir_all(old.join("drafts/deep")).unwrap();
        fs::write(old.join("drafts/deep/one.tex"), "years of work").unwrap();
        fs::write(old.join("notes.txt"), "mine").unwrap();
        let check = || {
            let read = |name: &str| fs::read_to_string(new.join(name)).unwrap();
            assert_eq!(read("notes.txt"), "mine");
            assert_eq!(read("drafts/deep/one.tex"), "years of work");
            assert_eq!(read("sweep.kept.csv"), "edited");
            assert_eq!(read("sweep.csv"), "ours");
            assert!(read("summary.kept.json").contains("0.2"));
            assert!(read("summary.json").contains("0.1"));
        };
        link_along(&old, &new, &());
        check();
        // Something that comes in between the two is not lost either.
        fs::write(old.join("drafts/two.tex"), "a late thought").unwrap();
        fs::write(old.join("msf.csv"), "a late edit").unwrap();
        move_rest(&old, &new, &()).unwrap();
        check();
        assert_eq!(fs::read_to_string(new.join("drafts/two.tex")).unwrap(), "a late thought");
        assert_eq!(fs::read_to_string(new.join("msf.kept.csv")).unwrap(), "a late edit");
        assert!(!old.exists());
    }
}
