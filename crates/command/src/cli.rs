//! The command line: `eigensync run`, `predict`, `msf`, `check`, `oscillators`, `compare`,
//! `list`.

use std::path::{Path, PathBuf};

use clap::{CommandFactory, Parser, Subcommand};
use clap_complete::Shell;
use dynamics::InstructionSet;

use crate::output::{say, tell};
use crate::{closing, curve, list, oscillators, output, predict, run, terminal};
use experiment::Planned;
use runner::atlas::words;
use runner::check::{self, Checked};
use user::text::{one_line, shown};
use user::{Problem, Result, Stages};

/// Predicts which oscillators of a network synchronise into clusters, at which coupling and in which
/// order, and checks the prediction by simulation.
///
/// An experiment is a TOML file; its results go to results/NAME/. Start with `eigensync list`, then
/// `eigensync check FILE` to see what a file will do and cost, then `eigensync run FILE`.
#[derive(Parser)]
#[command(name = "eigensync", version, arg_required_else_help = true, after_help = EXIT_STATUS)]
pub struct Cli {
    /// Say only errors and results: no progress, no warnings, which stand in the results as well
    #[arg(short, long, global = true)]
    quiet: bool,
    #[command(subcommand)]
    command: Command,
}

const EXIT_STATUS: &str = "Exit status: 0 when all claims and comparisons hold (with --quick, all that \
a quick run can decide), 1 when some do not, 2 when a command could not run.";

#[derive(Subcommand)]
enum Command {
    /// Run experiments and judge their claims
    Run {
        /// Experiment files, such as experiments/fig1-six-node.toml
        #[arg(required = true)]
        files: Vec<PathBuf>,
        /// Ten times shorter averages and transients: a first look, with larger errors
        #[arg(long)]
        quick: bool,
        /// Compute all anew: take over nothing of an earlier run that was stopped before its end
        #[arg(long)]
        fresh: bool,
        /// Threads to use; all processors by default. Results do not depend on it
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
        threads: Option<u16>,
        /// Vector instructions to use; the best by default. Results do not depend on them
        #[arg(long, value_name = "SET", value_parser = instruction_set, hide = true)]
        instruction_set: Option<InstructionSet>,
        #[command(flatten)]
        folders: Folders,
    },
    /// Predict the clusters of a network without an experiment file
    ///
    /// For example: eigensync predict roads.mtx --oscillator lorenz --coupling x:y
    Predict(predict::Args),
    /// Compute the master stability function of an oscillator, without a network
    ///
    /// For example: eigensync msf --oscillator rossler --coupling x:x
    Msf(curve::Args),
    /// Say what experiments will do and cost, without running them
    Check {
        /// Experiment files
        #[arg(required = true)]
        files: Vec<PathBuf>,
        /// As for `run`
        #[arg(long)]
        quick: bool,
        /// Print one JSON document, and nothing else, on standard output
        #[arg(long)]
        json: bool,
    },
    /// List the oscillators that are known, or show one with its equations
    ///
    /// For example: eigensync oscillators rossler
    Oscillators {
        /// Which one
        name: Option<String>,
        /// Print one JSON document, and nothing else, on standard output
        #[arg(long)]
        json: bool,
    },
    /// Compare results with golden outputs and say what moved
    Compare {
        /// Names of experiments; all that have golden outputs by default
        ids: Vec<String>,
        /// Say of every value that differs by how much, whether it is judged or not
        #[arg(long)]
        all: bool,
        #[command(flatten)]
        folders: Folders,
    },
    /// Print the completions of a shell
    ///
    /// For example, for bash: eigensync completions bash >
    /// ~/.local/share/bash-completion/completions/eigensync
    Completions {
        /// Which shell
        #[arg(value_enum)]
        shell: Shell,
    },
    /// Write the manual pages into a folder; `cargo xtask dist` does
    #[command(hide = true)]
    Man {
        /// Folder that is there
        folder: PathBuf,
    },
    /// List experiments with their titles, and what there is of their results
    List {
        /// Folder of experiment files
        #[arg(default_value = "experiments")]
        experiments: PathBuf,
        /// Print one JSON document, and nothing else, on standard output
        #[arg(long)]
        json: bool,
        #[command(flatten)]
        folders: Folders,
    },
}

#[derive(clap::Args)]
struct Folders {
    /// Folder that holds the results
    #[arg(long, value_name = "FOLDER", default_value = "results")]
    results: PathBuf,
    /// Folder that holds the golden outputs
    #[arg(long, value_name = "FOLDER", default_value = "experiments/golden")]
    golden: PathBuf,
}

