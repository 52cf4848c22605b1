//! Stable sets of all pairs of components over many systems, each held against another way to them: on
//! limit cycles the multipliers of `oracle/floquet.py`, in chaos a scan of many σ on orbits of their own.
//!
//! EIGENSYNC_LONG_TESTS=1 runs all and prints the tables of `docs/coverage.md`.

mod oracle;

use std::sync::Arc;

use dynamics::lyapunov::{Integrator, Tangent, Times, master_exponents};
use dynamics::{Closes, Coupling, Estimate, HindmarshRose, InstructionSet, Lorenz, Model, Rossler};
use msf::{MasterStability, Node, Refinement, Request, master_stability};

const NAMES: [&str; 3] = ["x", "y", "z"];

fn is_long() -> bool {
    std::env::var_os("EIGENSYNC_LONG_TESTS").is_some()
}

fn found(node: &Node, times: Times, relative_error: f64) -> MasterStability {
    let request = Request {
        sigma: Vec::new(),
        times,
        refinement: Refinement { relative_error, max_rounds: 8 },
        seed: 3,
        instruction_set: InstructionSet::best(),
    };
    master_stability(node, &request, dynamics::QUIET).expect("it can be computed")
}

fn in_words(msf: &MasterStability) -> String {
    let interval = |i: &msf::Interval| match i.upper() {
        Some(to) => format!("{:.4} to {to:.4}", i.lower()),
        None => format!("above {:.4}", i.lower()),
    };
    let each: Vec<String> = msf.stable.intervals.iter().map(interval).collect();
    if each.is_empty() { "none".into() } else { each.join(", ") }
}

#[test]
fn stable_sets_of_limit_cycles_are_those_of_multipliers_computed_elsewhere() {
    let every = if is_long() { 1 } else { 6 };
    for case in oracle::cases().into_iter().step_by(every) {
        let [from, to] = case.pair;
        let node = Node { dynamics: Arc::new(case.model), coupling: Coupling::pair(from, to) };
        let times = Times {
            integrator: Integrator::Rk4,
            step: 0.01,
            transient: 100.0,
            average: 1000.0,
            renormalise: 0.5,
        };
        let msf = found(&node, times, 1e-3);
        let what = format!("{:?} {} into {}", case.model, NAMES[from], NAMES[to]);
        let Some(Closes::AfterPeriod { period }) = msf.closes else {
            panic!("{what}: {:?}", msf.closes)
        };
        assert!((period / case.period - 1.0).abs() < 1e-7, "{what}: {period}");
        let zeros: Vec<f64> =
            msf.stable.zeros().map(|zero| zero.sigma).filter(|&s| s < oracle::LAST).collect();
        // Exponents are known to some 1e-11 there, over slopes down to 1e-3.
        let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-6 * b;
        assert!(
            msf.stable.contains(1e-3) == case.begins_stable
                && zeros.len() == case.zeros.len()
                && zeros.iter().zip(&case.zeros).all(near),
            "{what}: {zeros:?} against {:?}",
            case.zeros
        );
        println!(
            "| {:?} | {} into {} | {} | holds |",
            case.model,
            NAMES[from],
            NAMES[to],
            in_words(&msf)
        );
    }
}

/// Chaotic parameter sets.
fn chaotic() -> Vec<Model> {
    let lorenz = |alpha, r, b| Model::Lorenz(Lorenz { alpha, r, b });
    let rossler = |a, b, c| Model::Rossler(Rossler { a, b, c });
    let neuron =
        |current| Model::HindmarshRose(HindmarshRose { current, ..HindmarshRose::default() });
    vec![
        lorenz(10.0, 28.0, 8.0 / 3.0),
        lorenz(10.0, 28.0, 2.0),
        lorenz(10.0, 35.0, 8.0 / 3.0),
        lorenz(10.0, 60.0, 8.0 / 3.0),
        lorenz(16.0, 45.92, 4.0),
        rossler(0.2, 0.2, 9.0),
        rossler(0.2, 0.2, 5.7),
        rossler(0.15, 0.2, 10.0),
        rossler(0.1, 0.1, 14.0),
        neuron(3.2),
        neuron(3.1),
    ]
}

/// Signs of Λ at eight σ to an octave, on two orbits that no other exponent has, where both are beyond
/// doubt.
fn scan(node: &Node, last: f64) -> Vec<(f64, bool)> {
    let times = Times {
        integrator: Integrator::Rk4,
        step: 0.01,
        transient: 500.0,
        average: 3000.0,
        renormalise: 0.5,
    };
    let sigmas: Vec<f64> =
        (0..).map(|k| last * 0.5f64.powf(f64::from(k) / 8.0)).take_while(|&s| s > 1e-3).collect();
    let signs = [901, 902].map(|seed| {
        let tangents: Vec<Tangent> = sigmas.iter().map(|&sigma| Tangent { sigma, seed }).collect();
        let dynamics = node.dynamics.as_ref();
        let exponents =
            master_exponents(dynamics, &node.coupling, &times, &tangents, dynamics::QUIET);
        exponents.expect("it can be computed").into_iter().map(certain).collect::<Vec<_>>()
    });
    let both = |k: usize| signs[0][k].filter(|_| signs[0][k] == signs[1][k]);
    (0..sigmas.len()).filter_map(|k| Some((sigmas[k], both(k)?))).collect()
}

fn certain(lambda: Estimate) -> Option<bool> {
    let error = lambda.standard_error.hypot(1.0 / 3000.0);
    (lambda.mean.abs() > 4.0 * error).then_some(lambda.mean < 0.0)
}

#[test]
fn stable_sets_in_chaos_are_those_of_a_scan_of_many_sigma() {
    let models = if is_long() { chaotic() } else { chaotic()[..1].to_vec() };
    let mut wrong = Vec::new();
    for model in models {
        let pairs = (0..3).flat_map(|from| (0..3).map(move |to| [from, to]));
        for [from, to] in pairs.filter(|&pair| is_long() || pair == [0, 0]) {
            let node = Node { dynamics: Arc::new(model), coupling: Coupling::pair(from, to) };
            let times = Times {
                integrator: Integrator::Rk4,
                step: 0.01,
                transient: 500.0,
                average: 4000.0,
                renormalise: 0.5,
            };
            let msf = found(&node, times, 0.02);
            let scan = scan(&node, msf.looked.to);
            // A zero is where it is within its error.
            let near_zero = |sigma: f64| {
                let within = |zero: msf::Zero| {
                    (sigma - zero.sigma).abs() <= 4.0 * zero.standard_error + 0.01 * zero.sigma
                };
                msf.stable.zeros().any(within)
            };
            let differs = |(sigma, negative): &&(f64, bool)| {
                msf.stable.contains(*sigma) != *negative && !near_zero(*sigma)
            };
            let off: Vec<&(f64, bool)> = scan.iter().filter(differs).collect();
            let verdict = if off.is_empty() { "holds" } else { "differs" };
            println!(
                "| {model:?} | {} into {} | {} | {:.0} | {} | {verdict} |",
                NAMES[from],
                NAMES[to],
                in_words(&msf),
                msf.looked.to,
                scan.len()
            );
            if !off.is_empty() {
                wrong.push(format!("{model:?} {from} into {to}: {off:?}, {:?}", msf.stable));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
