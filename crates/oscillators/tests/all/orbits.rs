//! What orbits from the boxes of initial states do, and derivatives along them.

use dynamics::lyapunov::{Integrator, Tangent, Times, master_exponents};
use dynamics::{Coupling, QUIET};
use oscillators::{Behaviour, Entry, Kind, find, library};
use rayon::prelude::*;

use crate::{dynamics, flow, long, states, tangent};

#[test]
fn the_jacobian_of_every_oscillator_is_that_of_central_differences() {
    for entry in library() {
        let dynamics = dynamics(entry);
        for state in states(&*dynamics, 50) {
            for direction in 0..state.len() {
                let h = 1e-5 * (1.0 + state[direction].abs());
                let [above, below] = [h, -h].map(|by| {
                    let mut moved = state.clone();
                    moved[direction] += by;
                    flow(&*dynamics, &moved)
                });
                for (c, exact) in tangent(&*dynamics, &state, direction).into_iter().enumerate() {
                    let difference = (above[c] - below[c]) / (2.0 * h);
                    // The differences lose what F is rounded by, and what F bends by.
                    let allowed = 1e-6 * (1.0 + difference.abs() + above[c].abs());
                    assert!(
                        (exact - difference).abs() < allowed,
                        "{}: ∂F_{c}/∂x_{direction} at {state:?}: {exact}, {difference}",
                        entry.name
                    );
                }
            }
        }
    }
}

#[test]
fn orbits_stay_bounded_and_do_what_their_file_says_from_everywhere_in_their_box() {
    let n_seeds = if long() { 64 } else { 16 };
    library().par_iter().for_each(|entry| behaves(entry, n_seeds));
}

/// No exponent of the isolated oscillator may be that of rest, and none of an orbit that escapes or
/// meets what is no number is there at all.
fn behaves(entry: &Entry, n_seeds: u64) {
    const TIME: f64 = 2000.0;
    let step = entry.step;
    let renormalise = if entry.kind() == Kind::Map { 1.0 } else { 0.5 };
    let times =
        Times { integrator: Integrator::Rk4, step, transient: 200.0, average: TIME, renormalise };
    let tangents: Vec<_> = (0..n_seeds).map(|seed| Tangent { sigma: 0.0, seed }).collect();
    let coupling = Coupling::pair(0, 0);
    let exponents = master_exponents(&*dynamics(entry), &coupling, &times, &tangents, QUIET)
        .unwrap_or_else(|error| panic!("{}: {error}", entry.name));
    // The exponent 0 of a limit cycle is known to a few times 1/T, of a fixed point it is lower.
    let none = 10.0 / TIME;
    for (seed, exponent) in exponents.into_iter().enumerate() {
        let holds = match entry.behaviour {
            Behaviour::Chaotic => exponent.mean > none,
            Behaviour::Periodic => exponent.mean.abs() < none,
        };
        assert!(holds, "{} of seed {seed} is not {}: {exponent:?}", entry.name, entry.behaviour);
    }
}

#[test]
fn the_whole_box_of_henon_heiles_lies_below_the_energy_of_escape() {
    let entry = find("henon_heiles").unwrap();
    let ends: Vec<[f64; 2]> = entry.equations.start.values().copied().collect();
    let corner = |corner: usize| -> [f64; 4] { std::array::from_fn(|c| ends[c][corner >> c & 1]) };
    let energy = |[x, y, u, v]: [f64; 4]| {
        (u * u + v * v + x * x + y * y) / 2.0 + x * x * y - y * y * y / 3.0
    };
    // Within the box the potential rises from its middle outwards, so that corners bound it.
    for energy in (0..16).map(|number| energy(corner(number))) {
        assert!(energy > 0.14 && energy < 1.0 / 6.0, "{energy}");
    }
}
