//! Where a result comes from: version, commit, seed, plan, processor, time taken.

use std::time::Duration;

use indexmap::IndexMap;
use serde::Serialize;
use sha2::{Digest, Sha256};

use graph::Network;

use crate::plan::Plan;

/// The `provenance` of a summary. The only part of it that may differ between two equal runs.
#[derive(Serialize)]
pub struct Provenance {
    pub version: &'static str,
    /// Commit of eigensync that the program was built from; `+` when files were changed since.
    pub commit: &'static str,
    pub seed: u64,
    /// SHA-256 of the experiment as parsed, its shortening, and the network's links.
    pub plan_hash: String,
    /// Vector instructions the processor has; no result depends on them.
    pub host_features: Vec<&'static str>,
    /// Those that were used.
    pub instruction_set: &'static str,
    pub threads: usize,
    pub wall_time_s: f64,
    /// Of this, what each stage took.
    pub stages_s: IndexMap<String, f64>,
}

impl Provenance {
    /// Of a run that took so long in all and in its stages.
    pub fn new(plan: &Plan, (took, stages): (Duration, &[(String, Duration)])) -> Self {
        let seconds = |time: Duration| (time.as_secs_f64() * 1e3).round() / 1e3;
        Self {
            version: env!("CARGO_PKG_VERSION"),
            commit: env!("EIGENSYNC_COMMIT"),
            seed: plan.experiment.seed,
            plan_hash: plan_hash(plan),
            host_features: host_features(),
            instruction_set: plan.msf.instruction_set.name(),
            threads: rayon::current_num_threads(),
            wall_time_s: seconds(took),
            stages_s: stages.iter().map(|(name, time)| (name.clone(), seconds(*time))).collect(),
        }
    }
}

/// SHA-256 of the links and weights of a network, in node order.
pub fn links_hash(network: &Network) -> String {
    let mut hash = Sha256::new();
    add_links(&mut hash, network);
    text(hash)
}

fn plan_hash(plan: &Plan) -> String {
    let mut hash = Sha256::new();
    hash.update(plan.written.to_string());
    hash.update(plan.shortened.to_le_bytes());
    add_links(&mut hash, &plan.network);
    text(hash)
}

fn add_links(hash: &mut Sha256, network: &Network) {
    for (row, links) in network.adjacency().outer_iterator().enumerate() {
        for (col, weight) in links.iter() {
            hash.update((row as u64).to_le_bytes());
            hash.update((col as u64).to_le_bytes());
            hash.update(weight.to_le_bytes());
        }
    }
}

fn text(hash: Sha256) -> String {
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
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
