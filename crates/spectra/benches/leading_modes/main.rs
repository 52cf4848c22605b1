//! What leading modes cost from 10³ to 10⁶ nodes: `leading_modes/<fixture>/<n>`, eight modes of the
//! normalized matrix to a residual of 10⁻¹⁰, the number of them verified; and ten modes of 10⁵ nodes in
//! communities, `leading_modes/communities_10_modes/100000`.
//!
//! `cargo bench -p spectra`; a name or a part of one after `--` picks some. With a folder in
//! `EIGENSYNC_FIXTURES` the networks are written there instead, for `benches/peers/leading_modes.py`;
//! no larger ones than `EIGENSYNC_LARGEST` nodes, if that is set. With a folder in `EIGENSYNC_FOUND`,
//! `leading_modes.csv` there gets the products and the largest residual of each.

mod fixtures;

use std::hint::black_box;
use std::path::Path;
use std::time::{Duration, Instant};
use std::{env, fs, io, io::Write};

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, BenchmarkId, Criterion, SamplingMode};
use fixtures::Builder;
use graph::{CouplingMatrix, Normalization};
use spectra::{Modes, Request, Spectrum, leading_modes};

const SIZES: [usize; 4] = [1_000, 10_000, 100_000, 1_000_000];
/// A spectrum of this many nodes takes up to half a minute and is computed once: all samples are that
/// one measurement.
const ONCE: usize = 1_000_000;

/// Modes asked for, but for the fixture of ten.
const N_MODES: usize = 8;
const TEN_MODES: (&str, Builder) = ("communities_10_modes", fixtures::planted);
const TEN_MODES_SIZE: usize = 100_000;

const REQUEST: Request = Request {
    modes: Modes::Leading(N_MODES),
    solver: None,
    tolerance: 1e-10,
    max_products: 200_000,
    max_extra: 100,
    max_modes: 1000,
    seed: 1,
};

fn main() -> io::Result<()> {
    if let Some(folder) = env::var_os("EIGENSYNC_FIXTURES") {
        let largest = env::var("EIGENSYNC_LARGEST").ok().and_then(|n| n.parse().ok());
        return write_all(Path::new(&folder), largest.unwrap_or(usize::MAX));
    }
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("leading_modes");
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    group.warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_secs(1));
    for (fixture, n_nodes, n_modes) in cases() {
        bench(&mut group, fixture, n_nodes, n_modes)?;
    }
    group.finish();
    criterion.final_summary();
    Ok(())
}

/// Every fixture with its size and the number of modes.
///
/// Without the ring of 10⁵ cliques: its leading eigenvalues are closer to one another than rounding
/// lets anyone count, and are refused as unproven.
fn cases() -> Vec<((&'static str, Builder), usize, usize)> {
    let of_all_sizes =
        SIZES.into_iter().flat_map(|n| fixtures::ALL.map(|fixture| (fixture, n, N_MODES)));
    let countable =
        of_all_sizes.filter(|((name, _), n, _)| (*name, *n) != ("ring_of_cliques", ONCE));
    countable.chain([(TEN_MODES, TEN_MODES_SIZE, 10)]).collect()
}

/// The matrix is built when its benchmark runs, and not at all when a filter leaves that out.
fn bench(
    group: &mut BenchmarkGroup<'_, WallTime>,
    (name, build): (&str, Builder),
    n_nodes: usize,
    n_modes: usize,
) -> io::Result<()> {
    let mut matrix = None;
    let mut measured = None;
    let mut found = None;
    group.bench_function(BenchmarkId::new(name, n_nodes), |bencher| {
        let w = matrix.get_or_insert_with(|| coupling_matrix(build, n_nodes));
        if n_nodes < ONCE {
            return bencher.iter(|| found = Some(solve(w, n_modes)));
        }
        let once = *measured.get_or_insert_with(|| {
            let started = Instant::now();
            found = Some(black_box(solve(w, n_modes)));
            started.elapsed()
        });
        bencher.iter_custom(|n_times| once * n_times as u32);
    });
    match found {
        Some(spectrum) => {
            let (products, largest) = (spectrum.products, spectrum.largest_residual());
            note_found(&format!("leading_modes/{name}/{n_nodes},{products},{largest:.1e}"))
        }
        None => Ok(()),
    }
}

/// Adds a line to what was found, where that is asked for.
fn note_found(line: &str) -> io::Result<()> {
    let Some(folder) = env::var_os("EIGENSYNC_FOUND") else { return Ok(()) };
    let path = Path::new(&folder).join("leading_modes.csv");
    writeln!(fs::OpenOptions::new().create(true).append(true).open(path)?, "{line}")
}

fn coupling_matrix(build: Builder, n_nodes: usize) -> CouplingMatrix {
    CouplingMatrix::new(&build(n_nodes), Normalization::Normalized)
}

fn solve(w: &CouplingMatrix, n_modes: usize) -> Spectrum {
    let request = Request { modes: Modes::Leading(n_modes), ..REQUEST };
    let spectrum = leading_modes(w, &request).expect("the work allowed suffices");
    assert!(spectrum.n_modes() >= n_modes);
    spectrum
}

/// Writes `FOLDER/<fixture>_<n>.csr`: N and the number of entries as 64-bit integers, then row starts
/// and columns of the adjacency matrix as 32-bit integers, all little-endian; weights are 1.
fn write_all(folder: &Path, largest: usize) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    for ((name, build), n_nodes, _) in cases() {
        if n_nodes <= largest {
            let network = build(n_nodes);
            let adjacency = network.adjacency();
            let file = fs::File::create(folder.join(format!("{name}_{n_nodes}.csr")))?;
            let mut file = io::BufWriter::new(file);
            for count in [adjacency.rows() as u64, adjacency.nnz() as u64] {
                file.write_all(&count.to_le_bytes())?;
            }
            for &start in adjacency.proper_indptr().iter() {
                file.write_all(&(start as u32).to_le_bytes())?;
            }
            for column in adjacency.indices() {
                file.write_all(&column.to_le_bytes())?;
            }
            file.flush()?;
        }
    }
    Ok(())
}
