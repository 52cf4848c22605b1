//! Everything that an atlas writes: the table, a row a pair; the curves; the figure; the summary.

use std::path::PathBuf;
use std::time::Duration;

use claims::Judged;
use eigensync::numbers::{four_digits, with_error};
use eigensync::{Warning, Warnings, word};
use experiment::{Pair, System};
use golden::Comparison;
use journal::Journal;
use msf::{End, MasterStability};
use results_folder::{Folder, Place};
use serde::Serialize;
use serde_json::Value;
use user::text::number;
use user::{Problem, Result, Stages};

use super::curves::name;
use super::found::Found;
use super::words;
use crate::provenance::Provenance;
use crate::record::{LAYOUT, MsfRecord, msf_record};
use crate::report::REPORT;
use crate::{json, warning};

/// Results that are in place.
pub struct Written {
    pub place: PathBuf,
    pub comparison: Option<Comparison>,
}

/// `summary.json` of an atlas: keys are those of a run's summary where it has them.
#[derive(Serialize)]
struct Summary<'a> {
    layout: u32,
    id: &'a str,
    title: &'a str,
    source: &'a str,
    experiment: &'a Value,
    parameters: &'a Value,
    shortened: f64,
    atlas: Vec<PairRecord<'a>>,
    claims: &'a [Judged],
    warnings: Vec<Warning>,
    provenance: Provenance,
}

/// A pair of an atlas.
#[derive(Serialize)]
struct PairRecord<'a> {
    system: &'a str,
    from: &'a str,
    to: &'a str,
    class: String,
    msf: MsfRecord,
}

impl Found<'_> {
    /// Every pair with its curve.
    pub fn each(&self) -> impl Iterator<Item = (&System, &Pair, &MasterStability)> {
        self.plan.pairs().zip(self.curves).map(|((system, pair), curve)| (system, pair, curve))
    }

    /// What was published of a pair, as it was judged.
    pub fn claim(&self, system: &System, pair: &Pair) -> Option<&Judged> {
        let name = name(system, pair);
        self.claims.iter().find(|claim| claim.name == name)
    }
}

/// Writes the results folder; numbers come first, and whatever becomes of the figure costs none of them.
pub fn write(
    found: &Found<'_>,
    (journal, stages): (&Journal, &Stages),
    golden: Option<&Value>,
    took: &dyn Fn() -> Duration,
    place: Place,
) -> Result<Written> {
    let plan = found.plan;
    let folder = place.folder()?;
    write_table(&folder, found)?;
    write_curves(&folder, found)?;
    let tell = |warning: &Warning| warning::say(&plan.id, warning, &**stages.watch());
    let mut warnings = Warnings::after(&[], &tell);
    warn(found, &mut warnings);
    let curves: Vec<&MasterStability> = found.curves.iter().collect();
    let picture = stages.unmeasured("figure", || drawing::atlas(plan, &curves));
    picture.warnings.into_iter().for_each(|message| warnings.add("figure", message));
    let svg = picture.svg.map(String::into_bytes);
    for (name, bytes) in
        [("figure.png", picture.png), ("figure.pdf", picture.pdf), ("figure.svg", svg)]
    {
        if let Some(Err(problem)) = bytes.map(|bytes| folder.write(name, bytes)) {
            warnings.add("figure", problem.to_string());
        }
    }
    let warnings: Vec<Warning> = warnings.into_list().iter().map(warning::kept).collect();
    let took = (took(), &stages.took()[..]);
    let known_by = (plan.seed, plan.hash(), plan.instruction_set());
    let summary = Summary {
        layout: LAYOUT,
        id: &plan.id,
        title: &plan.title,
        source: &plan.source,
        experiment: &plan.written,
        parameters: &plan.parameters,
        shortened: plan.shortened,
        atlas: found.each().map(record).collect(),
        claims: found.claims,
        warnings: warnings.clone(),
        provenance: Provenance::new(known_by, journal.taken(), took, place.origin()),
    };
    let value = serde_json::to_value(&summary).map_err(|error| {
        Problem::from_error("the summary cannot be written as JSON", error).in_file(&plan.file)
    })?;
    let comparison = golden.map(|golden| golden::compare_summaries(golden, &value));
    folder.write(REPORT, words::report(found, &warnings, comparison.as_ref()))?;
    folder.write("summary.json", json::text(&value) + "\n")?;
    Ok(Written { place: place.finish(folder)?, comparison })
}

fn record<'a>((system, pair, curve): (&'a System, &'a Pair, &MasterStability)) -> PairRecord<'a> {
    PairRecord {
        system: &system.name,
        from: &pair.from,
        to: &pair.to,
        class: curve.stable.class().to_string(),
        msf: msf_record(curve),
    }
}

