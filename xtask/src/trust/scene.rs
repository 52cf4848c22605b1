//! A small sweep with older results in place, and the results that it must end with whatever befalls
//! it on the way.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use serde_json::Value;

use super::program::Program;
use super::{copy, remove};
use crate::root;

/// Longest time that the undisturbed run may take.
const PATIENCE: Duration = Duration::from_secs(600);

/// The experiment, without its seed and the lengths of its stages.
const EXPERIMENT: &str = r#"title = "A sweep to be disturbed"
seed  = SEED

[network.file]
path = "network.edges"

[oscillator.lorenz]
r = 35.0

[coupling]
matrix = "laplacian"
from   = "x"
to     = "y"

[msf]
sigma          = { from = 0.0, to = 12.0, points = 7 }
step           = 0.01
transient      = 10.0
average        = LENGTH
relative_error = 0.05

[sweep]
epsilon            = { from = 1.0, to = 5.0, points = 9 }
seeds              = 4
step               = 0.01
transient          = 40.0
average            = LENGTH
clusters           = [[1, 2, 6], [3, 4, 5]]
synchronised_below = 0.1
"#;

/// Name of the experiment.
pub const ID: &str = "sweep";
/// A file that a user keeps among the results, and what is in it.
const NOTES: (&str, &str) = ("notes.txt", "mine");

/// Files by name.
type Files = BTreeMap<String, Vec<u8>>;

/// The folder, as it is before each try, and what must come of it.
pub struct Scene {
    template: PathBuf,
    folder: PathBuf,
    older: Files,
    reference: Files,
    /// How long an undisturbed run takes.
    pub took: Duration,
}

impl Scene {
    /// Makes older results and the ones to compare with; averages are this long.
    pub fn new(program: &Program, folder: &Path, length: f64) -> Result<Self, String> {
        let template = folder.join("template");
        let failed = |error: std::io::Error| format!("{}: {error}", template.display());
        fs::create_dir_all(&template).map_err(failed)?;
        let network = root().join("experiments/networks/six-node.edges");
        fs::copy(network, template.join("network.edges")).map_err(failed)?;
        write_experiment(&template, 2, 100.0)?;
        let results = template.join("results").join(ID);
        let run = |folder: &Path| {
            let answer = program.run(folder, &["run", "sweep.toml"], PATIENCE)?;
            answer.is_one_of(&[0])?;
            Ok::<_, String>(answer.took)
        };
        run(&template)?;
        fs::write(results.join(NOTES.0), NOTES.1).map_err(failed)?;
        let older = files(&results)?;
        write_experiment(&template, 1, length)?;
        let undisturbed = folder.join("undisturbed");
        copy(&template, &undisturbed).map_err(failed)?;
        let took = run(&undisturbed)?;
        let reference = files(&undisturbed.join("results").join(ID))?;
        Ok(Self { folder: folder.join("try"), template, older, reference, took })
    }

    /// The folder for a try, as if nothing had happened yet.
    pub fn fresh(&self) -> Result<&Path, String> {
        remove(&self.folder)
            .and_then(|()| copy(&self.template, &self.folder))
            .map_err(|error| format!("{}: {error}", self.folder.display()))?;
        Ok(&self.folder)
    }

    /// The folder of the results.
    pub fn results(&self) -> PathBuf {
        self.folder.join("results")
    }

    /// The hidden folder of unfinished work.
    pub fn unfinished(&self) -> PathBuf {
        self.results().join(format!(".{ID}.unfinished"))
    }

