//! What stands where results are to go. Only results of the same experiment, in a folder of their
//! own, are ever replaced; anything else is somebody's, and refused.

use std::fs::{self, Metadata};
use std::io::{BufReader, ErrorKind};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::name::relative;
use user::text::shown;
use user::{Problem, Result};

/// The file that makes a folder one of results.
pub const SUMMARY: &str = "summary.json";

/// What stands for standard input where a file is named.
pub const STANDARD_INPUT: &str = "-";

/// What a summary says of itself, without its numbers.
#[derive(Deserialize)]
pub struct Head {
    /// Name of the experiment.
    pub id: String,
    /// 1 for a full run.
    pub shortened: f64,
    /// The experiment as it was parsed.
    pub experiment: Value,
    /// Where the results come from.
    pub provenance: Provenance,
    /// When the summary was written, in seconds since 1970.
    #[serde(skip)]
    written: Option<i64>,
}

/// The part of a summary's provenance that is read again.
#[derive(Deserialize)]
pub struct Provenance {
    /// What the plan is known by.
    pub plan_hash: String,
    /// How long the run took.
    pub wall_time_s: f64,
    /// What the results were made from; none in those of 0.1.0.
    pub origin: Option<Origin>,
}

/// What results were made from.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Origin {
    /// `run`, `predict` or `msf`.
    pub command: String,
    /// The experiment or the network, as seen from the results folder; `-` for a network from standard
    /// input, empty where there is none.
    pub file: PathBuf,
}

/// A folder of results of the experiment that would replace it.
pub struct Ours {
    pub folder: PathBuf,
    pub head: Head,
    pub identity: Identity,
}

/// Which folder or file it is, whatever it is called.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Identity(u64, u64);

impl Identity {
    /// Of what is at a path, which is not followed if it is a link.
    pub fn at(path: &Path) -> std::io::Result<Self> {
        fs::symlink_metadata(path).map(|found| Self::of(&found))
    }

    /// Of what is described so.
    pub fn of(found: &Metadata) -> Self {
        Self(found.dev(), found.ino())
    }
}

impl Head {
    /// Reads the summary of a folder of results; the error says why it is none.
    pub fn read(folder: &Path) -> std::result::Result<Self, String> {
        let path = folder.join(SUMMARY);
        let no_file = || format!("has no {SUMMARY} of eigensync in it");
        // A pipe would be waited for, and a link may lead anywhere.
        if !fs::symlink_metadata(&path).is_ok_and(|found| found.is_file()) {
            return Err(no_file());
        }
        let file = fs::File::open(&path)
            .map_err(|error| format!("has a {SUMMARY} that cannot be read: {error}"))?;
        let written = file.metadata().map(|found| found.mtime()).ok();
        let head = serde_json::from_reader(BufReader::with_capacity(1 << 16, file));
        head.map(|head: Self| Self { written, ..head }).map_err(|_| no_file())
    }

    /// When the run began, in seconds since 1970, if that can be told.
    pub fn began(&self) -> Option<i64> {
        Some(self.written? - self.provenance.wall_time_s.ceil() as i64)
    }

    /// Whether it is of a quick run.
    pub fn is_quick(&self) -> bool {
        self.shortened > 1.0
    }
}

impl Origin {
    /// Of results at a place, whose parent is there, made by a command from a file.
    pub fn new(command: &str, file: &Path, place: &Path) -> Result<Self> {
        let whole = |path: &Path| {
            let failed = |error| Problem::from_error("cannot be opened", error).in_file(path);
            path.canonicalize().map_err(failed)
        };
        let parent = place.parent().filter(|path| !path.as_os_str().is_empty());
        let folder = whole(parent.unwrap_or(Path::new(".")))?;
        let command = command.to_owned();
        if is_no_file(file) {
            return Ok(Self { command, file: file.to_owned() });
        }
        let file = relative(&whole(file)?, &folder.join(place.file_name().unwrap_or_default()));
        Ok(Self { command, file })
    }

