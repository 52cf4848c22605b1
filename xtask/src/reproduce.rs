//! `cargo xtask reproduce`: every experiment, its claims, the comparison with the golden outputs.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::{cargo, data, root, setup, status};

/// Options of `cargo xtask reproduce`.
#[derive(clap::Args)]
pub struct Args {
    /// Only this experiment (the name of its file without `.toml`); may be given several times
    #[arg(long, value_name = "ID")]
    only: Vec<String>,
    /// Ten times shorter simulations: a first look in two minutes
    #[arg(long)]
    quick: bool,
    /// Afterwards make the results the new golden outputs; the single way these change
    #[arg(long, conflicts_with = "quick")]
    bless: bool,
}

/// Runs the experiments with the release build of `eigensync` and gives its exit status.
pub fn run(args: &Args) -> Result<u8, String> {
    setup::ensure()?;
    let experiments = experiments(&args.only)?;
    data::bring_missing();
    eprintln!("building eigensync (a few minutes the first time)");
    let built = status(cargo().args(["build", "--release", "--package", "command"]))?;
    if built != 0 {
        return Err("eigensync could not be built; cargo's own messages are above".into());
    }
    let mut eigensync = cargo();
    eigensync.args(["run", "--release", "--quiet", "--package", "command", "--", "run"]);
    eigensync.args(&experiments);
    if args.quick {
        eigensync.arg("--quick");
    }
    let started = SystemTime::now();
    let code = status(&mut eigensync)?;
    if args.bless {
        if code > 1 {
            return Err("nothing was blessed, because not all experiments could be run".into());
        }
        experiments.iter().try_for_each(|experiment| bless(experiment, started))?;
    }
    Ok(code)
}

/// The experiment files asked for, relative to the root; all of them if none is named.
fn experiments(only: &[String]) -> Result<Vec<PathBuf>, String> {
    let folder = root().join("experiments");
    let entries = fs::read_dir(&folder)
        .map_err(|error| format!("{} cannot be read: {error}", folder.display()))?;
    let mut ids: Vec<String> = entries
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .filter_map(|path| Some(path.file_stem()?.to_string_lossy().into_owned()))
        .collect();
    ids.sort();
    if let Some(unknown) = only.iter().find(|id| !ids.contains(id)) {
        return Err(format!(
            "there is no experiment `{unknown}`\n\nhint: there are {}",
            ids.join(", ")
        ));
    }
    ids.retain(|id| only.is_empty() || only.contains(id));
    Ok(ids.iter().map(|id| Path::new("experiments").join(id).with_extension("toml")).collect())
}

/// Copies what golden outputs consist of from the results of an experiment, unless it was left out.
fn bless(experiment: &Path, started: SystemTime) -> Result<(), String> {
    let id = experiment.file_stem().expect("an experiment file has a name");
    let golden = root().join("experiments/golden").join(id);
    let result = root().join("results").join(id).join("summary.json");
    let written = fs::metadata(&result).and_then(|file| file.modified());
    if written.map_or(true, |written| written < started) {
        println!("{} was left out, and is not blessed", id.display());
        return Ok(());
    }
    fs::create_dir_all(&golden)
        .and_then(|()| fs::copy(&result, golden.join("summary.json")))
        .map_err(|error| format!("{} cannot be blessed: {error}", result.display()))?;
    println!("blessed {}", golden.join("summary.json").display());
    Ok(())
}
