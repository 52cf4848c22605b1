//! `SHA256SUMS`: the files of a results folder and what is in them, as `sha256sum --check` reads it.
//! It tells our files from a user's, and those that were edited. Its first line says what the others
//! must be, so that a list that somebody else made or mended is not taken for ours.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{Read, Result, Write};
use std::path::Path;
use std::time::{Duration, SystemTime};

use sha2::{Digest, Sha256};

use super::exchange::flush;
use super::standing::SUMMARY;

/// Name of the list.
const NAME: &str = "SHA256SUMS";
/// Beginning of its first line, which the SHA-256 of the others follows.
const HEADER: &str = "# written by eigensync, SHA-256 of the lines below: ";

/// Files of 0.1.0, which had no list, and beginnings of those that have a number in their name.
const OF_0_1_0: [&str; 11] = [
    "cascade.csv",
    "cascade.nwk",
    "clusters.csv",
    "eigenvectors.csv",
    "experiment.toml",
    "figure.png",
    "figure.svg",
    "msf.csv",
    "spectrum.csv",
    SUMMARY,
    "sweep.csv",
];
const MATRICES_OF_0_1_0: [&str; 2] = ["distance_epsilon_", "error_epsilon_"];
/// Files of 0.1.0 were all written within this time of its summary; later ones were edited.
const WRITTEN_TOGETHER: Duration = Duration::from_secs(60);

/// Bytes that are hashed at a time.
const PIECE: usize = 1 << 16;

/// Whose an entry of a results folder is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Owner {
    /// As we wrote it.
    Ours,
    /// Ours, but edited since.
    Edited,
    /// Not one of ours.
    User,
}

/// What a results folder was written with.
pub struct Manifest {
    sums: Option<BTreeMap<String, String>>,
    /// When the summary was written.
    written: Option<SystemTime>,
}

impl Manifest {
    /// Of a results folder.
    pub fn of(folder: &Path) -> Self {
        let text = fs::read_to_string(folder.join(NAME)).unwrap_or_default();
        Self { sums: listed(&text), written: modified(&folder.join(SUMMARY)) }
    }

    /// Whether an entry of this name is the list itself.
    pub fn is_called(name: &OsStr) -> bool {
        name == NAME
    }

    /// Whose this entry of the folder is.
    pub fn owner(&self, folder: &Path, name: &str) -> Owner {
        let path = folder.join(name);
        if !fs::symlink_metadata(&path).is_ok_and(|found| found.is_file()) {
            return Owner::User;
        }
        let Some(sums) = &self.sums else { return self.owner_in_0_1_0(&path, name) };
        match sums.get(name) {
            _ if name == NAME => Owner::Ours,
            None => Owner::User,
            Some(sum) if sum_of(&path).is_ok_and(|now| now == *sum) => Owner::Ours,
            Some(_) => Owner::Edited,
        }
    }

    fn owner_in_0_1_0(&self, path: &Path, name: &str) -> Owner {
        let is_matrix = name.ends_with(".npy")
            && MATRICES_OF_0_1_0.iter().any(|beginning| name.starts_with(beginning));
        if !is_matrix && !OF_0_1_0.contains(&name) {
            return Owner::User;
        }
        let later = modified(path).zip(self.written).and_then(|(at, written)| {
            at.duration_since(written).ok().filter(|later| *later > WRITTEN_TOGETHER)
        });
        if later.is_some() { Owner::Edited } else { Owner::Ours }
    }
}

/// Flushes the files of a folder and lists them in it; nothing is written to it after that.
pub fn seal(folder: &Path) -> Result<()> {
    let mut lines = BTreeMap::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        File::open(&path)?.sync_all()?;
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        lines.insert(name, sum_of(&path)?);
    }
    let lines: String = lines.iter().map(|(name, sum)| format!("{sum}  {name}\n")).collect();
    let mut list = File::create(folder.join(NAME))?;
    write!(list, "{HEADER}{}\n{lines}", text(Sha256::new().chain_update(&lines)))?;
    list.sync_all()?;
    flush(folder)
}

/// Whether a sealed folder was written after what is in place.
pub fn is_newer(sealed: &Path, in_place: &Path) -> bool {
    let of =
        |folder: &Path| modified(&folder.join(NAME)).or_else(|| modified(&folder.join(SUMMARY)));
    of(sealed) > of(in_place)
}

/// The sums by name, if the list is as we wrote it.
fn listed(list: &str) -> Option<BTreeMap<String, String>> {
    let (header, lines) = list.split_once('\n')?;
    if header.strip_prefix(HEADER)? != text(Sha256::new().chain_update(lines)) {
        return None;
    }
    let entry = |line: &str| line.split_once("  ").map(|(sum, name)| (name.into(), sum.into()));
    lines.lines().map(entry).collect()
}

fn modified(path: &Path) -> Option<SystemTime> {
    fs::metadata(path).and_then(|found| found.modified()).ok()
}

fn sum_of(path: &Path) -> Result<String> {
    let mut file = File::open(path)?;
    let (mut hash, mut piece) = (Sha256::new(), vec![0; PIECE]);
    loop {
        match file.read(&mut piece)? {
            0 => return Ok(text(hash)),
            n => hash.update(&piece[..n]),
        }
    }
}

fn text(hash: Sha256) -> String {
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}
