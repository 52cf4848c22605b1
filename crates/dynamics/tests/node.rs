//! The contract of node dynamics: compiled equations and equations chosen at run time go through the
//! same operations, whatever H = B h is, and anybody's own oscillator is as good as a built-in one.

use std::sync::Arc;

use dynamics::lyapunov::{Integrator, Tangent, Times, master_exponents, spectrum};
use dynamics::{
    Adaptive, AdaptiveOrder, Coupling, Errors, HindmarshRose, InstructionSet, Linearised,
    LinearisedMut, Lorenz, Method, Native, NodeDynamics, Observables, Oscillator, Outcome, Replica,
    Rossler, Scalar, Schedule, Simulation, SparseMatrix,
};

/// Equations of which only the flow and its tangent are known, as those of a program are.
#[derive(Debug)]
struct ByFlow<N>(N);

impl<N: NodeDynamics> NodeDynamics for ByFlow<N> {
    fn components(&self) -> Vec<&str> {
        self.0.components()
    }

    fn start(&self) -> &[[f64; 2]] {
        self.0.start()
    }

    fn flow(&self, set: InstructionSet, x: &[&[f64]], slope: &mut [&mut [f64]]) {
        self.0.flow(set, x, slope);
    }

    fn tangent_flow(&self, set: InstructionSet, at: Linearised<'_>, slope: LinearisedMut<'_, '_>) {
        self.0.tangent_flow(set, at, slope);
    }
}

/// Somebody's own oscillator: a Stuart–Landau limit cycle, ż = (1 + iω)z − |z|²z.
#[derive(Clone, Copy, Debug)]
struct StuartLandau {
    omega: f64,
}

