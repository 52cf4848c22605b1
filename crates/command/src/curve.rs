//! `eigensync msf`: the master stability function of an oscillator and its coupling, without a network.
//!
//! Λ(σ) is that of any network of these oscillators. It is planned as for two nodes with one link, so
//! that options are checked, and doubts are said, in the same words as for `run` and `predict`.

use std::path::{Path, PathBuf};
use std::time::Instant;

use comfy_table::Table as TextTable;
use comfy_table::presets::NOTHING;
use eigensync::numbers::{four_digits, two_digits, with_error};
use eigensync::{Warning, Warnings};
use msf::{MasterStability, Zero};
use serde::Serialize;
use serde_json::{Value, json};
use toml::toml;

use crate::begun::{Begun, Kept};
use crate::options::{NodeArgs, table, text};
use crate::output::{document, say, tell};
use crate::run::seconds;
use crate::signals;
use experiment::{Plan, Text, plan_of};
use results_folder::Folder;
use runner::provenance::{Provenance, known_by};
use runner::record::{LAYOUT, MsfRecord, msf_record};
use runner::results::write_msf;
use runner::{Work, findings, overview, warning};
use std::sync::Arc;
use user::text::shown;
use user::{Problem, Result, Stages, Watch};

/// Most rows of the curve that are shown.
const ROWS: usize = 17;

/// Options of `eigensync msf`.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    node: NodeArgs,
    /// Where to look, and at how many points: `0:16:65`. By default from 0 as far as the step goes,
    /// finer where a window may be hidden
    #[arg(long, value_name = "FROM:TO:POINTS", value_parser = grid)]
    sigma: Option<(f64, f64, u32)>,
    /// Step of the integrator, in model time units
    #[arg(long, value_name = "STEP")]
    step: Option<f64>,
    /// Time over which each exponent is averaged
    #[arg(long, value_name = "TIME", default_value_t = 4e4)]
    average: f64,
    /// Shorter averages: a first look
    #[arg(long)]
    quick: bool,
    /// Compute all anew: take over nothing of an earlier run that was stopped before its end
    #[arg(long)]
    fresh: bool,
    /// Take no curve from the cache, where earlier runs left theirs, and leave none there. It is the folder
    /// that EIGENSYNC_CACHE names, or eigensync in the user's folder of caches
    #[arg(long)]
    no_cache: bool,
    /// Print one JSON document, and nothing else, on standard output
    #[arg(long)]
    json: bool,
    /// Folder that holds the results
    #[arg(long, value_name = "FOLDER", default_value = "results")]
    results: PathBuf,
    /// Threads to use; all processors by default. Results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
}

/// `summary.json` of a curve alone: the keys of a run's summary that there are without a network.
#[derive(Serialize)]
struct Summary {
    layout: u32,
    id: String,
    title: String,
    experiment: Value,
    shortened: f64,
    msf: MsfRecord,
    warnings: Vec<Warning>,
    provenance: Provenance,
}

/// Computes the curve, writes the results folder and says what was found.
pub fn run(args: &Args) -> Result<()> {
    let started = Instant::now();
    let id = id(&args.node);
    let (made_from, how) = (
        ("msf", Path::new("")),
        Kept { quick: args.quick, fresh: args.fresh, no_cache: args.no_cache },
    );
    let Begun { stages, place, journal } = Begun::new(&args.results, &id, made_from, how)?;
    let mut place = Some(place);
    let computed = || {
        let plan = plan(args, &id, &stages)?;
        let work = Work { plan: &plan, journal: &journal, stages: &stages };
        let (msf, mut warnings) = findings::curve(&work)?;
        let place = place.take().expect("results are written once");
        let folder = place.folder()?;
        write_msf(&folder, &msf)?;
        warnings.extend(draw(&folder, &plan, &msf, stages.watch()));
        let took = (started.elapsed(), &stages.took()[..]);
        let summary = Summary {
            layout: LAYOUT,
            id: id.clone(),
            title: plan.title.clone(),
            experiment: experiment(&plan),
            shortened: plan.shortened,
            msf: msf_record(&msf),
            warnings: warnings.iter().map(warning::kept).collect(),
            provenance: Provenance::new(known_by(&plan), journal.taken(), took, place.origin()),
        };
        let json = serde_json::to_value(&summary)
            .map(|value| runner::json::text(&value))
            .map_err(|error| Problem::from_error("the summary cannot be written as JSON", error))?;
        folder.write("summary.json", format!("{json}\n"))?;
        Ok((plan, msf, place.finish(folder)?, json))
    };
    let (plan, msf, written, json) = signals::keeping(&journal, || journal.until(computed))?;
    let where_to = format!("results in {}, in {}", shown(&written), seconds(started.elapsed()));
    if args.json {
        document(&json);
        tell!("{where_to}");
    } else {
        say!("{}\n{where_to}", said(&plan, &msf));
    }
    Ok(())
}

