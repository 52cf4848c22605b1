//! One experiment after another, each from its plan to its place.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use experiment::Planned;
use golden::Comparison;
use results_folder::{Place, id};
use serde_json::Value;
use user::text::shown;
use user::{Problem, Result, Stages, Watch};

use crate::computed::Curves;
use crate::results::{self, Written};
use crate::{Work, findings, overview};
use claims::{Judged, judge};

/// An experiment that has run.
pub struct Done {
    /// Where its results are.
    pub place: PathBuf,
    /// What was found, in words.
    pub said: String,
    /// What was looked at besides, in words that go on.
    pub noted: Option<String>,
    /// Its claims, judged.
    pub claims: Vec<Judged>,
    /// What differs from the golden output, where there is one.
    pub comparison: Option<Comparison>,
    /// How long it took, reading and preparation among it.
    pub took: Duration,
}

/// Plans and the stages that they took.
pub type Plans = Vec<(Planned, Stages)>;

/// Plans all files, before any is run, so that a slip in the last one shows at once; two of one name
/// would overwrite each other's results. Experiments whose data are not here come apart, as the problems
/// that say so.
///
/// # Errors
/// What is wrong with the first file with which anything is.
pub fn plans(
    files: &[PathBuf],
    quick: bool,
    watch: &Arc<dyn Watch>,
) -> Result<(Plans, Vec<Problem>)> {
    let (mut plans, mut left_out): (Plans, _) = (Vec::new(), Vec::new());
    for file in files {
        let id = id(file)?;
        let stages = Stages::new(&id, watch.clone());
        match experiment::plan(file, &id, quick, &stages) {
            Ok(plan) => plans.push((plan, stages)),
            Err(problem) if problem.is_left_out() => left_out.push(problem),
            Err(problem) => return Err(problem),
        }
    }
    for (position, (later, _)) in plans.iter().enumerate() {
        if let Some((earlier, _)) =
            plans[..position].iter().find(|(plan, _)| plan.id() == later.id())
        {
            let message = format!(
                "has the same name as {}, and both would write the results folder {}",
                shown(earlier.file()),
                later.id()
            );
            return Err(Problem::new(message).in_file(later.file()).hint("run them one by one"));
        }
    }
    Ok((plans, left_out))
}

/// Runs one experiment, and puts its results in their place.
///
/// # Errors
/// What kept it from being finished, with what is kept of it.
pub fn run(
    work: &Work<'_>,
    place: Place,
    golden: Option<&Value>,
    curves: &mut Curves,
) -> Result<Done> {
    let started = Instant::now();
    let planned = work.stages.total();
    let took = || planned + started.elapsed();
    // It outlives a failure, so that it is the journal that says whether there is work to keep.
    let mut place = Some(place);
    let (findings, claims, written) = work.journal.until(|| {
        let findings = findings::find(work, curves)?;
        let (study, is_quick) = (&work.plan.study, work.plan.shortened > 1.0);
        let claims = work.plan.claims.iter();
        let claims: Vec<Judged> =
            claims.map(|claim| judge(claim, study, &findings, is_quick)).collect();
        let place = place.take().expect("results are written once");
        let written = results::write(work, &findings, claims.clone(), golden, &took, place)?;
        Ok((findings, claims, written))
    })?;
    let Written { place, comparison } = written;
    let said = overview::of(work.plan, &findings);
    let noted = eigensync::step_effects_looked_at(&findings.step_effects);
    Ok(Done { place, said, noted, claims, comparison, took: took() })
}
