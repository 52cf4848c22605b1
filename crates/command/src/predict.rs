//! `eigensync predict NETWORK`: a prediction without an experiment file. The options become the
//! experiment file that says the same, which is run like any other and kept beside the results.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use clap::ValueEnum;
use eigensync::Wanted;
use sha2::{Digest, Sha256};
use toml::{Table, Value, toml};

use crate::begun::{Begun, Kept};
use crate::first_answer::{self, FirstWork};
use crate::options::{NodeArgs, NodeTables, table, text};
use crate::output::{document as print_document, say, tell};
use crate::run::seconds;
use crate::signals;
use experiment::load;
use experiment::spec::{Experiment, Format, MatrixKind};
use experiment::{Plan, Text, plan_of};
use results_folder::{STANDARD_INPUT, id};
use runner::computed::Curves;
use runner::{Work, findings, overview, results};
use user::text::shown;
use user::{Problem, Result, Stages};

/// Longest network from standard input, in bytes.
const MOST_BYTES: u64 = 1 << 30;
/// Time of the average behind each exponent: as many follow as the accuracy of zeros asks for.
const AVERAGE: f64 = 5e3;
/// Digits of the SHA-256 of a network without a name that its results are called after.
const NAME_DIGITS: usize = 8;

/// Options of `eigensync predict`.
#[derive(clap::Args)]
pub struct Args {
    /// File of the network: an edge list, or another format told by its ending (.mtx, .graphml, .csv,
    /// .npy, .npz, .mat, .zip of The Virtual Brain); `-` for standard input, with `--format`
    network: PathBuf,
    #[command(flatten)]
    node: NodeArgs,
    /// Coupling matrix
    #[arg(long, value_enum, default_value_t = MatrixKind::Normalized)]
    matrix: MatrixKind,
    /// Modes to compute: `all`, or how many leading ones; the cascade reaches down to where the last of
    /// them becomes unstable. `auto` computes all where the stable set has an upper end and the network
    /// has up to 5000 nodes, else 20 and a zero mode for each further component
    #[arg(long, value_name = "M", default_value = "auto", value_parser = modes)]
    modes: Wanted,
    /// Instead of a number of modes: all that are unstable at this coupling strength, so that the
    /// cascade reaches down to it
    #[arg(long, value_name = "EPSILON", conflicts_with = "modes")]
    unstable_at: Option<f64>,
    /// Largest relative residual of a mode; by default 1e-12, beyond 5000 nodes 1e-10
    #[arg(long, value_name = "RESIDUAL")]
    tolerance: Option<f64>,
    /// Nodes are one cluster in steps of the eigenvector distance of at most this; without it, where
    /// it is zero up to the accuracy of the solver
    #[arg(long, value_name = "DISTANCE")]
    threshold: Option<f64>,
    /// Format of the file, where its ending does not tell
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// Matrix to take from a file that holds several
    #[arg(long, value_name = "NAME")]
    variable: Option<String>,
    /// Steps before the network is used, in this order: largest_component, drop_isolated,
    /// drop_self_loops, threshold=0.1 (drops weaker links), binarise, symmetrise=union,
    /// symmetrise=mean, symmetrise=max
    #[arg(long, value_name = "STEP", value_delimiter = ',')]
    prepare: Vec<String>,
    /// Standard error at which a zero of the master stability function is known well enough, relative to it;
    /// a first answer comes at once, to about a per cent
    #[arg(long, value_name = "SHARE", default_value_t = 1e-3)]
    accuracy: f64,
    /// Shorter averages for the master stability function, and no other answer: a first look
    #[arg(long)]
    quick: bool,
    /// Compute all anew: take over nothing of an earlier run
    #[arg(long)]
    fresh: bool,
    /// Take no curve from the cache, where earlier runs left theirs, and leave none there. It is the folder
    /// that EIGENSYNC_CACHE names, or eigensync in the user's folder of caches
    #[arg(long)]
    no_cache: bool,
    /// Print one JSON document, `summary.json`, and nothing else on standard output
    #[arg(long)]
    json: bool,
    /// Folder that holds the results
    #[arg(long, value_name = "FOLDER", default_value = "results")]
    results: PathBuf,
    /// Threads to use; all processors by default. Results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
}

/// The network of a prediction.
struct Input {
    /// As the user names it.
    named: PathBuf,
    /// Beside it the experiment file would lie that says the same.
    file: PathBuf,
    /// What came from standard input.
    given: Option<Arc<[u8]>>,
}

