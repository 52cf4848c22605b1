//! Steps of eighth order in lanes, through the public interface.

use std::sync::{Arc, Mutex};

use dynamics::{
    Adaptive, AdaptiveOrder, Coupling, HindmarshRose, InstructionSet, Lorenz, Method, Model,
    Observables, Observer, Outcome, ROUNDING_KICK, Record, Replica, Schedule, Series, Simulation,
    SparseMatrix,
};

/// A ring of so many nodes with weights, each linked to the next and to the one after three.
fn ring(n_nodes: usize) -> SparseMatrix {
    let mut entries = sprs::TriMatI::<f64, u32>::new((n_nodes, n_nodes));
    for i in 0..n_nodes {
        for (distance, weight) in [(1, 1.0), (3, 0.5 + 0.1 * i as f64)] {
            let j = (i + distance) % n_nodes;
            for (from, to) in [(i, j), (j, i)] {
                entries.add_triplet(from, to, weight);
                entries.add_triplet(from, from, -weight);
            }
        }
    }
    entries.to_csr()
}

/// Lorenz oscillators over two units of time, at steps of 1/20, a sample each.
fn lorenz(matrix: &SparseMatrix) -> Simulation<'_> {
    Simulation {
        dynamics: Arc::new(Model::Lorenz(Lorenz::default())),
        coupling: Coupling::pair(0, 1),
        matrix,
        method: Method::Dop853,
        schedule: Schedule { step: 0.05, transient: 0.0, average: 2.0, stride: 1 },
        observables: Observables { pairs: true, ..Observables::default() },
        series: None,
        kick: 0.0,
        instruction_set: InstructionSet::best(),
    }
}

fn replicas(n: u64) -> Vec<Replica> {
    (0..n).map(|k| Replica { epsilon: 0.3 * k as f64, seed: 1 + k % 3 }).collect()
}

fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

fn outcomes(simulation: &Simulation<'_>, replicas: &[Replica]) -> Vec<Outcome> {
    let runs = simulation.run(replicas, dynamics::QUIET).expect("the schedule is sound");
    runs.into_iter().map(|run| run.outcome).collect()
}

/// The first components of all nodes at time 4, by a method with a step 1/n, n a multiple of 5.
fn at_four(simulation: &Simulation<'_>, method: Method, n: u32) -> Vec<f64> {
    struct Last(Mutex<Vec<f64>>);
    impl Observer for Last {
        fn recorded(&self, _: usize, record: &Record<'_>) {
            *self.0.lock().unwrap() = record.states.to_vec();
        }
    }
    let n_nodes = simulation.matrix.rows();
    let schedule =
        Schedule { step: 1.0 / f64::from(n), transient: 0.0, average: 4.0, stride: n / 5 };
    let series = Some(Series::of((0..n_nodes).collect()));
    let last = Last(Mutex::default());
    let simulation = Simulation { method, schedule, series, ..simulation.clone() };
    simulation.run_observed(vec![Replica { epsilon: 0.7, seed: 1 }.into()], &last).unwrap();
    last.0.into_inner().unwrap()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn the_error_falls_with_the_eighth_power_of_the_step() {
    let matrix = ring(7);
    let neurons = Simulation {
        dynamics: Arc::new(Model::HindmarshRose(HindmarshRose::default())),
        coupling: Coupling::pair(0, 0),
        ..lorenz(&matrix)
    };
    for (simulation, n) in [(lorenz(&matrix), 20), (neurons, 5)] {
        let exact = at_four(&simulation, Method::Dop853, 16 * n);
        let error = |n| distance(&at_four(&simulation, Method::Dop853, n), &exact);
        let order = (error(n) / error(4 * n)).log2() / 2.0;
        assert!((7.5..9.0).contains(&order), "{order} from {} and {}", error(n), error(4 * n));
    }
}

#[test]
fn a_step_follows_the_orbit_that_rk4_at_a_tiny_step_and_the_adaptive_solver_follow() {
    let matrix = ring(7);
    let adaptive = Method::Adaptive(Adaptive {
        order: AdaptiveOrder::Eight,
        relative_tolerance: 1e-13,
        absolute_tolerance: 1e-13,
    });
    let lorenz = lorenz(&matrix);
    let by_dop853 = at_four(&lorenz, Method::Dop853, 200);
    for (method, n) in [(Method::Rk4, 10_000), (adaptive, 20)] {
        let off = distance(&by_dop853, &at_four(&lorenz, method, n));
        assert!(off < 1e-8, "{method:?}: {off}");
    }
}

#[test]
fn bits_do_not_depend_on_lanes_threads_or_instruction_set() {
    let matrix = ring(19);
    let simulation = Simulation { kick: ROUNDING_KICK, ..lorenz(&matrix) };
    let replicas = replicas(19);
    let alone: Vec<_> = replicas.iter().flat_map(|&r| outcomes(&simulation, &[r])).collect();
    for threads in [1, 2, 3] {
        assert_eq!(on_threads(threads, || outcomes(&simulation, &replicas)), alone, "{threads}");
    }
    for instruction_set in InstructionSet::available() {
        let simulation = Simulation { instruction_set, ..simulation.clone() };
        for lanes in [1, 2, 4, 8, 16] {
            let run = |batch| outcomes(&simulation, batch);
            let all = on_threads(1, || replicas.chunks(lanes).flat_map(run).collect::<Vec<_>>());
            assert_eq!(all, alone, "{instruction_set:?}, {lanes} lanes");
        }
    }
}

#[test]
fn bits_are_the_same_on_every_machine() {
    // The number was printed by this test. It changes when the arithmetic of a step does.
    let matrix = ring(7);
    let states = at_four(&lorenz(&matrix), Method::Dop853, 20);
    let digest = states.iter().fold(0xcbf2_9ce4_8422_2325, |hash: u64, x| {
        (hash ^ x.to_bits()).wrapping_mul(0x0100_0000_01b3)
    });
    assert_eq!(digest, 0x4e9c_9197_431a_0a40, "got {digest:#018x}");
}

#[test]
fn synchrony_that_is_stable_stays_at_the_level_of_rounding() {
    // On a complete network of six, λ = −6 for all transverse modes, which 2 damps.
    let mut entries = sprs::TriMatI::<f64, u32>::new((6, 6));
    for i in 0..6 {
        (0..6).for_each(|j| entries.add_triplet(i, j, if i == j { -5.0 } else { 1.0 }));
    }
    let matrix: SparseMatrix = entries.to_csr();
    let schedule = Schedule { step: 0.05, transient: 100.0, average: 100.0, stride: 1 };
    let simulation = Simulation { schedule, kick: ROUNDING_KICK, ..lorenz(&matrix) };
    let [Outcome::Completed(errors)] =
        &outcomes(&simulation, &[Replica { epsilon: 2.0, seed: 1 }])[..]
    else {
        panic!("the attractor is bounded")
    };
    assert!(errors.pairs.iter().all(|error| error.mean < 1e-12), "{:?}", errors.pairs);
}
