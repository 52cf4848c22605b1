//! `cargo xtask bench`: the benchmarks, the peers, and a folder of results that says on what machine.
//!
//! Each run goes to `benches/runs/DATE-COMMIT/`, written whole or not at all:
//!
//! - `machine.json`: processor, instruction sets, compilers, load, commit
//! - `all.csv`: every benchmark with its mean time and standard error
//! - `simulation.csv`: node-steps a second of eigensync and, with `--peers`, of the peers
//! - `growth.csv`: exponents of t ∝ nᵖ where an operation was timed from small to large
//! - `leading_modes.csv`, `clusters.csv`: seconds of eigensync and, with `--peers`, of the peers
//! - `peers.csv`, `errors.csv`, `notes.txt`: errors of the peers and of eigensync's methods, and what could not be measured and why

mod criterion;
mod equal_error;
mod growth;
mod large;
mod machine;
mod simulation;
mod table;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::{cargo, root, setup, status};
use machine::Machine;

/// Options of `cargo xtask bench`.
#[derive(clap::Args)]
pub struct Args {
    /// Only benchmarks whose name holds this text, such as `simulate/`
    #[arg(long, value_name = "TEXT")]
    filter: Option<String>,
    /// Also measure the tools that people use today (minutes; needs Python and a C++ compiler)
    #[arg(long)]
    peers: bool,
    /// Only peers whose file name holds one of these texts, such as `heyoka`
    #[arg(long, value_name = "TEXT", requires = "peers")]
    peer: Vec<String>,
    /// The largest network that peers find modes and clusters of, in nodes
    #[arg(long, value_name = "N", default_value_t = 100_000)]
    largest: usize,
    /// Seconds instead of minutes: shows that everything runs, not how fast
    #[arg(long)]
    quick: bool,
    /// Processor core that everything is measured on
    #[arg(long, value_name = "N", default_value_t = 0)]
    core: u16,
    /// Measure nothing: make the table of docs/performance.md from a run, the newest by default
    #[arg(long, value_name = "RUN", num_args = 0..=1, conflicts_with_all = ["filter", "peers", "quick"])]
    #[allow(clippy::option_option)]
    table: Option<Option<PathBuf>>,
}

/// The largest load average at which timings mean something.
const QUIET: f64 = 0.5;

/// Measures, or makes the table, and gives the exit status.
pub fn run(args: &Args) -> Result<u8, String> {
    let runs = root().join("benches/runs");
    match &args.table {
        Some(run) => table::update(&runs, run.as_deref()),
        None => measure(args, &runs),
    }
}

fn measure(args: &Args, runs: &Path) -> Result<u8, String> {
    setup::ensure()?;
    let machine = Machine::here(args.core);
    let work = root().join("target/bench");
    let unfinished = work.join("run");
    make_empty(&unfinished)?;
    let mut notes = Notes { folder: &unfinished };
    if let Some(filter) = &args.filter {
        notes.add(&format!("only benchmarks whose name holds `{filter}` were run"))?;
    }
    if !args.peer.is_empty() {
        notes.add(&format!("of the peers only {} were measured", args.peer.join(", ")))?;
    }
    if args.quick {
        notes.add("measured with --quick: these are no measurements to cite")?;
    }
    if let Some(load) = machine.load().filter(|&load| load > QUIET) {
        notes.add(&format!("the machine was busy when the run began, with a load of {load}"))?;
    }
    let fixtures = work.join("fixtures");
    let instruction_set = write_fixtures(&fixtures)?;
    let programs = build_benchmarks()?;
    let measured = run_benchmarks(args, &programs, &work)?;
    if args.peers {
        run_peers(args, &programs, &measured, &work, &unfinished)?;
    } else {
        notes.add("the peers were not measured; --peers does")?;
    }
    let ours = format!("eigensync {} {instruction_set}", env!("CARGO_PKG_VERSION"));
    let peers = read_if_there(&unfinished.join("peers.csv"))?;
    let rows = simulation::rows(&measured, &ours, peers.as_deref(), &fixtures)?;
    if measured.iter().all(|benchmark| !benchmark.id.starts_with(simulation::PEAK)) {
        notes.add("the peak was not measured, so shares of it are left empty")?;
    }
    for operation in &large::OPERATIONS {
        operation.complete(&measured, &ours, &work.join("found"), &unfinished)?;
    }
    write(&unfinished.join("all.csv"), &criterion::to_csv(&measured))?;
    write(&unfinished.join("simulation.csv"), &simulation::to_csv(&rows))?;
    if let Some(growth) = growth::to_csv(&measured) {
        write(&unfinished.join("growth.csv"), &growth)?;
    }
    let machine_json = serde_json::to_string_pretty(&machine).expect("text and numbers");
    write(&unfinished.join("machine.json"), &format!("{machine_json}\n"))?;
    let place = keep(&unfinished, runs, &machine.folder_name())?;
    if !rows.is_empty() {
        println!("{}", table::markdown(&rows));
        println!("{}", table::at_equal_error(&rows, &place)?.unwrap_or_default());
    }
    println!("{}", growth::markdown(&measured).unwrap_or_default());
    println!("{}", table::modes_and_clusters(&place)?.unwrap_or_default());
    println!("{}", place.display());
    Ok(0)
}

