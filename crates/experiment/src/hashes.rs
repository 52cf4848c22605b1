//! By which hashes networks and plans are known.

use graph::Network;
use serde_json::Value;
use sha2::{Digest, Sha256};

/// Bytes that are hashed at a time: many links at once take a tenth of the time.
const HASHED_BYTES: usize = 1 << 16;

/// SHA-256 of the links and weights of a network, in node order.
pub fn links_hash(network: &Network) -> String {
    let mut hash = Sha256::new();
    let mut bytes = Vec::new();
    for (row, links) in network.adjacency().outer_iterator().enumerate() {
        for (col, weight) in links.iter() {
            bytes.extend((row as u64).to_le_bytes());
            bytes.extend((col as u64).to_le_bytes());
            bytes.extend(weight.to_le_bytes());
        }
        if bytes.len() >= HASHED_BYTES {
            hash.update(&bytes);
            bytes.clear();
        }
    }
    hash.update(&bytes);
    text(hash)
}

/// SHA-256 of an experiment as parsed, its shortening, and the hash of its network's links.
pub fn plan_hash(written: &Value, shortened: f64, links_hash: &str) -> String {
    let mut hash = Sha256::new();
    hash.update(written.to_string());
    hash.update(shortened.to_le_bytes());
    hash.update(links_hash);
    text(hash)
}

fn text(hash: Sha256) -> String {
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}
