//! Simulations of whole networks, through the public interface.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use dynamics::{
    Adaptive, AdaptiveOrder, Coupling, DynamicsError, Errors, HindmarshRose, InstructionSet,
    Lorenz, Method, Model, Observables, Outcome, ROUNDING_KICK, Replica, Rossler, Run, Schedule,
    Simulation, SparseMatrix,
};
use proptest::prelude::*;

fn x_into_y() -> Coupling {
    Coupling::pair(0, 1)
}
const SCHEDULE: Schedule = Schedule { step: 0.01, transient: 50.0, average: 200.0, stride: 10 };

/// The laplacian coupling matrix of links given as (i, j, weight).
fn laplacian(n_nodes: usize, links: &[(usize, usize, f64)]) -> SparseMatrix {
    let mut entries = sprs::TriMatI::<f64, u32>::new((n_nodes, n_nodes));
    for &(i, j, weight) in links {
        entries.add_triplet(i, j, weight);
        entries.add_triplet(j, i, weight);
        entries.add_triplet(i, i, -weight);
        entries.add_triplet(j, j, -weight);
    }
    entries.to_csr()
}

/// Two halves {1,2,6} and {3,4,5}: Fan, Wang & Wang (2023), Sec. III A, numbered from 0.
fn six_node() -> SparseMatrix {
    let unit = [(0, 1), (0, 3), (0, 5), (1, 2), (2, 3), (3, 4), (4, 5)];
    let mut links: Vec<_> = unit.iter().map(|&(i, j)| (i, j, 1.0)).collect();
    links.extend([(1, 5, 1.5), (2, 4, 1.5)]);
    laplacian(6, &links)
}

fn lorenz_network(matrix: &SparseMatrix) -> Simulation<'_> {
    Simulation {
        dynamics: Arc::new(Model::Lorenz(Lorenz::default())),
        coupling: x_into_y(),
        matrix,
        method: Method::Rk4,
        schedule: SCHEDULE,
        observables: Observables { pairs: true, ..Observables::default() },
        series: None,
        kick: ROUNDING_KICK,
        instruction_set: InstructionSet::best(),
    }
}

fn replicas(epsilons: &[f64], seeds: u64) -> Vec<Replica> {
    let seeds = 1..=seeds;
    epsilons
        .iter()
        .flat_map(|&epsilon| seeds.clone().map(move |seed| Replica { epsilon, seed }))
        .collect()
}

fn run(simulation: &Simulation<'_>, replicas: &[Replica]) -> Vec<Run> {
    simulation.run(replicas, dynamics::QUIET).expect("the schedule is sound")
}

fn errors(run: &Run) -> &Errors {
    match &run.outcome {
        Outcome::Completed(errors) => errors,
        other => panic!("{other:?}"),
    }
}