/// Runs a command; the result says whether everything held.
pub fn run(cli: Cli) -> Result<bool> {
    if cli.quiet {
        output::be_quiet();
    }
    match cli.command {
        Command::Run { files, quick, fresh, threads, instruction_set, folders } => {
            use_threads(threads)?;
            let Folders { results, golden } = folders;
            run::run(&files, &run::Options { quick, fresh, instruction_set, results, golden })
        }
        Command::Predict(args) => {
            use_threads(args.threads)?;
            predict::run(&args).map(|()| true)
        }
        Command::Msf(args) => {
            use_threads(args.threads)?;
            curve::run(&args).map(|()| true)
        }
        Command::Check { files, quick, json } => {
            let plans = files.iter().map(|file| {
                let id = results_folder::id(file)?;
                let stages = Stages::new(&id, terminal::watch());
                experiment::plan(file, &id, quick, &stages)
            });
            if json {
                let checked = plans.map(|plan| Ok(checked(&plan?)));
                let checked = checked.collect::<Result<Vec<_>>>()?;
                let checked = serde_json::json!({ "experiments": checked });
                output::document(&format!("{checked:#}"));
                return Ok(true);
            }
            for plan in plans {
                let described = match plan? {
                    Planned::Experiment(plan) => check::describe(&plan),
                    Planned::Atlas(plan) => words::describe(&plan),
                };
                say!("{}", described.trim_end());
            }
            Ok(true)
        }
        Command::Compare { ids, all, folders } => {
            let golden = golden_ids(&folders.golden)?;
            if let Some(unknown) = ids.iter().find(|id| !golden.contains(id)) {
                let message = format!("there is no golden output called `{unknown}`");
                let known = format!("known here: {}", golden.join(", "));
                return Err(Problem::new(message).in_file(&folders.golden).hint(known));
            }
            let ids = if ids.is_empty() { golden } else { ids };
            let place = |id: String| {
                let Some(folder) = results_folder::aside(&folders.results, &id) else {
                    return (id.clone(), folders.results.join(id));
                };
                tell!(
                    "{id}: compared are the whole results in {}, which a run was killed over and the \
                     next one will put in place",
                    shown(&folder)
                );
                (id, folder)
            };
            compare_all(&ids.into_iter().map(place).collect::<Vec<_>>(), &folders.golden, all)
        }
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "eigensync", &mut script);
            output::document(String::from_utf8_lossy(&script).trim_end());
            Ok(true)
        }
        Command::Man { folder } => {
            clap_mangen::generate_to(Cli::command(), &folder).map(|()| true).map_err(|error| {
                Problem::from_error("manual pages cannot be written", error).in_file(&folder)
            })
        }
        Command::Oscillators { name, json } => {
            oscillators::oscillators(name.as_deref(), json).map(|()| true)
        }
        Command::List { experiments, json, folders } => {
            list::list(&experiments, &folders.results, json).map(|()| true)
        }
    }
}

/// What a plan will do and cost, for programs.
fn checked(plan: &Planned) -> serde_json::Value {
    let value = match plan {
        Planned::Experiment(plan) => serde_json::to_value(Checked::of(plan)),
        Planned::Atlas(plan) => serde_json::to_value(words::Checked::of(plan)),
    };
    value.expect("what was checked is made of texts and numbers")
}

/// More threads than so many for each processor would only wait for one another.
const THREADS_A_PROCESSOR: usize = 4;

fn use_threads(threads: Option<u16>) -> Result<()> {
    let Some(asked) = threads.map(usize::from) else { return Ok(()) };
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = asked.min(THREADS_A_PROCESSOR * processors);
    if threads < asked {
        tell!(
            "warning: `--threads {asked}`: {threads} are used, {THREADS_A_PROCESSOR} for each of \
             {processors} processor(s)"
        );
    }
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global()
        .map_err(|error| Problem::from_error("the threads cannot be started", error))
}

fn instruction_set(name: &str) -> std::result::Result<InstructionSet, String> {
    let set = match name {
        "baseline" => InstructionSet::Baseline,
        "avx2" => InstructionSet::Avx2,
        "avx512" => InstructionSet::Avx512,
        _ => return Err("expected baseline, avx2 or avx512".into()),
    };
    if set.is_available() { Ok(set) } else { Err("this processor does not have it".into()) }
}

/// Compares results, given by name and place, with the golden ones of the same name: what differs, or
/// everything that does, and a line for all.
fn compare_all(results: &[(String, PathBuf)], golden: &Path, all: bool) -> Result<bool> {
    let mut compared = Vec::new();
    for (id, place) in results {
        let Some(comparison) = golden::compare(place, &golden.join(id))? else { continue };
        let lines = if all { comparison.lines() } else { comparison.first_failures() };
        for line in lines {
            say!("{}: {}", one_line(id), one_line(line));
        }
        compared.push((&id[..], comparison));
    }
    let compared: Vec<_> = compared.iter().map(|(id, comparison)| (*id, comparison)).collect();
    say!("{}", closing::compared_in_a_line(&compared));
    Ok(compared.iter().all(|(_, comparison)| comparison.holds()))
}

fn golden_ids(golden: &Path) -> Result<Vec<String>> {
    let bless = "`cargo xtask reproduce --bless` makes golden outputs of results";
    let entries = std::fs::read_dir(golden).map_err(|error| {
        Problem::from_error("cannot be read", error).in_file(golden).hint(bless)
    })?;
    let with_summary = |path: &PathBuf| path.join("summary.json").exists();
    let mut ids: Vec<String> = entries
        .flatten()
        .map(|entry| entry.path())
        .filter(with_summary)
        .filter_map(|path| Some(path.file_name()?.to_string_lossy().into_owned()))
        .collect();
    if ids.is_empty() {
        return Err(Problem::new("holds no golden outputs").in_file(golden).hint(bless));
    }
    ids.sort();
    Ok(ids)
}
