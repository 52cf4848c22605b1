//! What runs that were killed have left: worth going on from, worth adopting, or to be cleared away.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use user::text::shown;
use user::{Problem, Result, Watch};

use crate::lock::{Lock, holds_work};
use crate::manifest::{Manifest, Owner};
use crate::standing::Head;
use crate::{carry, exchange, name};

/// How many letters 0.1.0 put after the name of an unfinished folder, so that no two were the same.
const LETTERS_OF_0_1_0: usize = 6;
/// What it called the older results between two renames.
const REPLACED_OF_0_1_0: &str = "-replaced";

/// Clears away the hidden folders that dead runs of any experiment have left without work in them.
pub fn of_dead_runs(results: &Path, watch: &dyn Watch) {
    for hidden in entries(results) {
        let name = hidden.file_name().unwrap_or_default().to_string_lossy();
        if name::id_of_hidden(&name).is_some() && !holds_work(&hidden) {
            remove_dead(&hidden, watch);
        }
    }
}

/// Removes a hidden folder unless somebody works in it.
pub fn remove_dead(hidden: &Path, watch: &dyn Watch) {
    if let Some(lock) = Lock::take_over(hidden) {
        lock.remove(watch);
    }
}

/// Adopts or clears away what 0.1.0 left of an experiment: whole folders are put in place if nothing
/// is there, the newer before the one that it replaced.
pub fn of_version_0_1_0(results: &Path, id: &str, place: &Path, watch: &dyn Watch) -> Result<()> {
    let mut left: Vec<PathBuf> = entries(results).filter(|path| is_of_0_1_0(path, id)).collect();
    left.sort_by_key(|path| path.to_string_lossy().ends_with(REPLACED_OF_0_1_0));
    for folder in &left {
        let is_whole = Head::read(folder).is_ok_and(|head| head.id == id);
        if is_whole && place.symlink_metadata().is_err() {
            exchange::put(folder, place).map_err(|error| {
                Problem::from_error("cannot be put in place", error).in_file(folder)
            })?;
            let place = shown(place);
            watch.noted(&format!("{place}: whole results of a killed run are put in place"));
        } else if place.is_dir() || holds_ours_only(folder) {
            // What is a user's in it goes to the results in place, of which there are some.
            if let Err(error) = carry::move_rest(folder, place, watch) {
                let folder = shown(folder);
                watch.warned(&format!("{folder} cannot be cleared away: {error}"));
            }
        }
    }
    Ok(())
}

fn is_of_0_1_0(path: &Path, id: &str) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let letters = name.strip_prefix(&format!(".{id}.unfinished-"));
    letters.is_some_and(|letters| {
        let letters = letters.strip_suffix(REPLACED_OF_0_1_0).unwrap_or(letters);
        letters.len() == LETTERS_OF_0_1_0 && letters.chars().all(|c| c.is_ascii_alphanumeric())
    })
}

fn holds_ours_only(folder: &Path) -> bool {
    let Ok(manifest) = Manifest::of(folder) else { return false };
    let is_ours = |name: &OsStr| matches!(manifest.owner(folder, name), Ok(Owner::Ours));
    entries(folder).all(|path| path.file_name().is_some_and(is_ours))
}

/// What is in a folder, if it can be read.
fn entries(folder: &Path) -> impl Iterator<Item = PathBuf> {
    fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path())
}
