//! Everything a run writes: the summary, the tables, the figure.

use eigensync::numbers::plain;
use eigensync::{Findings, Simulated, Sweep, Warning, completed};
use std::path::PathBuf;
use std::time::Duration;

use dynamics::{Errors, Estimate};
use msf::MasterStability;
use serde_json::Value;

use crate::cascade_files;
use crate::membership;
use crate::record::{Summary, summarise};
use crate::report::{self, REPORT};
use crate::warning;
use crate::{Work, computed, json};
use claims::Judged;
use experiment::Plan;
use experiment::spec::FigureKind;
use golden::Comparison;
use results_folder::{Folder, Place};
use user::text::number;
use user::{Problem, Result};

/// Up to this many nodes all computed eigenvectors are written as text.
const EIGENVECTOR_TABLE: usize = 5000;
/// The experiment file that says the same as the options of a prediction.
pub const EXPERIMENT: &str = "experiment.toml";

/// Results that are in place.
pub struct Written {
    /// Where they are.
    pub place: PathBuf,
    /// With the golden output, where there is one.
    pub comparison: Option<Comparison>,
}

/// Writes the results folder; `took` says how long the run has taken when asked, `golden` is the
/// golden summary. Numbers come first, and whatever becomes of the figure costs none of them.
///
/// # Errors
/// Where a file cannot be written, or the folder not be put in place.
pub fn write(
    work: &Work<'_>,
    findings: &Findings,
    claims: Vec<Judged>,
    golden: Option<&Value>,
    took: &dyn Fn() -> Duration,
    place: Place,
) -> Result<Written> {
    let &Work { plan, journal, stages } = work;
    let folder = place.folder()?;
    stages.unmeasured("files", || write_tables(&folder, plan, findings))?;
    if let Some(sweep) = &plan.study.sweep {
        stages.unmeasured("series", || write_series(&folder, work, sweep))?;
    }
    let picture = stages.unmeasured("figure", || drawing::picture(plan, findings));
    let tell = |warning: &Warning| warning::say(&plan.id, warning, &**stages.watch());
    let mut warnings = eigensync::Warnings::after(&[], &tell);
    picture.warnings.into_iter().for_each(|message| warnings.add("figure", message));
    let svg = picture.svg.map(String::into_bytes);
    for (name, bytes) in
        [("figure.png", picture.png), ("figure.pdf", picture.pdf), ("figure.svg", svg)]
    {
        if let Some(Err(problem)) = bytes.map(|bytes| folder.write(name, bytes)) {
            warnings.add("figure", problem.to_string());
        }
    }
    for (name, content) in &plan.kept {
        folder.write(name, content)?;
    }
    let mut summary = summarise(
        plan,
        findings,
        claims,
        (took(), &stages.took()),
        (journal.taken(), place.origin()),
    );
    summary.warnings.extend(warnings.into_list().iter().map(warning::kept));
    let failed = |error| {
        Problem::from_error("the summary cannot be written as JSON", error).in_file(&plan.file)
    };
    let value = serde_json::to_value(&summary).map_err(failed)?;
    let comparison = golden.map(|golden| golden::compare_summaries(golden, &value));
    let Summary { claims, warnings, .. } = &summary;
    folder.write(REPORT, report::of(plan, findings, claims, warnings, comparison.as_ref()))?;
    folder.write("summary.json", json::text(&value) + "\n")?;
    Ok(Written { place: place.finish(folder)?, comparison })
}

fn write_tables(folder: &Folder, plan: &Plan, findings: &Findings) -> Result<()> {
    write_spectrum(folder, plan, findings)?;
    write_msf(folder, &findings.msf)?;
    cascade_files::write(folder, plan, findings)?;
    membership::write(folder, plan, findings)?;
    if let Some(simulated) = &findings.simulated {
        write_sweep(folder, plan, simulated)?;
    }
    write_matrices(folder, plan, findings)
}

fn write_spectrum(folder: &Folder, plan: &Plan, findings: &Findings) -> Result<()> {
    let spectrum = findings.spectrum.real_modes();
    let header = ["mode", "lambda", "residual"].map(str::to_owned);
    let modes = spectrum.eigenvalues.iter().zip(&spectrum.residuals).enumerate();
    let rows = modes.map(|(k, (lambda, residual))| {
        vec![(k + 1).to_string(), number(*lambda), number(*residual)]
    });
    folder.write_table("spectrum.csv", &header, rows)?;
    let labels = plan.study.network.labels();
    if labels.len() > EIGENVECTOR_TABLE {
        return Ok(());
    }
    let mut header = vec!["node".to_owned()];
    header.extend((1..=spectrum.eigenvectors.len()).map(|k| format!("v{k}")));
    let rows = labels.iter().enumerate().map(|(i, label)| {
        let components = spectrum.eigenvectors.iter().map(|v| number(v[i]));
        std::iter::once(label.clone()).chain(components).collect()
    });
    folder.write_table("eigenvectors.csv", &header, rows)
}

