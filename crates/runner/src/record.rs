//! `summary.json`: a run in numbers, part by part. Modes count from 1, nodes go by their labels.

mod msf;
mod names;
mod network;
mod simulations;
mod spectrum;
mod states;

use std::time::Duration;

use eigensync::{Findings, StepEffect, Synchrony, Warning};
use experiment::Plan;
use journal::Held;
use results_folder::Origin;
use serde::Serialize;
use serde_json::Value;

use crate::provenance::{Provenance, known_by};
use claims::Judged;

pub use msf::{
    AttractorRecord, CriticalRecord, EndRecord, MsfRecord, ShiftRecord, ZeroRecord, msf_record,
};
pub use network::{NetworkRecord, StepRecord};
pub use simulations::{AgreementRecord, RegionRecord, SimulationRecord, StepChoiceRecord};
pub use spectrum::{SpectrumRecord, VerifiedRecord};
pub use states::{CoincidenceRecord, LabelRecord, RunsRecord, StateRecord};

/// Version of the layout of `summary.json`: it grows when a key goes or changes its meaning, not when
/// one is added. Files without it are of version 0.1.0 of the program.
pub const LAYOUT: u32 = 1;

/// `summary.json`: the run in numbers. Modes count from 1, nodes go by their labels.
#[derive(Serialize)]
pub struct Summary {
    /// Version of the layout of this file.
    pub layout: u32,
    /// Name of the experiment.
    pub id: String,
    /// Its title.
    pub title: String,
    /// Where its settings and expected values come from.
    pub source: String,
    /// The experiment file as parsed, defaults left out.
    pub experiment: Value,
    /// Every parameter used, in the words of experiment files, defaults among them.
    pub parameters: Value,
    /// 1 for a full run; by how much `--quick` shortened all times.
    pub shortened: f64,
    /// The network that was used.
    pub network: NetworkRecord,
    /// λ_k, descending.
    pub eigenvalues: Vec<f64>,
    /// How they are known.
    pub spectrum: SpectrumRecord,
    /// The master stability function.
    pub msf: MsfRecord,
    /// Where modes change stability.
    pub critical_couplings: Vec<CriticalRecord>,
    /// Whether, and where, all nodes synchronise.
    pub global_synchrony: Synchrony,
    /// Predicted states, from strong coupling down.
    pub cascade: Vec<StateRecord>,
    /// The sweep, one ε after another.
    pub simulations: Vec<SimulationRecord>,
    /// Which step they have, where that was chosen.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub simulations_step: Option<StepChoiceRecord>,
    /// What the step of the integrator does to their errors.
    pub simulations_step_effect: Vec<StepEffect>,
    /// Claims of the file, judged.
    pub claims: Vec<Judged>,
    /// What must be known beside these numbers.
    pub warnings: Vec<Warning>,
    /// Where the results come from.
    pub provenance: Provenance,
}

/// Collects a summary.
pub fn summarise(
    plan: &Plan,
    findings: &Findings,
    claims: Vec<Judged>,
    took: (Duration, &[(String, Duration)]),
    (taken, origin): (Held, &Origin),
) -> Summary {
    Summary {
        layout: LAYOUT,
        parameters: plan.parameters.clone(),
        id: plan.id.clone(),
        title: plan.title.clone(),
        source: plan.source.clone(),
        shortened: plan.shortened,
        network: network::record(plan),
        eigenvalues: findings.spectrum.real_eigenvalues(),
        spectrum: spectrum::record(&findings.spectrum),
        msf: msf_record(&findings.msf),
        critical_couplings: msf::critical_records(findings),
        global_synchrony: findings.synchrony.clone(),
        cascade: states::records(plan, findings),
        simulations: simulations::records(plan, findings),
        simulations_step: simulations::step_choice(plan),
        simulations_step_effect: findings.step_effects.clone(),
        claims,
        warnings: findings.warnings.clone(),
        provenance: Provenance::new(known_by(plan), taken, took, origin),
        experiment: plan.written.clone(),
    }
}
