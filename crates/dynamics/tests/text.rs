//! Equations as text: the bits of compiled ones, one path for every coupling, maps and forced systems.

use std::sync::{Arc, Mutex};

use dynamics::lyapunov::{Integrator, Tangent, Times, master_exponents, spectrum};
use dynamics::{
    Adaptive, AdaptiveOrder, Coupling, DynamicsError, Errors, HindmarshRose, InstructionSet,
    LinearSteps, Lorenz, Method, Native, NodeDynamics, Observables, Observer, Oscillator, Outcome,
    QUIET, Record, Replica, Rossler, Schedule, Series, Simulation, SparseMatrix, Text, Within,
};
use equations::{Description, Kind, System};

fn system(kind: Kind, equations: &[(&'static str, &str)], parameters: &[(&str, f64)]) -> System {
    let components = match kind {
        Kind::Coupling => vec!["x", "y", "z"],
        Kind::Flow | Kind::Map => equations.iter().map(|(component, _)| *component).collect(),
    };
    let description = Description {
        kind,
        components,
        equations: equations.to_vec(),
        parameters: parameters.to_vec(),
        ..Description::default()
    };
    System::read(&description).unwrap()
}

fn flow(
    equations: &[(&'static str, &str)],
    parameters: &[(&str, f64)],
    start: &[[f64; 2]],
) -> Text {
    Text::new(&system(Kind::Flow, equations, parameters), start.to_vec())
}

/// Compiled oscillators and their equations as text.
fn twins() -> Vec<(Arc<dyn NodeDynamics>, Text)> {
    let lorenz = [("x", "(y - x)*alpha"), ("y", "x*(r - z) - y"), ("z", "x*y - z*b")];
    let rossler = [("x", "-(y + z)"), ("y", "x + y*a"), ("z", "z*(x - c) + b")];
    let neuron = [
        ("x", "y + x^2*(3 - x) - z + current"),
        ("y", "1 - x^2*5 - y"),
        ("z", "((x + 1.6)*s - z)*r"),
    ];
    vec![
        (
            Arc::new(Native::new(Lorenz::default())),
            flow(&lorenz, &[("alpha", 10.0), ("r", 35.0), ("b", 8.0 / 3.0)], &Lorenz::START),
        ),
        (
            Arc::new(Native::new(Rossler::default())),
            flow(&rossler, &[("a", 0.2), ("b", 0.2), ("c", 9.0)], &Rossler::START),
        ),
        (
            Arc::new(Native::new(HindmarshRose::default())),
            flow(&neuron, &[("r", 0.006), ("s", 4.0), ("current", 3.2)], &HindmarshRose::START),
        ),
    ]
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

/// Two nodes that drive each other.
fn pair_of_nodes() -> SparseMatrix {
    let mut entries = sprs::TriMatI::<f64, u32>::new((2, 2));
    for (i, j, w) in [(0, 0, -1.0), (0, 1, 1.0), (1, 0, 1.0), (1, 1, -1.0)] {
        entries.add_triplet(i, j, w);
    }
    entries.to_csr()
}

fn simulation<'a>(
    dynamics: Arc<dyn NodeDynamics>,
    coupling: &Coupling,
    matrix: &'a SparseMatrix,
) -> Simulation<'a> {
    let (method, step) =
        if dynamics.is_map() { (Method::Iterate, 1.0) } else { (Method::Rk4, 0.01) };
    Simulation {
        dynamics,
        coupling: coupling.clone(),
        matrix,
        method,
        schedule: Schedule { step, transient: 500.0 * step, average: 2000.0 * step, stride: 10 },
        observables: Observables { pairs: true, ..Observables::default() },
        series: None,
        kick: 0.0,
        instruction_set: InstructionSet::best(),
    }
}

fn outcomes(simulation: &Simulation<'_>, epsilon: &[f64]) -> Vec<Outcome> {
    let replicas: Vec<Replica> =
        epsilon.iter().map(|&epsilon| Replica { epsilon, seed: 3 }).collect();
    let runs = simulation.run(&replicas, QUIET).expect("the schedule is sound");
    runs.into_iter().map(|run| run.outcome).collect()
}

fn completed(simulation: &Simulation<'_>, epsilon: &[f64]) -> Vec<Errors> {
    let errors = |outcome| match outcome {
        Outcome::Completed(errors) => errors,
        other => panic!("{other:?}"),
    };
    outcomes(simulation, epsilon).into_iter().map(errors).collect()
}

const SHORT: Times = Times {
    integrator: Integrator::Rk4,
    step: 0.01,
    transient: 5.0,
    average: 50.0,
    renormalise: 0.5,
};

fn tangents(sigma: impl Iterator<Item = f64>) -> Vec<Tangent> {
    sigma.zip(0u64..).map(|(sigma, k)| Tangent { sigma, seed: k / 8 }).collect()
}

#[test]
fn text_has_the_bits_of_compiled_equations() {
    let rotation = Coupling::matrix(&[vec![0.6, 0.0, 0.8], vec![0.0; 3], vec![-0.8, 0.0, 0.6]]);
    let epsilon: Vec<f64> = (0..19).map(|k| 0.01 * f64::from(k)).collect();
    let tangents = tangents((0..21).map(|k| 0.2 * f64::from(k)));
    let matrix = ring(11);
    for (native, text) in twins() {
        let text: Arc<dyn NodeDynamics> = Arc::new(text);
        assert_eq!(spectrum(&*native, &SHORT, 1).unwrap(), spectrum(&*text, &SHORT, 1).unwrap());
        for coupling in [Coupling::pair(0, 1), rotation.clone()] {
            let exponents = |dynamics: &dyn NodeDynamics| {
                master_exponents(dynamics, &coupling, &SHORT, &tangents, QUIET).unwrap()
            };
            assert_eq!(exponents(&*native), exponents(&*text));
            let errors = |dynamics: &Arc<dyn NodeDynamics>| {
                completed(&simulation(dynamics.clone(), &coupling, &matrix), &epsilon)
            };
            assert_eq!(errors(&native), errors(&text));
        }
    }
}

#[test]
fn a_component_as_a_formula_couples_as_the_component_does() {
    let formulas = |equations: &[(&'static str, &str)]| {
        Coupling::formulas(&system(Kind::Coupling, equations, &[]))
    };
    let both = [
        (formulas(&[("y", "x")]), Coupling::pair(0, 1)),
        (
            formulas(&[("x", "x"), ("z", "z")]),
            Coupling::matrix(&[vec![1.0, 0.0, 0.0], vec![0.0; 3], vec![0.0, 0.0, 1.0]]),
        ),
    ];
    let matrix = ring(11);
    let lorenz: Arc<dyn NodeDynamics> = Arc::new(Native::new(Lorenz::default()));
    let tangents = tangents((0..20).map(|k| 0.5 * f64::from(k)));
    for (formula, linear) in both {
        let of = |coupling: &Coupling| {
            let steps = LinearSteps::along_orbit(&*lorenz, coupling, 0.01, 1).unwrap();
            (
                completed(&simulation(lorenz.clone(), coupling, &matrix), &[0.3, 1.7, 2.9]),
                master_exponents(&*lorenz, coupling, &SHORT, &tangents, QUIET).unwrap(),
                steps.stable_up_to(1e5, (Method::Rk4, 0.01)),
            )
        };
        assert_eq!(of(&formula), of(&linear));
        let adaptive = Method::Adaptive(Adaptive {
            order: AdaptiveOrder::Eight,
            relative_tolerance: 1e-9,
            absolute_tolerance: 1e-9,
        });
        let of = |coupling: &Coupling| {
            let simulation = simulation(lorenz.clone(), coupling, &matrix);
            completed(&Simulation { method: adaptive, ..simulation }, &[1.7])
        };
        assert_eq!(of(&formula), of(&linear));
    }
}

fn logistic(r: f64) -> Text {
    Text::new(&system(Kind::Map, &[("x", "r*x*(1 - x)")], &[("r", r)]), vec![[0.1, 0.9]])
}

/// The state as it will be, sent to the others: x_i' = F(x_i) + ε Σ_j w_ij F(x_j).
fn through_itself(formula: &str) -> Coupling {
    let description = Description {
        kind: Kind::Coupling,
        components: vec!["x"],
        equations: vec![("x", formula)],
        ..Description::default()
    };
    Coupling::formulas(&System::read(&description).unwrap())
}

#[test]
fn the_logistic_map_coupled_through_itself_has_the_exponent_in_closed_form() {
    // δ' = (1 − σ) F'(s) δ: Λ(σ) = ln|1 − σ| + ln 2.
    let times = Times {
        integrator: Integrator::Rk4,
        step: 1.0,
        transient: 100.0,
        average: 40_000.0,
        renormalise: 1.0,
    };
    let tangents = tangents([0.0, 0.25, 0.5, 0.75, 1.5, 1.9, 3.0, 1e6].into_iter());
    let coupling = through_itself("4*x*(1 - x)");
    let exponents = master_exponents(&logistic(4.0), &coupling, &times, &tangents, QUIET).unwrap();
    for (exponent, Tangent { sigma, .. }) in exponents.iter().zip(&tangents) {
        let expected = (1.0 - sigma).abs().ln() + 2f64.ln();
        let allowed = 4.0 * exponent.standard_error + 1e-4;
        assert!((exponent.mean - expected).abs() < allowed, "{sigma}: {exponent:?}, {expected}");
    }
}

#[test]
fn tangents_that_vanish_or_grow_beyond_all_numbers_are_answered() {
    let coupling = through_itself("4*x*(1 - x)");
    let of = |sigma: f64, renormalise: f64| {
        let times = Times {
            integrator: Integrator::Rk4,
            step: 1.0,
            transient: 100.0,
            average: 40_000.0,
            renormalise,
        };
        let tangents = [Tangent { sigma, seed: 1 }];
        master_exponents(&logistic(4.0), &coupling, &times, &tangents, QUIET)
    };
    // At σ = 1 nothing is left after one step: as small as a number can be.
    let smallest = f64::MIN_POSITIVE.ln();
    assert!((of(1.0, 1.0).unwrap()[0].mean - smallest).abs() < 1e-9);
    // Far below the root of the smallest number a length is still known.
    let sigma = 1.0 - 1e-13;
    let (found, expected) = (of(sigma, 13.0).unwrap()[0].mean, (1.0 - sigma).ln() + 2f64.ln());
    assert!((found - expected).abs() < 0.02, "{found}, expected {expected}");
    assert!(matches!(of(1e300, 2.0), Err(DynamicsError::Overflow { sigma: 1e300 })));
}

#[test]
fn two_logistic_maps_synchronise_where_the_exponent_says() {
    // λ = −2, σ = 2ε: stable for 1/2 < σ < 3/2.
    let matrix = pair_of_nodes();
    let coupling = through_itself("4*x*(1 - x)");
    let simulation = simulation(Arc::new(logistic(4.0)), &coupling, &matrix);
    let kicked = Simulation { kick: 1e-14, ..simulation };
    let epsilon = [0.2, 0.24, 0.27, 0.5, 0.73, 0.76];
    let together: Vec<bool> =
        completed(&kicked, &epsilon).iter().map(|e| e.pairs[0].mean < 1e-6).collect();
    assert_eq!(together, [false, false, true, true, true, false]);
}

/// Keeps the states of a series, replica by replica.
struct Kept(Vec<Mutex<Vec<f64>>>);

impl Observer for Kept {
    fn recorded(&self, replica: usize, record: &Record<'_>) {
        self.0[replica].lock().unwrap().extend_from_slice(record.states);
    }
}

#[test]
fn maps_go_from_state_to_state_as_by_hand_in_any_lanes_and_strides() {
    let matrix = pair_of_nodes();
    let coupling = through_itself("x^2");
    for (n_replicas, stride) in [(1, 1), (2, 3), (3, 2), (8, 1), (16, 3)] {
        let mut simulation = simulation(Arc::new(logistic(3.7)), &coupling, &matrix);
        let average = f64::from(20 * stride);
        simulation.schedule = Schedule { step: 1.0, transient: 0.0, average, stride };
        simulation.series = Some(Series { from: Some(0.0), ..Series::of(vec![0, 1]) });
        let epsilon: Vec<f64> = (0..n_replicas).map(|k| 0.001 * f64::from(k)).collect();
        let replica = |&epsilon: &f64| Replica { epsilon, seed: 3 }.into();
        let kept = Kept(epsilon.iter().map(|_| Mutex::default()).collect());
        simulation.run_observed(epsilon.iter().map(replica).collect(), &kept).unwrap();
        for (states, &epsilon) in kept.0.iter().zip(&epsilon) {
            let states = states.lock().unwrap();
            let (states, _) = states.as_chunks::<2>();
            assert_eq!(states.len(), 21);
            for pair in states.windows(2) {
                let mut by_hand = pair[0];
                for _ in 0..stride {
                    let [a, b] = by_hand.map(|x| x * x);
                    let next = |x: f64, input: f64| 3.7 * x * (1.0 - x) + epsilon * input;
                    by_hand = [next(by_hand[0], b - a), next(by_hand[1], a - b)];
                }
                for (found, expected) in pair[1].iter().zip(by_hand) {
                    assert!((found - expected).abs() < 1e-13, "{epsilon}: {pair:?}, {by_hand:?}");
                }
            }
        }
    }
}

#[test]
fn a_clock_is_neither_perturbed_nor_does_it_escape() {
    // ẋ = −x + sin t is contracting: every pair synchronises, and Λ(0) = −1, whatever t does.
    let forced = [("x", "-x + sin(t)")];
    let text = flow(&forced, &[], &[[-5.0, 5.0]]);
    assert_eq!(text.components(), ["x", "t"]);
    assert_eq!((text.start().len(), text.n_free()), (2, 1));
    let exponents = master_exponents(
        &text,
        &Coupling::pair(0, 0),
        &SHORT,
        &tangents([0.0, 0.5].into_iter()),
        QUIET,
    )
    .unwrap();
    for (exponent, expected) in exponents.iter().zip([-1.0, -1.5]) {
        assert!((exponent.mean - expected).abs() < 1e-6, "{exponent:?}");
    }
    let matrix = pair_of_nodes();
    // Time runs to 25, further than orbits may go.
    let within = Arc::new(Within::new(Arc::new(text), 10.0));
    let mut simulation = simulation(within, &Coupling::pair(0, 0), &matrix);
    simulation.schedule.transient = 15.0;
    simulation.kick = 1e-3;
    let errors = completed(&simulation, &[0.0]);
    assert!(errors[0].pairs[0].mean < 0.01, "{errors:?}");
}

#[test]
fn the_radius_of_escape_is_that_of_the_equations() {
    let lorenz: Arc<dyn NodeDynamics> = Arc::new(Native::new(Lorenz::default()));
    let matrix = ring(11);
    for (radius, escapes) in [(10.0, true), (100.0, false)] {
        let within: Arc<dyn NodeDynamics> = Arc::new(Within::new(lorenz.clone(), radius));
        let coupling = Coupling::pair(0, 1);
        let simulation = simulation(within.clone(), &coupling, &matrix);
        let outcome = &outcomes(&simulation, &[0.1])[0];
        assert_eq!(matches!(outcome, Outcome::Escaped { .. }), escapes, "{outcome:?}");
        let exponents =
            master_exponents(&*within, &coupling, &SHORT, &tangents([1.0].into_iter()), QUIET);
        assert_eq!(matches!(exponents, Err(DynamicsError::Escaped { .. })), escapes);
    }
}

#[test]
fn a_map_is_not_integrated_and_a_flow_is_not_iterated() {
    let (matrix, coupling) = (pair_of_nodes(), through_itself("x"));
    let map = simulation(Arc::new(logistic(3.7)), &coupling, &matrix);
    let refused = |simulation: &Simulation<'_>| simulation.run(&[], QUIET).unwrap_err();
    let integrated = Simulation { method: Method::Rk4, ..map.clone() };
    assert_eq!(refused(&integrated), DynamicsError::WrongMethod { is_map: true });
    let halved = Schedule { step: 0.5, ..map.schedule };
    let halved = Simulation { schedule: halved, ..map };
    assert_eq!(refused(&halved), DynamicsError::StepOfMap { step: 0.5 });
    let rossler: Arc<dyn NodeDynamics> = Arc::new(Native::new(Rossler::default()));
    let iterated = Simulation {
        method: Method::Iterate,
        ..simulation(rossler, &Coupling::pair(0, 0), &matrix)
    };
    assert_eq!(refused(&iterated), DynamicsError::WrongMethod { is_map: false });
    let exponents = spectrum(&logistic(3.7), &SHORT, 1).unwrap_err();
    assert_eq!(exponents, DynamicsError::StepOfMap { step: 0.01 });
}