/// Adds what must be known beside the table: zeros that could not be refined, gaps that may hide a window,
/// and orbits of several kinds.
fn warn(found: &Found<'_>, warnings: &mut Warnings<'_>) {
    for (system, pair, curve) in found.each() {
        let name = name(system, pair);
        for zero in curve.stable.zeros().filter(|zero| !zero.refined) {
            let sigma = with_error(zero.sigma, zero.standard_error);
            warnings.add(
                "atlas",
                format!("{name}: the zero at sigma = {sigma} is not as good as asked"),
            );
        }
        for [from, to] in curve.doubtful.iter().map(|gap| gap.map(four_digits)) {
            let message = format!(
                "{name}: between sigma = {from} and {to} Λ comes so near zero that a window may be hidden"
            );
            warnings.add("atlas", message);
        }
        if !curve.attractors.is_empty() {
            let n = curve.attractors.len();
            let message = format!(
                "{name}: orbits settle on {n} different attractors; the curve is that of the first, and \
                 the windows are what is stable on each"
            );
            warnings.add("atlas", message);
        }
    }
}

/// A row for each pair; as many columns of windows as any pair needs.
fn write_table(folder: &Folder, found: &Found<'_>) -> Result<()> {
    let most = found.curves.iter().map(|curve| curve.stable.intervals.len()).max().unwrap_or(0);
    let mut header: Vec<String> =
        ["system", "from", "to", "class", "zeros", "lyapunov_isolated", "standard_error", "state"]
            .map(str::to_owned)
            .to_vec();
    for window in 1..=most {
        for end in ["from", "to"] {
            let column = format!("window_{window}_{end}");
            header.extend([
                column.clone(),
                format!("{column}_standard_error"),
                format!("{column}_is"),
            ]);
        }
    }
    header.extend(
        [
            "looked_from",
            "looked_to",
            "points",
            "narrowest_spacing",
            "widest_spacing",
            "looked_between",
            "doubtful",
            "attractors",
            "published",
            "verdict",
        ]
        .map(str::to_owned),
    );
    let rows = found.each().map(|(system, pair, curve)| {
        let mut row = vec![
            system.name.clone(),
            pair.from.clone(),
            pair.to.clone(),
            curve.stable.class().to_string(),
            curve.stable.zeros().count().to_string(),
            number(curve.isolated.mean),
            number(curve.isolated.standard_error),
            word(curve.state).to_owned(),
        ];
        for window in 0..most {
            match curve.stable.intervals.get(window) {
                Some(interval) => {
                    row.extend([interval.from, interval.to].into_iter().flat_map(end));
                }
                None => row.extend(std::iter::repeat_n(String::new(), 6)),
            }
        }
        row.extend(look(curve));
        let claim = found.claim(system, pair);
        row.push(claim.map_or_else(String::new, |claim| claim.paper.to_string()));
        row.push(claim.map_or_else(String::new, |claim| claim.verdict.to_string()));
        row
    });
    folder.write_table("atlas.csv", &header, rows)
}

/// σ, its standard error, and what it is.
fn end(end: End) -> [String; 3] {
    let (error, what) = match end {
        End::Zero(zero) if zero.refined => (number(zero.standard_error), "zero"),
        End::Zero(zero) => (number(zero.standard_error), "zero, not as good as asked"),
        End::Origin { included: true } => (String::new(), "origin"),
        End::Origin { included: false } => (String::new(), "origin, not included"),
        End::Looked { .. } => (String::new(), "end of the look"),
    };
    [number(end.sigma()), error, what.to_owned()]
}

/// How far and how finely was looked, and where that may not have been enough.
fn look(curve: &MasterStability) -> Vec<String> {
    let sigma = &curve.sigma;
    let spacings = || sigma.windows(2).map(|pair| pair[1] - pair[0]);
    let doubtful: Vec<String> = curve
        .doubtful
        .iter()
        .map(|[from, to]| format!("{} to {}", number(*from), number(*to)))
        .collect();
    vec![
        number(sigma[0]),
        number(sigma[sigma.len() - 1]),
        sigma.len().to_string(),
        number(spacings().fold(f64::INFINITY, f64::min)),
        number(spacings().fold(0.0, f64::max)),
        curve.looked.between.to_string(),
        doubtful.join("; "),
        curve.attractors.len().max(1).to_string(),
    ]
}

/// A row for each point of each curve.
fn write_curves(folder: &Folder, found: &Found<'_>) -> Result<()> {
    let header = ["system", "from", "to", "sigma", "Lambda", "standard_error"].map(str::to_owned);
    let rows = found.each().flat_map(|(system, pair, curve)| {
        curve.sigma.iter().zip(&curve.lambda).map(|(sigma, lambda)| {
            let [sigma, mean, error] = [*sigma, lambda.mean, lambda.standard_error].map(number);
            vec![system.name.clone(), pair.from.clone(), pair.to.clone(), sigma, mean, error]
        })
    });
    folder.write_table("atlas_curves.csv", &header, rows)
}
