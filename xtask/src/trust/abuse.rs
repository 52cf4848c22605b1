//! Experiment files and networks damaged at random: read, or refused with a message that names the
//! place, within ten seconds and 2 GB, and without a number in the results that is none.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use serde_json::Value;

use super::program::{Answer, STOPS};
use super::scene::names;
use super::{Trial, remove};
use super::{finite, mutation};
use crate::root;

/// Longest time that reading and checking a file may take.
const LIMIT: Duration = Duration::from_secs(10);

/// An experiment of a tenth of a second that has something of everything.
const EXPERIMENT: &str = r#"title = "To be damaged"
source = "nowhere"
seed = 1
prepare = ["drop_self_loops", { symmetrise = "max" }, "largest_component"]

NETWORK

[groups.ranges]
left = [1, 3]
right = [4, 6]

[oscillator.lorenz]
alpha = 10.0
r = 35.0
b = 2.6666666666666665

[coupling]
matrix = "laplacian"
from = "x"
to = "y"

[spectrum]
modes = 6
tolerance = 1e-10

[prediction]
threshold = 0.001

[msf]
sigma = { from = 0.0, to = 12.0, points = 7 }
step = 0.01
transient = 10.0
average = 40.0
relative_error = 0.05

[sweep]
epsilon = { from = 1.0, to = 5.0, points = 3 }
seeds = 2
step = 0.01
transient = 10.0
average = 20.0
error_to = "2"
clusters = [[1, 2, 6], [3, 4, 5]]
synchronised_below = 0.1

[figure]
eigenvectors = [2, 3]
mark_modes = [2]

[claims.integers]
of = "eigenvalues"
equals = [0, -2, -3, -4, -5, -6]
abs_tol = 1e-9
"#;

/// The tables that a network can come from.
const SOURCES: [&str; 2] = [
    "[network.file]\npath = \"network.edges\"",
    "[network.communities]\nsizes = [3, 3]\np_within = 0.9\np_between = 0.5\nseed = 3",
];

/// Experiments that take a network of any format and hardly any time.
const READER: &str = r#"title = "To read a network"
seed = 1
prepare = ["drop_self_loops", { symmetrise = "max" }, { threshold = 0.0 }, "largest_component"]

[network.file]
path = "NETWORK"

[oscillator.lorenz]

[coupling]
matrix = "normalized"
from = "x"
to = "y"

[spectrum]
modes = 2

[msf]
sigma = { from = 0.0, to = 12.0, points = 4 }
transient = 5.0
average = 20.0
"#;

/// Damaged experiment files: our own, which are run, and those of the project, which are checked.
pub fn experiments(trial: &mut Trial) -> Result<(), String> {
    let own: Vec<String> =
        SOURCES.iter().map(|table| EXPERIMENT.replace("NETWORK", table)).collect();
    let mut all = own.clone();
    for file in files(&root().join("experiments"), |ending| ending == "toml")? {
        all.push(fs::read_to_string(file).map_err(|error| error.to_string())?);
    }
    let folder = trial.folder.join("try");
    while trial.goes_on() {
        fresh(&folder)?;
        let chosen = trial.random.below(2 * all.len());
        let text = all.get(chosen).unwrap_or(&own[chosen % own.len()]);
        let file = folder.join("damaged.toml");
        let bytes = mutation::experiment(text, &all, &mut trial.random);
        fs::write(&file, bytes).map_err(|error| error.to_string())?;
        let outcome = check(trial, &folder)?;
        let is_own = own.contains(text);
        let outcome = match outcome {
            Ok(true) if is_own => run(trial, &folder)?,
            other => other.map(drop),
        };
        trial.count(outcome, &[&folder]);
    }
    Ok(())
}

/// Damaged networks, in all formats of which there are fixtures; their endings tell them.
pub fn networks(trial: &mut Trial) -> Result<(), String> {
    let mut fixtures = files(&root().join("crates/graph/tests/fixtures"), |ending| ending != "py")?;
    fixtures.extend(files(&root().join("experiments/networks"), |_| true)?);
    let folder = trial.folder.join("try");
    while trial.goes_on() {
        fresh(&folder)?;
        let fixture = trial.random.of(&fixtures).clone();
        let ending = fixture.extension().unwrap_or_default().to_string_lossy().into_owned();
        let mut bytes = fs::read(&fixture).map_err(|error| error.to_string())?;
        mutation::damage(&mut bytes, &mut trial.random);
        let name = format!("network.{ending}");
        let text = READER.replace("NETWORK", &name);
        fs::write(folder.join(&name), bytes)
            .and_then(|()| fs::write(folder.join("damaged.toml"), text))
            .map_err(|error| error.to_string())?;
        let outcome = match check(trial, &folder)? {
            Ok(true) => run(trial, &folder)?,
            other => other.map(drop),
        };
        trial.count(outcome, &[&folder]);
    }
    Ok(())
}

