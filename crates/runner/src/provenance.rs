//! Where a result comes from: version, commit, seed, plan, processor, time taken.

use std::time::Duration;

use indexmap::IndexMap;
use serde::Serialize;

use dynamics::InstructionSet;
use experiment::Plan;
use experiment::plan_hash;
use journal::Held;

use crate::program;
use results_folder::Origin;

/// The `provenance` of a summary. The only part of it that may differ between two equal runs.
#[derive(Serialize)]
pub struct Provenance {
    /// Version of eigensync.
    pub version: &'static str,
    /// Commit of eigensync that the program was built from; `+` when files were changed since.
    pub commit: &'static str,
    /// Command and file that the results were made from.
    pub origin: Origin,
    /// Seed of the experiment.
    pub seed: u64,
    /// SHA-256 of the experiment as parsed, its shortening, and the hash of the network's links.
    pub plan_hash: String,
    /// Vector instructions the processor has; no result depends on them.
    pub host_features: Vec<&'static str>,
    /// Those that were used.
    pub instruction_set: &'static str,
    /// How many there were.
    pub threads: usize,
    /// What an earlier run had computed, which ended before its results were written.
    pub taken_over: Held,
    /// Seconds from beginning to end.
    pub wall_time_s: f64,
    /// Of this, what each stage took.
    pub stages_s: IndexMap<String, f64>,
    /// Most memory that the process has held so far, which may have run other experiments before;
    /// none where the system does not say.
    pub peak_memory_bytes: Option<u64>,
}

impl Provenance {
    /// Of a run of a plan with a seed, a hash and instructions, that took so long in all and in its stages,
    /// and had so much computed by an earlier one.
    pub fn new(
        (seed, plan_hash, instructions): (u64, String, InstructionSet),
        taken_over: Held,
        (took, stages): (Duration, &[(String, Duration)]),
        origin: &Origin,
    ) -> Self {
        let seconds = |time: Duration| (time.as_secs_f64() * 1e3).round() / 1e3;
        Self {
            version: program::VERSION,
            commit: program::COMMIT,
            origin: origin.clone(),
            seed,
            plan_hash,
            host_features: host_features(),
            instruction_set: instructions.name(),
            threads: rayon::current_num_threads(),
            taken_over,
            wall_time_s: seconds(took),
            stages_s: stages.iter().map(|(name, time)| (name.clone(), seconds(*time))).collect(),
            peak_memory_bytes: peak_memory(),
        }
    }
}

/// What an experiment is known by: seed, hash, instructions.
pub fn known_by(plan: &Plan) -> (u64, String, InstructionSet) {
    let hash = plan_hash(&plan.written, plan.shortened, &plan.links_hash);
    (plan.study.seed, hash, plan.study.msf.instruction_set)
}

/// Most memory that this process has held, as Linux counts it; none elsewhere.
pub fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(1024 * line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?)
}

fn host_features() -> Vec<&'static str> {
    let mut features = Vec::new();
    #[cfg(target_arch = "x86_64")]
    {
        let known = [
            ("avx2", std::is_x86_feature_detected!("avx2")),
            ("fma", std::is_x86_feature_detected!("fma")),
            ("avx512f", std::is_x86_feature_detected!("avx512f")),
        ];
        features.extend(known.into_iter().filter(|(_, has)| *has).map(|(name, _)| name));
    }
    features
}
