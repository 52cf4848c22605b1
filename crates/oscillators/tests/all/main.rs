//! The library of oscillators: what stands in its files, and whether it is true.

mod compiled;
mod exponents;
mod listing;
mod mistakes;
mod orbits;
mod series;

use dynamics::{InstructionSet, Linearised, LinearisedMut, NodeDynamics};
use indexmap::IndexMap;
use oscillators::Entry;
use std::sync::Arc;

/// An oscillator with its default parameters.
fn dynamics(entry: &Entry) -> Arc<dyn NodeDynamics> {
    entry.with(&IndexMap::new()).unwrap()
}

/// States in a box of the same middle as that of initial states and three times as wide, where
/// equations have to make sense as well.
fn states(dynamics: &dyn NodeDynamics, count: u32) -> Vec<Vec<f64>> {
    // Multiples of irrational numbers, modulo 1, fill a box evenly.
    let irrational = |c: usize| f64::from(2 + c as u32).sqrt() + f64::from(3 + c as u32).cbrt();
    let state = |k: u32| {
        let within = |(c, &[from, to]): (usize, &[f64; 2])| {
            let part = (f64::from(k) * irrational(c)).fract();
            from + (to - from) * (3.0 * part - 1.0)
        };
        dynamics.start().iter().enumerate().map(within).collect()
    };
    (1..=count).map(state).collect()
}

/// F of one state.
fn flow(dynamics: &dyn NodeDynamics, state: &[f64]) -> Vec<f64> {
    let x: Vec<&[f64]> = state.chunks(1).collect();
    let mut slope = vec![0.0; state.len()];
    let mut slopes: Vec<&mut [f64]> = slope.chunks_mut(1).collect();
    dynamics.flow(InstructionSet::Baseline, &x, &mut slopes);
    slope
}

/// DF of one state in the direction of one component.
fn tangent(dynamics: &dyn NodeDynamics, state: &[f64], direction: usize) -> Vec<f64> {
    let along: Vec<f64> = (0..state.len()).map(|c| f64::from(u8::from(c == direction))).collect();
    let [value, tangent] = [state, &along].map(|x| x.chunks(1).collect::<Vec<_>>());
    let (mut of_value, mut of_tangent) = (vec![0.0; state.len()], vec![0.0; state.len()]);
    let mut values: Vec<&mut [f64]> = of_value.chunks_mut(1).collect();
    let mut tangents: Vec<&mut [f64]> = of_tangent.chunks_mut(1).collect();
    let at = Linearised { value: &value, tangent: &tangent };
    let slope = LinearisedMut { value: &mut values, tangent: &mut tangents };
    dynamics.tangent_flow(InstructionSet::Baseline, at, slope);
    of_tangent
}

/// Whether tests may take minutes.
fn long() -> bool {
    std::env::var_os("EIGENSYNC_LONG_TESTS").is_some()
}
