//! What will be done: an experiment with its network read, its names resolved and its numbers
//! checked, so that nothing can go wrong later for a reason that could have been seen now.

mod claims;
mod effects;
mod memory;
mod network;
mod node;
mod numbers;
mod ranges;
mod source;
mod spectrum;
mod step;

use eigensync::{Study, Sweep, Warning};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clustering::ClusterRule;
use dynamics::lyapunov::Times;
use dynamics::{
    Adaptive, AdaptiveOrder, Coupling, Method, Model, NodeDynamics, Observables, Schedule,
};
use graph::prepare::Report;
use graph::{CouplingMatrix, Network, Normalization};

pub use memory::Memory;
pub use network::nodes_named;
pub use node::Node;
use serde_json::Value;

use crate::hashes::{links_hash, plan_hash};
use crate::output::shown;
use crate::place::id;
use crate::problem::{Problem, Result};
use crate::progress::Stages;
use crate::spec::{
    Experiment, FigureKind, FigureSpec, MatrixKind, MethodKind, NetworkSpec, RegionsSpec,
    SweepSpec, ThresholdSpec,
};

/// `--quick` divides the times of sweeps and of the MSF by this.
pub const QUICK: f64 = 10.0;

/// Up to this many nodes all pairs are observed; beyond it only what the file asks for.
pub const ALL_PAIRS: usize = 2000;

/// An experiment that can be run.
pub struct Plan {
    /// Name of the file without its ending.
    pub id: String,
    /// The file itself.
    pub file: PathBuf,
    /// What is kept with the results because it is nowhere else, by name: an experiment file, a network.
    pub kept: Vec<(String, Arc<[u8]>)>,
    /// The specification as written, for titles, sources and the record.
    pub experiment: Experiment,
    /// The same as a document, defaults left out, for the record.
    pub written: Value,
    /// 1, or [`QUICK`]: by how much times are shortened.
    pub shortened: f64,
    /// What is asked of the library.
    pub study: Study,
    /// SHA-256 of the links and weights of its network.
    pub links_hash: String,
    /// What each step of preparation did.
    pub preparation: Vec<Report>,
    /// What the node of the study is known by.
    pub node: Node,
    /// What is doubtful about it, though it can be done.
    pub doubts: Vec<Warning>,
    /// The stages of the run, that of reading the network already taken.
    pub stages: Stages,
}

/// Plans all files; two of one name would overwrite each other's results. Experiments whose data are
/// not here come apart, as the problems that say so.
pub fn all(files: &[PathBuf], quick: bool) -> Result<(Vec<Plan>, Vec<Problem>)> {
    let (mut plans, mut left_out): (Vec<Plan>, _) = (Vec::new(), Vec::new());
    for file in files {
        match plan(file, quick) {
            Ok(plan) => plans.push(plan),
            Err(problem) if problem.is_left_out() => left_out.push(problem),
            Err(problem) => return Err(problem),
        }
    }
    for (position, later) in plans.iter().enumerate() {
        if let Some(earlier) = plans[..position].iter().find(|plan| plan.id == later.id) {
            let message = format!(
                "has the same name as {}, and both would write the results folder {}",
                shown(&earlier.file),
                later.id
            );
            return Err(Problem::new(message).in_file(&later.file).hint("run them one by one"));
        }
    }
    Ok((plans, left_out))
}

/// Checks an experiment file and reads what it names.
pub fn plan(file: &Path, quick: bool) -> Result<Plan> {
    of(crate::load::experiment(file)?, file, quick, Stages::new(&id(file)?))
}

/// The hash of the plan that [`plan`] would make, for which the network is all that must be read.
pub fn hash(file: &Path, quick: bool) -> Result<String> {
    let (experiment, written) = crate::load::experiment(file)?;
    let (shortened, stages) = (shortening(quick), Stages::default());
    let checker =
        Checker { file, experiment: &experiment, written: &written, shortened, stages: &stages };
    let (network, _) = checker.network()?;
    Ok(plan_hash(&written, shortened, &links_hash(&network)))
}

/// The same for the text of an experiment file that would be called so, after some stages.
pub fn of_text(text: &str, file: &Path, quick: bool, stages: Stages) -> Result<Plan> {
    of(crate::load::parse(text, file)?, file, quick, stages)
}

/// The same where the file of its network was read already, from standard input.
pub fn of_text_and_network(
    text: &str,
    network: Arc<[u8]>,
    file: &Path,
    quick: bool,
    stages: Stages,
) -> Result<Plan> {
    let (mut experiment, written) = crate::load::parse(text, file)?;
    if let NetworkSpec::File(spec) = &mut experiment.network {
        spec.given = Some(network);
    }
    of((experiment, written), file, quick, stages)
}