/// Writes the networks as text and gives the name of the instruction set that eigensync will use.
fn write_fixtures(folder: &Path) -> Result<String, String> {
    progress("writing the networks (the first time this builds eigensync's libraries)");
    let mut command = cargo();
    command.args(["run", "--quiet", "--release", "--manifest-path", "benches/fixtures/Cargo.toml"]);
    command.arg("--target-dir").arg(root().join("target")).arg("--").arg(folder);
    let output = command
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| format!("cannot start cargo: {error}"))?;
    if !output.status.success() {
        return Err("the networks could not be written; the messages are above".into());
    }
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// Builds all benchmarks of the workspace.
fn build_benchmarks() -> Result<Vec<criterion::Program>, String> {
    progress("building the benchmarks");
    let mut build = cargo();
    build.args(["bench", "--workspace", "--bench", "*", "--no-run"]);
    build.args(["--message-format", "json-render-diagnostics"]);
    let output = build
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| format!("cannot start cargo: {error}"))?;
    if !output.status.success() {
        return Err("the benchmarks could not be built; cargo's own messages are above".into());
    }
    Ok(criterion::programs(&String::from_utf8_lossy(&output.stdout)))
}

/// Runs the benchmarks, on one core but for some, and reads how long they took; what they found is in
/// `found/`.
fn run_benchmarks(
    args: &Args,
    programs: &[criterion::Program],
    work: &Path,
) -> Result<Vec<criterion::Benchmark>, String> {
    let (home, found) = (work.join("criterion"), work.join("found"));
    make_empty(&home)?;
    make_empty(&found)?;
    for program in programs {
        progress(&format!("running {}", program.name));
        let is_free =
            |operation: &large::Operation| operation.on_all_cores && operation.name == program.name;
        let mut command = if large::OPERATIONS.iter().any(is_free) {
            Command::new(&program.executable)
        } else {
            let mut command = on_core(args.core, &program.executable);
            command.env("RAYON_NUM_THREADS", "1");
            command
        };
        command.arg("--bench").args(&args.filter).current_dir(&program.package);
        command.env("CRITERION_HOME", &home).env("EIGENSYNC_FOUND", &found);
        command.env("OPENBLAS_NUM_THREADS", "1");
        if args.quick {
            command.args(["--warm-up-time", "0.1", "--measurement-time", "0.2"]);
        }
        // What criterion says on the way is progress, not a result.
        command.stdout(std::io::stderr());
        if status(&mut command)? != 0 {
            return Err(format!("{} failed; its own messages are above", program.name));
        }
    }
    criterion::read(&home)
}

/// Measures the peers on what eigensync was measured on.
fn run_peers(
    args: &Args,
    programs: &[criterion::Program],
    measured: &[criterion::Benchmark],
    work: &Path,
    out: &Path,
) -> Result<(), String> {
    let python = ["python3", "python"]
        .into_iter()
        .find(|python| Command::new(python).arg("--version").output().is_ok())
        .ok_or("there is no Python here, which the peers need\n\nhint: install Python 3.11 or later, or leave --peers out")?;
    let fixtures = work.join("fixtures");
    let mut command = Command::new(python);
    command
        .arg(root().join("benches/peers/run.py"))
        .args([&fixtures, &work.join("peers")])
        .arg(out);
    command.arg("--core").arg(args.core.to_string());
    if !measured.iter().any(|benchmark| benchmark.id.starts_with(simulation::SIMULATE)) {
        command.arg("--no-simulation");
    }
    for operation in &large::OPERATIONS {
        let option = format!("--{}", operation.name.replace('_', "-"));
        command.arg(option).args(operation.write_fixtures(
            measured,
            programs,
            args.largest,
            work,
        )?);
    }
    if !args.peer.is_empty() {
        command.arg("--only").arg(args.peer.join(","));
    }
    if args.quick {
        command.args(["--seconds", "0.02", "--repeats", "1", "--longest", "20"]);
    }
    match status(&mut command)? {
        0 => Ok(()),
        _ => Err("the peers could not be measured; the messages are above".into()),
    }
}

/// A command that keeps to one core, where the system can do that.
fn on_core(core: u16, program: &Path) -> Command {
    if Command::new("taskset").arg("--version").output().is_err() {
        progress("there is no taskset here, so the system chooses the cores");
        return Command::new(program);
    }
    let mut command = Command::new("taskset");
    command.arg("-c").arg(core.to_string()).arg(program);
    command
}

/// Moves a finished run to its place, beside earlier ones of the same day and commit.
fn keep(unfinished: &Path, runs: &Path, name: &str) -> Result<PathBuf, String> {
    let names = std::iter::once(name.to_owned()).chain((2..).map(|k| format!("{name}-{k}")));
    let place = names.map(|name| runs.join(name)).find(|place| !place.exists());
    let place = place.expect("there are more numbers than folders");
    fs::create_dir_all(runs)
        .and_then(|()| fs::rename(unfinished, &place))
        .map_err(|error| format!("{} cannot be written: {error}", place.display()))?;
    Ok(place)
}

/// Lines of `notes.txt`.
struct Notes<'a> {
    folder: &'a Path,
}

impl Notes<'_> {
    fn add(&mut self, line: &str) -> Result<(), String> {
        progress(line);
        let path = self.folder.join("notes.txt");
        fs::OpenOptions::new()
            .create(true)
            .append(true)
            .open(&path)
            .and_then(|mut file| writeln!(file, "{line}"))
            .map_err(|error| format!("{} cannot be written: {error}", path.display()))
    }
}

fn make_empty(folder: &Path) -> Result<(), String> {
    if folder.exists() {
        fs::remove_dir_all(folder)
            .map_err(|error| format!("{} cannot be emptied: {error}", folder.display()))?;
    }
    fs::create_dir_all(folder)
        .map_err(|error| format!("{} cannot be made: {error}", folder.display()))
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{} cannot be read: {error}", path.display()))
}

fn read_if_there(path: &Path) -> Result<Option<String>, String> {
    if path.exists() { read(path).map(Some) } else { Ok(None) }
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    fs::write(path, text).map_err(|error| format!("{} cannot be written: {error}", path.display()))
}

fn progress(text: &str) {
    eprintln!("bench: {text}");
}