impl Oscillator<2> for StuartLandau {
    const COMPONENTS: [&'static str; 2] = ["x", "y"];
    const START: [[f64; 2]; 2] = [[-1.0, 1.0], [-1.0, 1.0]];

    #[inline(always)]
    fn flow<S: Scalar>(&self, [x, y]: [S; 2]) -> [S; 2] {
        let growth = S::from(1.0) - (x * x + y * y);
        [growth * x - y * self.omega, growth * y + x * self.omega]
    }
}

/// A ring of nodes with the two nearest on either side.
fn ring(n_nodes: usize) -> SparseMatrix {
    let mut entries = sprs::TriMatI::<f64, u32>::new((n_nodes, n_nodes));
    for node in 0..n_nodes {
        for step in [1, 2, n_nodes - 2, n_nodes - 1] {
            entries.add_triplet(node, (node + step) % n_nodes, 1.0);
        }
        entries.add_triplet(node, node, -4.0);
    }
    entries.to_csr()
}

fn simulate(
    dynamics: Arc<dyn NodeDynamics>,
    coupling: &Coupling,
    method: Method,
    epsilon: &[f64],
) -> Vec<Errors> {
    let matrix = ring(11);
    let simulation = Simulation {
        dynamics,
        coupling: coupling.clone(),
        matrix: &matrix,
        method,
        schedule: Schedule { step: 0.01, transient: 5.0, average: 20.0, stride: 10 },
        observables: Observables { pairs: true, ..Observables::default() },
        series: None,
        kick: 0.0,
        instruction_set: InstructionSet::best(),
    };
    let replicas: Vec<Replica> =
        epsilon.iter().map(|&epsilon| Replica { epsilon, seed: 3 }).collect();
    let runs = simulation.run(&replicas, dynamics::QUIET).expect("the schedule is sound");
    let errors = |outcome| match outcome {
        Outcome::Completed(errors) => errors,
        other => panic!("{other:?}"),
    };
    runs.into_iter().map(|run| errors(run.outcome)).collect()
}

/// x and z rotated into the equations of x and z.
fn rotation() -> Coupling {
    Coupling::matrix(&[vec![0.6, 0.0, 0.8], vec![0.0; 3], vec![-0.8, 0.0, 0.6]])
}

#[test]
fn equations_chosen_at_run_time_give_the_bits_of_compiled_ones() {
    let epsilon: Vec<f64> = (0..19).map(|k| 0.01 * f64::from(k)).collect();
    macro_rules! check {
        ($($oscillator:expr),*) => {$(
            for coupling in [Coupling::pair(0, 1), rotation()] {
                let compiled = Native::new($oscillator);
                let of = |dynamics| simulate(dynamics, &coupling, Method::Rk4, &epsilon);
                assert_eq!(of(Arc::new(compiled)), of(Arc::new(ByFlow(compiled))), "{compiled:?}");
                let times = Times { integrator: Integrator::Rk4, step: 0.01, transient: 5.0, average: 50.0, renormalise: 0.5 };
                let tangents: Vec<Tangent> = (0..21u64)
                    .map(|k| Tangent { sigma: 0.2 * k as f64, seed: k / 8 })
                    .collect();
                let of = |dynamics: &dyn NodeDynamics| {
                    master_exponents(dynamics, &coupling, &times, &tangents, dynamics::QUIET).unwrap()
                };
                assert_eq!(of(&compiled), of(&ByFlow(compiled)), "{compiled:?}");
            }
        )*};
    }
    check!(Lorenz::default(), HindmarshRose::default(), Rossler::default());
}

#[test]
fn coupling_all_components_alike_takes_sigma_from_every_exponent() {
    // DF − σ 1 has the exponents of DF less σ.
    let identity: Vec<Vec<f64>> =
        (0..3).map(|d| (0..3).map(|c| f64::from(u8::from(c == d))).collect()).collect();
    let lorenz = Native::new(Lorenz::default());
    let times = Times {
        integrator: Integrator::Rk4,
        step: 0.005,
        transient: 20.0,
        average: 100.0,
        renormalise: 0.5,
    };
    let tangents = [0.0, 0.5, 2.0, 7.0].map(|sigma| Tangent { sigma, seed: 1 });
    let exponents =
        master_exponents(&lorenz, &Coupling::matrix(&identity), &times, &tangents, dynamics::QUIET)
            .unwrap();
    for (exponent, Tangent { sigma, .. }) in exponents.iter().zip(tangents) {
        let expected = exponents[0].mean - sigma;
        assert!((exponent.mean - expected).abs() < 1e-4, "{exponent:?} against {expected}");
    }
}

#[test]
fn a_coupling_matrix_is_what_the_adaptive_method_integrates_too() {
    let method = Method::Adaptive(Adaptive {
        order: AdaptiveOrder::Eight,
        relative_tolerance: 1e-10,
        absolute_tolerance: 1e-10,
    });
    let dynamics = || Arc::new(Native::new(Rossler::default()));
    // Synchronised fast, and over a short time, before chaos tells the methods apart.
    let [in_steps, adaptive] =
        [Method::Rk4, method].map(|method| simulate(dynamics(), &rotation(), method, &[0.05]));
    for (a, b) in in_steps[0].pairs.iter().zip(&adaptive[0].pairs) {
        assert!((a.mean - b.mean).abs() < 1e-3 * (1e-3 + b.mean), "{a:?} against {b:?}");
    }
}

#[test]
fn an_oscillator_of_ones_own_has_its_exponents_and_synchronises() {
    let mine = Native::new(StuartLandau { omega: 2.0 });
    let times = Times {
        integrator: Integrator::Rk4,
        step: 0.01,
        transient: 50.0,
        average: 200.0,
        renormalise: 0.5,
    };
    // Along the cycle 0, across it −2.
    let exponents = spectrum(&mine, &times, 1).unwrap();
    assert!(exponents[0].mean.abs() < 1e-3, "{exponents:?}");
    assert!((exponents[1].mean + 2.0).abs() < 1e-3, "{exponents:?}");
    let both = Coupling::matrix(&[vec![1.0, 0.0], vec![0.0, 1.0]]);
    let errors = simulate(Arc::new(mine), &both, Method::Rk4, &[0.0, 1.0]);
    let largest = |errors: &Errors| errors.pairs.iter().map(|e| e.mean).fold(0.0, f64::max);
    assert!(
        largest(&errors[0]) > 0.5 && largest(&errors[1]) < 0.05,
        "{:?}",
        errors.iter().map(largest).collect::<Vec<_>>()
    );
}
