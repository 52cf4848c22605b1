//! The MSF of oscillators whose stability limits are known from independent computations.
//!
//! The short forms run always; EIGENSYNC_LONG_TESTS=1 runs them long enough to test the numbers.

use dynamics::lyapunov::Times;
use dynamics::{Coupling, HindmarshRose, InstructionSet, Lorenz, Model, Rossler};
use msf::{MasterStability, Node, Refinement, Request, Zero, master_stability};

const LORENZ: Node =
    Node { model: Model::Lorenz(Lorenz { alpha: 10.0, r: 35.0, b: 8.0 / 3.0 }), coupling: X_TO_Y };
const X_TO_Y: Coupling = Coupling { from: 0, to: 1 };
const X_TO_X: Coupling = Coupling { from: 0, to: 0 };

fn compute(node: Node, [from, to]: [f64; 2], points: u32, average: f64) -> MasterStability {
    let step = (to - from) / f64::from(points - 1);
    let request = Request {
        sigma: (0..points).map(|k| from + step * f64::from(k)).collect(),
        times: Times { step: 0.01, transient: 500.0, average, renormalise: 0.5 },
        refinement: Refinement::default(),
        seed: 1,
        instruction_set: InstructionSet::best(),
    };
    master_stability(&node, &request, &|_| ()).expect("the request is sound")
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
    let msf = compute(LORENZ, [0.0, 12.0], 13, if long() { 2e4 } else { 1e3 });
    assert_eq!(zeros(&msf).len(), 1, "{:?}", msf.stable);
    check_edge(&msf, 0, 8.17, 0.01);
    assert!((msf.isolated.mean - 1.050).abs() < 0.002 + 4.0 * msf.isolated.standard_error);
    assert!(msf.stable.sigma_c().is_some());
}

#[test]
fn rossler_x_into_x_is_stable_in_a_bounded_window() {
    let node = Node { model: Model::Rossler(Rossler::default()), coupling: X_TO_X };
    let msf = compute(node, [0.0, 6.0], 13, if long() { 2e4 } else { 1e3 });
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
    let node = Node { model: Model::HindmarshRose(HindmarshRose::default()), coupling: X_TO_X };
    let msf = compute(node, [0.0, 1.6], 9, 2e4);
    assert_eq!(zeros(&msf).len(), 1, "{:?}", msf.stable);
    check_edge(&msf, 0, 0.943, 0.003);
    assert!((msf.isolated.mean - 0.0128).abs() < 0.0002 + 4.0 * msf.isolated.standard_error);
}

#[test]
fn the_curve_does_not_depend_on_the_number_of_threads() {
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| compute(LORENZ, [6.0, 10.0], 5, 100.0))
    };
    assert_eq!(on(1), on(2));
}
