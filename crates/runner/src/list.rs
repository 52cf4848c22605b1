//! `eigensync list`: the experiments of a folder, and what there is of each: results of a full or a
//! quick run, whether these still are what the file says, and work that was not finished.

use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::load;
use crate::output::{one_line, say, shown};
use crate::place::{Found, Head};
use crate::plan;
use crate::problem::{Problem, Result};
use crate::spec::{Experiment, GroupsSpec, NetworkSpec};

/// Larger files are read again only if they were touched since the results were written.
const READ_AGAIN: u64 = 16 << 20;

/// Lists the experiment files of a folder, with what there is of them in the results folder.
pub fn list(experiments: &Path, results: &Path) -> Result<()> {
    let entries = fs::read_dir(experiments)
        .map_err(|error| Problem::from_error("cannot be read", error).in_file(experiments))?;
    let is_toml = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "toml");
    let mut files: Vec<PathBuf> =
        entries.flatten().map(|entry| entry.path()).filter(is_toml).collect();
    files.sort();
    if files.is_empty() {
        return Err(Problem::new("holds no experiment files").in_file(experiments));
    }
    let lines: Vec<String> = files.par_iter().map(|file| line(file, results)).collect();
    for line in lines {
        say!("{}", one_line(&line));
    }
    Ok(())
}

fn line(file: &Path, results: &Path) -> String {
    let id = file.file_stem().unwrap_or_default().to_string_lossy();
    let found = Found::of(results, &id);
    let (experiment, title) = match load::experiment(file) {
        Ok((experiment, _)) => (Some(experiment), None),
        Err(problem) => (None, Some(format!("cannot be read: {problem}"))),
    };
    let state = |head: &Head| experiment.as_ref().map_or("", |now| change(file, now, head));
    let mut marks = Vec::new();
    marks.extend(found.full.as_ref().map(|head| format!("results{}", state(head))));
    marks.extend(found.quick.as_ref().map(|head| format!("results of a quick run{}", state(head))));
    marks.extend(found.aside.as_ref().map(|folder| {
        format!("whole results in {}: run it again to put them in place", shown(folder))
    }));
    if found.is_running {
        marks.push("running".into());
    } else if found.is_unfinished && found.aside.is_none() {
        marks.push("unfinished: run it again to go on from there".into());
    }
    let marks: String = marks.iter().map(|mark| format!("[{mark}] ")).collect();
    let title = title.or_else(|| experiment.map(|now| now.title)).unwrap_or_default();
    format!("{:<40} {marks}{title}", shown(file))
}

/// What has become of an experiment since its results were written, as an addition to a mark.
fn change(file: &Path, experiment: &Experiment, head: &Head) -> &'static str {
    if inputs(file, experiment).iter().all(|input| is_large(input) && !was_touched(input, head)) {
        // Nothing that would have to be read again; the experiment itself is compared as parsed.
        let now = load::experiment(file).map(|(_, written)| written);
        return if now.is_ok_and(|now| now == head.experiment) { "" } else { STALE };
    }
    match plan::hash(file, head.is_quick()) {
        Ok(hash) if hash == head.provenance.plan_hash => "",
        Ok(_) => STALE,
        Err(_) => ", of a network that cannot be read now",
    }
}

const STALE: &str = ", stale: the experiment or its network has changed since";

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
