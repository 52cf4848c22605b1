//! `eigensync run`: experiments one after another, each to its results folder, and how all of it ended.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use serde_json::Value;

use dynamics::InstructionSet;

use crate::closing::{self, Outcome};
use crate::output::{say, tell};
use crate::suite::Suite;
use crate::{begun, signals, terminal};
use experiment::Planned;
use golden::golden_summary;
use results_folder::Place;
use runner::computed::Curves;
use runner::{Done, Plans, Work, atlas, overview, plans};
use user::text::shown;
use user::{Result, Stages};

/// How experiments are run.
pub struct Options {
    pub quick: bool,
    pub fresh: bool,
    pub instruction_set: Option<InstructionSet>,
    pub results: PathBuf,
    pub golden: PathBuf,
}

/// Runs experiments; the result says whether all that could be decided holds.
pub fn run(files: &[PathBuf], options: &Options) -> Result<bool> {
    let started = Instant::now();
    let watch = terminal::watch();
    let (mut plans, left_out) = plans(files, options.quick, &watch)?;
    if let Some(set) = options.instruction_set {
        plans.iter_mut().for_each(|(plan, _)| plan.use_instructions(set));
    }
    let goldens = plans
        .iter()
        .map(|(plan, _)| golden_summary(&options.golden.join(plan.id())))
        .collect::<Result<Vec<Option<Value>>>>()?;
    let reserve = |(plan, _): &(Planned, _)| {
        let made_from = ("run", plan.file());
        Place::reserve(&options.results, plan.id(), made_from, options.quick, watch.clone())
    };
    let places = plans.iter().map(reserve).collect::<Result<Vec<Place>>>()?;
    let (mut curves, mut outcomes) = (Curves::default(), Vec::new());
    let mut suite = Suite::new(work(&plans));
    for (((plan, stages), place), golden) in plans.iter().zip(places).zip(&goldens) {
        suite.begin();
        let id = plan.id();
        let journal = begun::journal(&place, id, options.fresh)?;
        let golden = golden.as_ref();
        let done = signals::keeping(&journal, || match plan {
            Planned::Experiment(plan) => {
                let work = Work { plan, journal: &journal, stages };
                runner::run(&work, place, golden, &mut curves)
            }
            Planned::Atlas(plan) => atlas::run((plan, &journal, stages), place, golden),
        })?;
        if let Some(looked) = &done.noted {
            tell!("{id}: {looked}");
        }
        tell!("{id}: {} in {}{}", shown(&done.place), seconds(done.took), suite.done());
        if let [_] = &plans[..] {
            say!("{}\n{}\n", done.said, overview::cost(stages));
        }
        let Done { place, claims, comparison, .. } = done;
        outcomes.push(Outcome { id: id.to_owned(), place, claims, comparison });
    }
    let left_out: Vec<String> = left_out.iter().map(ToString::to_string).collect();
    say!("{}", closing::screen(&outcomes, &left_out, &seconds(started.elapsed())));
    Ok(outcomes.iter().all(Outcome::holds))
}

/// How much work each plan is beside the others: steps of nodes and of tangents. A curve that several
/// ask for is computed for the first.
fn work(plans: &Plans) -> Vec<f64> {
    let of = |(position, (plan, _)): (usize, &(Planned, Stages))| {
        let plan = match plan {
            Planned::Experiment(plan) => plan,
            Planned::Atlas(plan) => return plan.steps() as f64,
        };
        let is_same = |other: &Planned| match other {
            Planned::Experiment(p) => p.node == plan.node && p.study.msf == plan.study.msf,
            Planned::Atlas(_) => false,
        };
        let is_shared = plans[..position].iter().any(|(other, _)| is_same(other));
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
