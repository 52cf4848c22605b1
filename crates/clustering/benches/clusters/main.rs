//! What clusters cost from 10³ to 10⁶ nodes: `clusters/<fixture>_<rule>/<n>`, all modes unstable. Beside
//! them `clusters/sorted_rows/<n>`: eight components a node, sorted by the first, which is what N log N
//! comes to where the rows of many nodes no longer fit the cache.
//!
//! `cargo bench -p clustering`; a name or a part of one after `--` picks some. With a folder in
//! `EIGENSYNC_FIXTURES` the rows of eigenvectors are written there instead, with the clusters found,
//! for `benches/peers/clusters.py`; no larger ones than `EIGENSYNC_LARGEST` nodes, if that is set.
//! With a folder in `EIGENSYNC_FOUND`, `clusters.csv` there gets the number of clusters of each.

mod fixtures;

use std::path::Path;
use std::{env, fs, io, io::Write};

use clustering::{EigenvectorDistance, Partition};
use criterion::{BatchSize, BenchmarkId, Criterion};
use fixtures::Fixture;

const SIZES: [usize; 4] = [1_000, 10_000, 100_000, 1_000_000];

fn main() -> io::Result<()> {
    if let Some(folder) = env::var_os("EIGENSYNC_FIXTURES") {
        let largest = env::var("EIGENSYNC_LARGEST").ok().and_then(|n| n.parse().ok());
        return write_all(Path::new(&folder), largest.unwrap_or(usize::MAX));
    }
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("clusters");
    group.sample_size(10);
    for n_nodes in SIZES {
        let rows = rows(&fixtures::scale_free(n_nodes));
        group.bench_function(BenchmarkId::new("sorted_rows", n_nodes), |b| {
            let by_first = |mut rows: Vec<[f64; 8]>| {
                rows.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
                rows
            };
            b.iter_batched(|| rows.clone(), by_first, BatchSize::LargeInput);
        });
        for fixture in fixtures::all(n_nodes) {
            let (distance, exact, threshold) = clusters(&fixture);
            assert!(exact.is_refinement_of(&threshold));
            for (rule, clusters) in [("exact", &exact), ("threshold", &threshold)] {
                let id = format!("clusters/{}_{rule}/{n_nodes}", fixture.name);
                note_found(&format!("{id},{}", clusters.n_clusters()))?;
            }
            let id = |rule: &str| BenchmarkId::new(format!("{}_{rule}", fixture.name), n_nodes);
            group.bench_function(id("exact"), |b| b.iter(|| distance.exact_clusters().unwrap()));
            group.bench_function(id("threshold"), |b| {
                b.iter(|| distance.clusters_within(fixture.threshold).unwrap());
            });
        }
    }
    group.finish();
    criterion.final_summary();
    Ok(())
}

/// The first eight components after the constant one, node by node.
fn rows(fixture: &Fixture) -> Vec<[f64; 8]> {
    let modes = &fixture.spectrum.real_modes().eigenvectors[1..9];
    (0..modes[0].len()).map(|i| std::array::from_fn(|k| modes[k][i])).collect()
}

/// The distance with all modes unstable, its exact clusters and those at the threshold.
fn clusters(fixture: &Fixture) -> (EigenvectorDistance, Partition, Partition) {
    let modes: Vec<usize> = (1..fixture.spectrum.n_modes()).collect();
    let distance = EigenvectorDistance::new(&fixture.spectrum, &modes).unwrap();
    let exact = distance.exact_clusters().unwrap();
    let threshold = distance.clusters_within(fixture.threshold).unwrap();
    (distance, exact, threshold)
}

/// Adds a line to what was found, where that is asked for.
fn note_found(line: &str) -> io::Result<()> {
    let Some(folder) = env::var_os("EIGENSYNC_FOUND") else { return Ok(()) };
    let path = Path::new(&folder).join("clusters.csv");
    writeln!(fs::OpenOptions::new().create(true).append(true).open(path)?, "{line}")
}

/// Writes `FOLDER/<fixture>_<n>.rows`: N, the number m of modes and of eigenspaces as 64-bit integers;
/// the threshold and the tolerance of exact clusters; the components, a node a row; the exact cluster
/// of every node, then the one at the threshold, as 32-bit integers; all little-endian.
fn write_all(folder: &Path, largest: usize) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    for n_nodes in SIZES.into_iter().filter(|&n_nodes| n_nodes <= largest) {
        for fixture in fixtures::all(n_nodes) {
            let (distance, exact, threshold) = clusters(&fixture);
            let modes = &fixture.spectrum.real_modes().eigenvectors[1..];
            let file = fs::File::create(folder.join(format!("{}_{n_nodes}.rows", fixture.name)))?;
            let mut file = io::BufWriter::new(file);
            let n_spaces = fixture.spectrum.eigenspaces.len() - 1;
            for count in [distance.n_nodes(), modes.len(), n_spaces] {
                file.write_all(&(count as u64).to_le_bytes())?;
            }
            let components = (0..distance.n_nodes()).flat_map(|i| modes.iter().map(move |v| v[i]));
            let numbers = [fixture.threshold, distance.exact_tolerance()];
            for number in numbers.into_iter().chain(components) {
                file.write_all(&number.to_le_bytes())?;
            }
            for &cluster in exact.cluster_of().iter().chain(threshold.cluster_of()) {
                file.write_all(&(cluster as u32).to_le_bytes())?;
            }
            file.flush()?;
        }
    }
    Ok(())
}
