//! What will be done: an experiment with its network read, its names resolved and its numbers
//! checked, so that nothing can go wrong later for a reason that could have been seen now.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use clustering::ClusterRule;
use dynamics::lyapunov::Times;
use dynamics::{Adaptive, AdaptiveOrder, Coupling, Method, Model, Observables, Replica, Schedule};
use graph::{CouplingMatrix, Network, Normalization};

use crate::problem::{Problem, Result};
use crate::spec::{
    ClaimSpec, Experiment, FigureSpec, Format, Grid, MatrixKind, MethodKind, Name, NetworkSpec,
    Quantity, SolverKind, SweepSpec, WordOr,
};

/// `--quick` divides the times of sweeps and of the MSF by this.
pub const QUICK: f64 = 10.0;

/// Up to this many nodes all pairs are observed; beyond it only what the file asks for.
const ALL_PAIRS: usize = 2000;

/// An experiment that can be run.
pub struct Plan {
    /// Name of the file without its ending.
    pub id: String,
    /// The file itself.
    pub file: PathBuf,
    /// The specification as written, for titles, sources and the record.
    pub experiment: Experiment,
    /// 1, or [`QUICK`]: by how much times are shortened.
    pub shortened: f64,
    pub network: Network,
    pub matrix: CouplingMatrix,
    pub spectrum: spectra::Request,
    pub node: msf::Node,
    pub msf: msf::Request,
    pub rule: ClusterRule,
    pub sweep: Option<Sweep>,
}

/// Simulations over ε.
pub struct Sweep {
    pub epsilon: Vec<f64>,
    pub seeds: Vec<u64>,
    pub method: Method,
    pub schedule: Schedule,
    pub observables: Observables,
    pub synchronised_below: f64,
}

impl Sweep {
    /// All replicas, seed by seed within each ε.
    pub fn replicas(&self) -> Vec<Replica> {
        let of = |&epsilon| self.seeds.iter().map(move |&seed| Replica { epsilon, seed });
        self.epsilon.iter().flat_map(of).collect()
    }

    /// Steps of all replicas together.
    pub fn steps(&self) -> u64 {
        self.replicas().len() as u64 * self.schedule.steps()
    }
}

impl Plan {
    /// Steps of all tangent vectors of the MSF, refinement of one zero included.
    pub fn msf_steps(&self) -> u64 {
        (self.msf.sigma.len() as u64 + 16 + 64) * self.msf.times.steps()
    }
}

/// Checks an experiment file and reads what it names.
pub fn plan(file: &Path, quick: bool) -> Result<Plan> {
    let experiment = crate::load::experiment(file)?;
    let id = file
        .file_stem()
        .map(|stem| stem.to_string_lossy().into_owned())
        .ok_or_else(|| Problem::new("the file has no name to call its results by").in_file(file))?;
    let checker = Checker { file, experiment: &experiment };
    let shortened = if quick { QUICK } else { 1.0 };
    let network = checker.network()?;
    let matrix = CouplingMatrix::new(&network, checker.normalization());
    let node = checker.node()?;
    let plan = Plan {
        spectrum: checker.spectrum(network.n_nodes())?,
        msf: checker.msf(shortened)?,
        rule: checker.rule()?,
        sweep: experiment
            .sweep
            .as_ref()
            .map(|sweep| checker.sweep(sweep, &network, node.model, shortened))
            .transpose()?,
        id,
        file: file.to_owned(),
        shortened,
        network,
        matrix,
        node,
        experiment: experiment.clone(),
    };
    checker.claims(&plan)?;
    Ok(plan)
}

struct Checker<'a> {
    file: &'a Path,
    experiment: &'a Experiment,
}

