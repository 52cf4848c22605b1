//! What every command begins with that leaves results: a place that it alone writes to, the journal of
//! what it has computed, and the terminal that is told.

use std::path::Path;
use std::sync::Arc;

use journal::Journal;
use results_folder::Place;
use runner::program;
use user::{Result, Stages};

use crate::terminal;

/// The work on one experiment.
pub struct Begun {
    pub stages: Stages,
    pub place: Place,
    pub journal: Arc<Journal>,
}

impl Begun {
    /// Reserves the place of the results that are called so, and opens what an earlier run has left there.
    /// `made_from` are the command and the file.
    pub fn new(
        results: &Path,
        id: &str,
        made_from: (&'static str, &Path),
        (quick, fresh): (bool, bool),
    ) -> Result<Self> {
        let watch = terminal::watch();
        let place = Place::reserve(results, id, made_from, quick, watch.clone())?;
        let journal = journal(&place, id, fresh)?;
        Ok(Self { stages: Stages::new(id, watch), place, journal })
    }
}

/// The journal of a place that was reserved, as this program keeps it.
pub fn journal(place: &Place, id: &str, fresh: bool) -> Result<Arc<Journal>> {
    Journal::open(place.unfinished(), id, program::name(), fresh, terminal::watch()).map(Arc::new)
}