fn of(
    (experiment, written): (Experiment, Value),
    file: &Path,
    quick: bool,
    stages: Stages,
) -> Result<Plan> {
    let shortened = shortening(quick);
    let checker =
        Checker { file, experiment: &experiment, written: &written, shortened, stages: &stages };
    checker.effects()?;
    let (network, preparation) = checker.network()?;
    let (n_components, matrix, links_hash) = stages.unmeasured("preparation", || {
        let n_components = network.components().len();
        let matrix = CouplingMatrix::new(&network, checker.normalization());
        (n_components, matrix, links_hash(&network))
    });
    let node = checker.node()?;
    let sweep = experiment.sweep.as_ref();
    let study = Study {
        modes: checker.spectrum(network.n_nodes(), n_components)?,
        msf: checker.msf()?,
        rule: checker.rule(network.n_nodes())?,
        sweep: sweep.map(|sweep| checker.sweep(sweep, &network, node.model)).transpose()?,
        regions: experiment.regions.as_ref().map(RegionsSpec::bounds),
        seed: experiment.seed,
        node: node.equations(),
        network,
        n_components,
        matrix,
    };
    let mut plan = Plan {
        study,
        id: id(file)?,
        file: file.to_owned(),
        kept: Vec::new(),
        shortened,
        links_hash,
        preparation,
        node,
        experiment: experiment.clone(),
        written: written.clone(),
        doubts: Vec::new(),
        stages: Stages::default(),
    };
    plan.doubts = checker.steps(&plan)?;
    checker.regions(&plan.study.network)?;
    checker.figure(&plan.study.network, &plan.study.modes)?;
    checker.claims(&plan)?;
    Memory::of(&plan).affordable(file)?;
    Ok(Plan { stages, ..plan })
}

fn shortening(quick: bool) -> f64 {
    if quick { QUICK } else { 1.0 }
}

struct Checker<'a> {
    file: &'a Path,
    experiment: &'a Experiment,
    /// The same as a document, defaults left out.
    written: &'a Value,
    shortened: f64,
    stages: &'a Stages,
}