impl Input {
    fn of(args: &Args) -> Result<Self> {
        if args.network != Path::new(STANDARD_INPUT) {
            args.network.metadata().map_err(|error| {
                Problem::from_error("the network cannot be opened", error).in_file(&args.network)
            })?;
            return Ok(Self {
                named: args.network.clone(),
                file: args.network.clone(),
                given: None,
            });
        }
        let Some(format) = args.format else {
            let message = "the format of a network from standard input must be named";
            return Err(Problem::new(message).hint("`--format edge_list`, for example"));
        };
        let bytes = read_all(std::io::stdin().lock())?;
        // Two networks must not have one name.
        let name = format!("stdin-{}.{}", &sum(&bytes)[..NAME_DIGITS], format.ending());
        Ok(Self { named: STANDARD_INPUT.into(), file: name.into(), given: Some(bytes.into()) })
    }

    /// The name of the file, as it can stand in an experiment file.
    fn name(&self) -> Result<&str> {
        utf8(Path::new(self.file.file_name().unwrap_or_default()))
    }
}

/// All of standard input, unless it is longer than any network that can be read.
fn read_all(source: impl Read) -> Result<Vec<u8>> {
    let failed = |error| Problem::from_error("standard input cannot be read", error);
    let mut bytes = Vec::new();
    source.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > MOST_BYTES {
        let message = format!("standard input has more than {MOST_BYTES} bytes");
        return Err(Problem::new(message).hint("write it to a file, and name that"));
    }
    Ok(bytes)
}

/// Predicts, writes the results folder and says what was found.
pub fn run(args: &Args) -> Result<()> {
    let started = Instant::now();
    let input = Input::of(args)?;
    let id = id(&input.file)?;
    let node = args.node.tables()?;
    let document = experiment(args, &node, &input)?;
    let (made_from, how) = (
        ("predict", &*input.named),
        Kept { quick: args.quick, fresh: args.fresh, no_cache: args.no_cache },
    );
    let Begun { stages, place, journal } = Begun::new(&args.results, &id, made_from, how)?;
    let origin = place.origin().clone();
    // It outlives a failure, so that it is the journal that says whether there is work to keep.
    let mut place = Some(place);
    let predicted = || {
        let mut plan = plan(args, document, &input, (&origin.file, &id, &stages))?;
        let mut curves = Curves::of_two_answers();
        if !args.quick {
            let unwatched = Stages::new(&id, Arc::new(()));
            let (plan, stages) = (&mut plan, &unwatched);
            let mut work = FirstWork { plan, journal: &journal, stages };
            first_answer::tell(&mut work, &mut curves);
        }
        let work = Work { plan: &plan, journal: &journal, stages: &stages };
        let found = findings::find(&work, &mut curves)
            .map_err(|problem| problem.renamed(&plan.file, &input.named))?;
        let place = place.take().expect("results are written once");
        let took = || started.elapsed();
        let written = results::write(&work, &found, Vec::new(), None, &took, place)?;
        Ok((plan, found, written.place))
    };
    let (plan, found, place) = signals::keeping(&journal, || journal.until(predicted))?;
    let where_to = format!("results in {}, in {}", shown(&place), seconds(started.elapsed()));
    if args.json {
        let path = place.join("summary.json");
        let summary = std::fs::read_to_string(&path)
            .map_err(|error| Problem::from_error("cannot be read again", error).in_file(&path))?;
        print_document(summary.trim_end());
        tell!("{where_to}");
        return Ok(());
    }
    say!("{}\n{}", overview::of(&plan, &found), overview::cost(&stages));
    say!("\n{where_to}");
    say!("the same as an experiment file: {}", shown(place.join(results::EXPERIMENT)));
    Ok(())
}

/// The plan of the experiment file, which leaves open where Λ is looked at.
fn plan(
    args: &Args,
    mut document: Table,
    input: &Input,
    (origin, id, stages): (&Path, &str, &Stages),
) -> Result<Plan> {
    let file = input.file.with_extension("toml");
    let msf = [("average", AVERAGE.into()), ("relative_error", args.accuracy.into())];
    document.insert("msf".into(), table(msf));
    let asked = text(&document)?;
    let text = Text { text: &asked, id, file: &file, network: input.given.clone() };
    let plan = plan_of(&text, args.quick, stages);
    let mut plan = plan.map_err(|problem| problem.renamed(&file, &input.named))?;
    match &input.given {
        None => keep(&mut plan, document, origin)?,
        Some(bytes) => {
            keep(&mut plan, document, &input.file)?;
            plan.kept.push((input.name()?.to_owned(), bytes.clone()));
        }
    }
    Ok(plan)
}

