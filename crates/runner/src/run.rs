//! `eigensync run`: experiments one after another, each to its results folder, and how all of it ended.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use serde_json::Value;

use dynamics::InstructionSet;

use crate::claims;
use crate::closing::{self, Outcome};
use crate::compare;
use crate::computed::Curves;
use crate::findings;
use crate::journal::Journal;
use crate::output::{say, shown, tell};
use crate::overview;
use crate::place::Place;
use crate::plan::{self, Plan};
use crate::problem::Result;
use crate::progress;
use crate::results;

/// How experiments are run.
pub struct Options {
    pub quick: bool,
    pub fresh: bool,
    pub instruction_set: Option<InstructionSet>,
    pub results: PathBuf,
    pub golden: PathBuf,
}

/// Runs experiments; the result says whether all that could be decided holds. All files are planned
/// before any is run, so that a slip in the last one shows at once.
pub fn run(files: &[PathBuf], options: &Options) -> Result<bool> {
    let started = Instant::now();
    let (mut plans, left_out) = plan::all(files, options.quick)?;
    for plan in &mut plans {
        plan.study.msf.instruction_set =
            options.instruction_set.unwrap_or(plan.study.msf.instruction_set);
    }
    let goldens = plans
        .iter()
        .map(|plan| compare::golden_summary(&options.golden.join(&plan.id)))
        .collect::<Result<Vec<Option<Value>>>>()?;
    let reserve = |plan: &Plan| {
        Place::reserve(&options.results, &plan.id, ("run", &plan.file), options.quick)
    };
    let places = plans.iter().map(reserve).collect::<Result<Vec<Place>>>()?;
    let (mut curves, mut outcomes) = (Curves::default(), Vec::new());
    let mut suite = progress::Suite::new(work(&plans));
    for ((plan, place), golden) in plans.iter().zip(places).zip(&goldens) {
        suite.begin();
        let (outcome, found, took) = one(plan, place, golden.as_ref(), &mut curves, options.fresh)?;
        let place = shown(&outcome.place);
        tell!("{}: {place} in {}{}", plan.id, seconds(took), suite.done());
        if let [_] = &plans[..] {
            say!("{}\n{}\n", overview::of(plan, &found), overview::cost(plan));
        }
        outcomes.push(outcome);
    }
    let left_out: Vec<String> = left_out.iter().map(ToString::to_string).collect();
    say!("{}", closing::screen(&outcomes, &left_out, &seconds(started.elapsed())));
    Ok(outcomes.iter().all(Outcome::holds))
}

/// Runs one experiment; the time that it took comes last.
fn one(
    plan: &Plan,
    place: Place,
    golden: Option<&Value>,
    curves: &mut Curves,
    fresh: bool,
) -> Result<(Outcome, eigensync::Findings, Duration)> {
    let started = Instant::now();
    let planned = plan.stages.total();
    let took = || planned + started.elapsed();
    let journal = Journal::open(place.unfinished(), &plan.id, fresh)?;
    // It outlives a failure, so that it is the journal that says whether there is work to keep.
    let mut place = Some(place);
    let (found, claims, written) = journal.until(|| {
        let found = findings::find(plan, curves, &journal)?;
        let claims = claims::judge(plan, &found)?;
        let place = place.take().expect("results are written once");
        let written =
            results::write(plan, &found, claims.clone(), golden, (took, journal.taken()), place)?;
        Ok((found, claims, written))
    })?;
    if let Some(looked) = eigensync::step_effects_looked_at(&found.step_effects) {
        tell!("{}: {looked}", plan.id);
    }
    let results::Written { place, comparison } = written;
    Ok((Outcome { id: plan.id.clone(), place, claims, comparison }, found, took()))
}

/// How much work each plan is beside the others: steps of nodes and of tangents. A curve that several
/// ask for is computed for the first.
fn work(plans: &[Plan]) -> Vec<f64> {
    let of = |(position, plan): (usize, &Plan)| {
        let is_shared =
            plans[..position].iter().any(|p| p.node == plan.node && p.study.msf == plan.study.msf);
        let curve = if is_shared { 0.0 } else { plan.study.msf_steps() as f64 };
        let nodes = plan.study.network.n_nodes() as f64;
        curve + plan.study.sweep.as_ref().map_or(0.0, |sweep| sweep.steps() as f64 * nodes)
    };
    plans.iter().enumerate().map(of).collect()
}

/// A time as it is said.
pub fn seconds(time: Duration) -> String {
    format!("{:.1} s", time.as_secs_f64())
}