    /// Whether results beside a place that were made from this would be made again from the other: it
    /// is the same file, or was moved.
    pub fn is_same(&self, other: &Self, place: &Path) -> bool {
        let was_moved =
            || self.file.file_name() == other.file.file_name() && !self.path(place).exists();
        self.command == other.command && (self.file == other.file || was_moved())
    }

    /// In words for the terminal.
    pub fn shown(&self, place: &Path) -> String {
        if is_no_file(&self.file) {
            let command = format!("eigensync {} {}", self.command, shown(&self.file));
            return format!("`{}`", command.trim_end());
        }
        let path = self.path(place);
        let path = path.canonicalize().unwrap_or(path);
        format!("`eigensync {} {}`", self.command, shown(&path))
    }

    /// The file as seen from where we are; the place itself need not be there.
    fn path(&self, place: &Path) -> PathBuf {
        let results = place.parent().unwrap_or(Path::new(""));
        results.join(self.file.strip_prefix("..").unwrap_or(&self.file))
    }
}

/// Whether results are made from options alone, or from standard input.
fn is_no_file(file: &Path) -> bool {
    file.as_os_str().is_empty() || file == Path::new(STANDARD_INPUT)
}

impl Ours {
    /// Refuses what was made from another file.
    pub fn check_origin(&self, origin: &Origin, place: &Path) -> Result<()> {
        let Some(earlier) = self.head.provenance.origin.clone().or_else(|| self.old_origin())
        else {
            return Ok(());
        };
        if earlier.is_same(origin, place) {
            return Ok(());
        }
        let message =
            format!("holds the results of {}, which this would replace", earlier.shown(place));
        Err(refused(place, &message))
    }

    /// Version 0.1.0 left only the experiment file that a prediction was made into.
    fn old_origin(&self) -> Option<Origin> {
        self.folder.join("experiment.toml").exists().then(|| {
            let network = self.head.experiment["network"]["file"]["path"].as_str();
            let network = Path::new(network.unwrap_or_default());
            let whole = self.folder.canonicalize().unwrap_or_default();
            Origin { command: "predict".into(), file: relative(network, &whole) }
        })
    }
}

/// What stands at the place of an experiment's results: nothing, or results of the same experiment.
pub fn standing(place: &Path, id: &str) -> Result<Option<Ours>> {
    let found = match fs::symlink_metadata(place) {
        Ok(found) => found,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(unwritable(place, id, &error)),
    };
    if found.is_symlink() {
        let to = fs::read_link(place).unwrap_or_default();
        return Err(refused(place, &format!("is a link to {}", shown(&to))));
    }
    if !found.is_dir() {
        return Err(refused(place, "is a file"));
    }
    let head = Head::read(place).map_err(|why| refused(place, &why))?;
    if head.id != id {
        return Err(refused(place, &format!("holds results of another experiment, `{}`", head.id)));
    }
    if let Err(error) = rustix::fs::access(place, ALL_ACCESS) {
        let hint = "write elsewhere: `--results FOLDER`";
        return Err(Problem::from_error("cannot be replaced", error).in_file(place).hint(hint));
    }
    Ok(Some(Ours { folder: place.to_owned(), head, identity: Identity::of(&found) }))
}

/// What is needed to take files out of a folder.
pub const ALL_ACCESS: rustix::fs::Access = rustix::fs::Access::READ_OK
    .union(rustix::fs::Access::WRITE_OK)
    .union(rustix::fs::Access::EXEC_OK);

fn refused(place: &Path, why: &str) -> Problem {
    Problem::new(format!("{why}; expected nothing, or older results of the same experiment"))
        .in_file(place)
        .hint("results go here: move it away, or write elsewhere: `--results FOLDER`")
}

/// What is said where a folder of results cannot be written to.
pub fn unwritable(results: &Path, id: &str, error: &std::io::Error) -> Problem {
    if error.kind() == ErrorKind::InvalidFilename {
        let message = format!(
            "cannot hold a folder called after `{id}`: the name has {} bytes, and more are needed \
             for the hidden folder in which it is put together",
            id.len()
        );
        return Problem::new(message).in_file(results).hint("give the file a shorter name");
    }
    Problem::from_error("cannot be written to", error).in_file(results)
}
