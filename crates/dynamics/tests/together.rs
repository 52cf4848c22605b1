//! Several threads that advance one network together: large enough, and few enough replicas, that a
//! simulation has them do so.

mod common;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use dynamics::{
    Coupling, DynamicsError, InstructionSet, Lorenz, Method, Model, Native, Next, NodeDynamics,
    Observables, Observer, Oscillator, Outcome, QUIET, ROUNDING_KICK, Scalar, Schedule, Simulation,
    SparseMatrix, Start,
};
use equations::{Description, Kind, System};

use common::{interrupted, on_threads, replicas};

const N: usize = 240;

/// Nodes on a ring, each linked to the thirty that follow it, with weights: fourteen thousand terms.
fn large() -> SparseMatrix {
    let mut entries = sprs::TriMatI::<f64, u32>::new((N, N));
    for i in 0..N {
        for distance in 1..=30 {
            let (j, weight) = ((i + distance) % N, 0.01 + 0.0001 * ((i * distance) % 7) as f64);
            for (from, to) in [(i, j), (j, i)] {
                entries.add_triplet(from, to, weight);
                entries.add_triplet(from, from, -weight);
            }
        }
    }
    entries.to_csr()
}

/// 21 samples of transient, 100 of average, kicks at every tenth.
fn lorenz(matrix: &SparseMatrix) -> Simulation<'_> {
    Simulation {
        dynamics: Arc::new(Model::Lorenz(Lorenz::default())),
        coupling: Coupling::pair(0, 1),
        matrix,
        method: Method::Rk4,
        schedule: Schedule { step: 0.02, transient: 2.1, average: 10.0, stride: 5 },
        observables: Observables {
            component: 0,
            pairs: false,
            reference: Some(2),
            clusters: vec![vec![0, 1, 4], vec![2, 239]],
        },
        series: None,
        kick: ROUNDING_KICK,
        instruction_set: InstructionSet::best(),
    }
}

fn outcomes(simulation: &Simulation<'_>, n: u64, threads: usize) -> Vec<Outcome> {
    let runs = on_threads(threads, || simulation.run(&replicas(n), QUIET)).unwrap();
    runs.into_iter().map(|run| run.outcome).collect()
}

/// x(n + 1) = 1 − 1.7 x².
#[derive(Clone, Copy, Debug)]
struct Logistic;

impl Oscillator<1> for Logistic {
    const COMPONENTS: [&'static str; 1] = ["x"];
    const START: [[f64; 2]; 1] = [[-0.5, 0.5]];
    const IS_MAP: bool = true;

    fn flow<S: Scalar>(&self, [x]: [S; 1]) -> [S; 1] {
        [S::from(1.0) - x * x * 1.7]
    }
}

/// Both x and y sent as formulas.
fn formulas() -> Coupling {
    let system = System::read(&Description {
        kind: Kind::Coupling,
        components: vec!["x", "y", "z"],
        equations: vec![("x", "x"), ("y", "y*0.5 + x")],
        ..Description::default()
    });
    Coupling::formulas(&system.expect("these are formulas"))
}

#[test]
fn threads_that_share_a_network_give_the_bits_of_a_single_one() {
    let matrix = large();
    let rk4 = lorenz(&matrix);
    let several = Coupling::matrix(&[vec![0.1, 0.0, 0.2], vec![0.0; 3], vec![0.0, 0.3, 0.1]]);
    let map: Arc<dyn NodeDynamics> = Arc::new(Native::new(Logistic));
    let steps = Schedule { step: 1.0, transient: 20.0, average: 40.0, stride: 1 };
    let simulations = [
        Simulation { method: Method::Dop853, coupling: several, ..rk4.clone() },
        Simulation { coupling: formulas(), ..rk4.clone() },
        Simulation {
            dynamics: map,
            coupling: Coupling::pair(0, 0),
            method: Method::Iterate,
            schedule: steps,
            ..rk4.clone()
        },
        rk4,
    ];
    for simulation in simulations {
        for n in 1..=3 {
            let alone = outcomes(&simulation, n, 1);
            for threads in [2, 3] {
                let together = outcomes(&simulation, n, threads);
                assert_eq!(together, alone, "{:?}, {n} on {threads}", simulation.method);
            }
        }
    }
}

#[test]
fn interrupted_runs_that_threads_share_go_on_to_the_bits_of_undisturbed_ones() {
    let matrix = large();
    let simulation = lorenz(&matrix);
    let (outcomes_after, interruptions) =
        interrupted(&simulation, &replicas(2), |_, _| {}, |_, _| {});
    assert!(interruptions > 0, "no interruption");
    assert_eq!(outcomes_after, outcomes(&simulation, 2, 1));
}

/// Stops at once, or fails.
struct Ends {
    fails: bool,
}

impl Observer for Ends {
    fn advanced(&self, _: &[usize], _: u64) -> Next {
        assert!(!self.fails, "an observer that fails");
        Next::Stop
    }
}

#[test]
fn threads_that_share_a_network_end_when_their_observer_stops_them_or_fails() {
    let matrix = large();
    let simulation = lorenz(&matrix);
    let run = |fails| {
        let starts = replicas(1).into_iter().map(Start::from).collect();
        on_threads(2, || simulation.run_observed(starts, &Ends { fails }))
    };
    assert_eq!(run(false), Err(DynamicsError::Cancelled));
    assert!(catch_unwind(AssertUnwindSafe(|| run(true))).is_err());
}

#[test]
fn an_orbit_that_escapes_leaves_the_others_of_its_batch_alone_when_threads_share_them() {
    /// ẋ = x − 1: from both sides away from 1.
    #[derive(Clone, Copy, Debug)]
    struct Growth;
    impl Oscillator<1> for Growth {
        const COMPONENTS: [&'static str; 1] = ["x"];
        const START: [[f64; 2]; 1] = [[1.0, 2.0]];
        fn flow<S: Scalar>(&self, [x]: [S; 1]) -> [S; 1] {
            [x * 8.0 - 8.0]
        }
    }
    let matrix = large();
    let simulation = Simulation {
        dynamics: Arc::new(Native::new(Growth)),
        coupling: Coupling::pair(0, 0),
        ..lorenz(&matrix)
    };
    let alone = outcomes(&simulation, 3, 1);
    assert!(alone.iter().all(|outcome| matches!(outcome, Outcome::Escaped { .. })), "{alone:?}");
    assert_eq!(outcomes(&simulation, 3, 2), alone);
}