impl Checker<'_> {
    fn problem(&self, key: &str, message: impl std::fmt::Display) -> Problem {
        Problem::with_key(self.file, key, message)
    }

    fn network(&self) -> Result<Network> {
        let NetworkSpec::File(spec) = &self.experiment.network;
        let path = self.file.parent().unwrap_or(Path::new("")).join(&spec.path);
        let named = |message: String| self.problem("network.file.path", message);
        let source = std::fs::File::open(&path).map_err(|error| {
            named(format!("names {}, which cannot be opened: {error}", path.display()))
        })?;
        let read = match spec.format {
            Format::EdgeList => graph::formats::edge_list::read(source),
        };
        read.map_err(|error| named(format!("names {}: {error}", path.display())))
    }

    fn normalization(&self) -> Normalization {
        match self.experiment.coupling.matrix {
            MatrixKind::Laplacian => Normalization::Laplacian,
            MatrixKind::Normalized => Normalization::Normalized,
        }
    }

    fn node(&self) -> Result<msf::Node> {
        let (model, spec) = (self.experiment.oscillator, &self.experiment.coupling);
        let from = self.component("coupling.from", &spec.from, model)?;
        let to = self.component("coupling.to", &spec.to, model)?;
        Ok(msf::Node { model, coupling: Coupling { from, to } })
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

    fn spectrum(&self, n_nodes: usize) -> Result<spectra::Request> {
        let spec = &self.experiment.spectrum;
        let modes = match spec.modes {
            WordOr::Word(_) => spectra::Modes::All,
            WordOr::Number(modes) => {
                let modes = usize::try_from(modes).unwrap_or(usize::MAX);
                if modes == 0 || modes > n_nodes {
                    let message = format!("is {modes}, but the network has modes 1 to {n_nodes}");
                    return Err(self.problem("spectrum.modes", message));
                }
                spectra::Modes::Leading(modes)
            }
        };
        let solver = match spec.solver {
            SolverKind::Auto => spectra::SolverChoice::Auto,
            SolverKind::Dense => spectra::SolverChoice::Dense,
            SolverKind::Arpack => spectra::SolverChoice::Arpack,
        };
        Ok(spectra::Request { modes, solver, ..spectra::Request::default() })
    }

    fn msf(&self, shortened: f64) -> Result<msf::Request> {
        let spec = &self.experiment.msf;
        let sigma = self.grid("msf.sigma", &spec.sigma, 2)?;
        self.not_negative("msf.sigma", sigma[0])?;
        self.positive("msf.step", spec.step)?;
        self.not_negative("msf.transient", spec.transient)?;
        self.positive("msf.average", spec.average)?;
        self.positive("msf.renormalise", spec.renormalise)?;
        self.positive("msf.relative_error", spec.relative_error)?;
        let blocks = dynamics::BLOCKS as f64;
        let least = blocks * spec.renormalise.max(spec.step) * shortened;
        self.at_least("msf.average", spec.average, least)?;
        Ok(msf::Request {
            sigma,
            times: Times {
                step: spec.step,
                transient: spec.transient,
                average: spec.average / shortened,
                renormalise: spec.renormalise,
            },
            refinement: msf::Refinement {
                relative_error: spec.relative_error,
                ..msf::Refinement::default()
            },
            seed: self.experiment.seed,
        })
    }

    fn rule(&self) -> Result<ClusterRule> {
        match self.experiment.prediction.threshold {
            WordOr::Word(_) => Ok(ClusterRule::Exact),
            WordOr::Number(threshold) => {
                self.positive("prediction.threshold", threshold)?;
                Ok(ClusterRule::Threshold(threshold))
            }
        }
    }

    fn sweep(
        &self,
        spec: &SweepSpec,
        network: &Network,
        model: Model,
        shortened: f64,
    ) -> Result<Sweep> {
        let epsilon = self.grid("sweep.epsilon", &spec.epsilon, 1)?;
        self.not_negative("sweep.epsilon", epsilon[0])?;
        self.positive("sweep.step", spec.step)?;
        self.not_negative("sweep.transient", spec.transient)?;
        self.positive("sweep.average", spec.average)?;
        self.positive("sweep.tolerance", spec.tolerance)?;
        self.positive("sweep.synchronised_below", spec.synchronised_below)?;
        self.positive("sweep.stride", f64::from(spec.stride))?;
        self.positive("sweep.seeds", spec.seeds as f64)?;
        let schedule = Schedule {
            step: spec.step,
            transient: spec.transient / shortened,
            average: spec.average / shortened,
            stride: spec.stride,
        };
        let least = dynamics::BLOCKS as f64 * schedule.sampling_interval() * shortened;
        self.at_least("sweep.average", spec.average, least)?;
        let component = match &spec.component {
            Some(name) => self.component("sweep.component", name, model)?,
            None => 0,
        };
        let reference = match &spec.error_to {
            Some(name) => Some(self.label("sweep.error_to", name, network)?),
            None => None,
        };
        let clusters = self.clusters("sweep.clusters", &spec.clusters, network)?;
        let first = self.experiment.seed;
        Ok(Sweep {
            epsilon,
            seeds: (0..spec.seeds).map(|k| first.wrapping_add(k)).collect(),
            method: self.method(spec),
            schedule,
            observables: Observables {
                component,
                pairs: network.n_nodes() <= ALL_PAIRS,
                reference,
                clusters,
            },
            synchronised_below: spec.synchronised_below,
        })
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

    fn label(&self, key: &str, name: &Name, network: &Network) -> Result<usize> {
        network.node(&name.0).ok_or_else(|| {
            let labels = network.labels();
            let shown: Vec<_> = labels.iter().take(8).map(String::as_str).collect();
            let more = if labels.len() > shown.len() { ", …" } else { "" };
            let message = format!("names node \"{}\", which the network does not have", name.0);
            self.problem(key, message).hint(format!("its nodes are {}{more}", shown.join(", ")))
        })
    }

    /// Clusters of node labels as lists of nodes: two nodes or more each, none twice.
    fn clusters(
        &self,
        key: &str,
        named: &[Vec<Name>],
        network: &Network,
    ) -> Result<Vec<Vec<usize>>> {
        let mut seen = BTreeSet::new();
        let mut clusters = Vec::new();
        for names in named {
            let nodes: Vec<usize> =
                names.iter().map(|name| self.label(key, name, network)).collect::<Result<_>>()?;
            if nodes.len() < 2 {
                return Err(self.problem(key, "has a cluster of fewer than two nodes"));
            }
            if let Some(&twice) = nodes.iter().find(|&&node| !seen.insert(node)) {
                let label = &network.labels()[twice];
                return Err(self.problem(key, format!("has node \"{label}\" twice")));
            }
            clusters.push(nodes);
        }
        Ok(clusters)
    }

    /// A grid's values: finite, ascending, and at least so many.
    fn grid(&self, key: &str, grid: &Grid, least: usize) -> Result<Vec<f64>> {
        if let Grid::Even(even) = grid
            && even.points > 1_000_000
        {
            return Err(
                self.problem(key, format!("has {} points; the most is 1000000", even.points))
            );
        }
        let mut values = grid.values();
        if values.len() < least {
            let message = format!("has {} points, but needs {least} or more", values.len());
            return Err(self.problem(key, message));
        }
        if let Some(value) = values.iter().find(|value| !value.is_finite()) {
            return Err(self.problem(key, format!("contains {value}; its values must be finite")));
        }
        if matches!(grid, Grid::List(_)) {
            values.sort_by(f64::total_cmp);
        }
        match values.windows(2).find(|pair| pair[0] >= pair[1]) {
            None => Ok(values),
            Some(pair) => Err(self.problem(
                key,
                format!("goes from {} to {}; its values must ascend", pair[0], pair[1]),
            )),
        }
    }

    fn positive(&self, key: &str, value: f64) -> Result<()> {
        if value.is_finite() && value > 0.0 {
            return Ok(());
        }
        Err(self.problem(key, format!("is {value}, but must be finite and above zero")))
    }

    fn not_negative(&self, key: &str, value: f64) -> Result<()> {
        if value.is_finite() && value >= 0.0 {
            return Ok(());
        }
        Err(self.problem(key, format!("is {value}, but must be finite and not negative")))
    }

    fn at_least(&self, key: &str, value: f64, least: f64) -> Result<()> {
        // A hair of slack, since the least is itself a product of decimal fractions.
        if value >= least * (1.0 - 1e-9) {
            return Ok(());
        }
        Err(self.problem(key, format!("is {value}, but its standard error needs {least} or more")))
    }

    /// What a claim needs beside its quantity must be there, and must name what exists.
    fn claims(&self, plan: &Plan) -> Result<()> {
        for (name, claim) in &self.experiment.claims {
            self.claim(name, claim, plan)?;
        }
        Ok(())
    }

    fn claim(&self, name: &str, claim: &ClaimSpec, plan: &Plan) -> Result<()> {
        use Quantity as Q;
        let key = format!("claims.{name}");
        let bounds = [claim.equals.is_some(), claim.at_most.is_some(), claim.at_least.is_some()];
        if bounds.iter().filter(|given| **given).count() != 1 {
            let message = "must have exactly one of `equals`, `at_most`, `at_least`";
            return Err(self.problem(&key, message));
        }
        let needs = |what: &str, given: bool, of: &[Quantity]| {
            if of.contains(&claim.of) && !given {
                return Err(self.problem(&key, format!("needs `where.{what}`")));
            }
            Ok(())
        };
        let at = &claim.at;
        let by_epsilon = [Q::CascadeClusters, Q::SimulatedClusters, Q::SimulatedError];
        let by_clusters =
            [Q::CascadeOrder, Q::SimulatedOnset, Q::SimulatedOrder, Q::SimulatedError];
        needs("epsilon", at.epsilon.is_some(), &by_epsilon)?;
        needs("modes", at.modes.is_some(), &[Q::Eigenvectors, Q::CriticalCouplings])?;
        needs("clusters", at.clusters.is_some(), &by_clusters)?;
        let simulated =
            [Q::SimulatedClusters, Q::SimulatedOnset, Q::SimulatedOrder, Q::SimulatedError];
        if simulated.contains(&claim.of) && plan.sweep.is_none() {
            return Err(self.problem(&key, "is about simulations, but there is no [sweep]"));
        }
        if let Some(clusters) = &at.clusters {
            self.clusters(&format!("{key}.where.clusters"), clusters, &plan.network)?;
        }
        let n_nodes = plan.network.n_nodes();
        let modes = at.modes.iter().flatten();
        if let Some(mode) = modes.copied().find(|mode| !(1..=n_nodes).contains(mode)) {
            let message = format!("is {mode}, but the modes are 1 to {n_nodes}");
            return Err(self.problem(&format!("{key}.where.modes"), message));
        }
        if let (Some(epsilon), Some(sweep)) = (at.epsilon, &plan.sweep)
            && simulated.contains(&claim.of)
            && !sweep.epsilon.contains(&epsilon)
        {
            let message = format!("is {epsilon}, which is not a point of `sweep.epsilon`");
            return Err(self.problem(&format!("{key}.where.epsilon"), message));
        }
        Ok(())
    }
}

/// The part of the specification that says what the figure shows.
impl Plan {
    pub fn figure(&self) -> &FigureSpec {
        &self.experiment.figure
    }
}
