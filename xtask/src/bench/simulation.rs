//! `simulation.csv`: node-steps a second of every implementation, and their share of the peak.
//!
//! The share counts, for everyone alike, the additions and multiplications in the equations as they
//! are printed, fused or not and whatever an implementation saves of them. For a node and a step of
//! RK4, with c = nnz(W) / N entries of W in a row:
//!
//! ```text
//! 4 (2 c + 13 + 2) + 3 · 14
//! ```
//!
//! Methods that choose their own step do other operations; they have no share.
//!
//! Each of four stages has a product and a sum for each entry of the row, 13 operations in the flow of
//! Hindmarsh and Rose, and 2 for ε · input and its sum. Each of three components is advanced by a
//! product and a sum for x(t + h) in four stages, and for the x of the next stage in three.

use std::collections::HashMap;
use std::fmt::Write;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::criterion::Benchmark;
use super::read;

/// Benchmarks of the peak: elements are floating-point operations.
pub const PEAK: &str = "peak/";

/// Benchmarks of simulations.
pub const SIMULATE: &str = "simulate/";
/// Those of them by DOP853.
const OF_DOP853: &str = "simulate/dop853/";

/// The step of RK4, in which model time is counted.
const STEP: f64 = 0.01;
/// Steps of DOP853 in the benchmarks of each fixture, and in what words they stand in the table.
const DOP853: [(&str, f64); 2] = [("communities90", 0.125), ("cortex989", 0.1)];
const IN_STEPS: &str = " in steps of ";

/// A line of `simulation.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    pub fixture: String,
    pub implementation: String,
    /// Replicas advanced together.
    pub lanes: u32,
    pub node_steps_per_s: f64,
    /// Between 0 and 1, unless an implementation does fewer operations; empty where no peak is known.
    pub share_of_peak: Option<f64>,
}

impl Row {
    /// Whether the steps counted, of 0.01, are not those that the method took.
    pub fn is_adaptive(&self) -> bool {
        self.implementation.contains(" at tolerance ") || self.implementation.contains(IN_STEPS)
    }

    /// Of a row of eigensync, its method.
    pub fn method(&self) -> &str {
        self.implementation.rsplit_once(" of ").map_or("rk4", |(_, method)| method)
    }

    /// Of a row of eigensync, its step.
    pub fn step(&self) -> f64 {
        let named = self.implementation.split_once(IN_STEPS);
        let step = named.and_then(|(_, rest)| rest.split(' ').next()?.parse().ok());
        step.unwrap_or(STEP)
    }
}

/// A line of `peers.csv`, of which we need these columns.
#[derive(Deserialize)]
struct Peer {
    fixture: String,
    implementation: String,
    lanes: u32,
    node_steps_per_s: f64,
}

/// The rows of eigensync, from its benchmarks `simulate/FIXTURE/LANES`, and of the peers.
pub fn rows(
    measured: &[Benchmark],
    ours: &str,
    peers: Option<&str>,
    fixtures: &Path,
) -> Result<Vec<Row>, String> {
    let peaks = measured.iter().filter(|benchmark| benchmark.id.starts_with(PEAK));
    let peak = peaks
        .map(Benchmark::best_rate)
        .try_fold(0.0, |best, rate| Ok::<_, String>(f64::max(best, rate?)))?;
    let mut rows = Vec::new();
    for benchmark in measured {
        let by_dop853 = benchmark.id.strip_prefix(OF_DOP853);
        let id = by_dop853.or_else(|| benchmark.id.strip_prefix(SIMULATE));
        let Some((fixture, lanes)) = id.and_then(fixture_and_lanes) else { continue };
        let (mut implementation, mut rate) = (ours.to_owned(), benchmark.best_rate()?);
        if by_dop853.is_some() {
            let Some((_, step)) = DOP853.iter().find(|(name, _)| *name == fixture) else {
                continue;
            };
            write!(implementation, "{IN_STEPS}{step} of dop853").expect("a string can always grow");
            rate *= step / STEP;
        }
        let (fixture, node_steps_per_s) = (fixture.to_owned(), rate.round());
        rows.push(Row { fixture, implementation, lanes, node_steps_per_s, share_of_peak: None });
    }
    for peer in csv::Reader::from_reader(peers.unwrap_or_default().as_bytes()).into_deserialize() {
        let Peer { fixture, implementation, lanes, node_steps_per_s } =
            peer.map_err(|error| format!("peers.csv is not understood: {error}"))?;
        rows.push(Row { fixture, implementation, lanes, node_steps_per_s, share_of_peak: None });
    }
    if peak > 0.0 {
        let mut operations = HashMap::new();
        for row in rows.iter_mut().filter(|row| !row.is_adaptive()) {
            if !operations.contains_key(&row.fixture) {
                let file = fixtures.join(&row.fixture).with_extension("txt");
                operations.insert(row.fixture.clone(), operations_per_node_step(&read(&file)?)?);
            }
            row.share_of_peak = Some(row.node_steps_per_s * operations[&row.fixture] / peak);
        }
    }
    Ok(rows)
}

