//! `summary.json`: a run in numbers. `record/states` has the predicted states.

pub mod parameters;
mod states;

use eigensync::{Agreement, Findings, OverSeeds, Predicted, StepEffect, Synchrony, Warning, word};
use std::time::Duration;

use dynamics::{Estimate, Outcome, Run};
use msf::{Attractor, End, MasterStability, StableRegion, Zero};
use serde::Serialize;
use serde_json::Value;

use crate::claims::{Claim, labelled};
use crate::journal::Held;
use crate::place::Origin;
use crate::plan::Plan;
use crate::provenance::Provenance;
use crate::spec::StepSpec;

pub use states::StateRecord;

/// Version of the layout of `summary.json`: it grows when a key goes or changes its meaning, not when
/// one is added. Files without it are of version 0.1.0 of the program.
pub const LAYOUT: u32 = 1;

/// `summary.json`: the run in numbers. Modes count from 1, nodes go by their labels.
#[derive(Serialize)]
pub struct Summary {
    /// Version of the layout of this file.
    pub layout: u32,
    pub id: String,
    pub title: String,
    pub source: String,
    /// The experiment file as parsed, defaults left out.
    pub experiment: Value,
    /// Every parameter used, in the words of experiment files, defaults among them.
    pub parameters: Value,
    /// 1 for a full run; by how much `--quick` shortened all times.
    pub shortened: f64,
    pub network: NetworkRecord,
    pub eigenvalues: Vec<f64>,
    pub spectrum: SpectrumRecord,
    pub msf: MsfRecord,
    pub critical_couplings: Vec<CriticalRecord>,
    /// Whether, and where, all nodes synchronise.
    pub global_synchrony: Synchrony,
    pub cascade: Vec<StateRecord>,
    pub simulations: Vec<SimulationRecord>,
    /// What the step of the integrator does to their errors.
    pub simulations_step_effect: Vec<StepEffect>,
    pub claims: Vec<Claim>,
    /// What must be known beside these numbers.
    pub warnings: Vec<Warning>,
    pub provenance: Provenance,
}

#[derive(Serialize)]
pub struct NetworkRecord {
    /// SHA-256 of links and weights, so that a changed digit is seen as such.
    pub links_hash: String,
    /// What each step of preparation removed and left.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub preparation: Vec<StepRecord>,
    pub groups: usize,
    pub nodes: usize,
    pub links: usize,
    pub components: usize,
    pub isolated_nodes: usize,
}

#[derive(Serialize)]
pub struct StepRecord {
    /// As experiment files say it.
    pub step: Value,
    pub removed_nodes: usize,
    pub removed_groups: Vec<String>,
    pub removed_links: usize,
    pub removed_self_loops: usize,
    pub changed_links: usize,
    pub nodes: usize,
    pub links: usize,
    pub directed: bool,
}

#[derive(Serialize)]
pub struct SpectrumRecord {
    pub solver: &'static str,
    /// First and last mode of each run of equal eigenvalues of two modes or more.
    pub multiple: Vec<[usize; 2]>,
    /// Eigenvalues closer than this are one eigenspace.
    pub tolerance: f64,
    /// Largest ‖W v − λ v‖.
    pub largest_residual: f64,
    /// Where all modes with larger eigenvalues were asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cutoff: Option<f64>,
    pub verified: VerifiedRecord,
}

/// How it is known that no mode is missing above the last one, or above the cutoff.
#[derive(Serialize)]
pub struct VerifiedRecord {
    /// `dense`: all were computed; `inertia`: counted by a factorisation; `probed`: random vectors
    /// showed no further one.
    pub by: &'static str,
    /// 1 less the largest probability that one is missing nevertheless.
    pub confidence: f64,
}

#[derive(Serialize)]
pub struct MsfRecord {
    pub lyapunov_isolated: f64,
    pub lyapunov_isolated_standard_error: f64,
    pub lyapunov_isolated_step_shift: ShiftRecord,
    /// What that says: `chaotic`, `periodic` or `at rest`.
    pub isolated_state: &'static str,
    /// How many isolated oscillators ended in each of the states in which they come to rest; only
    /// where they do.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub rests: Vec<usize>,
    /// The σ between which was looked; Λ(0) is known besides.
    pub looked: [f64; 2],
    /// Stable intervals of σ, [from, to]; no upper end where the look ends stable.
    pub stable: Vec<(f64, Option<f64>)>,
    /// What the ends of these intervals are.
    pub stable_ends: Vec<[EndRecord; 2]>,
    pub sigma_c: Option<f64>,
    pub standard_error: Option<f64>,
    pub confidence_interval: Option<[f64; 2]>,
    /// Every zero of Λ, with its standard error.
    pub zeros: Vec<ZeroRecord>,
    /// Each attractor, where orbits settle on several.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub attractors: Vec<AttractorRecord>,
}

