//! What will be done: an experiment with its network read, its names resolved and its numbers
//! checked, so that nothing can go wrong later for a reason that could have been seen now.

mod atlas;
mod checker;
mod claimed;
mod effects;
mod memory;
mod network;
mod node;
mod numbers;
mod parameters;
mod planned;
mod ranges;
mod series;
mod source;
mod spectrum;
mod step;
mod sweep;
mod tried;
mod watched;

use eigensync::numbers::{plain, two_digits};
use eigensync::{Study, Warning};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use claims::Claim;
use clustering::ClusterRule;
use dynamics::lyapunov::{Integrator, Times};
use dynamics::{InstructionSet, NodeDynamics, StepChoice};
use graph::prepare::Report;
use graph::{CouplingMatrix, Normalization};

pub use atlas::{AtlasPlan, Pair, System};
pub use checker::QUICK;
use checker::{Checker, shortening};
pub use memory::Memory;
pub use node::Node;
pub use parameters::method;
pub use planned::Planned;
use serde_json::Value;
pub use series::Recorded;

use crate::hashes::{links_hash, plan_hash};
use crate::load::{self, AnyDocument, Document};
use crate::spec::{
    Experiment, FigureKind, FigureSpec, MatrixKind, MsfMethod, NetworkSpec, RegionsSpec, StepSpec,
    ThresholdSpec,
};
use user::{Problem, Result, Stages};

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
    /// Which coupling matrix.
    pub matrix: MatrixKind,
    /// What the node of the study is known by.
    pub node: Node,
    /// What `method = "auto"` has chosen for the sweep.
    pub chosen: Option<StepChoice>,
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

/// Checks a file and reads what it names.
///
/// # Errors
/// What is wrong with the file, or with what it names.
pub fn plan(file: &Path, id: &str, quick: bool, stages: &Stages) -> Result<Planned> {
    match load::document(file)? {
        AnyDocument::Experiment(document) => {
            of(*document, (file, id), quick, stages).map(Box::new).map(Planned::Experiment)
        }
        AnyDocument::Atlas(document) => {
            atlas::of(*document, (file, id), quick, stages).map(Box::new).map(Planned::Atlas)
        }
    }
}

/// The plan of an experiment that is given as a text.
///
/// # Errors
/// As [`plan`].
pub fn plan_of(text: &Text<'_>, quick: bool, stages: &Stages) -> Result<Plan> {
    let mut document: Document = load::parse(text.text, text.file)?;
    if let NetworkSpec::File(spec) = &mut document.experiment.network {
        spec.given.clone_from(&text.network);
    }
    of(document, (text.file, text.id), quick, stages)
}

/// The hash of the plan that [`plan`] would make, for which the network is all that must be read.
///
/// # Errors
/// What is wrong with the file, or with its network.
pub fn plan_hash_of(file: &Path, quick: bool) -> Result<String> {
    let (shortened, stages) = (shortening(quick), Stages::new("", Arc::new(())));
    let document = match load::document(file)? {
        AnyDocument::Experiment(document) => document,
        AnyDocument::Atlas(document) => return Ok(plan_hash(&document.written, shortened, "")),
    };
    let checker = Checker::of(&document, file, shortened, &stages);
    let (network, _) = checker.network()?;
    Ok(plan_hash(&document.written, shortened, &links_hash(&network)))
}

/// The node that a document without a network says, its tables `oscillator` and `coupling`.
///
/// - `origin`: the file in which mistakes have a place, and its text.
///
/// # Errors
/// What is wrong with it.
pub fn node_of(document: &toml::Table, (file, text): (&Path, &str)) -> Result<Node> {
    let mut whole = toml::toml! {
        title = "a node without a network"
        network.communities = { sizes = [2], p_within = 1.0, p_between = 0.0 }
        coupling.matrix = "laplacian"
        msf.sigma = [0.0, 1.0]
    };
    for (key, value) in document {
        match (whole.get_mut(key).and_then(toml::Value::as_table_mut), value) {
            (Some(there), toml::Value::Table(more)) => there.extend(more.clone()),
            _ => drop(whole.insert(key.clone(), value.clone())),
        }
    }
    let asked = toml::to_string(&whole)
        .map_err(|error| Problem::from_error("cannot be written as TOML", error).in_file(file))?;
    let document = Document { text: text.to_owned(), ..load::parse(&asked, file)? };
    let stages = Stages::new("", Arc::new(()));
    Ok(Checker::of(&document, file, 1.0, &stages).node()?.0)
}

