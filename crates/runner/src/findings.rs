//! What an experiment found: the stages of a run in order, each from those before it.

use clustering::{
    CascadeTree, ClusteringError, Partition, State, StateLabels, hold_against_links,
    merge_equal_clusters,
};
use msf::{CriticalCoupling, MasterStability, StableRegion};
use rayon::prelude::*;
use spectra::{RealModes, Spectrum};

use crate::agreement::{self, Agreement};
use crate::check;
use crate::computed::{self, Curves};
use crate::doubts;
use crate::journal::{Held, Journal};
use crate::plan::Plan;
use crate::prediction::Known;
use crate::problem::{Problem, Result, plain};
use crate::progress::Stages;
use crate::simulated::{Seen, Simulated};
use crate::stability;
use crate::step_effect::StepEffect;
use crate::synchrony::{Evidence, Synchrony, assumed_above};
use crate::table::four_digits;
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
    /// What the step of the integrator does to the errors of the sweep, at some of its couplings.
    pub step_effects: Vec<StepEffect>,
    /// At every ε of the sweep; empty without one, or without all pairs.
    pub agreement: Vec<Agreement>,
    /// What of this an earlier run had computed.
    pub taken: Held,
    /// What must be known beside these numbers, in the order in which it came up.
    pub warnings: Vec<Warning>,
}

/// Runs a plan: MSF, spectrum, prediction, simulation.
pub fn find(plan: &Plan, curves: &mut Curves, journal: &Journal) -> Result<Findings> {
    let stages = &plan.stages;
    let mut warnings = Warnings::new(&plan.id);
    check::warn(plan, &mut warnings);
    plan.doubts.iter().for_each(|doubt| warnings.add(doubt.about, &doubt.message[..]));
    let msf = curves.of(plan, journal)?;
    doubts::warn_of_short_times(plan, &mut warnings);
    stability::warn(plan, &msf, &mut warnings);
    let stable = &msf.stable;
    let n_nodes = plan.network.n_nodes();
    let request = plan.spectrum.request(stable, n_nodes);
    let spectrum = computed::spectrum(plan, &request, journal)?;
    check::warn_of_weak_links(&spectrum, &mut warnings);
    // Zero modes are zero exactly, and no others are.
    let modes = spectrum.real_modes();
    let mut critical = msf::critical_couplings(stable, &modes.eigenvalues, 0.0);
    critical.iter_mut().for_each(|critical| with_error_of_eigenvalue(critical, &modes));
    let fastest = fastest(plan, &spectrum, stable, &mut warnings);
    let fastest_rate = fastest.map_or_else(|| strongest(plan), f64::abs);
    if let Some(above) = assumed_above(stable, fastest_rate) {
        let looked = four_digits(msf.sigma[msf.sigma.len() - 1]);
        let above = four_digits(above);
        let message = format!(
            "nothing was looked at beyond σ = {looked}: above epsilon = {above} some modes are there, \
             and are taken to be stable"
        );
        warnings.add("cascade", message);
    }
    let known = Known { spectrum: &spectrum, fastest };
    if let Some(top) = known.top(stable) {
        warnings.add("cascade", beyond(plan, spectrum.n_modes(), top));
    }
    let n_states = (spectrum.eigenspaces.len() * stable.intervals.len()) as u64;
    let states = stages
        .measured("clusters", n_states, |progress| {
            let mut states = known.states(stable, plan.rule, progress)?;
            if stable.intervals.is_empty() {
                known.end_where_the_look_began(&mut states, msf.sigma[0]);
            }
            let matrix = plan.matrix.matrix().view();
            hold_against_links(&mut states, &spectrum, matrix, plan.rule, EQUITABLE)?;
            Ok(states)
        })
        .map_err(|error| unpredictable(plan, &error))?;
    let simulated = match &plan.sweep {
        Some(sweep) => {
            let mut simulated = computed::simulate(plan, sweep, journal, &mut warnings)?;
            simulated.apart = doubts::apart(&msf);
            Some(simulated)
        }
        None => {
            journal.tell_taken();
            None
        }
    };
    let mut step_effects = Vec::new();
    if let (Some(sweep), Some(simulated)) = (&plan.sweep, &simulated) {
        doubts::warn_of_runs(&msf, simulated, &mut warnings);
        step_effects = computed::effects_of_step(plan, sweep, simulated, journal)?;
        step_effects.iter().for_each(|effect| effect.warn(&mut warnings));
    }
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
        n_rests: msf.rests.len(),
        looked: &msf.sigma,
        fastest_rate,
    });
    let cascade = merge_equal_clusters(&states);
    let labels = labels(plan, &spectrum, &cascade, &states, stages).map_err(|error| {
        Problem::from_error("the clusters cannot be labelled", error).in_file(&plan.file)
    })?;
    drop(states);
    let mut trees = CascadeTree::of_each_run(&cascade, LEAST_LISTED);
    trees.iter_mut().for_each(|tree| tree.label(&cascade, &labels));
    let taken = journal.taken();
    let mut findings = Findings {
        cascade,
        labels,
        trees,
        spectrum,
        msf,
        critical,
        synchrony,
        simulated,
        step_effects,
        agreement,
        taken,
        warnings: Vec::new(),
    };
    doubts::warn_of_groups(&findings, &mut warnings);
    findings.warnings = warnings.into_list();
    Ok(findings)
}

/// ε_k = σ/|λ_k| is as uncertain as both; λ_k is so where the links behind it are lost in rounding.
fn with_error_of_eigenvalue(critical: &mut CriticalCoupling, modes: &RealModes<'_>) {
    let relative = modes.error(critical.mode - 1) / critical.lambda.abs();
    if critical.epsilon.is_finite() {
        critical.standard_error = critical.standard_error.hypot(critical.epsilon * relative);
    }
}