/// By how much half of `msf.step` changes a number.
#[derive(Serialize)]
pub struct ShiftRecord {
    pub mean: f64,
    pub standard_error: f64,
}

impl From<Estimate> for ShiftRecord {
    fn from(Estimate { mean, standard_error }: Estimate) -> Self {
        Self { mean, standard_error }
    }
}

/// An attractor of several.
#[derive(Serialize)]
pub struct AttractorRecord {
    /// Orbits that settled on it, of how many.
    pub orbits: [usize; 2],
    /// σ at which it was told from the others, and Λ there.
    pub told_at: f64,
    pub lambda: f64,
    pub lambda_standard_error: f64,
    pub isolated_state: &'static str,
    pub stable_ends: Vec<[EndRecord; 2]>,
}

/// An end of a stable interval.
#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum EndRecord {
    Zero {
        sigma: f64,
        standard_error: f64,
        refined: bool,
    },
    /// σ = 0, where nodes become equal themselves, or only the limit.
    Origin {
        included: bool,
    },
    /// No end is known: the last σ that was looked at.
    Looked {
        sigma: f64,
    },
}

impl From<End> for EndRecord {
    fn from(end: End) -> Self {
        match end {
            End::Zero(Zero { sigma, standard_error, refined, .. }) => {
                Self::Zero { sigma, standard_error, refined }
            }
            End::Origin { included } => Self::Origin { included },
            End::Looked { sigma } => Self::Looked { sigma },
        }
    }
}

#[derive(Serialize)]
pub struct ZeroRecord {
    pub sigma: f64,
    pub standard_error: f64,
    pub falling: bool,
    /// Whether it is known as well as was asked for.
    pub refined: bool,
    /// None where no line could be drawn through exponents near it.
    pub step_shift: Option<ShiftRecord>,
}

#[derive(Serialize)]
pub struct CriticalRecord {
    pub mode: usize,
    pub lambda: f64,
    /// None where no coupling stabilises the mode.
    pub epsilon: Option<f64>,
    pub standard_error: Option<f64>,
    pub stable_above: bool,
    /// Whether the zero of Λ behind it is known as well as was asked for.
    pub refined: bool,
}

#[derive(Serialize)]
pub struct SimulationRecord {
    pub epsilon: f64,
    /// `completed`, `escaped`, `failed` (the adaptive integrator gave up), or how many did.
    pub outcome: String,
    /// Runs that stayed bounded: clusters and agreement are of means over these.
    pub n_seeds: usize,
    /// Simulated clusters of two nodes or more.
    pub clusters: Option<Vec<Vec<String>>>,
    /// Prediction against simulation, where all pairs were observed and a mode is unstable.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub agreement: Option<AgreementRecord>,
    /// δx_i of every node to the reference node.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub error_to_reference: Vec<Option<OverSeeds>>,
    /// δx^c_m of every cluster of the experiment.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub error_within_clusters: Vec<Option<OverSeeds>>,
}

/// Prediction against simulation at one ε.
#[derive(Serialize)]
pub struct AgreementRecord {
    /// Pearson's correlation of δx_ij with δe_ij over all pairs.
    pub pearson: Option<f64>,
    /// Spearman's.
    pub spearman: Option<f64>,
    /// Adjusted Rand index of predicted and simulated clusters.
    pub adjusted_rand_index: Option<f64>,
    /// How far these depend on the seeds, by the jackknife; none with fewer than two.
    pub pearson_standard_error: Option<f64>,
    pub spearman_standard_error: Option<f64>,
    pub adjusted_rand_index_standard_error: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub regions: Option<RegionRecord>,
}

/// Regions of prediction and simulation.
#[derive(Serialize)]
pub struct RegionRecord {
    /// Clusters of regions by name; regions in none are not synchronisable.
    pub predicted: Vec<Vec<String>>,
    pub simulated: Vec<Vec<String>>,
    /// Fraction of regions of the same verdict.
    pub same_verdict: f64,
    /// Of the clusters of the regions that are synchronisable in both.
    pub adjusted_rand_index: Option<f64>,
}

