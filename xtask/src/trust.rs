//! `cargo xtask trust`: whether the command keeps its promises when it is disturbed. Runs are killed
//! at random moments, system calls fail, the disk is full, two run at once, and experiment files and
//! networks are damaged at random. Everything follows from a seed; what failed is kept.

mod abuse;
mod faults;
mod finite;
mod journal;
mod kills;
mod mutation;
mod program;
mod random;
mod scene;

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::{cargo, root, setup, status};
use program::Program;
use random::Random;

/// Options of `cargo xtask trust`.
#[derive(clap::Args)]
pub struct Args {
    /// Minutes to spend; each kind of disturbance has its share
    #[arg(long, value_name = "M", default_value_t = 20.0)]
    minutes: f64,
    /// Seed of all that is random; a run is repeated by its seed, up to the moments of signals
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Only these kinds, named as in the table; may be given several times
    #[arg(long, value_name = "KIND")]
    only: Vec<String>,
    /// Try this program instead of the release build of `eigensync`
    #[arg(long, value_name = "PATH")]
    program: Option<PathBuf>,
}

/// Where things are tried, and where what failed is kept.
const FOLDER: &str = "target/trust";

/// A kind of disturbance: what it is called, its share of the time, and how it is tried.
struct Kind {
    name: &'static str,
    share: f64,
    run: fn(&mut Trial) -> Result<(), String>,
}

const KINDS: [Kind; 7] = [
    Kind { name: "killed and resumed", share: 0.4, run: kills::run },
    Kind { name: "failing system calls", share: 0.15, run: faults::system_calls },
    Kind { name: "full disk", share: 0.05, run: faults::full_disk },
    Kind { name: "full streams", share: 0.02, run: faults::full_streams },
    Kind { name: "two at once", share: 0.03, run: faults::two_at_once },
    Kind { name: "mutated experiments", share: 0.2, run: abuse::experiments },
    Kind { name: "mutated networks", share: 0.15, run: abuse::networks },
];

/// One kind being tried: what it may use, and how it went.
pub struct Trial {
    name: &'static str,
    pub program: Program,
    pub random: Random,
    /// A folder of its own to work in.
    pub folder: PathBuf,
    end: Instant,
    tried: usize,
    failures: Vec<String>,
    /// Why it was not tried, if it was not.
    skipped: Option<String>,
}

impl Trial {
    fn new(kind: &Kind, program: &Program, seed: u64, time: Duration) -> Result<Self, String> {
        let folder = root().join(FOLDER).join(kind.name.replace(' ', "-"));
        let made = remove(&folder).and_then(|()| fs::create_dir_all(&folder));
        made.map_err(|error| format!("{} cannot be made: {error}", folder.display()))?;
        Ok(Self {
            name: kind.name,
            program: program.clone(),
            random: Random::new(seed, kind.name),
            folder,
            end: Instant::now() + time,
            tried: 0,
            failures: Vec::new(),
            skipped: None,
        })
    }

    /// Whether there is time for another try; the first is always made.
    pub fn goes_on(&self) -> bool {
        self.tried == 0 || Instant::now() < self.end
    }

    /// Counts a try; where it failed, what it used is kept beside an account of what happened.
    pub fn count(&mut self, outcome: Result<(), String>, used: &[&Path]) {
        self.tried += 1;
        let Err(what) = outcome else { return };
        let kept = root().join(FOLDER).join("failed").join(format!(
            "{}-{}",
            self.name.replace(' ', "-"),
            self.tried
        ));
        let keep = || {
            fs::create_dir_all(&kept)?;
            fs::write(kept.join("what.txt"), &what)?;
            used.iter()
                .try_for_each(|path| copy(path, &kept.join(path.file_name().unwrap_or_default())))
        };
        let place = match keep() {
            Ok(()) => kept.display().to_string(),
            Err(error) => format!("could not be kept: {error}"),
        };
        eprintln!("{} {}: {what}\n    {place}", self.name, self.tried);
        self.failures.push(place);
    }

    /// Says why this kind cannot be tried here.
    pub fn skip(&mut self, why: &str) {
        self.skipped = Some(why.to_owned());
    }
}

/// Tries every kind and gives 1 if anything failed.
pub fn run(args: &Args) -> Result<u8, String> {
    if let Some(unknown) = args.only.iter().find(|name| KINDS.iter().all(|k| k.name != **name)) {
        let known = KINDS.map(|kind| kind.name).join(", ");
        return Err(format!("there is no kind `{unknown}`\n\nhint: there are {known}"));
    }
    let program = Program::new(&program(args)?);
    let _ = remove(&root().join(FOLDER).join("failed"));
    let kinds =
        || KINDS.iter().filter(|k| args.only.is_empty() || args.only.iter().any(|n| n == k.name));
    let shares: f64 = kinds().map(|kind| kind.share).sum();
    let mut trials = Vec::new();
    for kind in kinds() {
        let time = Duration::from_secs_f64(60.0 * args.minutes * kind.share / shares);
        eprintln!("{}: {:.0} s", kind.name, time.as_secs_f64());
        let mut trial = Trial::new(kind, &program, args.seed, time)?;
        (kind.run)(&mut trial)?;
        trials.push(trial);
    }
    Ok(report(&trials, args.seed))
}

/// The program to try, built if none was named.
fn program(args: &Args) -> Result<PathBuf, String> {
    if let Some(program) = &args.program {
        return program.canonicalize().map_err(|e| format!("{}: {e}", program.display()));
    }
    setup::ensure()?;
    eprintln!("building eigensync (a few minutes the first time)");
    if status(cargo().args(["build", "--release", "--package", "command"]))? != 0 {
        return Err("eigensync could not be built; cargo's own messages are above".into());
    }
    Ok(root().join("target/release/eigensync"))
}

/// Prints the table of counts; the exit status is 1 if anything failed.
fn report(trials: &[Trial], seed: u64) -> u8 {
    println!("{:<22} {:>7} {:>7} {:>7}", "kind", "tried", "held", "failed");
    for trial in trials {
        let Trial { name, tried, failures, skipped, .. } = trial;
        let failed = failures.len();
        let note = skipped.as_ref().map_or_else(String::new, |why| format!("  skipped: {why}"));
        println!("{name:<22} {tried:>7} {:>7} {failed:>7}{note}", tried - failed);
    }
    let failures: Vec<&String> = trials.iter().flat_map(|trial| &trial.failures).collect();
    for place in &failures {
        println!("failed: {place}");
    }
    println!("seed {seed}");
    u8::from(!failures.is_empty())
}

/// Removes a folder, if it is there.
pub fn remove(folder: &Path) -> std::io::Result<()> {
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

/// Copies a file or a folder; a pipe in it would be waited for, and stays behind.
pub fn copy(from: &Path, to: &Path) -> std::io::Result<()> {
    if !from.is_dir() {
        return if from.is_file() { fs::copy(from, to).map(drop) } else { Ok(()) };
    }
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        copy(&entry.path(), &to.join(entry.file_name()))?;
    }
    Ok(())
}
