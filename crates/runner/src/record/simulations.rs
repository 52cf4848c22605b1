//! The sweep in a summary: errors, clusters, and agreement with the prediction at each ε.

use dynamics::{Outcome, Run, StepChoice};
use eigensync::{Agreement, Findings, OverSeeds, Predicted};
use experiment::Plan;
use experiment::spec::MethodKind;
use serde::Serialize;

use super::names::named;

/// The runs at one ε.
#[derive(Serialize)]
pub struct SimulationRecord {
    /// Coupling strength.
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
    /// The same for Spearman's correlation.
    pub spearman_standard_error: Option<f64>,
    /// The same for the Rand index.
    pub adjusted_rand_index_standard_error: Option<f64>,
    /// Regions, where the experiment asks for them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub regions: Option<RegionRecord>,
}

/// Regions of prediction and simulation.
#[derive(Serialize)]
pub struct RegionRecord {
    /// Clusters of regions by name; regions in none are not synchronisable.
    pub predicted: Vec<Vec<String>>,
    /// The same in simulation.
    pub simulated: Vec<Vec<String>>,
    /// Fraction of regions of the same verdict.
    pub same_verdict: f64,
    /// Of the clusters of the regions that are synchronisable in both.
    pub adjusted_rand_index: Option<f64>,
}

/// The simulations, one ε after another.
pub fn records(plan: &Plan, findings: &Findings) -> Vec<SimulationRecord> {
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

/// What `method = "auto"` has chosen, and how well that does.
#[derive(Serialize)]
pub struct StepChoiceRecord {
    /// The integrator, by the name that experiment files call it.
    pub method: MethodKind,
    /// Its step.
    pub step: f64,
    /// What a step errs by per unit of time, relative to the size of the attractor, as it was measured.
    pub error: f64,
}

pub(super) fn step_choice(plan: &Plan) -> Option<StepChoiceRecord> {
    let StepChoice { method, step, error, .. } = plan.chosen?;
    Some(StepChoiceRecord { method: experiment::method(method), step, error })
}