/// Collects a summary.
pub fn summarise(
    plan: &Plan,
    findings: &Findings,
    claims: Vec<Claim>,
    took: (Duration, &[(String, Duration)]),
    (taken, origin): (Held, &Origin),
) -> Summary {
    let (network, spectrum) = (&plan.study.network, &findings.spectrum);
    Summary {
        layout: LAYOUT,
        parameters: parameters::of(plan),
        id: plan.id.clone(),
        title: plan.experiment.title.clone(),
        source: plan.experiment.source.clone(),
        shortened: plan.shortened,
        network: NetworkRecord {
            preparation: step_records(plan),
            groups: network.groups().len(),
            nodes: network.n_nodes(),
            links: network.n_links(),
            components: plan.study.n_components,
            isolated_nodes: network.isolated_nodes().len(),
            links_hash: plan.links_hash.clone(),
        },
        eigenvalues: spectrum.real_eigenvalues(),
        spectrum: SpectrumRecord {
            solver: match spectrum.solver {
                spectra::Solver::Dense => "dense",
                spectra::Solver::Arpack => "arpack",
                spectra::Solver::Chebyshev => "chebyshev",
                spectra::Solver::ShiftInvert => "shift-invert",
            },
            multiple: spectrum
                .real_modes()
                .eigenspaces
                .iter()
                .filter(|modes| modes.len() > 1)
                .map(|modes| [modes.start + 1, modes.end])
                .collect(),
            tolerance: spectrum.tolerance,
            largest_residual: spectrum.largest_residual(),
            cutoff: spectrum.cutoff,
            verified: verified(spectrum.verification),
        },
        msf: msf_record(&findings.msf),
        critical_couplings: critical_records(findings),
        global_synchrony: findings.synchrony.clone(),
        cascade: states::records(plan, findings),
        simulations: simulation_records(plan, findings),
        simulations_step_effect: findings.step_effects.clone(),
        claims,
        warnings: findings.warnings.clone(),
        provenance: Provenance::new(plan, taken, took, origin),
        experiment: plan.written.clone(),
    }
}

fn verified(verification: spectra::Verification) -> VerifiedRecord {
    match verification {
        spectra::Verification::Dense => VerifiedRecord { by: "dense", confidence: 1.0 },
        spectra::Verification::Inertia { .. } => VerifiedRecord { by: "inertia", confidence: 1.0 },
        spectra::Verification::Probed { confidence, .. } => {
            VerifiedRecord { by: "probed", confidence }
        }
    }
}

fn step_records(plan: &Plan) -> Vec<StepRecord> {
    let record = |(step, report): (&StepSpec, &graph::prepare::Report)| StepRecord {
        step: serde_json::to_value(step).unwrap_or_default(),
        removed_nodes: report.removed_nodes.len(),
        removed_groups: report.removed_groups.clone(),
        removed_links: report.removed_links,
        removed_self_loops: report.removed_self_loops,
        changed_links: report.changed_links,
        nodes: report.n_nodes,
        links: report.n_links,
        directed: report.directed,
    };
    plan.experiment.prepare.iter().zip(&plan.preparation).map(record).collect()
}

/// A curve in numbers.
pub fn msf_record(msf: &MasterStability) -> MsfRecord {
    let sigma_c = msf.stable.sigma_c();
    MsfRecord {
        lyapunov_isolated: msf.isolated.mean,
        lyapunov_isolated_standard_error: msf.isolated.standard_error,
        lyapunov_isolated_step_shift: msf.isolated_step_shift.into(),
        isolated_state: word(msf.state),
        rests: msf.rests.clone(),
        looked: [msf.sigma[0], msf.sigma[msf.sigma.len() - 1]],
        stable: msf.stable.intervals.iter().map(|i| (i.lower(), i.upper())).collect(),
        stable_ends: ends(&msf.stable),
        attractors: msf.attractors.iter().map(attractor_record).collect(),
        sigma_c: sigma_c.map(|zero| zero.sigma),
        standard_error: sigma_c.map(|zero| zero.standard_error),
        confidence_interval: sigma_c.map(|zero| zero.confidence_interval()),
        zeros: msf.stable.zeros().map(zero_record).collect(),
    }
}

fn ends(stable: &StableRegion) -> Vec<[EndRecord; 2]> {
    stable.intervals.iter().map(|i| [i.from, i.to].map(Into::into)).collect()
}

