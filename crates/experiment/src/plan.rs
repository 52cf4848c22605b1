//! What will be done: an experiment with its network read, its names resolved and its numbers
//! checked, so that nothing can go wrong later for a reason that could have been seen now.

mod claimed;
mod effects;
mod memory;
mod network;
mod node;
mod numbers;
mod parameters;
mod ranges;
mod series;
mod source;
mod spectrum;
mod step;
mod watched;

use eigensync::{ALL_PAIRS, Study, Sweep, Warning};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use claims::Claim;
use clustering::ClusterRule;
use dynamics::lyapunov::Times;
use dynamics::{
    Adaptive, AdaptiveOrder, Coupling, Method, Model, NodeDynamics, Observables, Schedule,
};
use graph::prepare::Report;
use graph::{CouplingMatrix, Names, Network, Normalization};

pub use memory::Memory;
pub use node::Node;
use serde_json::Value;
pub use series::Recorded;

use crate::hashes::{links_hash, plan_hash};
use crate::load;
use crate::spec::{
    CouplingSpec, Experiment, FigureKind, FigureSpec, MatrixKind, MethodKind, NetworkSpec,
    RegionsSpec, StepSpec, SweepSpec, ThresholdSpec,
};
use user::{Problem, Result, Stages};

/// `--quick` divides the times of sweeps and of the MSF by this.
pub const QUICK: f64 = 10.0;

/// An experiment that can be run.
pub struct Plan {
    /// Name of the file without its ending.
    pub id: String,
    /// The file itself.
    pub file: PathBuf,
    /// What is kept with the results because it is nowhere else, by name: an experiment file, a network.
    pub kept: Vec<(String, Arc<[u8]>)>,
    /// One line that says what the experiment shows.
    pub title: String,
    /// Where its settings and expected values come from.
    pub source: String,
    /// The experiment file as a document, defaults left out, for the record.
    pub written: Value,
    /// Every parameter that is used, in the words of experiment files, defaults among them; keys that
    /// have no effect are null.
    pub parameters: Value,
    /// 1, or [`QUICK`]: by how much times are shortened.
    pub shortened: f64,
    /// What is asked of the library.
    pub study: Study,
    /// SHA-256 of the links and weights of its network.
    pub links_hash: String,
    /// Each step of preparation, and what it did.
    pub preparation: Vec<(StepSpec, Report)>,
    /// The coupling in the words of the file.
    pub coupling: CouplingSpec,
    /// What the node of the study is known by.
    pub node: Node,
    /// What the figure shows; modes, positions and couplings in it are there.
    pub figure: FigureSpec,
    /// What the source says, each claim of an instance that will be there.
    pub claims: Vec<Claim>,
    /// Of which replicas states on the way are written.
    pub recorded: Option<Recorded>,
    /// What is doubtful about it, though it can be done.
    pub doubts: Vec<Warning>,
}

/// The text of an experiment file.
pub struct Text<'a> {
    /// What it says.
    pub text: &'a str,
    /// What the experiment is called.
    pub id: &'a str,
    /// The file, which need not be there; paths in the text are seen from beside it.
    pub file: &'a Path,
    /// The file of its network where it was read already, from standard input.
    pub network: Option<Arc<[u8]>>,
}

/// Checks an experiment file and reads what it names.
///
/// # Errors
/// What is wrong with the file, or with what it names.
pub fn plan(file: &Path, id: &str, quick: bool, stages: &Stages) -> Result<Plan> {
    of(load::experiment(file)?, (file, id), quick, stages)
}

/// The same of a text.
///
/// # Errors
/// As [`plan`].
pub fn plan_of(text: &Text<'_>, quick: bool, stages: &Stages) -> Result<Plan> {
    let (mut experiment, written) = load::parse(text.text, text.file)?;
    if let NetworkSpec::File(spec) = &mut experiment.network {
        spec.given.clone_from(&text.network);
    }
    of((experiment, written), (text.file, text.id), quick, stages)
}

/// The hash of the plan that [`plan`] would make, for which the network is all that must be read.
///
/// # Errors
/// What is wrong with the file, or with its network.
pub fn plan_hash_of(file: &Path, quick: bool) -> Result<String> {
    let (experiment, written) = load::experiment(file)?;
    let (shortened, stages) = (shortening(quick), Stages::new("", Arc::new(())));
    let checker =
        Checker { file, experiment: &experiment, written: &written, shortened, stages: &stages };
    let (network, _) = checker.network()?;
    Ok(plan_hash(&written, shortened, &links_hash(&network)))
}

fn of(
    (experiment, written): (Experiment, Value),
    (file, id): (&Path, &str),
    quick: bool,
    stages: &Stages,
) -> Result<Plan> {
    let shortened = shortening(quick);
    let checker = Checker { file, experiment: &experiment, written: &written, shortened, stages };
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
    let doubts = checker.steps(&study, &node)?;
    checker.regions(&study.network)?;
    checker.figure(&study.network, &study.modes)?;
    let claims = checker.claims(&study)?;
    let recorded = match &study.sweep {
        Some(sweep) => checker.recorded(sweep, &study.network, node.model)?,
        None => None,
    };
    Memory::of_study(&study, experiment.figure.kind).affordable(file)?;
    let parameters = parameters::of(&experiment, &study, &node);
    let Experiment { title, source, coupling, prepare, figure, .. } = experiment;
    Ok(Plan {
        id: id.to_owned(),
        file: file.to_owned(),
        kept: Vec::new(),
        title,
        source,
        written,
        parameters,
        shortened,
        study,
        links_hash,
        preparation: prepare.into_iter().zip(preparation).collect(),
        coupling,
        node,
        figure,
        claims,
        recorded,
        doubts,
    })
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
        let names = Names::of(network);
        let reference = match &spec.error_to {
            Some(name) => {
                let named = names.node(name.as_ref());
                Some(named.map_err(|error| self.misnamed("sweep.error_to", &error))?)
            }
            None => None,
        };
        let mut clusters = names
            .clusters(&spec.clusters)
            .map_err(|error| self.misnamed("sweep.clusters", &error))?;
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
            series: spec
                .series
                .as_ref()
                .map(|series| self.series(series, network, model))
                .transpose()?,
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

impl Plan {
    /// The kind of the figure that can be drawn.
    pub fn figure_kind(&self) -> FigureKind {
        drawn_kind(&self.study, self.figure.kind)
    }
}

/// The kind of figure that can be drawn: there are no matrices where not all pairs are observed, and the
/// sweep is shown instead.
fn drawn_kind(study: &Study, asked: FigureKind) -> FigureKind {
    let has_pairs = study.sweep.as_ref().is_some_and(|sweep| sweep.observables.pairs);
    match asked {
        FigureKind::Matrices if !has_pairs => FigureKind::Sweep,
        FigureKind::Sweep | FigureKind::Matrices | FigureKind::Regions | FigureKind::None => asked,
    }
}