/// A folder with a network, and with a pipe that nobody writes to.
fn fresh(folder: &Path) -> Result<(), String> {
    let network = root().join("experiments/networks/six-node.edges");
    remove(folder)
        .and_then(|()| fs::create_dir_all(folder))
        .and_then(|()| fs::copy(network, folder.join("network.edges")))
        .map_err(|error| format!("{}: {error}", folder.display()))?;
    let _ = Command::new("mkfifo").arg(folder.join("pipe")).status();
    Ok(())
}

/// `eigensync check`: whether the file is right; a message says what is wrong with it.
fn check(trial: &Trial, folder: &Path) -> Result<Result<bool, String>, String> {
    let answer = trial.program.run(folder, &["check", "damaged.toml"], LIMIT)?;
    let outcome = answer.is_one_of(&[0, 2]).and_then(|()| match answer.status.code() {
        Some(0) => Ok(true),
        _ => names_the_place(&answer, folder).map(|()| false),
    });
    Ok(outcome.map_err(|why| format!("check: {why}")))
}

/// `eigensync run`, stopped where it would take long.
fn run(trial: &Trial, folder: &Path) -> Result<Result<(), String>, String> {
    let mut running = trial.program.start(folder, &[], &["run", "damaged.toml"])?;
    if running.lasts(LIMIT)? {
        running.signal("INT")?;
    }
    let answer = running.end(STOPS)?;
    let outcome = answer.is_one_of(&[0, 1, 2, 130]).and_then(|()| match answer.status.code() {
        Some(2) => names_the_place(&answer, folder),
        Some(0 | 1) => numbers_are_finite(&folder.join("results/damaged")),
        _ => Ok(()),
    });
    Ok(outcome.map_err(|why| format!("run: {why}")))
}

/// A message names a file that is here, and in it a key or a line or what else there is.
fn names_the_place(answer: &Answer, folder: &Path) -> Result<(), String> {
    let Some(at) = answer.stderr.find("error: ") else {
        return Err(format!("no message\n{}", answer.stderr));
    };
    let message = &answer.stderr[at..];
    let names_a_file = names(folder)?.iter().any(|name| message.contains(name.as_str()));
    let names_a_place = message.contains('`') || message.contains("line ") || {
        message.split(':').any(|piece| piece.parse::<usize>().is_ok())
    };
    if message.len() > 4000 {
        return Err(format!("a message of {} bytes", message.len()));
    }
    if message.chars().any(|c| c.is_control() && c != '\n' && c != '\t') {
        return Err(format!("control characters in {message:?}"));
    }
    if names_a_file && names_a_place { Ok(()) } else { Err(format!("no place in: {message}")) }
}

/// No number in the summary or the tables is NaN or infinite.
fn numbers_are_finite(results: &Path) -> Result<(), String> {
    let text = fs::read_to_string(results.join("summary.json")).map_err(|e| e.to_string())?;
    let summary: Value = serde_json::from_str(&text).map_err(|error| error.to_string())?;
    if let Some(key) = finite::first_that_is_not(&summary) {
        return Err(format!("summary.json: {key} is not finite"));
    }
    // The other tables have labels in them, as first lines have, and a node may be called `nan`.
    for table in ["spectrum.csv", "msf.csv", "sweep.csv"].map(|name| results.join(name)) {
        if !table.exists() {
            continue;
        }
        let text = fs::read_to_string(&table).map_err(|error| error.to_string())?;
        let is_none = |field: &str| field.parse::<f64>().is_ok_and(|number| !number.is_finite());
        if let Some(line) = text.lines().skip(1).find(|line| line.split(',').any(is_none)) {
            return Err(format!("{}: not finite: {line}", table.display()));
        }
    }
    Ok(())
}

/// Files of a folder with one of these endings, sorted.
fn files(folder: &Path, is_wanted: impl Fn(&str) -> bool) -> Result<Vec<PathBuf>, String> {
    let paths = names(folder)?.into_iter().map(|name| folder.join(name));
    let has = |path: &PathBuf| {
        let ending = path.extension().unwrap_or_default().to_string_lossy().into_owned();
        is_wanted(&ending)
    };
    Ok(paths.filter(has).collect())
}
