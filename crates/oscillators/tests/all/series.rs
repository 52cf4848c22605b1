//! Exponents by Taylor series against those by RK4.

use dynamics::lyapunov::{Integrator, Tangent, Times, master_exponents, takes_series};
use dynamics::{Coupling, Estimate, QUIET};
use equations::{Description, System};
use oscillators::{Entry, Kind, library};
use rayon::prelude::*;

use crate::{dynamics, long};

const SERIES: Integrator = Integrator::Taylor { tolerance: 1e-6 };

/// The mean over orbits, with the larger of its scatter and what the blocks of each say.
fn mean(exponents: &[Estimate]) -> Estimate {
    let means: Vec<f64> = exponents.iter().map(|e| e.mean).collect();
    let scatter = Estimate::from_independent(&means);
    let own = exponents.iter().map(|e| e.standard_error).fold(0.0, f64::max);
    Estimate { standard_error: scatter.standard_error.max(0.5 * own), ..scatter }
}

/// The first component into its own equation, as it is and as a formula.
fn couplings(entry: &Entry) -> [Coupling; 2] {
    let dynamics = dynamics(entry);
    let components = dynamics.components()[..dynamics.n_free()].to_vec();
    let formula = format!("tanh({})", components[0]);
    let system = System::read(&Description {
        kind: equations::Kind::Coupling,
        equations: vec![(components[0], &formula)],
        components,
        ..Description::default()
    });
    [Coupling::pair(0, 0), Coupling::formulas(&system.unwrap())]
}

fn agrees(entry: &Entry) -> bool {
    let average = if long() { 20_000.0 } else { 400.0 };
    let times = |integrator| Times {
        integrator,
        step: entry.step,
        transient: 200.0,
        average,
        renormalise: 0.5,
    };
    let model = dynamics(entry);
    let mut are_there = true;
    for coupling in couplings(entry) {
        are_there &= takes_series(&*model, &coupling, &times(SERIES));
        for sigma in [0.0, 0.3] {
            let tangents: Vec<_> = (0..4).map(|seed| Tangent { sigma, seed }).collect();
            let [by_rk4, by_series] = [Integrator::Rk4, SERIES].map(|integrator| {
                let times = times(integrator);
                mean(&master_exponents(&*model, &coupling, &times, &tangents, QUIET).unwrap())
            });
            let away = (by_rk4.mean - by_series.mean).abs();
            let error = by_rk4.standard_error.hypot(by_series.standard_error);
            let allowed = 6.0 * error + 10.0 / average;
            assert!(away < allowed, "{}, {sigma}: {by_rk4:?}, {by_series:?}", entry.name);
        }
    }
    are_there
}

#[test]
fn series_and_rk4_agree_on_every_flow_of_the_library() {
    let flows: Vec<&Entry> = library().iter().filter(|e| e.kind() == Kind::Flow).collect();
    let with_series = flows.par_iter().filter(|entry| agrees(entry)).count();
    // Those with pieces have none, and are followed by RK4 both times.
    assert!(with_series >= 12 && with_series < flows.len(), "{with_series} of {}", flows.len());
}