/// `FIXTURE/LANES` taken apart; nothing else is a simulation.
fn fixture_and_lanes(id: &str) -> Option<(&str, u32)> {
    let (fixture, lanes) = id.split_once('/')?;
    Some((fixture, lanes.parse().ok()?))
}

/// Floating-point operations of a node and a step, from the first line of a fixture: N, nnz(W), ….
fn operations_per_node_step(fixture: &str) -> Result<f64, String> {
    let mut numbers = fixture.split_ascii_whitespace().map(str::parse::<u32>);
    let (Some(Ok(n_nodes)), Some(Ok(n_entries))) = (numbers.next(), numbers.next()) else {
        return Err("a fixture does not begin with its nodes and entries".into());
    };
    let row_length = f64::from(n_entries) / f64::from(n_nodes);
    Ok(4.0 * (2.0 * row_length + 13.0 + 2.0) + 3.0 * 14.0)
}

/// The text of `simulation.csv`.
pub fn to_csv(rows: &[Row]) -> String {
    let mut csv = String::from("fixture,implementation,lanes,node_steps_per_s,share_of_peak\n");
    for row in rows {
        let share = row.share_of_peak.map_or_else(String::new, |share| format!("{share:.4}"));
        let Row { fixture, implementation, lanes, node_steps_per_s, .. } = row;
        writeln!(csv, "{fixture},{implementation},{lanes},{node_steps_per_s},{share}")
            .expect("a string can always grow");
    }
    csv
}

/// The rows of a `simulation.csv`.
pub fn from_csv(text: &str) -> Result<Vec<Row>, String> {
    csv::Reader::from_reader(text.as_bytes())
        .into_deserialize()
        .collect::<Result<_, _>>()
        .map_err(|error| format!("simulation.csv is not understood: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn benchmark(id: &str, elements: f64, best: f64) -> Benchmark {
        let throughput = Some((elements, "Elements".to_owned()));
        Benchmark { id: id.to_owned(), mean: 2.0 * best, standard_error: 0.0, best, throughput }
    }

    #[test]
    fn a_row_of_thirty_entries_costs_342_operations() {
        assert_eq!(operations_per_node_step("90 2700 16\n0 30").unwrap(), 342.0);
        assert!(operations_per_node_step("90").is_err());
    }

    #[test]
    fn eigensync_and_peers_share_one_peak_and_one_count() {
        let fixtures = std::env::temp_dir().join(format!("xtask-bench-{}", std::process::id()));
        std::fs::create_dir_all(&fixtures).unwrap();
        std::fs::write(fixtures.join("ring10.txt"), "10 300 16\n").unwrap();
        let measured = [
            benchmark("observe/ring10/16", 1.0, 1.0),
            benchmark("peak/avx2", 342e3, 1.0),
            benchmark("simulate/ring10/16", 1000.0, 2.0),
        ];
        let peers = "fixture,implementation,lanes,node_steps_per_s,largest_error_at_1,seconds_to_start\n\
                     ring10,Tool 1.0,1,100,1e-9,0.1\n\
                     ring10,Tool 1.0 at tolerance 1e-6,1,900,1e-9,0.1\n";
        let rows = rows(&measured, "eigensync", Some(peers), &fixtures);
        std::fs::remove_dir_all(&fixtures).unwrap();
        let rows = rows.unwrap();
        let shares: Vec<_> = rows.iter().map(|row| row.share_of_peak).collect();
        assert_eq!(rows.iter().map(|row| row.lanes).collect::<Vec<_>>(), [16, 1, 1]);
        assert_eq!(shares, [Some(0.5), Some(0.1), None], "an adaptive method has no share");
        assert_eq!(from_csv(&to_csv(&rows)).unwrap(), rows);
    }

    #[test]
    fn without_a_peak_the_share_is_empty() {
        let measured = [benchmark("simulate/ring10/1", 1000.0, 2.0)];
        let rows = rows(&measured, "eigensync", None, Path::new("nowhere")).unwrap();
        assert_eq!(to_csv(&rows).lines().nth(1), Some("ring10,eigensync,1,500,"));
    }
}
