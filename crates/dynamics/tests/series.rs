//! Time series on request: states at every k-th sample, told as they come.

mod common;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use dynamics::{
    Adaptive, AdaptiveOrder, BLOCKS, Coupling, DynamicsError, InstructionSet, Lorenz, Method,
    Model, Native, Observables, Observer, Oscillator, Outcome, ROUNDING_KICK, Record, Replica,
    Rossler, Run, Scalar, Schedule, Series, Simulation, Snapshot, SparseMatrix,
};

use common::{on_threads, replicas};

/// The laplacian coupling matrix of a ring, of two nodes with one link.
fn ring(n_nodes: usize) -> SparseMatrix {
    let mut entries = sprs::TriMatI::<f64, u32>::new((n_nodes, n_nodes));
    for i in 0..if n_nodes == 2 { 1 } else { n_nodes } {
        let j = (i + 1) % n_nodes;
        for (from, to) in [(i, j), (j, i)] {
            entries.add_triplet(from, to, 1.0);
            entries.add_triplet(from, from, -1.0);
        }
    }
    entries.to_csr()
}

/// Lorenz oscillators, x into y: 50 samples of transient, 100 of average, kicks at every tenth.
fn lorenz(matrix: &SparseMatrix, series: Series) -> Simulation<'_> {
    Simulation {
        dynamics: Arc::new(Model::Lorenz(Lorenz::default())),
        coupling: Coupling::pair(0, 1),
        matrix,
        method: Method::Rk4,
        schedule: Schedule { step: 0.01, transient: 5.0, average: 10.0, stride: 10 },
        observables: Observables { pairs: true, ..Observables::default() },
        series: Some(series),
        kick: ROUNDING_KICK,
        instruction_set: InstructionSet::best(),
    }
}

fn adaptive(order: AdaptiveOrder, tolerance: f64) -> Method {
    let (relative_tolerance, absolute_tolerance) = (tolerance, tolerance);
    Method::Adaptive(Adaptive { order, relative_tolerance, absolute_tolerance })
}

/// A record that is kept.
#[derive(Clone, Debug, PartialEq)]
struct Kept {
    sample: u64,
    time: f64,
    states: Vec<f64>,
}

/// Keeps all records, by replica.
#[derive(Default)]
struct Keeping(Mutex<BTreeMap<usize, Vec<Kept>>>);

impl Observer for Keeping {
    fn recorded(&self, replica: usize, record: &Record<'_>) {
        let mut all = self.0.lock().unwrap();
        keep(all.entry(replica).or_default(), record);
    }
}

/// Appends a record to those of its replica, of which it must be the next.
fn keep(records: &mut Vec<Kept>, record: &Record<'_>) {
    let Record { number, sample, time, states } = *record;
    assert_eq!(number, records.len() as u64, "no record is left out or comes twice");
    records.push(Kept { sample, time, states: states.to_vec() });
}

/// Runs replicas to their ends; their records, replica by replica.
fn run(simulation: &Simulation<'_>, replicas: &[Replica]) -> (Vec<Run>, Vec<Vec<Kept>>) {
    let keeping = Keeping::default();
    let starts = replicas.iter().map(|&replica| replica.into()).collect();
    let runs = simulation.run_observed(starts, &keeping).unwrap();
    (runs, keeping.0.into_inner().unwrap().into_values().collect())
}

/// ẋ = −x.
#[derive(Clone, Copy, Debug)]
struct Decay;