/// A number of modes, or the word for one.
fn modes(text: &str) -> std::result::Result<Wanted, String> {
    match (text, text.parse::<u64>()) {
        ("all", _) => Ok(Wanted::All),
        ("auto", _) => Ok(Wanted::Auto),
        (_, Ok(modes)) if modes > 0 => Ok(Wanted::Leading(modes)),
        _ => Err("expected `all`, `auto` or a number above zero".into()),
    }
}

fn spectrum(args: &Args) -> Value {
    let modes = match args.unstable_at {
        Some(epsilon) => table([("unstable_at", epsilon.into())]),
        None => match args.modes {
            Wanted::Leading(modes) => i64::try_from(modes).unwrap_or(i64::MAX).into(),
            Wanted::All => "all".into(),
            _ => "auto".into(),
        },
    };
    let mut spectrum = toml::Table::from_iter([("modes".to_owned(), modes)]);
    spectrum.extend(args.tolerance.map(|tolerance| ("tolerance".to_owned(), tolerance.into())));
    spectrum.into()
}

/// Keeps with the results the experiment file that lies there, and what it says for the record: it
/// names the network as seen from there.
fn keep(plan: &mut Plan, mut document: Table, network: &Path) -> Result<()> {
    document["network"]["file"]["path"] = utf8(network)?.into();
    let text = text(&document)?;
    plan.written = load::parse::<Experiment>(&text, Path::new(results::EXPERIMENT))?.written;
    plan.kept = vec![(results::EXPERIMENT.to_owned(), text.into_bytes().into())];
    Ok(())
}

/// A path as it can stand in an experiment file.
fn utf8(path: &Path) -> Result<&str> {
    path.to_str().ok_or_else(|| Problem::new("the path is no text in UTF-8").in_file(path))
}

/// The experiment file beside the network that says what the options say, but for the curve.
fn experiment(args: &Args, node: &NodeTables, input: &Input) -> Result<Table> {
    let name_of_file = input.name()?;
    let mut document = toml! {
        seed = 1
    };
    let title = format!("Prediction for {name_of_file}");
    document.insert("title".into(), title.into());
    if !args.prepare.is_empty() {
        let steps: Result<Vec<Value>> = args.prepare.iter().map(|step| preparation(step)).collect();
        document.insert("prepare".into(), steps?.into());
    }
    let mut file = toml! { path = "" };
    file["path"] = name_of_file.into();
    file.insert("format".into(), name(&format(args)?).into());
    if let Some(variable) = &args.variable {
        file.insert("variable".into(), variable.as_str().into());
    }
    document.insert("network".into(), table([("file", file.into())]));
    document.insert("oscillator".into(), node.oscillator.clone());
    document.insert("coupling".into(), node.coupling(&name(&args.matrix)));
    document.insert("spectrum".into(), spectrum(args));
    if let Some(threshold) = args.threshold {
        document.insert("prediction".into(), table([("threshold", threshold.into())]));
    }
    Ok(document)
}

/// The name of a choice in experiment files, which is that on the command line.
fn name(choice: &impl ValueEnum) -> String {
    choice.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
}

/// `STEP`, `STEP=HOW` or `STEP=NUMBER` as an entry of `prepare`.
fn preparation(step: &str) -> Result<Value> {
    Ok(match step.split_once('=') {
        None => step.into(),
        Some((step, how)) => {
            let value = how.parse::<f64>().map_or_else(|_| how.into(), Value::from);
            table([(step, value)])
        }
    })
}

/// The format that was asked for, or that the name of the file tells.
fn format(args: &Args) -> Result<Format> {
    args.format.or_else(|| Format::of_ending(&args.network)).ok_or_else(|| {
        let ending = args.network.extension().unwrap_or_default().to_string_lossy();
        Problem::new(format!("has an ending that tells no format, \".{ending}\""))
            .in_file(&args.network)
            .hint("name it: `--format edge_list`, for example")
    })
}

/// SHA-256 as text.
fn sum(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
