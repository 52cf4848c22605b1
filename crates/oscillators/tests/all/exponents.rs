//! Lyapunov spectra: published ones, and what their sums have to be.

use dynamics::lyapunov::{Integrator, Times, spectrum};
use dynamics::{Estimate, NodeDynamics};
use nalgebra::DMatrix;
use oscillators::{Entry, Kind, Published, library};
use rayon::prelude::*;

use crate::{dynamics, long, states, tangent};

/// All exponents, descending.
fn exponents(entry: &Entry, dynamics: &dyn NodeDynamics, average: f64) -> Vec<Estimate> {
    let renormalise = if entry.kind() == Kind::Map { 1.0 } else { 0.5 };
    let times = Times {
        integrator: Integrator::Rk4,
        step: entry.step,
        transient: 500.0,
        average,
        renormalise,
    };
    let mut exponents =
        spectrum(dynamics, &times, 1).unwrap_or_else(|error| panic!("{}: {error}", entry.name));
    // That of time is found last, whatever the others are.
    exponents.sort_by(|a, b| b.mean.total_cmp(&a.mean));
    exponents
}

#[test]
fn published_exponents_hold_within_four_standard_errors_and_a_unit_of_their_last_digit() {
    let shorter = if long() {
        1.0
    } else {
        eprintln!(
            "a twentieth of the time: EIGENSYNC_LONG_TESTS averages as long as the files say"
        );
        20.0
    };
    let all: Vec<(&Entry, &Published)> = library()
        .iter()
        .flat_map(|entry| entry.published.iter().map(move |p| (entry, p)))
        .collect();
    assert!(all.len() >= 16, "{}", all.len());
    let checked: Vec<Checked> = all
        .par_iter()
        .flat_map_iter(|(entry, published)| check(entry, published, published.average / shorter))
        .collect();
    let lines: String = checked.iter().map(|checked| checked.line.as_str()).collect();
    println!("{lines}");
    assert!(checked.iter().all(|checked| checked.holds), "{lines}");
}

/// An exponent as it is published and as it is obtained, in words.
struct Checked {
    line: String,
    holds: bool,
}

/// Holds one published spectrum against what is obtained.
fn check(entry: &Entry, published: &Published, average: f64) -> Vec<Checked> {
    let dynamics = entry.with(&published.parameters).unwrap();
    let obtained = exponents(entry, &*dynamics, average);
    assert_eq!(obtained.len(), published.exponents.len(), "{}", entry.name);
    let last_digit = 10f64.powi(-published.digits);
    let check = |(obtained, expected): (Estimate, &f64)| {
        // No average over a time T knows an exponent to better than 1/T.
        let allowed = 4.0 * obtained.standard_error + last_digit + 1.0 / average;
        let (name, Estimate { mean, standard_error }) = (entry.name, obtained);
        let holds = (mean - expected).abs() < allowed;
        let doubt = if holds { "" } else { "  fails" };
        let line = format!("{name:18} {expected:12.6} {mean:12.6} ± {standard_error:.6}{doubt}\n");
        Checked { line, holds }
    };
    obtained.into_iter().zip(&published.exponents).map(check).collect()
}

/// The rate at which volume grows, if it is the same everywhere: ∇·F, or ln |det DF| of a map.
fn constant_growth(entry: &Entry, dynamics: &dyn NodeDynamics) -> Option<f64> {
    let rate = |state: &Vec<f64>| {
        let columns: Vec<f64> =
            (0..state.len()).flat_map(|direction| tangent(dynamics, state, direction)).collect();
        let jacobian = DMatrix::from_vec(state.len(), state.len(), columns);
        if entry.kind() == Kind::Map { jacobian.determinant().abs().ln() } else { jacobian.trace() }
    };
    let rates: Vec<f64> = states(dynamics, 50).iter().map(rate).collect();
    let first = rates[0];
    let is_constant = rates.iter().all(|rate| (rate - first).abs() < 1e-9 * (1.0 + first.abs()));
    is_constant.then_some(first)
}

#[test]
fn exponents_sum_to_the_growth_of_volume_where_that_is_the_same_everywhere() {
    let checked: Vec<&str> = library()
        .par_iter()
        .filter_map(|entry| {
            let dynamics = dynamics(entry);
            let growth = constant_growth(entry, &*dynamics)?;
            let sum: f64 = exponents(entry, &*dynamics, 200.0).iter().map(|e| e.mean).sum();
            // RK4 makes of exp(h ∇·F) what its step allows.
            assert!(
                (sum - growth).abs() < 1e-3 * (1.0 + growth.abs()),
                "{}: {sum}, {growth}",
                entry.name
            );
            Some(entry.name)
        })
        .collect();
    assert!(checked.len() >= 12, "{checked:?}");
}

#[test]
fn exponents_of_a_conservative_oscillator_come_in_pairs_that_sum_to_zero() {
    let entry = oscillators::find("henon_heiles").unwrap();
    let found = exponents(entry, &*dynamics(entry), 2000.0);
    for (up, down) in [(found[0], found[3]), (found[1], found[2])] {
        assert!((up.mean + down.mean).abs() < 1e-3, "{found:?}");
    }
}
