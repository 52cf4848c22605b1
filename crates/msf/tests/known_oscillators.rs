//! The MSF of oscillators whose stability limits are known from independent computations.
//!
//! The short forms run always; EIGENSYNC_LONG_TESTS=1 runs them long enough to test the numbers.

use std::sync::Arc;

use dynamics::lyapunov::{Integrator, Times};
use dynamics::{Coupling, HindmarshRose, InstructionSet, Lorenz, Model, Rossler};
use msf::{End, Isolated, MasterStability, Node, Refinement, Request, Zero, master_stability};

const LORENZ: Model = Model::Lorenz(Lorenz { alpha: 10.0, r: 35.0, b: 8.0 / 3.0 });
const X_TO_Y: [usize; 2] = [0, 1];
const X_TO_X: [usize; 2] = [0, 0];

fn node(model: Model, [from, to]: [usize; 2]) -> Node {
    Node { dynamics: Arc::new(model), coupling: Coupling::pair(from, to) }
}

fn compute(node: &Node, [from, to]: [f64; 2], points: u32, average: f64) -> MasterStability {
    let step = (to - from) / f64::from(points - 1);
    let request = Request {
        sigma: (0..points).map(|k| from + step * f64::from(k)).collect(),
        times: Times {
            integrator: Integrator::Rk4,
            step: 0.01,
            transient: 500.0,
            average,
            renormalise: 0.5,
        },
        refinement: Refinement::default(),
        seed: 1,
        instruction_set: InstructionSet::best(),
    };
    master_stability(node, &request, dynamics::QUIET).expect("the request is sound")
}

fn long() -> bool {
    std::env::var_os("EIGENSYNC_LONG_TESTS").is_some()
}

fn zeros(msf: &MasterStability) -> Vec<Zero> {
    msf.stable.zeros().collect()
}

fn check_edge(msf: &MasterStability, index: usize, expected: f64, slack: f64) {
    let zero = zeros(msf)[index];
    let allowed = slack + 4.0 * zero.standard_error;
    assert!((zero.sigma - expected).abs() < allowed, "{zero:?} against {expected} ± {allowed}");
}

#[test]
fn lorenz_x_into_y_is_stable_beyond_8_17() {
    let msf = compute(&node(LORENZ, X_TO_Y), [0.0, 12.0], 13, if long() { 2e4 } else { 1e3 });
    assert_eq!(zeros(&msf).len(), 1, "{:?}", msf.stable);
    check_edge(&msf, 0, 8.17, 0.01);
    assert!((msf.isolated.mean - 1.050).abs() < 0.002 + 4.0 * msf.isolated.standard_error);
    assert!(msf.stable.sigma_c().is_some());
}

#[test]
fn rossler_x_into_x_is_stable_in_a_bounded_window() {
    let node = node(Model::Rossler(Rossler::default()), X_TO_X);
    let msf = compute(&node, [0.0, 6.0], 13, if long() { 2e4 } else { 1e3 });
    assert_eq!(zeros(&msf).len(), 2, "{:?}", msf.stable);
    check_edge(&msf, 0, 0.187, 0.001);
    check_edge(&msf, 1, 4.61, 0.02);
    assert_eq!(msf.stable.sigma_c(), None);
}

#[test]
fn hindmarsh_rose_x_into_x_is_stable_beyond_0_943() {
    if !long() {
        eprintln!("skipped: set EIGENSYNC_LONG_TESTS=1 (about two minutes)");
        return;
    }
    let node = node(Model::HindmarshRose(HindmarshRose::default()), X_TO_X);
    let msf = compute(&node, [0.0, 1.6], 9, 2e4);
    assert_eq!(zeros(&msf).len(), 1, "{:?}", msf.stable);
    check_edge(&msf, 0, 0.943, 0.003);
    assert!((msf.isolated.mean - 0.0128).abs() < 0.0002 + 4.0 * msf.isolated.standard_error);
}

#[test]
fn the_curve_does_not_depend_on_the_number_of_threads() {
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| compute(&node(LORENZ, X_TO_Y), [6.0, 10.0], 5, 100.0))
    };
    assert_eq!(on(1), on(2));
}

/// Shorter orbits, a tenth as many points: what is proved here does not need more.
fn quick(model: Model, pair: [usize; 2], sigma: Vec<f64>) -> MasterStability {
    let request = Request {
        sigma,
        times: Times {
            integrator: Integrator::Rk4,
            step: 0.01,
            transient: 200.0,
            average: 1000.0,
            renormalise: 0.5,
        },
        refinement: Refinement { relative_error: 0.02, max_rounds: 12 },
        seed: 1,
        instruction_set: InstructionSet::best(),
    };
    master_stability(&node(model, pair), &request, dynamics::QUIET).expect("the request is sound")
}

#[test]
fn a_grid_that_starts_inside_a_stable_range_finds_the_zero_below_it() {
    let lorenz = Model::Lorenz(Lorenz { alpha: 10.0, r: 28.0, b: 2.0 });
    let msf = quick(lorenz, X_TO_Y, vec![10.0, 15.0, 20.0]);
    let zero = msf.stable.sigma_c().expect("the set is sigma > sigma_c");
    assert!((zero.sigma - 5.13).abs() < 0.02 + 4.0 * zero.standard_error, "{zero:?}");
    assert_eq!(msf.stable.intervals[0].to, End::Looked { sigma: 20.0 });
}

