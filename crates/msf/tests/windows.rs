//! Windows of stable σ that nobody points at, on limit cycles and in chaos: known from multipliers that
//! another program computed, and from simulations.

use std::sync::Arc;

use dynamics::lyapunov::{Integrator, Times};
use dynamics::{Closes, Coupling, HindmarshRose, InstructionSet, Lorenz, Model, Rossler};
use msf::{End, MasterStability, Node, Refinement, Request, master_stability};

/// A window of stable σ, without an upper end where none was found.
type Window = (f64, Option<f64>);

/// What is found where nobody says where to look, in short averages.
fn found(
    model: Model,
    [from, to]: [usize; 2],
    (transient, average): (f64, f64),
) -> MasterStability {
    let node = Node { dynamics: Arc::new(model), coupling: Coupling::pair(from, to) };
    let request = Request {
        sigma: Vec::new(),
        times: Times {
            integrator: Integrator::Rk4,
            step: 0.01,
            transient,
            average,
            renormalise: 0.5,
        },
        refinement: Refinement { relative_error: 0.003, ..Refinement::default() },
        seed: 1,
        instruction_set: InstructionSet::best(),
    };
    master_stability(&node, &request, dynamics::QUIET).expect("the request is sound")
}

fn windows(msf: &MasterStability) -> Vec<Window> {
    msf.stable.intervals.iter().map(|interval| (interval.lower(), interval.upper())).collect()
}

fn assert_windows(msf: &MasterStability, expected: &[Window], within: f64) {
    let found = windows(msf);
    let near = |a: f64, b: f64| (a - b).abs() <= within * b.max(1e-12);
    let ends = |(a, b): (&Window, &Window)| {
        near(a.0, b.0)
            && match (a.1, b.1) {
                (Some(a), Some(b)) => near(a, b),
                (a, b) => a == b,
            }
    };
    assert!(
        found.len() == expected.len() && found.iter().zip(expected).all(ends),
        "{found:?} against {expected:?}"
    );
}

fn hindmarsh_rose(current: f64) -> Model {
    Model::HindmarshRose(HindmarshRose { current, ..HindmarshRose::default() })
}

fn rossler(a: f64, b: f64, c: f64) -> Model {
    Model::Rossler(Rossler { a, b, c })
}

const SHORT: (f64, f64) = (50.0, 400.0);

#[test]
fn windows_of_limit_cycles_are_those_of_their_multipliers() {
    let cases: [(Model, [usize; 2], &[Window]); 7] = [
        (
            rossler(0.2, 2.0, 5.7),
            [2, 0],
            &[(0.0, Some(0.40718)), (1.70833, Some(9.04643)), (12.63808, Some(113.40329))],
        ),
        (rossler(0.2, 2.0, 5.7), [0, 1], &[(0.33550, Some(0.41365))]),
        (hindmarsh_rose(4.0), [2, 2], &[(0.0, Some(0.0248411)), (0.0874894, Some(1.678745))]),
        (hindmarsh_rose(4.0), [2, 0], &[(0.0, Some(0.225105)), (101.72084, None)]),
        (rossler(0.2, 0.2, 2.5), [2, 2], &[(2.42616405, Some(3.50173731))]),
        (rossler(0.2, 0.2, 2.5), [0, 0], &[(0.0, Some(4.07572196))]),
        (Model::Lorenz(Lorenz { alpha: 10.0, r: 160.0, b: 8.0 / 3.0 }), [1, 1], &[(0.0, None)]),
    ];
    for (model, pair, expected) in cases {
        let msf = found(model, pair, SHORT);
        assert!(
            matches!(msf.closes, Some(Closes::AfterPeriod { .. })),
            "{model:?} {:?}",
            msf.closes
        );
        assert_windows(&msf, expected, 2e-5);
        for zero in msf.stable.zeros() {
            assert!(zero.refined && zero.standard_error < 1e-7 * zero.sigma, "{zero:?}");
        }
    }
}

#[test]
fn a_window_that_begins_beyond_sigma_of_fifty_is_found() {
    // Hindmarsh–Rose, z into x: above 74.7.
    let msf = found(hindmarsh_rose(3.2), [2, 0], (500.0, 1500.0));
    assert_windows(&msf, &[(74.7, None)], 0.05);
    assert!(matches!(msf.stable.intervals[0].to, End::Looked { sigma } if sigma > 100.0));
}

#[test]
fn a_window_that_ends_where_lambda_hardly_differs_from_zero_is_found() {
    if std::env::var_os("EIGENSYNC_LONG_TESTS").is_none() {
        eprintln!("skipped: set EIGENSYNC_LONG_TESTS=1 (two minutes)");
        return;
    }
    // Rössler (0.15, 0.2, 10), y into y: from 0.17 to about 55, beyond which Λ stays below 0.02.
    let msf = found(rossler(0.15, 0.2, 10.0), [1, 1], (500.0, 4e4));
    assert_windows(&msf, &[(0.1695, Some(55.0))], 0.06);
}