/// What the results are called after: oscillator, parameters and coupling.
fn id(node: &NodeArgs) -> String {
    let text = format!("{}-{}", node.oscillator, node.coupling);
    text.chars().map(|c| if c.is_alphanumeric() || "_=.+-".contains(c) { c } else { '-' }).collect()
}

fn plan(args: &Args, id: &str, stages: &Stages) -> Result<Plan> {
    let node = args.node.tables()?;
    let mut msf = toml::Table::new();
    if let Some((low, high, points)) = args.sigma {
        let sigma = [("from", low.into()), ("to", high.into()), ("points", points.into())];
        msf.insert("sigma".into(), table(sigma));
    }
    msf.insert("average".into(), args.average.into());
    msf.extend(args.step.map(|step| ("step".to_owned(), step.into())));
    let mut document = toml! {
        seed = 1
    };
    let title =
        format!("Master stability function of {}, {}", args.node.oscillator, node.node.function);
    document.insert("title".into(), title.into());
    let pair = [
        ("sizes", toml::Value::from(vec![2])),
        ("p_within", 1.0.into()),
        ("p_between", 0.0.into()),
    ];
    document.insert("network".into(), table([("communities", table(pair))]));
    document.insert("coupling".into(), node.coupling("laplacian"));
    document.insert("oscillator".into(), node.oscillator);
    document.insert("msf".into(), msf.into());
    let options = PathBuf::from(format!("{id}.toml"));
    let asked = text(&document)?;
    let text = Text { text: &asked, id, file: &options, network: None };
    plan_of(&text, args.quick, stages)
        .map_err(|problem| problem.renamed(&options, Path::new("the options")))
}

/// What was asked for, in the words of experiment files.
fn experiment(plan: &Plan) -> Value {
    let written = &plan.written;
    let mut coupling = written["coupling"].clone();
    if let Some(coupling) = coupling.as_object_mut() {
        coupling.remove("matrix");
    }
    json!({
        "title": written["title"],
        "seed": written["seed"],
        "oscillator": written["oscillator"],
        "coupling": coupling,
        "msf": written["msf"],
    })
}

/// The figure; what goes wrong with it costs no results.
fn draw(
    folder: &Folder,
    plan: &Plan,
    msf: &MasterStability,
    watch: &Arc<dyn Watch>,
) -> Vec<Warning> {
    let tell = |warning: &Warning| warning::say(&plan.id, warning, &**watch);
    let mut warnings = Warnings::after(&[], &tell);
    for (name, drawn) in drawing::curve_alone(&plan.title, msf) {
        let written = drawn
            .and_then(|bytes| folder.write(name, bytes).map_err(|problem| problem.to_string()));
        if let Err(reason) = written {
            warnings.add("figure", format!("{name} is missing: {reason}"));
        }
    }
    warnings.into_list()
}

fn said(plan: &Plan, msf: &MasterStability) -> String {
    let mut text = format!("{}\n\n", plan.title);
    for (name, value) in [
        ("isolated", overview::isolated(msf)),
        ("stable for", overview::stable(msf)),
        ("zeros", zeros(msf)),
        ("looked at", overview::looked_at(&msf.looked)),
    ] {
        text.push_str(&format!("{name:<12} {value}\n"));
    }
    let mut rows = TextTable::new();
    rows.load_style(NOTHING);
    rows.set_header(["sigma", "Lambda", ""]);
    let every = msf.sigma.len().div_ceil(ROWS);
    for (sigma, lambda) in msf.sigma.iter().zip(&msf.lambda).step_by(every) {
        let error = format!("± {}", two_digits(lambda.standard_error));
        rows.add_row([four_digits(*sigma), four_digits(lambda.mean), error]);
    }
    text.push_str(&format!("\n{rows}\n"));
    if every > 1 {
        text.push_str("msf.csv has every point\n");
    }
    text
}

fn zeros(msf: &MasterStability) -> String {
    let zero = |zero: Zero| {
        let ways = if zero.falling { "falls" } else { "rises" };
        let doubt = if zero.refined { "" } else { ", not as good as asked" };
        format!("{}, where Λ {ways}{doubt}", with_error(zero.sigma, zero.standard_error))
    };
    let zeros: Vec<String> = msf.stable.zeros().map(zero).collect();
    if zeros.is_empty() { "none".into() } else { zeros.join("; ") }
}

/// `FROM:TO:POINTS`.
fn grid(text: &str) -> std::result::Result<(f64, f64, u32), String> {
    let parts: Vec<&str> = text.split(':').collect();
    let parsed = match parts[..] {
        [from, to, points] => from.parse().ok().zip(to.parse().ok()).zip(points.parse().ok()),
        _ => None,
    };
    let Some(((from, to), points)) = parsed else {
        return Err("expected two numbers and a count, such as 0:16:65".into());
    };
    Ok((from, to, points))
}
