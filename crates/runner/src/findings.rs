//! What an experiment found: the stages of a run in order, each from those before it.

use clustering::{
    CascadeTree, ClusteringError, Partition, State, StateLabels, hold_against_links,
    merge_equal_clusters,
};
use dynamics::DynamicsError;
use msf::{CriticalCoupling, MasterStability, StableRegion};
use rayon::prelude::*;
use spectra::Spectrum;

use crate::agreement::{self, Agreement};
use crate::check;
use crate::plan::{Plan, Sweep};
use crate::prediction::Known;
use crate::problem::{Problem, Result, plain};
use crate::progress::Stages;
use crate::simulated::Simulated;
use crate::stability;
use crate::synchrony::{Evidence, Synchrony};
use crate::warning::{Warning, Warnings};

/// Total weights of two nodes to a cluster that differ by no more, relative to what they are made of,
/// differ by rounding.
pub const EQUITABLE: f64 = 1e-9;

/// Clusters of fewer nodes are in no tree: a million single nodes tell nothing.
const LEAST_LISTED: usize = 2;

/// Everything computed in one run.
pub struct Findings {
    pub spectrum: Spectrum,
    pub msf: MasterStability,
    pub critical: Vec<CriticalCoupling>,
    /// Whether, and where, all nodes synchronise.
    pub synchrony: Synchrony,
    /// Predicted states, from large ε down; neighbours differ in their clusters.
    pub cascade: Vec<State>,
    /// Of each of these states.
    pub labels: Vec<StateLabels>,
    /// The same states as trees, labelled: one for each run of states in which clusters only split.
    pub trees: Vec<CascadeTree>,
    pub simulated: Option<Simulated>,
    /// At every ε of the sweep; empty without one, or without all pairs.
    pub agreement: Vec<Agreement>,
    /// What must be known beside these numbers, in the order in which it came up.
    pub warnings: Vec<Warning>,
}

/// The master stability functions computed so far: experiments that ask for the same one share it.
#[derive(Default)]
pub struct Curves(Vec<(msf::Node, msf::Request, MasterStability)>);

impl Curves {
    /// The curve of a plan, computed unless an earlier plan had the same node and request.
    fn of(&mut self, plan: &Plan, stages: &Stages) -> Result<MasterStability> {
        let same = |known: &&(msf::Node, msf::Request, MasterStability)| {
            known.0 == plan.node && known.1 == plan.msf
        };
        if let Some((_, _, curve)) = self.0.iter().find(same) {
            return Ok(curve.clone());
        }
        let compute = |progress: dynamics::Progress<'_>| {
            msf::master_stability(&plan.node, &plan.msf, progress)
        };
        let curve = stages
            .measured("msf", plan.msf_steps(), compute)
            .map_err(|error| msf_problem(plan, &error))?;
        refuse_overflow(plan, &curve)?;
        self.0.push((plan.node, plan.msf.clone(), curve.clone()));
        Ok(curve)
    }
}

/// Runs a plan: MSF, spectrum, prediction, simulation.
pub fn find(plan: &Plan, curves: &mut Curves, stages: &Stages) -> Result<Findings> {
    let failed = |what: &str, error: &dyn std::fmt::Display| {
        Problem::from_error(what, error).in_file(&plan.file)
    };
    let mut warnings = Warnings::new(&plan.id);
    check::warn(plan, &mut warnings);
    plan.doubts.iter().for_each(|doubt| warnings.add(doubt.about, &doubt.message[..]));
    let msf = curves.of(plan, stages)?;
    stability::warn(plan, &msf, &mut warnings);
    let stable = &msf.stable;
    let n_nodes = plan.network.n_nodes();
    let request = plan.spectrum.request(stable, n_nodes);
    let spectrum = stages
        .told("spectrum", |tell| {
            spectra::leading_modes_with(&plan.matrix, &request, &|advance| tell(&advanced(advance)))
        })
        .map_err(|error| failed("the spectrum could not be computed", &error))?;
    check::warn_of_weak_links(&spectrum, &mut warnings);
    let critical = msf::critical_couplings(stable, &spectrum.eigenvalues, spectrum.tolerance);
    let fastest = fastest(plan, &spectrum, stable, &mut warnings);
    let known = Known { spectrum: &spectrum, fastest };
    if let Some(top) = known.top(stable) {
        warnings.add("cascade", beyond(plan, spectrum.eigenvalues.len(), top));
    }
    let n_states = (spectrum.eigenspaces.len() * stable.intervals.len()) as u64;
    let states = stages
        .measured("clusters", n_states, |progress| {
            let mut states = known.states(stable, plan.rule, progress)?;
            let matrix = plan.matrix.matrix().view();
            hold_against_links(&mut states, &spectrum, matrix, plan.rule, EQUITABLE)?;
            Ok(states)
        })
        .map_err(|error| unpredictable(plan, &error))?;
    let simulated = match &plan.sweep {
        Some(sweep) => Some(simulate(plan, sweep, stages)?),
        None => None,
    };
    let agreement = match &simulated {
        Some(simulated) => stages
            .unmeasured("agreement", || agreement::at_all(plan, &spectrum, &states, simulated))?,
        None => Vec::new(),
    };
    let synchrony = Synchrony::of(&Evidence {
        known,
        stable,
        critical: &critical,
        states: &states,
        n_components: plan.n_components,
        looked_to: msf.sigma[msf.sigma.len() - 1],
    });
    let cascade = merge_equal_clusters(&states);
    let labels = labels(plan, &spectrum, &cascade, &states, stages)
        .map_err(|error| failed("the clusters cannot be labelled", &error))?;
    drop(states);
    let mut trees = CascadeTree::of_each_run(&cascade, LEAST_LISTED);
    trees.iter_mut().for_each(|tree| tree.label(&cascade, &labels));
    let warnings = warnings.into_list();
    Ok(Findings {
        cascade,
        labels,
        trees,
        spectrum,
        msf,
        critical,
        synchrony,
        simulated,
        agreement,
        warnings,
    })
}

