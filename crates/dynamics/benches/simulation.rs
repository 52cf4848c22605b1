//! Speed of simulations and of the master stability function on one thread.
//!
//! Named operation/fixture/size; elements are node-steps (of tangents: tangent-steps, of `peak`:
//! floating-point operations). A node-step of `communities90` has 4 · (30 + 27) additions and
//! products at 30 links a node, one of `cortex989` 4 · (2 · 36 + 27): its links have weights.
//!
//! `peak` is what a processor does of packed multiplications and additions, one rounding each, when
//! nothing has to be waited for or fetched: the measure of all the rest.

#[path = "../../../benches/fixtures/src/networks.rs"]
mod networks;

use std::hint::black_box;
use std::sync::Arc;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use dynamics::lyapunov::{Integrator, Tangent, Times, master_exponents};
use dynamics::{
    Coupling, HindmarshRose, InstructionSet, Lanes, Method, Model, Observables, Oscillator, QUIET,
    ROUNDING_KICK, Replica, Schedule, Simulation, SparseMatrix, Text, Work,
};
use equations::{Description, System};

fn x_into_x() -> Coupling {
    Coupling::pair(0, 0)
}

fn model() -> Model {
    Model::HindmarshRose(HindmarshRose::default())
}

/// A simulation of so many samples, ten steps each.
fn simulation(matrix: &SparseMatrix, samples: u32, observables: Observables) -> Simulation<'_> {
    let (step, stride) = (0.01, 10);
    let average = f64::from(samples * stride) * step;
    Simulation {
        dynamics: Arc::new(model()),
        coupling: x_into_x(),
        matrix,
        method: Method::Rk4,
        schedule: Schedule { step, transient: 0.0, average, stride },
        observables,
        series: None,
        kick: ROUNDING_KICK,
        instruction_set: InstructionSet::best(),
    }
}

fn replicas(lanes: u32) -> Vec<Replica> {
    let replica = |k: u32| Replica { epsilon: 0.3 + 0.05 * f64::from(k), seed: 1 + u64::from(k) };
    (0..lanes).map(replica).collect()
}

fn time_run(criterion: &mut Criterion, name: &str, simulation: &Simulation<'_>, lanes: u32) {
    let replicas = replicas(lanes);
    let node_steps = replicas.len() * simulation.matrix.rows();
    let mut group = criterion.benchmark_group(name);
    group.throughput(Throughput::Elements(node_steps as u64 * simulation.schedule.steps()));
    group.bench_function(lanes.to_string(), |bencher| {
        bencher.iter(|| simulation.run(&replicas, QUIET).expect("the schedule is sound"));
    });
}

/// The same by steps of eighth order, which are this long; a sample each.
fn by_dop853<'a>(simulation: &Simulation<'a>, step: f64) -> Simulation<'a> {
    let average = simulation.schedule.average;
    Simulation {
        method: Method::Dop853,
        schedule: Schedule { step, transient: 0.0, average, stride: 1 },
        ..simulation.clone()
    }
}

fn simulate(criterion: &mut Criterion) {
    let communities = networks::coupling_matrix(&networks::communities90());
    let cortex = networks::coupling_matrix(&networks::cortex989());
    for lanes in [1, 2, 4, 8, 16] {
        let none = Observables::default;
        let simulation_90 = simulation(communities.matrix(), 1000, none());
        time_run(criterion, "simulate/communities90", &simulation_90, lanes);
        let simulation_989 = simulation(cortex.matrix(), 40, none());
        time_run(criterion, "simulate/cortex989", &simulation_989, lanes);
        let simulation_90 = by_dop853(&simulation_90, 0.125);
        time_run(criterion, "simulate/dop853/communities90", &simulation_90, lanes);
        let simulation_989 = by_dop853(&simulation_989, 0.1);
        time_run(criterion, "simulate/dop853/cortex989", &simulation_989, lanes);
    }
}

/// One replica of a large network, and three, on two threads and on one.
fn together(criterion: &mut Criterion) {
    let cortex = networks::coupling_matrix(&networks::cortex989());
    let rk4 = simulation(cortex.matrix(), 40, Observables::default());
    let dop853 = by_dop853(&rk4, 0.1);
    let pairs = Observables { pairs: true, ..Observables::default() };
    let observed = simulation(cortex.matrix(), 40, pairs);
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let named = [("rk4", &rk4), ("dop853", &dop853), ("pairs", &observed)];
        for (name, simulation) in named {
            for n in [1, 2, 3, 16] {
                let name = format!("together/{name}/{n}");
                let (replicas, of) = (replicas(n), format!("{threads}-threads"));
                let mut group = criterion.benchmark_group(name);
                let elements = u64::from(n) * 989 * simulation.schedule.steps();
                group.throughput(Throughput::Elements(elements));
                group.bench_function(of, |bencher| {
                    bencher.iter(|| pool.install(|| simulation.run(&replicas, QUIET)));
                });
            }
        }
    }
}