#[test]
fn a_grid_that_starts_above_a_window_finds_the_window() {
    // Rössler, x into x: stable for 0.187 < σ < 4.61.
    let rossler = Model::Rossler(Rossler::default());
    let msf = quick(rossler, X_TO_X, vec![10.0, 11.0, 12.0]);
    assert_eq!((msf.sigma.len(), msf.lambda.len()), (11, 11));
    assert_eq!((msf.sigma[0], msf.sigma[7]), (10.0 / 256.0, 5.0));
    let [low, high] = zeros(&msf)[..] else { panic!("{:?}", msf.stable) };
    assert!(low.falling && (low.sigma - 0.187).abs() < 0.01 + 4.0 * low.standard_error, "{low:?}");
    assert!(
        !high.falling && (high.sigma - 4.61).abs() < 0.1 + 4.0 * high.standard_error,
        "{high:?}"
    );
}

#[test]
fn a_grid_of_cells_thirty_times_as_wide_as_sigma_c_finds_it() {
    let msf = quick(LORENZ, X_TO_Y, vec![0.0, 250.0, 500.0]);
    let zero = msf.stable.sigma_c().expect("the set is sigma > sigma_c");
    assert!(zero.refined, "{zero:?}");
    assert!((zero.sigma - 8.17).abs() < 0.01 + 4.0 * zero.standard_error, "{zero:?}");
}

#[test]
fn a_fixed_point_is_at_rest_and_stable_from_the_origin_on() {
    let rossler = Model::Rossler(Rossler { a: -0.1, b: 0.2, c: 5.0 });
    let msf = quick(rossler, X_TO_X, vec![0.0, 1.0, 2.0]);
    assert_eq!(msf.state, Isolated::AtRest);
    assert_eq!(msf.stable.intervals[0].from, End::Origin { included: true });
    assert!(msf.stable.contains(0.0));
}

#[test]
fn nodes_at_rest_in_two_different_states_are_not_equal_without_coupling() {
    // Lorenz with 1 < r < 24: two fixed points with the same exponents, whatever the coupling x to x.
    let lorenz = Model::Lorenz(Lorenz { alpha: 10.0, r: 10.0, b: 8.0 / 3.0 });
    let msf = quick(lorenz, X_TO_X, vec![0.0, 1.0, 2.0]);
    assert_eq!(msf.state, Isolated::AtRest);
    assert!(msf.rests.len() == 2 && msf.rests.iter().sum::<usize>() == 16, "{:?}", msf.rests);
    assert_eq!(msf.stable.intervals[0].from, End::Origin { included: false });
    assert!(!msf.stable.contains(0.0) && msf.stable.contains(1e-9));
    // z into y tells them apart by Λ too; below r = 1 there is one, the origin.
    let apart = quick(lorenz, [2, 1], vec![0.0, 5.0, 10.0, 15.0]);
    assert_eq!(apart.rests.len(), 2);
    assert!(
        !apart.stable.contains(0.0) && apart.attractors.iter().all(|a| !a.stable.contains(0.0))
    );
    let one = Model::Lorenz(Lorenz { alpha: 10.0, r: 0.5, b: 8.0 / 3.0 });
    let one = quick(one, X_TO_X, vec![0.0, 1.0, 2.0]);
    assert!(one.rests == [16] && one.stable.contains(0.0), "{one:?}");
}

#[test]
fn a_limit_cycle_that_any_coupling_damps_has_no_zero() {
    // Λ(0) = 0; y into y damps at every σ > 0, by Floquet multipliers.
    let lorenz = Model::Lorenz(Lorenz { alpha: 10.0, r: 160.0, b: 8.0 / 3.0 });
    let msf = quick(lorenz, [1, 1], vec![0.0, 10.0, 20.0]);
    assert_eq!(msf.state, Isolated::Periodic);
    assert_eq!(zeros(&msf), [], "{:?}", msf.stable);
    assert!(msf.stable.intervals[0].lower() < 1.0, "{:?}", msf.stable);
}

#[test]
fn orbits_on_two_fixed_points_give_a_zero_each_and_no_mean_of_both() {
    // z into y tells the two fixed points of Lorenz at r = 10 apart: Λ = 0 at 4.899 and at 8.022.
    let lorenz = Model::Lorenz(Lorenz { alpha: 10.0, r: 10.0, b: 8.0 / 3.0 });
    let msf = quick(lorenz, [2, 1], vec![0.0, 5.0, 10.0, 15.0]);
    let mut ends: Vec<f64> =
        msf.attractors.iter().flat_map(|a| a.stable.zeros()).map(|zero| zero.sigma).collect();
    ends.sort_by(f64::total_cmp);
    assert_eq!(ends.len(), 2, "{:?}", msf.attractors);
    assert!((ends[0] - 4.899).abs() < 0.1 && (ends[1] - 8.022).abs() < 0.16, "{ends:?}");
    // What is stable on both is what may be predicted.
    assert_eq!(msf.stable.zeros().map(|zero| zero.sigma).collect::<Vec<_>>(), [ends[0]]);
}
