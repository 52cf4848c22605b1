//! Orbits and tangents by series against RK4 with tiny steps.

use super::*;
use crate::integrators::rk4::STAGES;
use crate::{HindmarshRose, Linearised, LinearisedMut, Lorenz, Model, Rossler};

/// Steps of RK4 over a unit of time.
const TINY: f64 = 1e4;

/// An orbit and a tangent, component by component.
type State = [Vec<f64>; 2];

fn rate(dynamics: &dyn NodeDynamics, coupling: &Coupling, sigma: f64, at: &State) -> State {
    let n = at[0].len();
    let mut to = [vec![0.0; n], vec![0.0; n]];
    let [value, tangent] = at.each_ref().map(|x| x.chunks(1).collect::<Vec<_>>());
    let [a, b] = &mut to;
    let (mut a, mut b): (Vec<_>, Vec<_>) = (a.chunks_mut(1).collect(), b.chunks_mut(1).collect());
    let slope = LinearisedMut { value: &mut a, tangent: &mut b };
    let here = Linearised { value: &value, tangent: &tangent };
    dynamics.tangent_flow(InstructionSet::Baseline, here, slope);
    for (equation, component, weight) in coupling.constant_derivative().into_iter().flatten() {
        to[1][equation] -= sigma * weight * at[1][component];
    }
    to
}

fn by_rk4(
    dynamics: &dyn NodeDynamics,
    coupling: &Coupling,
    sigma: f64,
    mut at: State,
    time: f64,
) -> State {
    let n_steps = (time * TINY).ceil();
    let h = time / n_steps;
    for _ in 0..n_steps as usize {
        let (mut sum, mut ahead) = (at.clone(), at.clone());
        for (weight, advance) in STAGES {
            let slope = rate(dynamics, coupling, sigma, &ahead);
            for part in 0..2 {
                for c in 0..at[part].len() {
                    sum[part][c] += slope[part][c] * (weight * h);
                    ahead[part][c] = at[part][c] + slope[part][c] * (advance * h);
                }
            }
        }
        at = sum;
    }
    at
}

/// The largest errors after about a unit of time from some states of an orbit, relative to the largest
/// component: of the orbit and of the growth of a tangent.
fn errors(model: &Model, coupling: &Coupling, sigma: f64, tolerance: f64) -> [f64; 2] {
    let followed = Followed::new(model, coupling, tolerance).unwrap();
    let equations = &followed.equations;
    let steps = Steps::new(tolerance, model.start(), f64::INFINITY);
    let mut orbit = Orbit::<1>::new(&equations.programs, steps.order());
    orbit.begin(0, &initial_states(model.start(), 1, 5));
    let mut piece = Piece::<16>::new(&equations.jacobian, [sigma; 16], steps.order());
    let advance = |until: f64, orbit: &mut Orbit<1>, piece: &mut Piece<16>| {
        let mut time = 0.0;
        while time < until {
            orbit.expand(&equations.programs, steps.order());
            let h = steps.of(orbit, &equations.jacobian, &[followed.levels.of(sigma)]);
            piece.advance(&equations.jacobian, orbit, &h, steps.order());
            orbit.advance(&h, steps.order());
            time += h[0];
        }
        time
    };
    let mut worst = [0.0f64; 2];
    for _ in 0..6 {
        advance(20.0, &mut orbit, &mut piece);
        piece.renormalise();
        let here = |orbit: &Orbit<1>, piece: &Piece<16>| {
            let n = orbit.n_components();
            [
                (0..n).map(|c| orbit.component(c)[0][0]).collect::<Vec<f64>>(),
                (0..n).map(|c| piece.component(c)[0]).collect(),
            ]
        };
        let start = here(&orbit, &piece);
        let time = advance(1.0, &mut orbit, &mut piece);
        let exact = by_rk4(model, coupling, sigma, start, time);
        let found = here(&orbit, &piece);
        for part in 0..2 {
            let size = exact[part].iter().fold(0.0f64, |size, x| size.max(x.abs()));
            let away = found[part].iter().zip(&exact[part]).map(|(a, b)| (a - b).abs());
            worst[part] = worst[part].max(away.fold(0.0, f64::max) / size);
        }
    }
    worst
}

#[test]
fn errors_after_a_unit_of_time_follow_the_tolerance() {
    let cases = [
        (Model::Lorenz(Lorenz::default()), Coupling::pair(0, 1), 8.0),
        (Model::Lorenz(Lorenz::default()), Coupling::pair(0, 0), 40.0),
        (Model::Rossler(Rossler::default()), Coupling::pair(0, 0), 2.0),
        (Model::HindmarshRose(HindmarshRose::default()), Coupling::pair(0, 0), 1.0),
    ];
    for (model, coupling, sigma) in cases {
        for tolerance in [1e-6, 1e-10] {
            // Chaos multiplies what each of some twenty steps adds.
            for error in errors(&model, &coupling, sigma, tolerance) {
                assert!(error < 1000.0 * tolerance, "{model:?} {tolerance}: {error:e}");
            }
        }
    }
}