impl Checker<'_> {
    fn problem(&self, key: &str, message: impl std::fmt::Display) -> Problem {
        Problem::with_key(self.file, key, message)
    }

    fn normalization(&self) -> Normalization {
        match self.experiment.coupling.matrix {
            MatrixKind::Laplacian => Normalization::Laplacian,
            MatrixKind::Normalized => Normalization::Normalized,
        }
    }

    fn node(&self) -> Result<Node> {
        let (model, spec) = (self.experiment.oscillator, &self.experiment.coupling);
        self.parameters(model)?;
        let from = self.component("coupling.from", &spec.from, model)?;
        let to = self.component("coupling.to", &spec.to, model)?;
        Ok(Node { model, coupling: Coupling::pair(from, to) })
    }

    fn parameters(&self, model: Model) -> Result<()> {
        let parameters = serde_json::to_value(model).unwrap_or_default();
        let parameters = parameters[model.name()].as_object().into_iter().flatten();
        parameters.into_iter().try_for_each(|(name, value)| {
            let key = format!("oscillator.{}.{name}", model.name());
            match value.as_f64() {
                Some(value) => self.parameter_range(&key, value),
                // JSON has no word for what is not finite, so that it comes out as null.
                None => Err(self.problem(&key, "must be finite")),
            }
        })
    }

    fn component(&self, key: &str, name: &str, model: Model) -> Result<usize> {
        let components = model.components();
        components.iter().position(|component| *component == name).ok_or_else(|| {
            let message = format!(
                "is \"{name}\", but `{}` has components {}",
                model.name(),
                components.join(", ")
            );
            let others: Vec<_> = Model::all()
                .iter()
                .filter(|other| other.components().contains(&name))
                .map(|other| format!("`{}` has a component `{name}`", other.name()))
                .collect();
            let problem = self.problem(key, message);
            if others.is_empty() { problem } else { problem.hint(others.join("; ")) }
        })
    }

    fn msf(&self) -> Result<msf::Request> {
        let spec = &self.experiment.msf;
        let sigma = self.grid("msf.sigma", &spec.sigma, 2)?;
        self.not_negative("msf.sigma", sigma[0])?;
        self.positive("msf.step", spec.step)?;
        self.not_negative("msf.transient", spec.transient)?;
        self.positive("msf.average", spec.average)?;
        self.positive("msf.renormalise", spec.renormalise)?;
        self.positive("msf.relative_error", spec.relative_error)?;
        let interval = (spec.renormalise / spec.step).round().max(1.0) * spec.step;
        self.blocks("msf.average", spec.average, (interval, "`msf.renormalise` in whole steps"))?;
        let times = Times {
            step: spec.step,
            transient: spec.transient / self.shortened,
            average: spec.average / self.shortened,
            renormalise: spec.renormalise,
        };
        let exponents = sigma.len() as f64;
        self.feasible("msf", exponents * (times.transient + times.average) / times.step)?;
        self.msf_ranges()?;
        Ok(msf::Request {
            sigma,
            times,
            refinement: msf::Refinement {
                // Shorter averages are for a first look, with larger errors.
                relative_error: spec.relative_error * self.shortened.sqrt(),
                ..msf::Refinement::default()
            },
            seed: self.experiment.seed,
            instruction_set: dynamics::InstructionSet::best(),
        })
    }

    fn rule(&self, n_nodes: usize) -> Result<ClusterRule> {
        match self.experiment.prediction.threshold {
            ThresholdSpec::Exact => Ok(ClusterRule::Exact),
            ThresholdSpec::Within(threshold) => {
                self.positive("prediction.threshold", threshold)?;
                self.threshold_range(threshold, n_nodes)?;
                Ok(ClusterRule::Threshold(threshold))
            }
        }
    }

    fn sweep(&self, spec: &SweepSpec, network: &Network, model: Model) -> Result<Sweep> {
        let epsilon = self.grid("sweep.epsilon", &spec.epsilon, 1)?;
        let schedule = self.schedule(spec, epsilon[0])?;
        let pairs = network.n_nodes() <= ALL_PAIRS;
        self.affordable(spec.seeds, epsilon.len(), &schedule, (network.n_nodes(), pairs))?;
        let component = match &spec.component {
            Some(name) => self.component("sweep.component", name, model)?,
            None => 0,
        };
        let reference = match &spec.error_to {
            Some(name) => Some(self.label("sweep.error_to", name, network)?),
            None => None,
        };
        let mut clusters = self.clusters("sweep.clusters", &spec.clusters, network)?;
        if clusters.is_empty() && reference.is_none() && network.n_nodes() > 1 {
            clusters.push((0..network.n_nodes()).collect());
        }
        self.bound("sweep.synchronised_below", spec.synchronised_below, pairs)?;
        self.sweep_ranges(spec)?;
        let first = self.experiment.seed;
        Ok(Sweep {
            epsilon,
            seeds: (0..spec.seeds).map(|k| first.wrapping_add(k)).collect(),
            method: self.method(spec),
            schedule,
            observables: Observables { component, pairs, reference, clusters },
            series: None,
            synchronised_below: spec.synchronised_below,
            kick: spec.kick,
        })
    }

    fn schedule(&self, spec: &SweepSpec, least_epsilon: f64) -> Result<Schedule> {
        self.not_negative("sweep.epsilon", least_epsilon)?;
        self.positive("sweep.step", spec.step)?;
        self.not_negative("sweep.kick", spec.kick)?;
        self.not_negative("sweep.transient", spec.transient)?;
        self.positive("sweep.average", spec.average)?;
        self.positive("sweep.tolerance", spec.tolerance)?;
        self.positive("sweep.stride", f64::from(spec.stride))?;
        self.positive("sweep.seeds", spec.seeds as f64)?;
        let schedule = Schedule {
            step: spec.step,
            transient: spec.transient / self.shortened,
            average: spec.average / self.shortened,
            stride: spec.stride,
        };
        let interval = (schedule.sampling_interval(), "`sweep.step` × `sweep.stride`");
        self.blocks("sweep.average", spec.average, interval)?;
        Ok(schedule)
    }

    fn method(&self, spec: &SweepSpec) -> Method {
        let adaptive = |order| {
            Method::Adaptive(Adaptive {
                order,
                relative_tolerance: spec.tolerance,
                absolute_tolerance: spec.tolerance,
            })
        };
        match spec.method {
            MethodKind::Rk4 => Method::Rk4,
            MethodKind::Dopri5 => adaptive(AdaptiveOrder::Five),
            MethodKind::Dop853 => adaptive(AdaptiveOrder::Eight),
        }
    }
}

/// The part of the specification that says what the figure shows.
impl Plan {
    pub fn figure(&self) -> &FigureSpec {
        &self.experiment.figure
    }

    /// The kind of the figure that can be drawn: there are no matrices where not all pairs are
    /// observed, and the sweep is shown instead.
    pub fn figure_kind(&self) -> FigureKind {
        let has_pairs = self.study.sweep.as_ref().is_some_and(|sweep| sweep.observables.pairs);
        match self.figure().kind {
            FigureKind::Matrices if !has_pairs => FigureKind::Sweep,
            kind => kind,
        }
    }
}