    /// The summary in place.
    pub fn summary(&self) -> Result<Vec<u8>, String> {
        let path = self.results().join(ID).join("summary.json");
        fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))
    }

    /// How many finished replicas the run that wrote the results in place took over.
    pub fn taken_over(&self) -> Result<usize, String> {
        let summary: Value =
            serde_json::from_slice(&self.summary()?).map_err(|error| error.to_string())?;
        let taken = summary["provenance"]["taken_over"]["replicas"].as_u64();
        taken.map(|n| n as usize).ok_or_else(|| "the summary counts no replicas taken over".into())
    }

    /// Whether whole results are in place, older or new, and the user's file with them.
    pub fn is_whole(&self) -> Result<(), String> {
        let now = files(&self.results().join(ID))?;
        // A user's file may have been carried along, or not yet.
        if now == self.older { Ok(()) } else { same(&now, &self.reference) }
    }

    /// The same where there may have been no room for the figure, which is a warning and costs nothing
    /// else.
    pub fn is_whole_but_for_a_figure(&self) -> Result<(), String> {
        let mut summary: Value =
            serde_json::from_slice(&self.summary()?).map_err(|error| error.to_string())?;
        let warnings = summary["warnings"].as_array_mut();
        let is_of_figure = |warning: &Value| warning["about"] == "figure";
        let Some(warnings) = warnings.filter(|all| all.iter().any(is_of_figure)) else {
            return self.is_whole();
        };
        warnings.retain(|warning| !is_of_figure(warning));
        let mut now = files(&self.results().join(ID))?;
        now.insert("summary.json".into(), summary.to_string().into_bytes());
        let mut expected = self.reference.clone();
        expected.retain(|name, _| !name.starts_with("figure.") || now.contains_key(name));
        same(&now, &expected)
    }

    /// Whether an undisturbed run now ends with the results that it must end with, and leaves nothing
    /// beside them.
    pub fn ends_well(&self, program: &Program) -> Result<(), String> {
        let answer = program.run(&self.folder, &["run", "sweep.toml"], PATIENCE)?;
        answer.is_one_of(&[0])?;
        same(&files(&self.results().join(ID))?, &self.reference)?;
        for (folder, expected) in
            [(self.results(), vec![ID.to_owned()]), (self.folder.clone(), names(&self.template)?)]
        {
            let names = names(&folder)?;
            if names != expected {
                return Err(format!("{}: {names:?}, expected {expected:?}", folder.display()));
            }
        }
        Ok(())
    }
}

fn write_experiment(folder: &Path, seed: u64, length: f64) -> Result<(), String> {
    let text = EXPERIMENT.replace("SEED", &seed.to_string());
    let text = text.replace("LENGTH", &format!("{length:.1}"));
    fs::write(folder.join("sweep.toml"), text).map_err(|error| error.to_string())
}

/// Names in a folder, sorted.
pub fn names(folder: &Path) -> Result<Vec<String>, String> {
    let entries = fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut names: Vec<String> =
        entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    Ok(names)
}

fn files(folder: &Path) -> Result<Files, String> {
    let read = |name: String| match fs::read(folder.join(&name)) {
        Ok(content) => Ok((name, content)),
        Err(error) => Err(format!("{}: {error}", folder.join(name).display())),
    };
    names(folder)?.into_iter().map(read).collect()
}

/// The same to the last bit, but for what a summary says of where and when.
fn same(now: &Files, expected: &Files) -> Result<(), String> {
    if let Some(name) = expected.keys().find(|name| !now.contains_key(*name)) {
        return Err(format!("{name} is missing"));
    }
    for (name, content) in now {
        let Some(expected) = expected.get(name) else { return Err(format!("{name} is new")) };
        let is_same = match name == "summary.json" {
            true => without_provenance(content)? == without_provenance(expected)?,
            false => content == expected,
        };
        if !is_same {
            return Err(format!("{name} differs from that of an undisturbed run"));
        }
    }
    Ok(())
}

fn without_provenance(summary: &[u8]) -> Result<Value, String> {
    let mut summary: Value = serde_json::from_slice(summary)
        .map_err(|error| format!("the summary is not JSON: {error}"))?;
    match summary.as_object_mut().and_then(|all| all.remove("provenance")) {
        Some(_) => Ok(summary),
        None => Err("the summary has no provenance".into()),
    }
}
