//! What clusters cost from 10³ to 10⁶ nodes: `clusters/<fixture>_<rule>/<n>`, all modes unstable.
//!
//! `cargo bench -p clustering`; a name or a part of one after `--` picks some.

mod fixtures;

use clustering::EigenvectorDistance;
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};

const SIZES: [usize; 4] = [1_000, 10_000, 100_000, 1_000_000];

fn clusters(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("clusters");
    group.sample_size(10);
    for n_nodes in SIZES {
        for fixture in fixtures::all(n_nodes) {
            let modes: Vec<usize> = (1..fixture.spectrum.eigenvalues.len()).collect();
            let distance = EigenvectorDistance::new(&fixture.spectrum, &modes).unwrap();
            let exact = distance.exact_clusters().unwrap();
            let threshold = distance.clusters_within(fixture.threshold).unwrap();
            assert!(exact.is_refinement_of(&threshold));
            let id = |rule: &str| BenchmarkId::new(format!("{}_{rule}", fixture.name), n_nodes);
            group.bench_function(id("exact"), |b| b.iter(|| distance.exact_clusters().unwrap()));
            group.bench_function(id("threshold"), |b| {
                b.iter(|| distance.clusters_within(fixture.threshold).unwrap());
            });
        }
    }
    group.finish();
}

criterion_group!(benches, clusters);
criterion_main!(benches);
