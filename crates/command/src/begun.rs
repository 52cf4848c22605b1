//! What every command begins with that leaves results: a place that it alone writes to, the journal of
//! what it has computed, and the terminal that is told.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use journal::{Cache, Journal};
use results_folder::Place;
use runner::program;
use user::{Result, Stages};

use crate::terminal;

/// What of earlier runs is taken over, and how long this one is.
#[derive(Clone, Copy)]
pub struct Kept {
    pub quick: bool,
    /// Whether all is computed anew.
    pub fresh: bool,
    /// Whether curves are neither taken from the user's cache nor kept there.
    pub no_cache: bool,
}

/// The work on one experiment.
pub struct Begun {
    pub stages: Stages,
    pub place: Place,
    pub journal: Arc<Journal>,
}

impl Begun {
    /// Reserves the place of the results that are called so, and opens what an earlier run has left there,
    /// beside the user's cache where it is wanted. `made_from` are the command and the file.
    pub fn new(
        results: &Path,
        id: &str,
        made_from: (&'static str, &Path),
        Kept { quick, fresh, no_cache }: Kept,
    ) -> Result<Self> {
        let watch = terminal::watch();
        let place = Place::reserve(results, id, made_from, quick, watch.clone())?;
        let cache = if no_cache { None } else { cache_folder() };
        let cache = cache.map(|folder| Cache::new(folder, fresh));
        let journal = open(&place, id, fresh)?.with_cache(cache).into();
        Ok(Self { stages: Stages::new(id, watch), place, journal })
    }
}

/// The journal of a place that was reserved, as this program keeps it.
pub fn journal(place: &Place, id: &str, fresh: bool) -> Result<Arc<Journal>> {
    open(place, id, fresh).map(Arc::new)
}

fn open(place: &Place, id: &str, fresh: bool) -> Result<Journal> {
    Journal::open(place.unfinished(), id, program::name(), fresh, terminal::watch())
}

/// The user's folder of curves: `EIGENSYNC_CACHE`, of which an empty one means none, or a folder beside
/// those of other programs.
fn cache_folder() -> Option<PathBuf> {
    let variable = |name| std::env::var_os(name).map(PathBuf::from);
    if let Some(folder) = variable("EIGENSYNC_CACHE") {
        return (!folder.as_os_str().is_empty()).then_some(folder);
    }
    // A relative path is to be ignored, by the XDG base directory specification.
    let of_user = variable("XDG_CACHE_HOME").filter(|folder| folder.is_absolute());
    let of_user = of_user.or_else(|| Some(variable("HOME")?.join(".cache")));
    Some(of_user?.join("eigensync"))
}