/// Every bit of every pair error of every run, folded into one number (FNV-1a).
fn digest(runs: &[Run]) -> u64 {
    let bits = runs.iter().flat_map(|run| &errors(run).pairs).flat_map(|e| {
        [e.mean.to_bits(), e.standard_error.to_bits()].map(u64::to_le_bytes).concat()
    });
    bits.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

#[test]
fn bits_do_not_depend_on_threads_or_lanes() {
    let matrix = six_node();
    let simulation = lorenz_network(&matrix);
    let replicas = replicas(&[1.5, 2.4, 3.5, 4.5], 5);
    let one = on_threads(1, || run(&simulation, &replicas));
    let two = on_threads(2, || run(&simulation, &replicas));
    let alone: Vec<_> = replicas.iter().flat_map(|&r| run(&simulation, &[r])).collect();
    assert_eq!(digest(&one), digest(&two));
    assert_eq!(digest(&one), digest(&alone));
}

#[test]
fn bits_are_the_same_on_every_machine() {
    // The numbers were printed by this test, last when sums over links came to end with the node's
    // own term. They change when the arithmetic of the kernel does, and then every golden output has to be looked at again.
    let matrix = six_node();
    let lorenz = lorenz_network(&matrix);
    let neuron = Simulation {
        dynamics: Arc::new(Model::HindmarshRose(HindmarshRose::default())),
        coupling: Coupling::pair(0, 0),
        ..lorenz.clone()
    };
    let digests = [&lorenz, &neuron].map(|s| digest(&run(s, &replicas(&[0.3, 2.4], 2))));
    assert_eq!(digests, [0xc8c6_b670_0ac7_c777, 0x65c4_44c9_ed27_2acb], "got {digests:#018x?}");
}

#[test]
fn bits_are_the_same_for_every_instruction_set_and_number_of_lanes() {
    // Unweighted links and weighted ones are summed differently; 19 nodes fill no run of numbers.
    let links = |weight: fn(usize) -> f64| -> Vec<_> {
        (0..19)
            .flat_map(|i| [(i, (i + 1) % 19, weight(i)), (i, (i + 5) % 19, weight(i + 3))])
            .collect()
    };
    for matrix in [laplacian(19, &links(|_| 1.0)), laplacian(19, &links(|i| 1.0 + 0.1 * i as f64))]
    {
        let simulation = Simulation {
            observables: Observables {
                pairs: true,
                reference: Some(7),
                clusters: vec![vec![0, 1, 18]],
                ..Observables::default()
            },
            schedule: Schedule { transient: 5.0, average: 33.0, ..SCHEDULE },
            ..lorenz_network(&matrix)
        };
        let replicas = replicas(&[0.5, 2.5], 8);
        let alone: Vec<_> = replicas.iter().flat_map(|&r| run(&simulation, &[r])).collect();
        for instruction_set in InstructionSet::available() {
            let simulation = Simulation { instruction_set, ..simulation.clone() };
            for lanes in [1, 2, 4, 8, 16] {
                let runs = on_threads(1, || {
                    replicas
                        .chunks(lanes)
                        .flat_map(|batch| run(&simulation, batch))
                        .collect::<Vec<_>>()
                });
                assert_eq!(runs, alone, "{instruction_set:?}, {lanes} lanes");
            }
        }
    }
}

#[test]
fn global_synchronisation_is_reached_above_the_critical_coupling_and_lost_below_it() {
    let matrix = six_node();
    let runs = run(&lorenz_network(&matrix), &replicas(&[6.0, 1.0], 1));
    assert!(errors(&runs[0]).pairs.iter().all(|e| e.mean < 1e-9));
    assert!(errors(&runs[1]).pairs.iter().all(|e| e.mean > 1.0));
}

#[test]
fn uncoupled_nodes_differ_like_independent_orbits() {
    // Of two independent copies of a variable with standard deviation s, |difference| has a mean
    // between 0.9 s and 1.2 s for any distribution as broad as that of x of Lorenz, about 9.
    let matrix = laplacian(2, &[(0, 1, 1.0)]);
    let runs = run(&lorenz_network(&matrix), &replicas(&[0.0], 8));
    for run in &runs {
        let error = errors(run).pairs[0];
        assert!((8.0..12.0).contains(&error.mean), "{error:?}");
    }
}

#[test]
fn diffusion_of_a_damped_oscillator_decays_at_the_known_rate() {
    // Lorenz with r = 0 rests at 0; there z decouples: ż = −bz − ελz for z into z on two nodes with
    // λ = 2, so their difference decays as exp(−(b + 2ε)t), and ⟨|z_1 − z_2|⟩ over [0, T] is
    // |z_1 − z_2|(0) (1 − exp(−(b + 2ε)T)) / (b + 2ε)T once x and y have gone.
    let matrix = laplacian(2, &[(0, 1, 1.0)]);
    let simulation = Simulation {
        dynamics: Arc::new(Model::Lorenz(Lorenz { alpha: 1.0, r: 0.0, b: 0.001 })),
        coupling: Coupling::pair(2, 2),
        schedule: Schedule { step: 0.01, transient: 30.0, average: 400.0, stride: 1 },
        observables: Observables { component: 2, pairs: true, ..Observables::default() },
        ..lorenz_network(&matrix)
    };
    let runs = run(&simulation, &replicas(&[0.0, 0.01], 1));
    let mean = |index: usize| errors(&runs[index]).pairs[0].mean;
    let averaged =
        |rate: f64| (-30.0 * rate).exp() * (1.0 - (-400.0 * rate).exp()) / (400.0 * rate);
    let expected = averaged(0.021) / averaged(0.001);
    assert!((mean(1) / mean(0) / expected - 1.0).abs() < 1e-3, "{} {expected}", mean(1) / mean(0));
}

#[test]
fn fixed_step_and_adaptive_integrators_agree_within_their_errors() {
    let matrix = six_node();
    let fixed = Simulation {
        schedule: Schedule { average: 1000.0, ..SCHEDULE },
        ..lorenz_network(&matrix)
    };
    let tolerances = (1e-8, 1e-8);
    let replicas = replicas(&[1.0], 2);
    let reference = run(&fixed, &replicas);
    for order in [AdaptiveOrder::Five, AdaptiveOrder::Eight] {
        let method = Method::Adaptive(Adaptive {
            order,
            relative_tolerance: tolerances.0,
            absolute_tolerance: tolerances.1,
        });
        let adaptive = run(&Simulation { method, ..fixed.clone() }, &replicas);
        for (a, b) in reference.iter().zip(&adaptive) {
            for (a, b) in errors(a).pairs.iter().zip(&errors(b).pairs) {
                let allowed = 5.0 * a.standard_error.hypot(b.standard_error);
                assert!((a.mean - b.mean).abs() < allowed, "{order:?}: {a:?} against {b:?}");
            }
        }
    }
}

#[test]
fn fixed_step_and_adaptive_integrators_follow_the_same_orbit_before_chaos_parts_them() {
    let matrix = six_node();
    let short = Schedule { step: 0.001, transient: 0.0, average: 2.0, stride: 10 };
    let fixed = Simulation { schedule: short, ..lorenz_network(&matrix) };
    let method = Method::Adaptive(Adaptive {
        order: AdaptiveOrder::Eight,
        relative_tolerance: 1e-12,
        absolute_tolerance: 1e-12,
    });
    let adaptive = Simulation { method, ..fixed.clone() };
    let replicas = replicas(&[2.0], 1);
    let (a, b) = (run(&fixed, &replicas), run(&adaptive, &replicas));
    for (a, b) in errors(&a[0]).pairs.iter().zip(&errors(&b[0]).pairs) {
        assert!((a.mean - b.mean).abs() < 1e-7, "{} against {}", a.mean, b.mean);
    }
}

#[test]
fn an_orbit_that_escapes_is_an_outcome_with_its_time_and_leaves_the_others_alone() {
    // Beyond its bounded window x-to-x coupling drives two Rössler oscillators to infinity.
    let matrix = laplacian(2, &[(0, 1, 1.0)]);
    let simulation = Simulation {
        dynamics: Arc::new(Model::Rossler(Rossler::default())),
        coupling: Coupling::pair(0, 0),
        ..lorenz_network(&matrix)
    };
    let runs = run(&simulation, &replicas(&[0.5, -5.0, 0.5], 1));
    assert_eq!(runs[0].outcome, runs[2].outcome);
    assert!(errors(&runs[0]).pairs[0].mean.is_finite());
    match runs[1].outcome {
        Outcome::Escaped { time } => assert!(time > 0.0 && time < 250.0, "at {time}"),
        _ => panic!("negative coupling must drive the nodes apart"),
    }
}

#[test]
fn nodes_that_have_become_equal_part_again_where_their_synchrony_is_unstable() {
    // Node 2 drives leaves 0 and 1, whose inputs round alike: once equal they would stay so for ever.
    // At ε = 0.2 the leaves' mode (λ = −1) is unstable, though at ε = 20 it is not.
    let matrix = laplacian(3, &[(0, 2, 1.0), (1, 2, 1.0)]);
    let error = |epsilon, kick| {
        let simulation = Simulation { kick, ..lorenz_network(&matrix) };
        let runs = run(&simulation, &replicas(&[epsilon], 1));
        errors(&runs[0]).pairs[0].mean
    };
    assert_eq!(error(20.0, 0.0), 0.0);
    let kept_apart = error(20.0, ROUNDING_KICK);
    assert!(kept_apart > 0.0 && kept_apart < 1e-10, "{kept_apart}");
    assert!(error(0.2, ROUNDING_KICK) > 1.0);
}

#[test]
fn progress_counts_every_step_of_every_replica() {
    let matrix = six_node();
    let simulation = lorenz_network(&matrix);
    let steps = AtomicU64::new(0);
    let replicas = replicas(&[1.0, 2.0, 3.0], 1);
    let count = |done| {
        steps.fetch_add(done, Ordering::Relaxed);
        std::ops::ControlFlow::Continue(())
    };
    simulation.run(&replicas, &count).unwrap();
    assert_eq!(steps.into_inner(), 3 * simulation.schedule.steps());
}

#[test]
fn schedules_that_make_no_sense_are_refused() {
    let matrix = six_node();
    let refused = |schedule| {
        let simulation = Simulation { schedule, ..lorenz_network(&matrix) };
        simulation.run(&replicas(&[1.0], 1), dynamics::QUIET).unwrap_err()
    };
    let step = refused(Schedule { step: 0.0, ..SCHEDULE });
    assert_eq!(step, DynamicsError::BadStep { step: 0.0 });
    let transient = refused(Schedule { transient: -1.0, ..SCHEDULE });
    assert_eq!(transient, DynamicsError::BadTime { name: "transient", value: -1.0 });
    let average = refused(Schedule { average: 0.0, ..SCHEDULE });
    assert_eq!(average, DynamicsError::TooFewSamples { samples: 0, needed: 20 });
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn errors_to_a_reference_are_the_pair_errors_with_it(reference in 0usize..6, seed in 0u64..1000) {
        let matrix = six_node();
        let observables = Observables {
            pairs: true,
            reference: Some(reference),
            clusters: vec![vec![0, 1, 5], vec![2, 4]],
            ..Observables::default()
        };
        let schedule = Schedule { transient: 5.0, average: 20.0, ..SCHEDULE };
        let simulation = Simulation { observables, schedule, ..lorenz_network(&matrix) };
        let runs = run(&simulation, &[Replica { epsilon: 1.0, seed }]);
        let errors = errors(&runs[0]);
        for node in 0..6 {
            prop_assert_eq!(errors.to_reference[node].mean, errors.pair(node, reference, 6));
        }
        let mean = [(0, 1), (0, 5), (1, 5)].map(|(i, j)| errors.pair(i, j, 6)).iter().sum::<f64>() / 3.0;
        prop_assert!((errors.within_clusters[0].mean - mean).abs() < 1e-12 * mean);
        prop_assert!((errors.within_clusters[1].mean - errors.pair(2, 4, 6)).abs() < 1e-12);
    }
}