impl Oscillator<1> for Decay {
    const COMPONENTS: [&'static str; 1] = ["x"];
    const START: [[f64; 2]; 1] = [[1.0, 2.0]];

    fn flow<S: Scalar>(&self, [x]: [S; 1]) -> [S; 1] {
        [-x]
    }
}

#[test]
fn records_of_diffusion_decay_by_what_the_method_makes_of_the_eigenvalues() {
    // On two nodes ẋ_1 + ẋ_2 = −(x_1 + x_2) and ẋ_1 − ẋ_2 = −(1 + 2ε)(x_1 − x_2). A step of RK4
    // multiplies by R(hμ); record n is 3 · 5 n steps later. Exponentials are what the others approach.
    let matrix = ring(2);
    let series = Series { every: 3, from: Some(0.0), ..Series::of(vec![0, 1]) };
    let schedule = Schedule { step: 0.02, transient: 1.0, average: 4.0, stride: 5 };
    let of = |method| Simulation {
        dynamics: Arc::new(Native::new(Decay)),
        coupling: Coupling::pair(0, 0),
        method,
        schedule,
        kick: 0.0,
        ..lorenz(&matrix, series.clone())
    };
    let rk4 = |z: f64| (1.0 + z + z * z / 2.0 + z.powi(3) / 6.0 + z.powi(4) / 24.0).powi(15);
    // Of order 8 and with steps so short, DOP853's is the exponential to rounding.
    let exact = |z: f64| (15.0 * z).exp();
    type Factor<'a> = &'a dyn Fn(f64) -> f64;
    let methods: [(Method, Factor<'_>, f64); 4] = [
        (Method::Rk4, &rk4, 1e-13),
        (Method::Dop853, &exact, 1e-13),
        (adaptive(AdaptiveOrder::Five, 1e-11), &exact, 1e-9),
        (adaptive(AdaptiveOrder::Eight, 1e-12), &exact, 1e-9),
    ];
    for (method, factor, allowed) in methods {
        let replicas = [0.0, 0.3, 1.0].map(|epsilon| Replica { epsilon, seed: 4 });
        for (replica, records) in replicas.iter().zip(run(&of(method), &replicas).1) {
            // 50 samples, every third from the initial state on.
            assert_eq!(records.len(), 17);
            for (n, record) in records.iter().enumerate() {
                assert_eq!((record.sample, record.time), (3 * n as u64, 3.0 * n as f64 * 0.1));
                for (sign, mu) in [(1.0, -1.0), (-1.0, -1.0 - 2.0 * replica.epsilon)] {
                    let of = |record: &Kept| record.states[0] + sign * record.states[1];
                    let expected = of(&records[0]) * factor(schedule.step * mu).powi(n as i32);
                    let error = (of(record) - expected).abs();
                    assert!(error < allowed, "{method:?}, record {n}, μ = {mu}: off by {error}");
                }
            }
        }
    }
}

/// x, y, z of two nodes.
type Two = [[f64; 3]; 2];

/// Two Lorenz oscillators, x into y, one step of RK4 later. With its points x_1, x_2, x_3 that step is
/// x + [(x_1 − x) + 2 (x_2 − x) + (x_3 − x)] / 3 + h/6 f(x_3).
fn step_of_two(x: Two, epsilon: f64, h: f64) -> Two {
    let Lorenz { alpha, r, b } = Lorenz::default();
    let flow = |[x, y, z]: [f64; 3], other: f64| {
        [alpha * (y - x), (r - z) * x - y + epsilon * (other - x), x * y - b * z]
    };
    let slope = |[one, other]: Two| [flow(one, other[0]), flow(other, one[0])];
    let each = |of: &dyn Fn(usize, usize) -> f64| [0, 1].map(|node| [0, 1, 2].map(|c| of(node, c)));
    let ahead = |k: Two, by: f64| each(&|node, c| x[node][c] + by * h * k[node][c]);
    let x_1 = ahead(slope(x), 0.5);
    let x_2 = ahead(slope(x_1), 0.5);
    let x_3 = ahead(slope(x_2), 1.0);
    let k = slope(x_3);
    each(&|node, c| {
        let from_x = |point: Two| point[node][c] - x[node][c];
        let outer = from_x(x_1) + from_x(x_3);
        let sum = outer + 2.0 * from_x(x_2);
        x[node][c] + (sum * (1.0 / 3.0) + k[node][c] * (h / 6.0))
    })
}

#[test]
fn records_have_the_bits_of_a_loop_over_steps_in_any_number_of_lanes() {
    let matrix = ring(2);
    let series = Series { every: 4, from: Some(0.0), ..Series::of(vec![0, 1]) };
    let simulation = Simulation { kick: 0.0, ..lorenz(&matrix, series) };
    for lanes in [1, 2, 3, 5, 16] {
        let replicas = replicas(lanes);
        let records = on_threads(1, || run(&simulation, &replicas).1);
        for (replica, records) in replicas.iter().zip(records) {
            let of = |record: &Kept| -> [[f64; 3]; 2] {
                [0, 3].map(|at| std::array::from_fn(|c| record.states[at + c]))
            };
            let mut state = of(&records[0]);
            assert_eq!(records.len(), 1 + 150 / 4);
            for record in &records[1..] {
                for _ in 0..4 * 10 {
                    state = step_of_two(state, replica.epsilon, 0.01);
                }
                assert_eq!(of(record), state, "ε = {}, at {}", replica.epsilon, record.time);
            }
        }
    }
}

#[test]
fn records_have_the_same_bits_for_any_lanes_threads_and_instruction_set() {
    let matrix = ring(19);
    let series = Series {
        nodes: vec![18, 0, 7],
        components: Some(vec![2, 0]),
        every: 7,
        from: Some(1.0),
        to: Some(13.0),
    };
    let simulation = lorenz(&matrix, series);
    let replicas = replicas(16);
    let alone: Vec<_> =
        replicas.iter().flat_map(|&replica| run(&simulation, &[replica]).1).collect();
    assert!(alone.iter().all(|records| records.len() == 1 + (130 - 10) / 7));
    assert!(alone.iter().flatten().all(|record| record.states.len() == 6));
    for threads in [2, 3] {
        let together = on_threads(threads, || run(&simulation, &replicas).1);
        assert_eq!(together, alone, "{threads} threads");
    }
    for instruction_set in InstructionSet::available() {
        let simulation = Simulation { instruction_set, ..simulation.clone() };
        for lanes in [1, 2, 4, 8, 16] {
            let batches = || replicas.chunks(lanes).flat_map(|batch| run(&simulation, batch).1);
            let records: Vec<_> = on_threads(1, || batches().collect());
            assert_eq!(records, alone, "{instruction_set:?}, {lanes} lanes");
        }
    }
}

#[test]
fn chosen_nodes_and_components_are_those_of_the_whole_state() {
    let matrix = ring(19);
    let (nodes, components) = ([18, 0, 7], [2, 0]);
    let chosen = Series { components: Some(components.to_vec()), ..Series::of(nodes.to_vec()) };
    let replicas = replicas(3);
    for method in [Method::Rk4, adaptive(AdaptiveOrder::Five, 1e-6)] {
        let of = |series: &Series| {
            let simulation = Simulation { method, ..lorenz(&matrix, series.clone()) };
            run(&simulation, &replicas).1.concat()
        };
        let (whole, some) = (of(&Series::of((0..19).collect())), of(&chosen));
        assert_eq!((whole.len(), some.len()), (3 * 101, 3 * 101));
        for (whole, some) in whole.iter().zip(&some) {
            let states =
                nodes.iter().flat_map(|node| components.map(|c| whole.states[3 * node + c]));
            assert_eq!(some.states, states.collect::<Vec<_>>());
        }
    }
}

#[test]
fn the_errors_of_a_run_are_those_of_its_records_and_of_a_run_without_any_to_the_last_bit() {
    let matrix = ring(5);
    for method in [Method::Rk4, adaptive(AdaptiveOrder::Eight, 1e-6)] {
        let simulation = Simulation { method, ..lorenz(&matrix, Series::of((0..5).collect())) };
        let (runs, records) = run(&simulation, &replicas(3));
        let without = Simulation { series: None, ..simulation.clone() };
        assert_eq!(run(&without, &replicas(3)), (runs.clone(), Vec::new()));
        for (run, records) in runs.iter().zip(records) {
            let Outcome::Completed(errors) = &run.outcome else { panic!("{run:?}") };
            // The first record is the state that the transient leaves, before the first average.
            let averaged = &records[1..];
            assert_eq!((records[0].time, averaged.len()), (5.0, 5 * BLOCKS));
            let mean = |i: usize, j: usize| {
                let error = |record: &Kept| (record.states[3 * i] - record.states[3 * j]).abs();
                let block = |block: &[Kept]| block.iter().map(error).sum::<f64>() * (1.0 / 5.0);
                let blocks = averaged.chunks(5).map(block).zip(1..);
                blocks.fold(0.0, |mean, (value, n)| mean + (value - mean) * (1.0 / f64::from(n)))
            };
            for (i, j) in [(0, 1), (1, 3), (2, 4)] {
                assert_eq!(errors.pair(i, j, 5), mean(i, j), "{method:?}, {i} and {j}");
            }
        }
    }
}

/// The records of a simulation that is interrupted again and again, cut back to what it goes on from each
/// time; and how often it was.
fn interrupted(simulation: &Simulation<'_>, replicas: &[Replica]) -> (Vec<Vec<Kept>>, u64) {
    let series = simulation.series.as_ref().unwrap();
    let records: Vec<Mutex<Vec<Kept>>> = replicas.iter().map(|_| Mutex::default()).collect();
    let mut n_cut = 0;
    let begins = |place: usize, from: Option<&Snapshot>| {
        let told = |from: &Snapshot| series.n_records_by(&simulation.schedule, from.sample());
        let n_told = from.map_or(0, told) as usize;
        let mut records = records[place].lock().unwrap();
        assert!(records.len() >= n_told, "a snapshot is of samples that were told");
        n_cut += records.len() - n_told;
        records.truncate(n_told);
    };
    let recorded = |place: usize, record: &Record<'_>| {
        keep(&mut records[place].lock().unwrap(), record);
    };
    let (_, interruptions) = common::interrupted(simulation, replicas, begins, recorded);
    assert!(n_cut > 0, "no record was told again");
    (records.into_iter().map(|of| of.into_inner().unwrap()).collect(), interruptions)
}

#[test]
fn a_stopped_and_resumed_simulation_gives_the_records_of_an_undisturbed_one() {
    let matrix = ring(5);
    let of = |every, from| Series { every, from, ..Series::of(vec![4, 1]) };
    for (method, n_replicas) in [(Method::Rk4, 21), (adaptive(AdaptiveOrder::Five, 1e-6), 4)] {
        for series in [of(1, Some(0.0)), of(7, Some(2.3)), of(5, None)] {
            let simulation = Simulation { method, ..lorenz(&matrix, series) };
            let replicas = replicas(n_replicas);
            let undisturbed = run(&simulation, &replicas).1;
            let (records, interruptions) = interrupted(&simulation, &replicas);
            assert!(interruptions > 4, "only {interruptions} interruptions");
            assert_eq!(records, undisturbed, "{method:?}");
        }
    }
}

#[test]
fn records_end_before_an_orbit_escapes_or_cannot_be_integrated_and_those_of_others_go_on() {
    // Negative coupling drives two Rössler oscillators to infinity.
    let matrix = ring(2);
    for method in [Method::Rk4, adaptive(AdaptiveOrder::Five, 1e-6)] {
        let simulation = Simulation {
            dynamics: Arc::new(Model::Rossler(Rossler::default())),
            coupling: Coupling::pair(0, 0),
            method,
            ..lorenz(&matrix, Series { from: Some(0.0), ..Series::of(vec![0, 1]) })
        };
        let replica = |epsilon| Replica { epsilon, seed: 1 };
        let (runs, records) = run(&simulation, &[0.5, -5.0, 0.4].map(replica));
        let (Outcome::Escaped { time } | Outcome::Failed { time, .. }) = runs[1].outcome else {
            panic!("{:?}", runs[1])
        };
        assert_eq!([records[0].len(), records[2].len()], [151, 151]);
        let last = records[1].last().unwrap();
        let after = time - last.time;
        assert!(after > 0.0 && after < 0.1 + 1e-9, "{} and {time}", last.time);
        assert!(last.states.iter().all(|x| x.abs() < dynamics::ESCAPE_RADIUS));
    }
}

#[test]
fn a_simulation_refuses_a_series_that_cannot_be_had() {
    let matrix = ring(5);
    let refused = lorenz(&matrix, Series::of(vec![5])).run(&replicas(1), dynamics::QUIET);
    assert_eq!(refused, Err(DynamicsError::NoSuchNode { node: 5, n_nodes: 5 }));
}
