//! `eigensync predict NETWORK`: a prediction without an experiment file. The options become the
//! experiment file that says the same, which is run like any other and kept beside the results.

use eigensync::Wanted;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::ValueEnum;
use dynamics::lyapunov::Times;
use dynamics::{Model, NodeDynamics};
use toml::{Table, Value, toml};

use crate::computed::{self, Curves};
use crate::journal::Journal;
use crate::output::{say, shown};
use crate::place::{self, Place};
use crate::plan::{self, Node, Plan};
use crate::problem::{Problem, Result, nearest};
use crate::progress::Stages;
use crate::spec::{Format, MatrixKind};
use crate::{findings, load, overview, results};

/// Points of the curve Λ(σ).
const SIGMA_POINTS: i64 = 65;
/// Times of the first look at Λ, which finds how far the curve must reach.
const FIRST_LOOK: Times = Times { step: 0.01, transient: 500.0, average: 4000.0, renormalise: 0.5 };

/// Options of `eigensync predict`.
#[derive(clap::Args)]
pub struct Args {
    /// File of the network: an edge list, or another format told by its ending (.mtx, .graphml, .csv,
    /// .npy, .npz, .mat, .zip of The Virtual Brain)
    network: PathBuf,
    /// Oscillator at every node, with parameters that are not the default ones: `lorenz`,
    /// `hindmarsh_rose:current=3.1`
    #[arg(long, value_name = "NAME[:P=X,…]")]
    oscillator: String,
    /// Component of the driving node, and the component whose equation it enters: `x:y`
    #[arg(long, value_name = "FROM:TO")]
    coupling: String,
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
    /// Shorter averages for the master stability function: a first look
    #[arg(long)]
    quick: bool,
    /// Compute all anew: take over nothing of an earlier run that was stopped before its end
    #[arg(long)]
    fresh: bool,
    /// Folder that holds the results
    #[arg(long, value_name = "FOLDER", default_value = "results")]
    results: PathBuf,
    /// Threads to use; all processors by default. Results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
}

/// Predicts, writes the results folder and says in words what was found.
pub fn run(args: &Args) -> Result<()> {
    let started = Instant::now();
    // As if the file lay beside the network, whose name the results have.
    let file = args.network.with_extension("toml");
    let id = place::id(&args.network)?;
    let stages = Stages::new(&id);
    let document = experiment(args)?;
    let made_from = ("predict", &*args.network);
    let place = Place::reserve(&args.results, &id, made_from, args.quick)?;
    let journal = Journal::open(place.unfinished(), &id, args.fresh)?;
    let origin = place.origin().clone();
    // It outlives a failure, so that it is the journal that says whether there is work to keep.
    let mut place = Some(place);
    let (plan, found, place) = journal.until(|| {
        let plan = plan(args, document, &file, (&origin.file, stages, &journal))?;
        let found = findings::find(&plan, &mut Curves::default(), &journal)
            .map_err(|problem| problem.renamed(&file, &args.network))?;
        let place = place.take().expect("results are written once");
        let place = {
            let took = (|| started.elapsed(), journal.taken());
            results::write(&plan, &found, Vec::new(), took, place)?
        };
        Ok((plan, found, place))
    })?;
    say!("{}", overview::of(&plan, &found).trim_end());
    say!("\nresults in {}, in {:.1} s", shown(&place), started.elapsed().as_secs_f64());
    say!("the same as an experiment file: {}", shown(place.join(results::EXPERIMENT)));
    Ok(())
}

/// The plan of the experiment file, with the curve's reach, which takes a first look at Λ.
fn plan(
    args: &Args,
    mut document: Table,
    file: &Path,
    (origin, stages, journal): (&Path, Stages, &Journal),
) -> Result<Plan> {
    let sigma = table([
        ("from", 0.0.into()),
        ("to", reach(args, &stages, journal)?.into()),
        ("points", SIGMA_POINTS.into()),
    ]);
    document.insert("msf".into(), table([("sigma", sigma), ("average", 4e4.into())]));
    let mut plan = plan::of_text(&text(&document)?, file, args.quick, stages)
        .map_err(|problem| problem.renamed(file, &args.network))?;
    keep(&mut plan, document, origin)?;
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
    plan.written = load::parse(&text, Path::new(results::EXPERIMENT))?.1;
    plan.kept = Some(text);
    Ok(())
}

fn text(document: &Table) -> Result<String> {
    toml::to_string_pretty(document)
        .map_err(|error| Problem::from_error("the options cannot be written as TOML", error))
}

/// A path as it can stand in an experiment file.
fn utf8(path: &Path) -> Result<&str> {
    path.to_str().ok_or_else(|| Problem::new("the path is no text in UTF-8").in_file(path))
}

