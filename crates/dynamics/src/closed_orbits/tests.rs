//! Closed orbits against numbers that are known otherwise.

use super::*;
use crate::{HindmarshRose, Lorenz, Model, Rossler};

const SEEDS: [u64; 12] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12];

fn orbits(model: Model, pair: [usize; 2], transient: f64) -> Option<Vec<Settled>> {
    let dynamics: Arc<dyn NodeDynamics> = Arc::new(model);
    let coupling = Coupling::pair(pair[0], pair[1]);
    closed_orbits(&dynamics, &coupling, (0.01, transient), &SEEDS, crate::QUIET).unwrap()
}

fn one(model: Model, pair: [usize; 2], transient: f64) -> ClosedOrbit {
    let mut found = orbits(model, pair, transient).expect("it closes");
    assert_eq!(found.len(), 1);
    found.remove(0).orbit
}

fn period(orbit: &ClosedOrbit) -> f64 {
    let Closes::AfterPeriod { period } = orbit.closes() else { panic!("{:?}", orbit.closes()) };
    period
}

fn zero_between(orbit: &ClosedOrbit, [mut low, mut high]: [f64; 2]) -> f64 {
    let at = |sigma: f64| orbit.exponents(&[sigma])[0].mean;
    let falls = at(low) > 0.0;
    assert_ne!(falls, at(high) > 0.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if (at(middle) > 0.0) == falls { low = middle } else { high = middle }
    }
    low
}

#[test]
fn hindmarsh_rose_at_current_four_has_the_period_and_the_zeros_of_its_multipliers() {
    // An independent computation of the multipliers: period 20.1279, zeros 0.08749 and 1.67875.
    let model = Model::HindmarshRose(HindmarshRose { current: 4.0, ..HindmarshRose::default() });
    let orbit = one(model, [2, 2], 50.0);
    assert!((period(&orbit) - 20.1279).abs() < 1e-4, "{}", period(&orbit));
    let zeros = [[0.05, 0.12], [1.5, 1.8]].map(|bracket| zero_between(&orbit, bracket));
    assert!((zeros[0] - 0.08749).abs() < 1e-5 && (zeros[1] - 1.67875).abs() < 1e-5, "{zeros:?}");
}

#[test]
fn rossler_with_c_of_2_5_has_its_zero_where_floquet_multipliers_have_it() {
    let orbit = one(Model::Rossler(Rossler { a: 0.2, b: 0.2, c: 2.5 }), [2, 2], 50.0);
    let zero = zero_between(&orbit, [2.0, 3.0]);
    assert!((zero - 2.42616).abs() < 1e-5, "{zero}");
    let estimate = orbit.exponents(&[zero])[0];
    assert!(estimate.standard_error < 1e-9, "{estimate:?}");
}

#[test]
fn lorenz_at_r_of_160_damps_at_first_order_and_far_out() {
    let orbits =
        orbits(Model::Lorenz(Lorenz { alpha: 10.0, r: 160.0, b: 8.0 / 3.0 }), [1, 1], 100.0);
    for Settled { orbit, .. } in orbits.expect("it closes") {
        let slope = orbit.first_order().unwrap();
        assert!(slope.mean < 0.0 && slope.standard_error < 1e-6, "{slope:?}");
        for exponent in orbit.exponents(&[1e-6, 0.1, 1.0, 10.0, 1e4]) {
            assert!(exponent.mean < 0.0 && exponent.standard_error < 1e-7, "{exponent:?}");
        }
        assert_eq!(orbit.exponents(&[0.0])[0], crate::Estimate::default());
    }
}

#[test]
fn chaos_closes_nowhere() {
    for model in Model::all() {
        assert!(orbits(model, [0, 0], 200.0).is_none(), "{model:?}");
    }
}

#[test]
fn two_fixed_points_are_two_orbits_with_the_rates_of_their_jacobians() {
    let found = orbits(Model::Lorenz(Lorenz { alpha: 10.0, r: 10.0, b: 8.0 / 3.0 }), [0, 0], 50.0);
    let found = found.expect("it closes");
    assert_eq!(found.iter().map(|settled| settled.seeds.len()).sum::<usize>(), 12);
    for Settled { orbit, .. } in &found {
        assert_eq!(orbit.closes(), Closes::AtOnce);
        let rate = orbit.exponents(&[0.0])[0].mean;
        // The real part of the complex roots of x³ + 41/3 x² + 160/3 x + 480.
        let residue = {
            // x = rate + i ω is a root where the imaginary part and the real one vanish.
            let omega = (3.0 * rate * rate + 2.0 * rate * 41.0 / 3.0 + 160.0 / 3.0).sqrt();
            rate.powi(3) - 3.0 * rate * omega * omega
                + 41.0 / 3.0 * (rate * rate - omega * omega)
                + 160.0 / 3.0 * rate
                + 480.0
        };
        assert!(residue.abs() < 1e-9, "{rate}: {residue}");
    }
}
