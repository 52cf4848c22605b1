//! What will be done for an atlas: each of its systems as the node of an experiment would be, checked by
//! the same rules, with every coupling of one of its components into another.

use std::path::{Path, PathBuf};

use dynamics::{Coupling, InstructionSet};
use serde_json::Value;
use user::{Problem, Result, Stages, nearest};

use super::checker::{Checker, shortening};
use super::node::Function;
use super::node::Node;
use crate::hashes::plan_hash;
use crate::load::Document;
use crate::spec::defaults::millionth;
use crate::spec::{
    Atlas, CommunitiesSpec, CouplingSpec, Experiment, FigureSpec, Grid, MatrixKind, MsfMethod,
    MsfSpec, NetworkSpec, OscillatorSpec, PredictionSpec, PublishedSpec, SpectrumSpec, SystemSpec,
};

/// Fewest σ of a curve: fewer show no window.
const LEAST_POINTS: u32 = 9;
/// Most σ of a curve.
const MOST_POINTS: f64 = 1e5;

/// An atlas that can be made.
pub struct AtlasPlan {
    /// Name of the file without its ending.
    pub id: String,
    /// The file itself.
    pub file: PathBuf,
    /// One line that says what it shows.
    pub title: String,
    /// Where its settings and published values come from.
    pub source: String,
    /// The file as a document, defaults left out, for the record.
    pub written: Value,
    /// Every parameter that is used, defaults among them.
    pub parameters: Value,
    /// By how much times are shortened.
    pub shortened: f64,
    /// Seed of everything random.
    pub seed: u64,
    /// Values of σ for each pair.
    pub points: u32,
    /// The systems, in the order of the file.
    pub systems: Vec<System>,
}

/// An oscillator of an atlas.
pub struct System {
    /// Its name in the file.
    pub name: String,
    /// What the figure calls it.
    pub title: String,
    /// Its components that can be coupled.
    pub components: Vec<String>,
    /// The couplings, from component by component, to component by component.
    pub pairs: Vec<Pair>,
    /// How each curve is computed, but for its σ.
    msf: msf::Request,
}

/// One component into the equation of another.
pub struct Pair {
    /// Component that is read.
    pub from: String,
    /// Component whose equation it enters.
    pub to: String,
    /// The oscillator, coupled so.
    pub node: Node,
    /// What others have found.
    pub published: Option<PublishedSpec>,
}

impl AtlasPlan {
    /// What the plan is known by.
    pub fn hash(&self) -> String {
        plan_hash(&self.written, self.shortened, "")
    }

    /// Vector instructions to use; results do not depend on them.
    pub fn instruction_set(&self) -> InstructionSet {
        self.systems[0].msf.instruction_set
    }

    pub(super) fn use_instructions(&mut self, set: InstructionSet) {
        self.systems.iter_mut().for_each(|system| system.msf.instruction_set = set);
    }

    /// Steps of tangent vectors that all curves take, about.
    pub fn steps(&self) -> u64 {
        self.pairs().map(|(system, _)| system.request(1.0, self.points).steps()).sum()
    }

    /// The systems with each of their pairs, in order.
    pub fn pairs(&self) -> impl Iterator<Item = (&System, &Pair)> {
        self.systems.iter().flat_map(|system| system.pairs.iter().map(move |pair| (system, pair)))
    }
}

impl System {
    /// Times of every exponent.
    pub fn times(&self) -> &dynamics::lyapunov::Times {
        &self.msf.times
    }

    /// The curve up to a σ: points lie closer towards 0, as windows do.
    pub fn request(&self, reach: f64, points: u32) -> msf::Request {
        let sigma = |k: u32| reach * (f64::from(k) / f64::from(points - 1)).powi(2);
        msf::Request { sigma: (0..points).map(sigma).collect(), ..self.msf.clone() }
    }
}

pub(super) fn of(
    document: Document<Atlas>,
    (file, id): (&Path, &str),
    quick: bool,
    stages: &Stages,
) -> Result<AtlasPlan> {
    let (atlas, shortened) = (&document.experiment, shortening(quick));
    if atlas.atlas.is_empty() {
        return Err(Problem::with_key(file, "atlas", "has no systems").hint(
            "give each a table, such as [atlas.rossler] with oscillator.rossler = { c = 9.0 }",
        ));
    }
    let systems = atlas.atlas.iter().map(|(name, spec)| {
        let experiment = experiment(atlas, spec);
        let checker = Checker {
            file,
            experiment: &experiment,
            written: &document.written,
            text: &document.text,
            system: Some(name),
            shortened,
            stages,
        };
        checker.system(name, spec, atlas.msf.points)
    });
    let systems = systems.collect::<Result<Vec<System>>>()?;
    Ok(AtlasPlan {
        id: id.to_owned(),
        file: file.to_owned(),
        title: atlas.title.clone(),
        source: atlas.source.clone(),
        parameters: parameters(atlas, &systems),
        written: document.written,
        shortened,
        seed: atlas.seed,
        points: atlas.msf.points,
        systems,
    })
}