fn of(document: Document, (file, id): (&Path, &str), quick: bool, stages: &Stages) -> Result<Plan> {
    let shortened = shortening(quick);
    let checker = Checker::of(&document, file, shortened, stages);
    let experiment = checker.experiment;
    checker.effects()?;
    let (network, preparation) = checker.network()?;
    let (n_components, matrix, links_hash) = stages.unmeasured("preparation", || {
        let n_components = network.components().len();
        let matrix = CouplingMatrix::new(&network, checker.normalization());
        (n_components, matrix, links_hash(&network))
    });
    let (node, unused) = checker.node()?;
    let dynamics = node.dynamics();
    let modes = checker.spectrum(network.n_nodes(), n_components)?;
    let msf = checker.msf(dynamics)?;
    let rule = checker.rule(network.n_nodes())?;
    let sweep = experiment.sweep.as_ref();
    let sweep =
        sweep.map(|spec| checker.sweep(spec, (&network, &matrix), &node.equations)).transpose()?;
    let (sweep, chosen) = sweep.map_or((None, None), |(sweep, chosen)| (Some(sweep), chosen));
    let study = Study {
        modes,
        msf,
        rule,
        sweep,
        regions: experiment.regions.as_ref().map(RegionsSpec::bounds),
        seed: experiment.seed,
        node: node.equations.clone(),
        network,
        n_components,
        matrix,
    };
    let doubt = |key| Warning { about: "oscillator", message: format!("nothing uses `{key}`") };
    let mut doubts: Vec<Warning> = unused.into_iter().map(doubt).collect();
    let jumps = checker.tried(&node, study.msf.times.step)?;
    doubts.extend(jumps.map(|message| Warning { about: "msf", message }));
    doubts.extend(checker.steps(&study)?);
    if let Some(StepChoice { error, is_within: false, .. }) = chosen {
        let message = format!(
            "no step within reach errs by less than `sweep.tolerance`, as where equations jump or have \
             kinks; RK4 is taken, whose step errs by {} of the attractor per unit of time",
            two_digits(error)
        );
        doubts.push(Warning { about: "simulations", message });
    }
    checker.regions(&study.network)?;
    checker.figure(&study.network, &study.modes)?;
    let claims = checker.claims(&study)?;
    let recorded = match &study.sweep {
        Some(sweep) => checker.recorded(sweep, &study.network, dynamics)?,
        None => None,
    };
    Memory::of_study(&study, experiment.figure.kind).affordable(file)?;
    let parameters = parameters::of(experiment, &study);
    let Document { experiment, written, .. } = document;
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
        matrix: coupling.matrix,
        node,
        chosen,
        figure,
        claims,
        recorded,
        doubts,
    })
}

impl Checker<'_> {
    fn normalization(&self) -> Normalization {
        match self.experiment.coupling.matrix {
            MatrixKind::Laplacian => Normalization::Laplacian,
            MatrixKind::Normalized => Normalization::Normalized,
        }
    }

    fn msf(&self, dynamics: &dyn NodeDynamics) -> Result<msf::Request> {
        let spec = &self.experiment.msf;
        let step = self.step("msf.step", spec.step, dynamics)?;
        let renormalise = spec.renormalise.unwrap_or(if dynamics.is_map() { 1.0 } else { 0.5 });
        let sigma = match &spec.sigma {
            Some(grid) => self.grid("msf.sigma", grid, 2)?,
            None => Vec::new(),
        };
        self.not_negative("msf.sigma", sigma.first().copied().unwrap_or(0.0))?;
        self.not_negative("msf.transient", spec.transient)?;
        self.positive("msf.average", spec.average)?;
        self.positive("msf.renormalise", renormalise)?;
        if dynamics.is_map() && renormalise.fract() != 0.0 {
            let message = format!("is {}, but a map goes in steps of 1", plain(renormalise));
            return Err(self.problem("msf.renormalise", message).hint("take a whole number"));
        }
        self.positive("msf.tolerance", spec.tolerance)?;
        self.positive("msf.relative_error", spec.relative_error)?;
        let interval = (renormalise / step).round().max(1.0) * step;
        self.blocks("msf.average", spec.average, (interval, "`msf.renormalise` in whole steps"))?;
        let times = Times {
            integrator: match spec.method {
                MsfMethod::Auto => Integrator::Auto { tolerance: spec.tolerance },
                MsfMethod::Rk4 => Integrator::Rk4,
                MsfMethod::Taylor => Integrator::Taylor { tolerance: spec.tolerance },
            },
            step,
            transient: spec.transient / self.shortened,
            average: spec.average / self.shortened,
            renormalise,
        };
        let exponents = sigma.len() as f64;
        self.feasible("msf", exponents * (times.transient + times.average) / times.step)?;
        self.msf_ranges(step, renormalise)?;
        Ok(msf::Request {
            sigma,
            times,
            refinement: msf::Refinement {
                // Shorter averages are for a first look, with larger errors.
                relative_error: spec.relative_error * self.shortened.sqrt(),
                max_rounds: rounds(spec.average),
            },
            seed: self.experiment.seed,
            instruction_set: InstructionSet::best(),
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
}

/// Rounds of refinement: as much time for short averages as for those of 20,000.
fn rounds(average: f64) -> usize {
    const LONG: f64 = 2e4;
    let rounds = msf::Refinement::default().max_rounds;
    (LONG / average).ceil().clamp(1.0, 100.0) as usize * rounds
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
