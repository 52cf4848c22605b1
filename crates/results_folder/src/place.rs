//! The place that one run reserves, and how its work gets there.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use user::text::shown;
use user::{Problem, Result, Watch};

use crate::exchange::clear;
use crate::folder::Folder;
use crate::lock::{self, Lock};
use crate::name::{FILES, REPLACED, WHOLE};
use crate::standing::{Origin, Ours, standing, unwritable};
use crate::{carry, exchange, leftovers, manifest, name};

/// A place for results that this run alone writes to.
pub struct Place {
    results: PathBuf,
    id: String,
    origin: Origin,
    quick: bool,
    watch: Arc<dyn Watch>,
    /// The hidden folder; released when the place is dropped.
    lock: Option<Lock>,
}

impl Place {
    /// Reserves the place of an experiment and tries all that is needed to put results there, before
    /// hours are spent on what could not be kept. `file` is what the results are made from.
    pub fn reserve(
        results: &Path,
        id: &str,
        (command, file): (&'static str, &Path),
        quick: bool,
        watch: Arc<dyn Watch>,
    ) -> Result<Self> {
        let failed = |error| unwritable(results, id, &error);
        fs::create_dir_all(results).map_err(failed)?;
        let origin = Origin::new(command, file, &results.join(id))?;
        let results = &within(results, id).map_err(failed)?;
        let (id_owned, results_owned) = (id.to_owned(), results.to_owned());
        let mut place =
            Self { results: results_owned, id: id_owned, origin, quick, watch, lock: None };
        let (target, _) = place.target()?;
        refuse_mounted(&target)?;
        let hidden = name::hidden(results, id, quick);
        refuse_mounted(&hidden)?;
        let lock =
            Lock::take(&hidden, &place.origin, &*place.watch).map_err(|error| match error {
                lock::Refusal::Io(error) => failed(error),
                lock::Refusal::Problem(problem) => problem,
            })?;
        place.lock = Some(lock);
        exchange::try_out(&hidden).map_err(failed)?;
        let (in_place, cleared) = place.settle()?;
        cleared?;
        carry::check(&in_place)?;
        leftovers::of_version_0_1_0(results, id, &in_place, &*place.watch)?;
        leftovers::of_dead_runs(results, &*place.watch);
        Ok(place)
    }

    /// The hidden folder, for what a later run of the same experiment goes on from.
    pub fn unfinished(&self) -> &Path {
        self.lock.as_ref().map_or(&self.results, Lock::folder)
    }

    /// What the results will be said to be made from.
    pub fn origin(&self) -> &Origin {
        &self.origin
    }

    /// An empty folder for the files of the results.
    pub fn folder(&self) -> Result<Folder> {
        let making = self.unfinished().join(FILES);
        let failed = |error| unwritable(&self.results, &self.id, &error);
        // Should the hidden folder have been taken away, the results are still here.
        clear(&making).and_then(|()| fs::create_dir_all(&making)).map_err(failed)?;
        Ok(Folder::new(making, self.results.join(&self.id)))
    }

    /// Puts the whole folder in its place, in exchange for older results, and gives that place.
    pub fn finish(mut self, folder: Folder) -> Result<PathBuf> {
        let hidden = self.unfinished().to_owned();
        let making = folder.into_path();
        let failed = |error: std::io::Error| {
            Problem::from_error("the results cannot be put in place", error).in_file(&hidden)
        };
        manifest::seal(&making).map_err(failed)?;
        fs::rename(&making, hidden.join(WHOLE)).map_err(failed)?;
        exchange::flush(&hidden).map_err(failed)?;
        let (place, cleared) = self.settle()?;
        match cleared {
            Ok(()) => self.lock.take().into_iter().for_each(|lock| lock.remove(&*self.watch)),
            // No reason to call the new results failed; the next run tries it again.
            Err(problem) => self.watch.warned(&format!("{}: {problem}", self.id)),
        }
        if !self.quick {
            leftovers::remove_dead(&name::hidden(&self.results, &self.id, true), &*self.watch);
        }
        Ok(place)
    }

    /// Where the results go, and what stands there. A quick run goes elsewhere if a full one is there.
    fn target(&self) -> Result<(PathBuf, Option<Ours>)> {
        let place = self.results.join(&self.id);
        let there = self.mine(&place)?;
        if !self.quick || there.as_ref().is_none_or(|ours| ours.head.is_quick()) {
            return Ok((place, there));
        }
        let place = name::quick(&self.results, &self.id);
        let there = self.mine(&place)?;
        Ok((place, there))
    }

    /// What stands at a place, if it may be replaced by this run.
    fn mine(&self, place: &Path) -> Result<Option<Ours>> {
        let there = standing(place, &self.id);
        // Of what is mounted there, that is to be said.
        let there = there.or_else(|problem| refuse_mounted(place).and(Err(problem)))?;
        if let Some(ours) = &there {
            ours.check_origin(&self.origin, place)?;
        }
        Ok(there)
    }

    /// Puts what is whole in place and clears away what it replaced: the end of a run, and the first
    /// thing that the next one does where it was killed in the middle of that. Gives the place, and
    /// whether the older results could be cleared away.
    fn settle(&self) -> Result<(PathBuf, Result<()>)> {
        let [whole, replaced] = [WHOLE, REPLACED].map(|name| self.unfinished().join(name));
        let (place, there) = self.target()?;
        let failed = |error: std::io::Error| {
            let hint = format!("the whole results are in {}", shown(&whole));
            Problem::from_error("cannot be put in place", error).in_file(&place).hint(hint)
        };
        let is_newer = |ours: &Ours| manifest::is_newer(&whole, &ours.folder);
        let placed = match &there {
            None if whole.exists() => exchange::put(&whole, &place),
            None if replaced.exists() => exchange::put(&replaced, &place),
            Some(ours) if whole.exists() && is_newer(ours) => {
                carry::link_along(&place, &whole, &*self.watch);
                exchange::resemble(&place, &whole);
                exchange::swap(&whole, &place, &replaced, ours.identity)
            }
            _ => Ok(()),
        };
        match placed {
            // A full run and a quick one of the same experiment have finished at the same time.
            Err(error) if error.kind() == ErrorKind::AlreadyExists => return self.settle(),
            placed => placed.map_err(failed)?,
        }
        clear(&self.unfinished().join(FILES))
            .map_err(|error| unwritable(&self.results, &self.id, &error))?;
        let mut older = [whole, replaced].into_iter().filter(|older| older.exists());
        let cleared = older.try_for_each(|older| {
            carry::move_rest(&older, &place, &*self.watch).map_err(|error| {
                let hint = format!(
                    "what is yours in it belongs to {}: move it there, and remove the folder",
                    shown(&place)
                );
                let message = "older results cannot be cleared away";
                Problem::from_error(message, error).in_file(&older).hint(hint)
            })
        });
        Ok((place, cleared))
    }
}

impl Drop for Place {
    /// After an error nothing stays that is not worth going on from.
    fn drop(&mut self) {
        if let Some(lock) = self.lock.take() {
            let _ = clear(&lock.folder().join(FILES));
            if !lock::holds_work(lock.folder()) {
                lock.remove(&*self.watch);
            }
        }
    }
}

/// The folder of results, named from the root where the program was started in results that it may
/// exchange: its own folder is then another one, and names that lead up from there lead elsewhere.
fn within(results: &Path, id: &str) -> std::io::Result<PathBuf> {
    let (root, here) = (fs::canonicalize(results)?, std::env::current_dir()?);
    let is_inside = [root.join(id), name::quick(&root, id)].iter().any(|at| here.starts_with(at));
    Ok(if is_inside { root } else { results.to_owned() })
}

/// A file system that is mounted at the place cannot be exchanged for a folder.
fn refuse_mounted(place: &Path) -> Result<()> {
    if !exchange::is_mount(place) {
        return Ok(());
    }
    let message = "a file system is mounted there, which cannot be exchanged for new results";
    let hint = "write into it: `--results` names a folder that holds results";
    Err(Problem::new(message).in_file(place).hint(hint))
}