/// The experiment file beside the network that says what the options say, but for the curve.
fn experiment(args: &Args) -> Result<Table> {
    args.network.metadata().map_err(|error| {
        Problem::from_error("the network cannot be opened", error).in_file(&args.network)
    })?;
    let name_of_file = utf8(Path::new(args.network.file_name().unwrap_or_default()))?;
    let (oscillator, model) = oscillator(&args.oscillator)?;
    let (from, to) = components_coupled(args)?;
    coupling(model, (from, to))?;
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
    document.insert("oscillator".into(), oscillator);
    let coupling =
        [("matrix", name(&args.matrix).into()), ("from", from.into()), ("to", to.into())];
    document.insert("coupling".into(), table(coupling));
    document.insert("spectrum".into(), spectrum(args));
    if let Some(threshold) = args.threshold {
        document.insert("prediction".into(), table([("threshold", threshold.into())]));
    }
    Ok(document)
}

fn table<const N: usize>(entries: [(&str, Value); N]) -> Value {
    Value::Table(entries.into_iter().map(|(key, value)| (key.to_owned(), value)).collect())
}

/// The name of a choice in experiment files, which is that on the command line.
fn name(choice: &impl ValueEnum) -> String {
    choice.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
}

/// `NAME` or `NAME:PARAMETER=VALUE,…` as the table `[oscillator.NAME]`.
fn oscillator(text: &str) -> Result<(Value, Model)> {
    let (name, parameters) = text.split_once(':').unwrap_or((text, ""));
    let known: Vec<&str> = Model::all().iter().map(Model::name).collect();
    if !known.contains(&name) {
        let hint = match nearest(name, known.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("known here: {}", known.join(", ")),
        };
        return Err(Problem::new(format!("there is no oscillator `{name}`")).hint(hint));
    }
    let mut values = Table::new();
    for entry in parameters.split(',').filter(|entry| !entry.is_empty()) {
        let value = entry.split_once('=').and_then(|(key, value)| {
            let value = value.trim().parse::<f64>().ok()?;
            Some((key.trim().to_owned(), value))
        });
        // With larger ones orbits leave the bounds within which they count as finite.
        let Some((key, value)) = value.filter(|(_, value)| value.abs() <= 1e6) else {
            let message = format!(
                "`--oscillator {text}`: `{entry}` is no parameter, expected one such as r=35, of a \
                 size up to 1e6"
            );
            return Err(Problem::new(message));
        };
        values.insert(key, value.into());
    }
    let value = table([(name, values.into())]);
    let model = value.clone().try_into().map_err(|error: toml::de::Error| {
        Problem::new(format!("`--oscillator {text}`: {}", error.message().trim_end()))
    })?;
    Ok((value, model))
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

fn components(model: Model) -> String {
    format!("`{}` has components {}", model.name(), model.components().join(", "))
}

/// The components that `--coupling` names.
fn components_coupled(args: &Args) -> Result<(&str, &str)> {
    args.coupling.split_once(':').ok_or_else(|| {
        let message = format!("`--coupling {}` must be two components, such as x:y", args.coupling);
        let hint =
            oscillator(&args.oscillator).map_or_else(|_| String::new(), |(_, m)| components(m));
        Problem::new(message).hint(hint)
    })
}

fn coupling(model: Model, (from, to): (&str, &str)) -> Result<dynamics::Coupling> {
    let component = |name: &str| {
        model.components().iter().position(|known| *known == name).ok_or_else(|| {
            Problem::new(format!("`--coupling` names the component \"{name}\""))
                .hint(components(model))
        })
    };
    Ok(dynamics::Coupling::pair(component(from)?, component(to)?))
}

/// How far the curve of Λ must reach.
fn reach(args: &Args, stages: &Stages, journal: &Journal) -> Result<f64> {
    let (_, model) = oscillator(&args.oscillator)?;
    let node = Node { model, coupling: coupling(model, components_coupled(args)?)? };
    computed::reach(&node, &FIRST_LOOK, stages, journal)
        .map_err(|error| Problem::from_error("the master stability function", error))
}

/// The format that was asked for, or that the name of the file tells.
fn format(args: &Args) -> Result<Format> {
    if let Some(format) = args.format {
        return Ok(format);
    }
    let ending = args.network.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    Ok(match &ending[..] {
        "mtx" => Format::MatrixMarket,
        "graphml" | "xml" => Format::Graphml,
        "csv" | "dat" => Format::Dense,
        "npy" => Format::Npy,
        "npz" => Format::Npz,
        "mat" => Format::Matlab,
        "zip" => Format::Tvb,
        "edges" | "edgelist" | "el" | "txt" | "tsv" | "" => Format::EdgeList,
        _ => {
            let mut message = String::from("has an ending that tells no format");
            write!(message, ", \".{ending}\"").expect("a string takes every text");
            return Err(Problem::new(message)
                .in_file(&args.network)
                .hint("name it: `--format edge_list`, for example"));
        }
    })
}