/// Λ(σ) on the grid.
pub fn write_msf(folder: &Folder, msf: &MasterStability) -> Result<()> {
    let header = ["sigma", "Lambda", "standard_error"].map(str::to_owned);
    let rows = msf.sigma.iter().zip(&msf.lambda).map(|(sigma, lambda)| {
        vec![number(*sigma), number(lambda.mean), number(lambda.standard_error)]
    });
    folder.write_table("msf.csv", &header, rows)
}

/// What one column of the sweep's table takes from the errors of a run.
type Column = Box<dyn Fn(&Errors) -> Estimate>;

/// A row for each ε and seed; errors of a run that escaped are left empty.
fn write_sweep(folder: &Folder, plan: &Plan, simulated: &Simulated) -> Result<()> {
    let Some(sweep) = &plan.study.sweep else { return Ok(()) };
    let labels = plan.study.network.labels();
    let mut header = ["epsilon", "seed", "outcome"].map(str::to_owned).to_vec();
    let mut columns: Vec<Column> = Vec::new();
    if let Some(reference) = sweep.observables.reference {
        for (node, label) in labels.iter().enumerate() {
            header.push(format!("error_{label}_to_{}", labels[reference]));
            columns.push(Box::new(move |errors: &Errors| errors.to_reference[node]));
        }
    }
    for m in 0..sweep.observables.clusters.len() {
        header.push(format!("error_within_cluster_{}", m + 1));
        columns.push(Box::new(move |errors: &Errors| errors.within_clusters[m]));
    }
    let rows = simulated.runs.iter().map(|run| {
        let errors = completed(run);
        let mut row = vec![number(run.replica.epsilon), run.replica.seed.to_string()];
        row.push(match &run.outcome {
            dynamics::Outcome::Completed(_) => "completed".into(),
            dynamics::Outcome::Escaped { time } => format!("escaped at {time}"),
            dynamics::Outcome::Failed { time, reason } => format!("failed at {time}: {reason}"),
        });
        row.extend(columns.iter().map(|of| errors.map_or(String::new(), |e| number(of(e).mean))));
        row
    });
    folder.write_table("sweep.csv", &header, rows)
}

/// The states on the way that were asked for: of each replica a table with a row for each time.
fn write_series(folder: &Folder, work: &Work<'_>, sweep: &Sweep) -> Result<()> {
    let Some(recorded) = &work.plan.recorded else { return Ok(()) };
    let states = computed::states_of(work, sweep, &recorded.replicas);
    for (replica, states) in recorded.replicas.iter().zip(&states) {
        let name = format!("series_epsilon_{}_seed_{}.csv", plain(replica.epsilon), replica.seed);
        folder.write_through(&name, |out| {
            let mut table = csv::Writer::from_writer(out);
            table.write_field("time")?;
            table.write_record(&recorded.columns)?;
            work.journal.states(states, |time, state| {
                table.write_field(number(time))?;
                table.write_record(state.iter().map(|&x| number(x)))?;
                Ok(())
            })?;
            table.flush()
        })?;
    }
    Ok(())
}

/// δe_ij and δx_ij of every ε, where the figure shows them, as NumPy arrays of shape (N, N). ε stands in
/// their names as the shortest text that reads back as the same number, so that no two are alike.
fn write_matrices(folder: &Folder, plan: &Plan, findings: &Findings) -> Result<()> {
    let Some(simulated) = &findings.simulated else { return Ok(()) };
    if !matches!(plan.figure_kind(), FigureKind::Matrices | FigureKind::Regions) {
        return Ok(());
    }
    let n_nodes = plan.study.network.n_nodes();
    for (position, &epsilon) in simulated.epsilon.iter().enumerate() {
        let epsilon = plain(epsilon);
        if let Some(distance) = drawing::distance(findings, position) {
            let name = format!("distance_epsilon_{epsilon}.npy");
            folder.write(&name, npy(n_nodes, &distance.matrix()))?;
        }
        let errors = drawing::error_matrix(plan, simulated, position);
        folder.write(&format!("error_epsilon_{epsilon}.npy"), npy(n_nodes, &errors))?;
    }
    Ok(())
}

/// A square matrix in NumPy's format.
fn npy(n_nodes: usize, values: &[f64]) -> Vec<u8> {
    use npyz::WriterBuilder;
    let mut bytes = Vec::new();
    let shape = [n_nodes as u64, n_nodes as u64];
    let options = npyz::WriteOptions::new().default_dtype().shape(&shape).writer(&mut bytes);
    let mut writer = options.begin_nd().expect("memory takes every byte");
    writer.extend(values).expect("memory takes every byte");
    writer.finish().expect("as many values as the shape says");
    bytes
}
