//! The files of a results folder and the SHA-256 of each, as its summary lists them under
//! `provenance.files`: what is ours, what was edited, and what is a user's.
//!
//! The summary lists itself too, as it is without that list. It may be larger than anything else
//! here, so that it is cut as the text that we wrote rather than taken apart.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{Error, ErrorKind, Read, Result, Write};
use std::path::Path;
use std::time::{Duration, SystemTime};

use serde::Deserialize;
use sha2::{Digest, Sha256};

use crate::exchange::flush;
use crate::standing::SUMMARY;

/// Files of 0.1.0, whose summaries list none, and beginnings of those that have a number in their
/// name.
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

/// What stands before the list of files in a summary, and what ends the summary after it.
const LIST: &str = ",\n    \"files\": ";
const END: &str = "\n  }\n}\n";

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
    /// Sums by name; none if the summary lists none.
    sums: Option<BTreeMap<String, String>>,
    /// Of the summary as it is now, without the list.
    summary: Option<String>,
    /// When the summary was written.
    written: Option<SystemTime>,
}

impl Manifest {
    /// Of a results folder. A summary that cannot be read is an error, since it tells what is whose;
    /// where there is none, nothing is listed.
    pub fn of(folder: &Path) -> Result<Self> {
        let path = folder.join(SUMMARY);
        let written = modified(&path);
        let text = match fs::read(&path) {
            Ok(bytes) => String::from_utf8_lossy(&bytes).into_owned(),
            Err(error) if error.kind() == ErrorKind::NotFound => String::new(),
            Err(error) => return Err(named(SUMMARY, &error)),
        };
        Ok(match unsealed(&text) {
            Some((summary, sums)) => {
                Self { sums: Some(sums), summary: Some(sum_of_text(&summary)), written }
            }
            // Whoever wrote it anew has edited it, whatever it says.
            None => Self { sums: listed(&text), summary: None, written },
        })
    }

    /// Whether a file of this name is one of ours, edited or not.
    pub fn lists(&self, name: &OsStr) -> bool {
        let name = name.to_str().unwrap_or_default();
        self.sums.as_ref().map_or_else(|| is_of_0_1_0(name), |sums| sums.contains_key(name))
    }

    /// Whose this entry of the folder is. One of ours that cannot be read is an error: nobody knows
    /// whether it was edited.
    pub fn owner(&self, folder: &Path, name: &OsStr) -> Result<Owner> {
        let path = folder.join(name);
        let is_file = fs::symlink_metadata(&path)?.is_file();
        if !is_file || !self.lists(name) {
            return Ok(Owner::User);
        }
        let name = name.to_str().unwrap_or_default();
        let Some(sum) = self.sums.as_ref().and_then(|sums| sums.get(name)) else {
            return Ok(self.owner_in_0_1_0(&path));
        };
        let now = match name {
            SUMMARY => self.summary.clone(),
            _ => Some(sum_of(&path).map_err(|error| named(name, &error))?),
        };
        Ok(if now.as_ref() == Some(sum) { Owner::Ours } else { Owner::Edited })
    }

    fn owner_in_0_1_0(&self, path: &Path) -> Owner {
        let later = modified(path).zip(self.written).and_then(|(at, written)| {
            at.duration_since(written).ok().filter(|later| *later > WRITTEN_TOGETHER)
        });
        if later.is_some() { Owner::Edited } else { Owner::Ours }
    }
}

fn is_of_0_1_0(name: &str) -> bool {
    let is_matrix = name.ends_with(".npy")
        && MATRICES_OF_0_1_0.iter().any(|beginning| name.starts_with(beginning));
    is_matrix || OF_0_1_0.contains(&name)
}

/// An error with the name of the file that it befell.
fn named(name: &str, error: &Error) -> Error {
    Error::new(error.kind(), format!("{name} cannot be read: {error}"))
}

/// Flushes the files of a folder and lists them in its summary; nothing is written to it after that.
pub fn seal(folder: &Path) -> Result<()> {
    let path = folder.join(SUMMARY);
    let summary = fs::read_to_string(&path)?;
    let mut sums = BTreeMap::from([(SUMMARY.to_owned(), sum_of_text(&summary))]);
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if name != SUMMARY {
            File::open(&path)?.sync_all()?;
            sums.insert(name, sum_of(&path)?);
        }
    }
    let mut file = File::create(path)?;
    file.write_all(sealed(&summary, &sums)?.as_bytes())?;
    file.sync_all()?;
    flush(folder)
}

/// Whether a sealed folder was written after what is in place.
pub fn is_newer(sealed: &Path, in_place: &Path) -> bool {
    modified(&sealed.join(SUMMARY)) > modified(&in_place.join(SUMMARY))
}

fn modified(path: &Path) -> Option<SystemTime> {
    fs::metadata(path).and_then(|found| found.modified()).ok()
}

/// A summary, which ends with its provenance, with a list of files at the end of that.
fn sealed(summary: &str, sums: &BTreeMap<String, String>) -> Result<String> {
    let body = summary.strip_suffix(END).ok_or_else(|| {
        Error::other("the summary does not end with its provenance, where its files are listed")
    })?;
    let sums = serde_json::to_string_pretty(sums)?.replace('\n', "\n    ");
    Ok(format!("{body}{LIST}{sums}{END}"))
}

/// The summary without its list of files, and the list.
fn unsealed(summary: &str) -> Option<(String, BTreeMap<String, String>)> {
    let (body, list) = summary.rsplit_once(LIST)?;
    let sums = serde_json::from_str(list.strip_suffix(END)?).ok()?;
    Some((format!("{body}{END}"), sums))
}

/// The list of files in a summary however it is laid out.
fn listed(summary: &str) -> Option<BTreeMap<String, String>> {
    #[derive(Deserialize)]
    struct Summary {
        provenance: Provenance,
    }
    #[derive(Deserialize)]
    struct Provenance {
        files: Option<BTreeMap<String, String>>,
    }
    serde_json::from_str::<Summary>(summary).ok()?.provenance.files
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

fn sum_of_text(content: &str) -> String {
    text(Sha256::new().chain_update(content))
}

fn text(hash: Sha256) -> String {
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sealed_summary_is_json_and_gives_back_its_text_and_its_list() {
        let summary = "{\n  \"a\": 0.1,\n  \"provenance\": {\n    \"seed\": 1\n  }\n}\n";
        let sums = BTreeMap::from([("a".to_owned(), "1".to_owned()), ("b".into(), "2".into())]);
        let sealed = sealed(summary, &sums).unwrap();
        let parsed: serde_json::Value = serde_json::from_str(&sealed).unwrap();
        assert_eq!(format!("{parsed:#}\n"), sealed);
        assert_eq!(parsed["provenance"]["files"]["b"], "2");
        assert_eq!(unsealed(&sealed), Some((summary.to_owned(), sums.clone())));
        assert_eq!(listed(&parsed.to_string()), Some(sums));
        assert_eq!(unsealed(summary), None);
        assert!(super::sealed("{}", &BTreeMap::new()).is_err());
    }
}
