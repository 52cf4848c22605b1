//! What leading modes cost from 10³ to 10⁶ nodes: `leading_modes/<fixture>/<n>`, eight modes of the
//! normalized matrix to a residual of 10⁻¹⁰, the number of them verified.
//!
//! `cargo bench -p spectra`; a name or a part of one after `--` picks some. With a folder in
//! `EIGENSYNC_FIXTURES` the networks are written there instead, for `benches/peers/leading_modes.py`.

mod fixtures;

use std::hint::black_box;
use std::path::Path;
use std::time::{Duration, Instant};
use std::{env, fs, io, io::Write};

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, BenchmarkId, Criterion, SamplingMode};
use fixtures::Builder;
use graph::{CouplingMatrix, Normalization};
use spectra::{Modes, Request, SolverChoice, Spectrum, leading_modes};

const SIZES: [usize; 4] = [1_000, 10_000, 100_000, 1_000_000];
/// A spectrum of this many nodes takes up to half a minute and is computed once: all samples are that
/// one measurement.
const ONCE: usize = 1_000_000;

const REQUEST: Request = Request {
    modes: Modes::Leading(8),
    solver: SolverChoice::Auto,
    tolerance: 1e-10,
    max_products: 200_000,
    max_extra: 100,
    max_modes: 1000,
    seed: 1,
};

fn main() -> io::Result<()> {
    if let Some(folder) = env::var_os("EIGENSYNC_FIXTURES") {
        return write_all(Path::new(&folder));
    }
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("leading_modes");
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    group.warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_secs(1));
    for n_nodes in SIZES {
        for fixture in fixtures::ALL {
            bench(&mut group, fixture, n_nodes);
        }
    }
    group.finish();
    criterion.final_summary();
    Ok(())
}

/// The matrix is built when its benchmark runs, and not at all when a filter leaves that out.
fn bench(group: &mut BenchmarkGroup<'_, WallTime>, (name, build): (&str, Builder), n_nodes: usize) {
    let mut matrix = None;
    let mut measured = None;
    group.bench_function(BenchmarkId::new(name, n_nodes), |bencher| {
        let w = matrix.get_or_insert_with(|| coupling_matrix(build, n_nodes));
        if n_nodes < ONCE {
            return bencher.iter(|| solve(w));
        }
        let once = *measured.get_or_insert_with(|| {
            let started = Instant::now();
            black_box(solve(w));
            started.elapsed()
        });
        bencher.iter_custom(|n_times| once * n_times as u32);
    });
}

fn coupling_matrix(build: Builder, n_nodes: usize) -> CouplingMatrix {
    CouplingMatrix::new(&build(n_nodes), Normalization::Normalized)
}

fn solve(w: &CouplingMatrix) -> Spectrum {
    let spectrum = leading_modes(w, &REQUEST).expect("the work allowed suffices");
    assert!(spectrum.eigenvalues.len() >= 8);
    spectrum
}

/// Writes `FOLDER/<fixture>_<n>.csr`: N and the number of entries as 64-bit integers, then row starts
/// and columns of the adjacency matrix as 32-bit integers, all little-endian; weights are 1.
fn write_all(folder: &Path) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    for n_nodes in SIZES {
        for (name, build) in fixtures::ALL {
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
