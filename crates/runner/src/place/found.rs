//! What there is of an experiment in a results folder, at a look that changes nothing.

use std::path::Path;

use super::leftovers::holds_work;
use super::lock::is_held;
use super::name;
use super::standing::Head;

/// Results and unfinished work of one experiment.
#[derive(Default)]
pub struct Found {
    pub full: Option<Head>,
    pub quick: Option<Head>,
    /// Whether a run is at work on it now.
    pub is_running: bool,
    /// Whether a run that has ended left work that another could go on from.
    pub is_unfinished: bool,
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
        found
    }
}