/// λ_N: the last eigenvalue, or computed by itself where it decides and is not among the leading ones.
fn fastest(
    plan: &Plan,
    spectrum: &Spectrum,
    stable: &StableRegion,
    warnings: &mut Warnings,
) -> Option<f64> {
    if spectrum.is_whole() {
        return spectrum.real_eigenvalues().last().copied();
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

/// The largest |w_ii|, which |λ_N| is at least.
fn strongest(plan: &Plan) -> f64 {
    let diagonal = plan.matrix.matrix().diag_iter();
    diagonal.flatten().fold(0.0, |largest, w| largest.max(w.abs()))
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

impl Findings {
    /// The clusters predicted at a coupling strength; none where the prediction does not reach.
    pub fn predicted_at(&self, epsilon: f64) -> Option<&Partition> {
        self.cascade.iter().find(|state| state.holds_at(epsilon)).map(|state| &*state.clusters)
    }

    /// The clusters predicted on either side of critical couplings that may, within two standard errors,
    /// lie on the other side of this ε; none for a side that is not predicted.
    pub fn predicted_about(&self, epsilon: f64) -> Vec<Option<&Partition>> {
        let is_near = |c: &&CriticalCoupling| {
            (c.epsilon - epsilon).abs() <= 2.0 * c.standard_error && c.epsilon.is_finite()
        };
        let near: Vec<f64> = self.critical.iter().filter(is_near).map(|c| c.epsilon).collect();
        let [low, high] =
            near.iter().fold([epsilon; 2], |[low, high], &at| [low.min(at), high.max(at)]);
        if near.is_empty() {
            return Vec::new();
        }
        let is_met =
            |state: &&State| state.epsilon.0 <= high && state.epsilon.1.is_none_or(|to| low <= to);
        let mut met: Vec<Option<&Partition>> =
            self.cascade.iter().filter(is_met).map(|state| Some(&*state.clusters)).collect();
        let [top, bottom] = [self.cascade.first(), self.cascade.last()];
        let ends_above = top.and_then(|state| state.epsilon.1).is_some_and(|to| to <= high);
        let ends_below = bottom.is_some_and(|state| low <= state.epsilon.0);
        met.extend((ends_above || ends_below).then_some(None));
        met
    }

    /// Whether something is predicted at every ε.
    pub fn is_predicted_everywhere(&self) -> bool {
        let [first, last] = [self.cascade.first(), self.cascade.last()];
        first.is_some_and(|state| state.epsilon.1.is_none())
            && last.is_some_and(|state| state.epsilon.0 == 0.0)
    }

    /// ε at which these nodes cease to be in one predicted cluster as ε falls; none if they never are
    /// or never cease to be.
    pub fn predicted_loss(&self, cluster: &[usize]) -> Option<f64> {
        let is_together = |state: &&State| together(state, cluster);
        let lost = self
            .cascade
            .iter()
            .skip_while(|state| !is_together(state))
            .find(|s| !is_together(s))?;
        lost.epsilon.1
    }

    /// Where these clusters were seen in the sweep: looked for at the strongest couplings at which
    /// they are predicted and of which the sweep has a point, or anywhere if there are none. None
    /// without a sweep.
    pub fn seen(&self, clusters: &[Vec<usize>]) -> Option<Seen> {
        let simulated = self.simulated.as_ref()?;
        let holds = |state: &State| clusters.iter().all(|cluster| together(state, cluster));
        let runs = self.cascade.chunk_by(|a, b| holds(a) == holds(b));
        let ranges = runs.filter(|run| holds(&run[0])).map(range_of);
        let has_point = |range: &(f64, Option<f64>)| {
            simulated
                .epsilon
                .iter()
                .any(|&epsilon| epsilon > range.0 && range.1.is_none_or(|to| epsilon <= to))
        };
        Some(simulated.seen(clusters, ranges.into_iter().find(has_point)))
    }

    /// How many runs of the sweep lie in the range of a state, and how many of these escaped; none
    /// without a sweep.
    pub fn runs_in(&self, state: &State) -> Option<[usize; 2]> {
        let simulated = self.simulated.as_ref()?;
        let inside = |at: &usize| state.holds_at(simulated.epsilon[*at]);
        let positions: Vec<usize> = (0..simulated.epsilon.len()).filter(inside).collect();
        let escaped = positions.iter().map(|&at| simulated.escaped(at)).sum();
        Some([positions.len() * simulated.seeds.len(), escaped])
    }

    /// Where the clusters of one predicted state were seen in the sweep: looked for in its range and
    /// above, as far as the states there hold them too.
    pub fn state_seen(&self, state: usize, clusters: &[Vec<usize>]) -> Option<Seen> {
        let holds = |state: &&State| clusters.iter().all(|cluster| together(state, cluster));
        let above = self.cascade[..state].iter().rev().take_while(holds).count();
        let range = range_of(&self.cascade[state - above..=state]);
        Some(self.simulated.as_ref()?.seen(clusters, Some(range)))
    }
}

/// Whether a state has these nodes in one cluster.
fn together(state: &State, cluster: &[usize]) -> bool {
    let of = state.clusters.cluster_of();
    cluster.iter().all(|&node| of[node] == of[cluster[0]])
}

/// The range of ε of neighbouring states, from strong coupling down.
fn range_of(states: &[State]) -> (f64, Option<f64>) {
    (states[states.len() - 1].epsilon.0, states[0].epsilon.1)
}
