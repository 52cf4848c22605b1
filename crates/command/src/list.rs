//! `eigensync list`: the experiments of a folder, and what there is of each: results of a full or a
//! quick run, whether these still are what the file says, and work that was not finished.

use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde::Serialize;

use crate::output::{document, say};
use experiment::load::{self, AnyDocument};
use experiment::spec::{Experiment, GroupsSpec, NetworkSpec};
use results_folder::{Found, Head};
use user::text::{one_line, shown};
use user::{Problem, Result};

/// Larger files are read again only if they were touched since the results were written.
const READ_AGAIN: u64 = 16 << 20;

/// Lists the experiment files of a folder, with what there is of them in the results folder.
pub fn list(experiments: &Path, results: &Path, json: bool) -> Result<()> {
    let entries = fs::read_dir(experiments)
        .map_err(|error| Problem::from_error("cannot be read", error).in_file(experiments))?;
    let is_toml = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "toml");
    let mut files: Vec<PathBuf> =
        entries.flatten().map(|entry| entry.path()).filter(is_toml).collect();
    files.sort();
    if files.is_empty() {
        return Err(Problem::new("holds no experiment files").in_file(experiments));
    }
    let entries: Vec<Entry> = files.par_iter().map(|file| Entry::of(file, results)).collect();
    if json {
        let entries = serde_json::json!({ "experiments": entries });
        document(&format!("{entries:#}"));
        return Ok(());
    }
    for entry in entries {
        say!("{}", one_line(&entry.line()));
    }
    Ok(())
}

/// An experiment and what there is of it.
#[derive(Serialize)]
struct Entry {
    id: String,
    file: String,
    /// None where the file cannot be read.
    title: Option<String>,
    /// Why it cannot be read.
    problem: Option<String>,
    /// Results of a full run, if there are any, and whether these still are what the file says.
    results: Option<State>,
    quick_results: Option<State>,
    /// Where whole results wait for the next run to put them in place.
    aside: Option<PathBuf>,
    running: bool,
    unfinished: bool,
}

/// What has become of an experiment since its results were written.
#[derive(Clone, Copy, Serialize)]
#[serde(rename_all = "snake_case")]
enum State {
    Current,
    /// The experiment or its network has changed.
    Stale,
    /// Its network cannot be read now.
    Unknown,
    /// The experiment cannot be read.
    Unreadable,
}

impl State {
    /// As an addition to a mark.
    fn words(self) -> &'static str {
        match self {
            Self::Current | Self::Unreadable => "",
            Self::Stale => ", stale: the experiment or its network has changed since",
            Self::Unknown => ", of a network that cannot be read now",
        }
    }
}

impl Entry {
    fn of(file: &Path, results: &Path) -> Self {
        let id = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let found = Found::of(results, &id);
        let (document, problem) = match load::document(file) {
            Ok(document) => (Some(document), None),
            Err(problem) => (None, Some(problem.to_string())),
        };
        let state = |head: &Head| {
            document.as_ref().map_or(State::Unreadable, |now| change(file, now, head))
        };
        Self {
            file: file.to_string_lossy().into_owned(),
            results: found.full.as_ref().map(state),
            quick_results: found.quick.as_ref().map(state),
            running: found.is_running,
            unfinished: found.is_unfinished,
            aside: found.aside,
            title: document.map(title),
            problem,
            id,
        }
    }

    fn line(&self) -> String {
        let mut marks = Vec::new();
        marks.extend(self.results.map(|state| format!("results{}", state.words())));
        let quick = self.quick_results;
        marks.extend(quick.map(|state| format!("results of a quick run{}", state.words())));
        marks.extend(self.aside.as_ref().map(|folder| {
            format!("whole results in {}: run it again to put them in place", shown(folder))
        }));
        if self.running {
            marks.push("running".into());
        } else if self.unfinished && self.aside.is_none() {
            marks.push("unfinished: run it again to go on from there".into());
        }
        let marks: String = marks.iter().map(|mark| format!("[{mark}] ")).collect();
        let title = match (&self.problem, &self.title) {
            (Some(problem), _) => format!("cannot be read: {problem}"),
            (None, title) => title.clone().unwrap_or_default(),
        };
        format!("{:<40} {marks}{title}", shown(&self.file))
    }
}

fn title(document: AnyDocument) -> String {
    match document {
        AnyDocument::Experiment(document) => document.experiment.title,
        AnyDocument::Atlas(document) => document.experiment.title,
    }
}

/// What has become of an experiment since its results were written.
fn change(file: &Path, document: &AnyDocument, head: &Head) -> State {
    let (written, inputs) = match document {
        AnyDocument::Experiment(document) => {
            (&document.written, inputs(file, &document.experiment))
        }
        AnyDocument::Atlas(document) => (&document.written, Vec::new()),
    };
    if inputs.iter().all(|input| is_large(input) && !was_touched(input, head)) {
        // Nothing that would have to be read again; the experiment itself is compared as parsed.
        return if *written == head.experiment { State::Current } else { State::Stale };
    }
    match experiment::plan_hash_of(file, head.is_quick()) {
        Ok(hash) if hash == head.provenance.plan_hash => State::Current,
        Ok(_) => State::Stale,
        Err(_) => State::Unknown,
    }
}

/// The files that an experiment reads.
fn inputs(file: &Path, experiment: &Experiment) -> Vec<PathBuf> {
    let network = match &experiment.network {
        NetworkSpec::File(spec) => Some(&spec.path),
        NetworkSpec::Hierarchical(spec) => Some(&spec.path),
        NetworkSpec::Communities(_) => None,
    };
    let groups = match &experiment.groups {
        Some(GroupsSpec::File { path }) => Some(path),
        _ => None,
    };
    let beside = |path: &PathBuf| file.parent().unwrap_or(Path::new("")).join(path);
    network.into_iter().chain(groups).map(beside).collect()
}

fn is_large(input: &Path) -> bool {
    fs::metadata(input).is_ok_and(|found| found.len() > READ_AGAIN)
}

/// Whether a file may have changed since the run began; the time of its last change of any kind
/// tells, which no copying sets back.
fn was_touched(input: &Path, head: &Head) -> bool {
    let changed = fs::metadata(input).map_or(i64::MAX, |found| found.ctime());
    head.began().is_none_or(|began| changed >= began)
}
