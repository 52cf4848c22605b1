//! What there is of an experiment in a results folder, at a look that changes nothing.

use std::path::{Path, PathBuf};

use crate::lock::{holds_work, is_held};
use crate::name::{self, REPLACED, WHOLE};
use crate::standing::Head;

/// Results and unfinished work of one experiment.
#[derive(Default)]
pub struct Found {
    /// Results of a full run.
    pub full: Option<Head>,
    /// Results of a quick one.
    pub quick: Option<Head>,
    /// Whether a run is at work on it now.
    pub is_running: bool,
    /// Whether a run that has ended left work that another could go on from.
    pub is_unfinished: bool,
    /// Whole results that a run was killed over before they were in place, where nothing is.
    pub aside: Option<PathBuf>,
}

impl Found {
    /// Of the experiment of this name.
    pub fn of(results: &Path, id: &str) -> Self {
        let mut found = Self::default();
        for folder in [results.join(id), name::quick(results, id)] {
            let Some(head) = Head::read(&folder).ok().filter(|head| head.id == id) else {
                continue;
            };
            let place = if head.is_quick() { &mut found.quick } else { &mut found.full };
            place.get_or_insert(head);
        }
        for hidden in [false, true].map(|quick| name::hidden(results, id, quick)) {
            let is_held = is_held(&hidden);
            found.is_running |= is_held;
            found.is_unfinished |= !is_held && holds_work(&hidden);
        }
        found.aside = aside(results, id);
        found
    }
}

/// Whole results that the next run of an experiment will put in place, where nothing is: those of a run
/// that was killed over it, or the older ones, if it was killed between two renames.
pub fn aside(results: &Path, id: &str) -> Option<PathBuf> {
    let is_in_place = results.join(id).symlink_metadata().is_ok();
    let hidden = [false, true].map(|quick| name::hidden(results, id, quick));
    let folders = hidden.iter().filter(|hidden| !is_held(hidden));
    let mut whole = folders.flat_map(|hidden| [WHOLE, REPLACED].map(|name| hidden.join(name)));
    let is_it = |folder: &PathBuf| Head::read(folder).is_ok_and(|head| head.id == id);
    if is_in_place { None } else { whole.find(is_it) }
}