impl Checker<'_> {
    fn system(&self, name: &str, spec: &SystemSpec, points: u32) -> Result<System> {
        self.at_most("msf.points", f64::from(points), MOST_POINTS)?;
        if points < LEAST_POINTS {
            let message = format!("is {points}, but needs {LEAST_POINTS} or more to show a window");
            return Err(self.problem("msf.points", message));
        }
        let (node, unused) = self.node()?;
        if let Some(key) = unused.first() {
            return Err(self.problem(key, "is used by nothing").hint("leave it out"));
        }
        let dynamics = node.dynamics();
        let components: Vec<String> =
            dynamics.components()[..dynamics.n_free()].iter().map(ToString::to_string).collect();
        for (key, published) in &spec.published {
            self.published(key, published, &components)?;
        }
        let mut pairs = Vec::new();
        for (i, from) in components.iter().enumerate() {
            for (j, to) in components.iter().enumerate() {
                let mut node = node.clone();
                node.function = Function::Pair([from.clone(), to.clone()]);
                node.equations.coupling = Coupling::pair(i, j);
                let published = spec.published.get(&format!("{from}:{to}")).cloned();
                pairs.push(Pair { from: from.clone(), to: to.clone(), node, published });
            }
        }
        let msf = self.msf(dynamics)?;
        if let Some(jump) = self.tried(&pairs[0].node, msf.times.step)? {
            return Err(self.problem("oscillator", format!("cannot be followed: {jump}")));
        }
        let title = spec.title.clone().unwrap_or_else(|| name.to_owned());
        Ok(System { name: name.to_owned(), title, components, pairs, msf })
    }

    /// Refuses published windows of no pair, and such as cannot be.
    fn published(&self, pair: &str, spec: &PublishedSpec, components: &[String]) -> Result<()> {
        let key = format!("published.\"{pair}\"");
        let known: Vec<String> = components
            .iter()
            .flat_map(|from| components.iter().map(move |to| format!("{from}:{to}")))
            .collect();
        if !known.iter().any(|known| known == pair) {
            let hint = match nearest(pair, known.iter().map(String::as_str)) {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => format!("the pairs are {}", known.join(", ")),
            };
            return Err(self.problem(&key, "is about no pair of components").hint(hint));
        }
        self.positive(&format!("{key}.within"), spec.within)?;
        let ends: Vec<f64> = spec.windows.iter().flatten().copied().collect();
        let ascend = ends.windows(2).all(|pair| pair[0] < pair[1]);
        let finite = ends.iter().rev().skip(1).all(|end| end.is_finite());
        if !ascend || !finite || ends.first().is_some_and(|&first| first < 0.0) {
            let message = "must be windows [from, to] from 0 or above, ascending and apart, of which \
                           only the last may end at inf";
            return Err(self.problem(&format!("{key}.windows"), message));
        }
        Ok(())
    }
}

/// What the rules of experiments are asked about: the system alone, for whose couplings a first look will
/// find the σ.
fn experiment(atlas: &Atlas, spec: &SystemSpec) -> Experiment {
    let of_library = match &spec.oscillator {
        OscillatorSpec::Known { name, .. } => oscillators::find(name).ok().map(|entry| entry.step),
        OscillatorSpec::Custom(_) => None,
    };
    let communities = CommunitiesSpec {
        sizes: vec![2],
        p_within: Some(1.0),
        p_between: Some(0.0),
        probability: None,
        seed: None,
    };
    let first = spec.oscillator.components().into_iter().next();
    let coupling = CouplingSpec {
        matrix: MatrixKind::Laplacian,
        from: first.clone(),
        to: first,
        function: None,
        subexpressions: indexmap::IndexMap::new(),
        parameters: indexmap::IndexMap::new(),
    };
    let msf = MsfSpec {
        sigma: Some(Grid::List(vec![0.0, 1.0])),
        method: MsfMethod::default(),
        step: spec.step.or(of_library),
        tolerance: millionth(),
        transient: atlas.msf.transient,
        average: spec.average.unwrap_or(atlas.msf.average),
        renormalise: atlas.msf.renormalise,
        relative_error: atlas.msf.relative_error,
    };
    Experiment {
        title: atlas.title.clone(),
        source: atlas.source.clone(),
        seed: atlas.seed,
        network: NetworkSpec::Communities(communities),
        prepare: Vec::new(),
        groups: None,
        regions: None,
        oscillator: spec.oscillator.clone(),
        escape_radius: dynamics::ESCAPE_RADIUS,
        coupling,
        spectrum: SpectrumSpec::default(),
        msf,
        prediction: PredictionSpec::default(),
        sweep: None,
        figure: FigureSpec::default(),
        claims: indexmap::IndexMap::new(),
    }
}

/// The atlas with its defaults, and the step of each system.
fn parameters(atlas: &Atlas, systems: &[System]) -> Value {
    let mut parameters = serde_json::to_value(atlas).unwrap_or_default();
    for system in systems {
        let times = system.times();
        parameters["atlas"][&system.name]["step"] = times.step.into();
        parameters["atlas"][&system.name]["average"] = times.average.into();
        parameters["msf"]["transient"] = times.transient.into();
        parameters["msf"]["relative_error"] = system.msf.refinement.relative_error.into();
    }
    parameters["msf"]["average"] = Value::Null;
    parameters
}