fn attractor_record(attractor: &Attractor) -> AttractorRecord {
    AttractorRecord {
        orbits: [attractor.orbits, attractor.of],
        told_at: attractor.told_at,
        lambda: attractor.lambda.mean,
        lambda_standard_error: attractor.lambda.standard_error,
        isolated_state: word(attractor.state),
        stable_ends: ends(&attractor.stable),
    }
}

fn zero_record(zero: Zero) -> ZeroRecord {
    let Zero { sigma, standard_error, falling, refined, step_shift } = zero;
    ZeroRecord { sigma, standard_error, falling, refined, step_shift: step_shift.map(Into::into) }
}

fn critical_records(findings: &Findings) -> Vec<CriticalRecord> {
    let finite = |value: f64| value.is_finite().then_some(value);
    let record = |(mode, lambda): (usize, f64)| {
        findings.transitions_of(mode).map(move |transition| CriticalRecord {
            mode: mode + 1,
            lambda,
            epsilon: finite(transition.epsilon),
            standard_error: finite(transition.standard_error),
            stable_above: transition.zero.falling,
            refined: transition.zero.refined,
        })
    };
    findings.spectrum.real_eigenvalues().into_iter().enumerate().flat_map(record).collect()
}

fn simulation_records(plan: &Plan, findings: &Findings) -> Vec<SimulationRecord> {
    let (Some(sweep), Some(simulated)) = (&plan.study.sweep, &findings.simulated) else {
        return vec![];
    };
    let reference = sweep.observables.reference.map_or(0, |_| plan.study.network.n_nodes());
    let record = |(position, &epsilon): (usize, &f64)| SimulationRecord {
        epsilon,
        outcome: outcome(simulated.at(position)),
        n_seeds: simulated.bounded(position),
        clusters: simulated.clusters(position).map(|c| named(&c.nontrivial(), plan)),
        agreement: findings
            .agreement
            .get(position)
            .filter(|agreement| matches!(agreement.predicted, Predicted::Unstable(_)))
            .map(|agreement| agreement_record(plan, agreement)),
        error_to_reference: (0..reference)
            .map(|node| simulated.over_seeds(position, |errors| errors.to_reference[node]))
            .collect(),
        error_within_clusters: (0..sweep.observables.clusters.len())
            .map(|m| simulated.over_seeds(position, |errors| errors.within_clusters[m]))
            .collect(),
    };
    simulated.epsilon.iter().enumerate().map(record).collect()
}

/// How the runs at one ε ended.
fn outcome(runs: &[Run]) -> String {
    let count = |ended: fn(&Run) -> bool| runs.iter().filter(|run| ended(run)).count();
    let escaped = count(|run| matches!(run.outcome, Outcome::Escaped { .. }));
    let failed = count(|run| matches!(run.outcome, Outcome::Failed { .. }));
    let all = runs.len();
    match (escaped, failed) {
        (0, 0) => "completed".into(),
        (escaped, 0) if escaped == all => "escaped".into(),
        (0, failed) if failed == all => "failed".into(),
        (escaped, 0) => format!("{escaped} of {all} escaped"),
        (0, failed) => format!("{failed} of {all} failed"),
        (escaped, failed) => format!("{escaped} of {all} escaped, {failed} failed"),
    }
}

fn agreement_record(plan: &Plan, agreement: &Agreement) -> AgreementRecord {
    let groups = plan.study.network.groups();
    let names = |clusters: Vec<Vec<usize>>| {
        let name = |region: &usize| groups[*region].name.clone();
        clusters.iter().map(|regions| regions.iter().map(name).collect()).collect()
    };
    AgreementRecord {
        pearson: agreement.correlation.map(|correlation| correlation.pearson),
        spearman: agreement.correlation.map(|correlation| correlation.spearman),
        adjusted_rand_index: agreement.rand_index,
        pearson_standard_error: agreement.errors.pearson,
        spearman_standard_error: agreement.errors.spearman,
        adjusted_rand_index_standard_error: agreement.errors.rand_index,
        regions: agreement.regions.as_ref().map(|regions| RegionRecord {
            predicted: names(regions.predicted.clusters()),
            simulated: names(regions.simulated.clusters()),
            same_verdict: regions.agreement.verdict_fraction(),
            adjusted_rand_index: regions.agreement.adjusted_rand_index,
        }),
    }
}

fn named(clusters: &[Vec<usize>], plan: &Plan) -> Vec<Vec<String>> {
    let labels = labelled(clusters, &plan.study.network).into_iter();
    labels.map(|cluster| cluster.into_iter().map(str::to_owned).collect()).collect()
}