/// λ_N: the last eigenvalue, or computed by itself where it decides and is not among the leading ones.
fn fastest(
    plan: &Plan,
    spectrum: &Spectrum,
    stable: &StableRegion,
    warnings: &mut Warnings,
) -> Option<f64> {
    if spectrum.eigenvalues.len() == plan.network.n_nodes() {
        return spectrum.eigenvalues.last().copied();
    }
    if stable.is_unbounded() {
        return None;
    }
    match spectra::smallest_eigenvalue(&plan.matrix) {
        Ok(lambda) => Some(lambda),
        Err(error) => {
            warnings.add("global_synchrony", format!("λ_N is not known: {error}"));
            None
        }
    }
}

/// What is not predicted from a part of the modes, and what would be needed for it.
fn beyond(plan: &Plan, computed: usize, top: f64) -> String {
    format!(
        "the stable set has an upper end, and {computed} of {} modes were computed: above epsilon = {} \
         the fastest modes may be unstable, and nothing is predicted there. `spectrum.modes = \"all\"` \
         decides it",
        plan.network.n_nodes(),
        plain(top)
    )
}

fn advanced(advance: spectra::Advance) -> String {
    let spectra::Advance { products, converged, wanted } = advance;
    format!("{converged} of {wanted} modes found, {products} matrix-vector products")
}

fn unpredictable(plan: &Plan, error: &ClusteringError) -> Problem {
    let problem =
        Problem::from_error("the cascade could not be predicted", error).in_file(&plan.file);
    match error {
        ClusteringError::NoTransverseMode { .. } => problem.hint(format!(
            "the network has {} components, and each brings an eigenvalue 0: ask for more modes \
             than that, or prepare the network by `largest_component`",
            plan.n_components
        )),
        _ => problem,
    }
}

/// Which clusters are exact and which approximate, state by state.
fn labels(
    plan: &Plan,
    spectrum: &Spectrum,
    cascade: &[State],
    stretches: &[State],
    stages: &Stages,
) -> std::result::Result<Vec<StateLabels>, ClusteringError> {
    let (matrix, rule) = (plan.matrix.matrix().view(), plan.rule);
    stages.measured("labels", cascade.len() as u64, |progress| {
        let of = |state: &State| {
            let stretches = state.stretches(stretches);
            let labels = StateLabels::of(state, stretches, spectrum, matrix, rule, EQUITABLE);
            progress(1);
            labels
        };
        cascade.par_iter().map(of).collect()
    })
}

fn msf_problem(plan: &Plan, error: &msf::MsfError) -> Problem {
    let what = "the master stability function could not be computed";
    let problem = Problem::from_error(what, error).in_file(&plan.file);
    if !matches!(error, msf::MsfError::Dynamics(DynamicsError::Escaped { .. })) {
        return problem;
    }
    problem.hint(format!(
        "either the parameters of [oscillator.{}] leave it no bounded attractor, or `msf.step` is \
         too long for it",
        plan.node.model.name()
    ))
}

/// A perturbation may grow beyond all numbers between two renormalisations.
fn refuse_overflow(plan: &Plan, msf: &MasterStability) -> Result<()> {
    let Some(at) = msf.lambda.iter().position(|lambda| !lambda.mean.is_finite()) else {
        return Ok(());
    };
    let message = format!(
        "reaches {}, where perturbations grow beyond all numbers between two renormalisations",
        plain(msf.sigma[at])
    );
    let hint = "end the grid earlier, or shorten `msf.renormalise` and `msf.step`";
    Err(Problem::with_key(&plan.file, "msf.sigma", message).hint(hint))
}

fn simulate(plan: &Plan, sweep: &Sweep, stages: &Stages) -> Result<Simulated> {
    let simulation = dynamics::Simulation {
        model: plan.node.model,
        coupling: plan.node.coupling,
        matrix: plan.matrix.matrix(),
        method: sweep.method,
        schedule: sweep.schedule,
        observables: sweep.observables.clone(),
        kick: sweep.kick,
        instruction_set: plan.msf.instruction_set,
    };
    let runs = stages
        .measured("sweep", sweep.steps(), |progress| simulation.run(&sweep.replicas(), progress))
        .map_err(|error| {
            Problem::from_error("the sweep could not be simulated", error).in_file(&plan.file)
        })?;
    Ok(Simulated::new(sweep, plan.network.n_nodes(), runs))
}

impl Findings {
    /// The clusters predicted at a coupling strength; none where the prediction does not reach.
    pub fn predicted_at(&self, epsilon: f64) -> Option<&Partition> {
        self.cascade.iter().find(|state| state.holds_at(epsilon)).map(|state| &*state.clusters)
    }

    /// ε at which these nodes cease to be in one predicted cluster as ε falls; none if they never do.
    pub fn predicted_loss(&self, cluster: &[usize]) -> Option<f64> {
        let together = |state: &State| {
            let of = state.clusters.cluster_of();
            cluster.iter().all(|&node| of[node] == of[cluster[0]])
        };
        let lost = self.cascade.iter().find(|state| !together(state))?;
        Some(lost.epsilon.1.unwrap_or(f64::INFINITY))
    }
}