/// The same equations as text: what a program takes beside compiled ones.
fn text() -> Text {
    let neuron = HindmarshRose::default();
    let system = System::read(&Description {
        components: HindmarshRose::COMPONENTS.to_vec(),
        equations: vec![
            ("x", "y + x^2*(3 - x) - z + current"),
            ("y", "1 - x^2*5 - y"),
            ("z", "((x + 1.6)*s - z)*r"),
        ],
        parameters: vec![("r", neuron.r), ("s", neuron.s), ("current", neuron.current)],
        ..Description::default()
    });
    Text::new(&system.expect("these are equations"), HindmarshRose::START.to_vec())
}

fn simulate_text(criterion: &mut Criterion) {
    let communities = networks::coupling_matrix(&networks::communities90());
    let compiled = simulation(communities.matrix(), 1000, Observables::default());
    for lanes in [1, 16] {
        let text = Simulation { dynamics: Arc::new(text()), ..compiled.clone() };
        let first = |simulation: &Simulation<'_>| simulation.run(&replicas(lanes), QUIET);
        assert_eq!(first(&compiled), first(&text), "the same bits");
        time_run(criterion, "simulate-text/communities90", &text, lanes);
    }
}

/// The same with all pairs observed at every sample.
fn observe(criterion: &mut Criterion) {
    let cortex = networks::coupling_matrix(&networks::cortex989());
    let pairs = Observables { pairs: true, ..Observables::default() };
    time_run(criterion, "observe/cortex989", &simulation(cortex.matrix(), 640, pairs), 16);
}

/// Λ at 121 values of σ about one orbit, and at 32 with orbits of their own, as zeros are refined.
fn msf(criterion: &mut Criterion) {
    let times = Times {
        integrator: Integrator::Rk4,
        step: 0.01,
        transient: 100.0,
        average: 1000.0,
        renormalise: 0.5,
    };
    let one_orbit: Vec<_> =
        (0..121).map(|k| Tangent { sigma: 0.0125 * f64::from(k), seed: 1 }).collect();
    let own_orbits: Vec<_> = (0..32).map(|seed| Tangent { sigma: 0.9, seed }).collect();
    let mut group = criterion.benchmark_group("msf/hindmarsh_rose");
    for (name, tangents) in [("121", one_orbit), ("32-own-orbits", own_orbits)] {
        group.throughput(Throughput::Elements(tangents.len() as u64 * times.steps()));
        group.bench_function(name, |bencher| {
            bencher.iter(|| master_exponents(&model(), &x_into_x(), &times, &tangents, QUIET));
        });
        let by_series = Times { integrator: Integrator::Taylor { tolerance: 1e-6 }, ..times };
        group.bench_function(format!("{name}-series"), |bencher| {
            bencher.iter(|| master_exponents(&model(), &x_into_x(), &by_series, &tangents, QUIET));
        });
        group.bench_function(format!("{name}-text"), |bencher| {
            bencher.iter(|| master_exponents(&text(), &x_into_x(), &times, &tangents, QUIET));
        });
    }
}

/// Multiplications and additions on `V` independent runs of `L` numbers each.
struct Peak<const V: usize, const L: usize> {
    rounds: u64,
    factor: f64,
    term: f64,
}

impl<const V: usize, const L: usize> Work for Peak<V, L> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let (mut products, mut sums) = ([Lanes([1.0; L]); V], [Lanes([0.0; L]); V]);
        for _ in 0..self.rounds {
            for v in 0..V {
                products[v] = products[v] * self.factor;
                sums[v] = sums[v] + self.term;
            }
        }
        products.iter().chain(&sums).flat_map(|lanes| lanes.0).sum()
    }
}

fn peak(criterion: &mut Criterion) {
    const VECTORS: u64 = 6;
    const ROUNDS: u64 = 1 << 20;
    let mut group = criterion.benchmark_group("peak");
    for set in InstructionSet::available() {
        let (factor, term) = black_box((1.0 + 1e-9, 0.5));
        macro_rules! time {
            ($width:literal) => {{
                group.throughput(Throughput::Elements(2 * VECTORS * $width * ROUNDS));
                group.bench_function(set.name(), |bencher| {
                    let peak =
                        || Peak::<{ VECTORS as usize }, $width> { rounds: ROUNDS, factor, term };
                    bencher.iter(|| set.run(peak()));
                });
            }};
        }
        match set {
            InstructionSet::Baseline => time!(2),
            InstructionSet::Avx2 => time!(4),
            InstructionSet::Avx512 => time!(8),
        }
    }
}

/// One thread, so that a machine's speed is that of one of its cores.
fn on_one_thread() -> Criterion {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("no pool was made before");
    Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_secs(1))
        .measurement_time(Duration::from_secs(3))
}

criterion_group! {
    name = benches;
    config = on_one_thread();
    targets = peak, simulate, simulate_text, together, msf, observe
}
criterion_main!(benches);
