//! The command line: `eigensync run`, `predict`, `check`, `compare`, `list`.

use eigensync::Agreement;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::{Parser, Subcommand};
use dynamics::InstructionSet;

use crate::claims::{Claim, Verdict};
use crate::computed::Curves;
use crate::journal::Journal;
use crate::output::{one_line, say, shown, tell};
use crate::place::Place;
use crate::plan::{self, Plan};
use crate::problem::{Problem, Result};
use crate::spec::FigureKind;
use crate::{check, claims, compare, findings, list, place, predict, results, table};

/// Predicted states of an experiment beside simulation that are shown; its summary has them all.
const STATES_SHOWN: usize = 12;

/// Predicts which oscillators of a network synchronise into clusters, at which coupling and in which
/// order, and checks the prediction by simulation.
///
/// An experiment is a TOML file; its results go to results/NAME/. Start with `eigensync list`, then
/// `eigensync check FILE` to see what a file will do and cost, then `eigensync run FILE`.
#[derive(Parser)]
#[command(name = "eigensync", version, arg_required_else_help = true, after_help = EXIT_STATUS)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXIT_STATUS: &str = "Exit status: 0 when all claims and comparisons hold, 1 when some do not, \
2 when a command could not run.";

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
    /// Say what experiments will do and cost, without running them
    Check {
        /// Experiment files
        #[arg(required = true)]
        files: Vec<PathBuf>,
        /// As for `run`
        #[arg(long)]
        quick: bool,
    },
    /// Compare results with golden outputs and say what moved
    Compare {
        /// Names of experiments; all that have golden outputs by default
        ids: Vec<String>,
        #[command(flatten)]
        folders: Folders,
    },
    /// List experiments with their titles, and what there is of their results
    List {
        /// Folder of experiment files
        #[arg(default_value = "experiments")]
        experiments: PathBuf,
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
    match cli.command {
        Command::Run { files, quick, fresh, threads, instruction_set, folders } => {
            use_threads(threads)?;
            run_files(&files, (quick, fresh), instruction_set, &folders)
        }
        Command::Predict(args) => {
            use_threads(args.threads)?;
            predict::run(&args).map(|()| true)
        }
        Command::Check { files, quick } => {
            for file in &files {
                say!("{}", check::describe(&plan::plan(file, quick)?).trim_end());
            }
            Ok(true)
        }
        Command::Compare { ids, folders } => {
            let golden = golden_ids(&folders.golden)?;
            if let Some(unknown) = ids.iter().find(|id| !golden.contains(id)) {
                let message = format!("there is no golden output called `{unknown}`");
                let known = format!("known here: {}", golden.join(", "));
                return Err(Problem::new(message).in_file(&folders.golden).hint(known));
            }
            let ids = if ids.is_empty() { golden } else { ids };
            let place = |id: String| {
                let Some(folder) = place::aside(&folders.results, &id) else {
                    return (id.clone(), folders.results.join(id));
                };
                tell!(
                    "{id}: compared are the whole results in {}, which a run was killed over and the \
                     next one will put in place",
                    shown(&folder)
                );
                (id, folder)
            };
            compare_all(&ids.into_iter().map(place).collect::<Vec<_>>(), &folders.golden)
        }
        Command::List { experiments, folders } => {
            list::list(&experiments, &folders.results).map(|()| true)
        }
    }
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

/// Plans all files before running any, so that a slip in the last one shows at once.
fn run_files(
    files: &[PathBuf],
    (quick, fresh): (bool, bool),
    instruction_set: Option<InstructionSet>,
    folders: &Folders,
) -> Result<bool> {
    let started = Instant::now();
    let (mut plans, left_out) = plan::all(files, quick)?;
    for plan in &mut plans {
        plan.study.msf.instruction_set = instruction_set.unwrap_or(plan.study.msf.instruction_set);
    }
    let reserve =
        |plan: &Plan| Place::reserve(&folders.results, &plan.id, ("run", &plan.file), quick);
    let places = plans.iter().map(reserve).collect::<Result<Vec<Place>>>()?;
    let mut curves = Curves::default();
    let mut judged: Vec<(String, Vec<Claim>)> = Vec::new();
    let mut times = Vec::new();
    let mut agreements: Vec<(String, f64, Agreement)> = Vec::new();
    let mut states: Vec<table::StateRow> = Vec::new();
    let mut written = Vec::new();
    for (plan, place) in plans.iter().zip(places) {
        let started = Instant::now();
        let planned = plan.stages.total();
        let took = || planned + started.elapsed();
        let journal = Journal::open(place.unfinished(), &plan.id, fresh)?;
        // It outlives a failure, so that it is the journal that says whether there is work to keep.
        let mut place = Some(place);
        let done = || {
            let found = findings::find(plan, &mut curves, &journal)?;
            let claims = claims::judge(plan, &found)?;
            let place = place.take().expect("results are written once");
            let place =
                results::write(plan, &found, claims.clone(), (took, journal.taken()), place)?;
            Ok((found, claims, place))
        };
        let (found, claims, place) = journal.until(done)?;
        times.push(table::Times { id: plan.id.clone(), stages: plan.stages.took(), all: took() });
        tell!("{}: {} in {}", plan.id, shown(&place), seconds(took()));
        judged.push((plan.id.clone(), claims));
        states.extend(state_rows(plan, &found));
        if let Some(looked) = eigensync::step_effects_looked_at(&found.step_effects) {
            tell!("{}: {looked}", plan.id);
        }
        written.push((plan.id.clone(), place));
        if matches!(plan.figure_kind(), FigureKind::Matrices | FigureKind::Regions) {
            let epsilon = found.simulated.map_or_else(Vec::new, |simulated| simulated.epsilon);
            let rows = epsilon.into_iter().zip(found.agreement);
            agreements.extend(rows.map(|(epsilon, row)| (plan.id.clone(), epsilon, row)));
        }
    }
    let with_claims = judged.iter().filter(|(_, claims)| !claims.is_empty());
    say!("{}", table::claims(with_claims.map(|(id, claims)| (id.as_str(), &claims[..]))));
    if let Some(table) = table::states(&states) {
        say!("{table}\n");
    }
    let rows = agreements.iter().map(|(id, epsilon, row)| (id.as_str(), *epsilon, row));
    if let Some(table) = table::agreement(rows) {
        say!("{table}\n");
    }
    if plans.len() > 1 {
        say!("{}\n", table::times(&times));
    }
    let all = || judged.iter().flat_map(|(_, claims)| claims);
    for claim in all().filter(|claim| claim.verdict != Verdict::Holds && !claim.reason.is_empty()) {
        say!("{}: {}", one_line(&claim.name).replace('_', " "), one_line(&claim.reason));
    }
    let count = |verdict| all().filter(|claim| claim.verdict == verdict).count();
    let undecided = match count(Verdict::CannotBeJudged) {
        0 => String::new(),
        undecided => format!(", {undecided} cannot be judged"),
    };
    say!(
        "{} claims hold, {} differ as known, {} differ{undecided}; {}",
        count(Verdict::Holds),
        count(Verdict::DiffersAsKnown),
        count(Verdict::Differs),
        seconds(started.elapsed())
    );
    if count(Verdict::Differs) > 0 && plans.iter().any(|plan| plan.shortened > 1.0) {
        say!(
            "times were shortened by --quick: whether a simulated claim holds, a full run decides"
        );
    }
    for problem in &left_out {
        say!("left out: {problem}");
    }
    let golden = compare_all(&written, &folders.golden)?;
    Ok(golden && count(Verdict::Differs) + count(Verdict::CannotBeJudged) == 0)
}

/// The first predicted states with clusters, and what the sweep shows of them.
fn state_rows(plan: &Plan, found: &eigensync::Findings) -> Vec<table::StateRow> {
    let has_pairs = plan.study.sweep.as_ref().is_some_and(|sweep| sweep.observables.pairs);
    let states = found.cascade.iter().enumerate().filter(|_| has_pairs);
    let row = |(at, state): (usize, &clustering::State)| {
        let clusters = state.clusters.nontrivial();
        if clusters.is_empty() {
            return None;
        }
        let eigensync::Seen { onset, end } = found.state_seen(at, &clusters)?;
        let (id, predicted) = (plan.id.clone(), state.epsilon);
        Some(table::StateRow { id, predicted, seen: [onset, end], runs: found.runs_in(state)? })
    };
    states.filter_map(row).take(STATES_SHOWN).collect()
}

/// Compares results, given by name and place, with the golden ones of the same name.
fn compare_all(results: &[(String, PathBuf)], golden: &Path) -> Result<bool> {
    let mut all_hold = true;
    for (id, place) in results {
        let Some(comparison) = compare::compare(place, &golden.join(id))? else {
            say!("{id}: no golden output to compare with");
            continue;
        };
        let verdict = if comparison.holds() { "holds" } else { "differs" };
        say!("{id}: the comparison with the golden output {verdict}");
        for line in comparison.lines() {
            say!("    {line}");
        }
        all_hold &= comparison.holds();
    }
    Ok(all_hold)
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

fn seconds(time: Duration) -> String {
    format!("{:.1} s", time.as_secs_f64())
}
