//! Seeded initial states whose values never change: the conversion from bits is our own.

use rand_core::Rng;
use rand_pcg::Pcg64;

/// Initial states of `n_nodes` oscillators, drawn uniformly from a box, component by component within
/// each node.
///
/// Source of the generator: M. E. O'Neill, PCG XSL RR 128/64 (2014).
pub fn initial_states(start: &[[f64; 2]], n_nodes: usize, seed: u64) -> Vec<f64> {
    const STREAM: u128 = 0x0065_6967_656e_7379_6e63;
    let mut generator = Pcg64::new(u128::from(seed), STREAM);
    let mut draw = |[from, to]: [f64; 2]| from + (to - from) * unit_interval(generator.next_u64());
    (0..n_nodes).flat_map(|_| start).map(|&within| draw(within)).collect()
}

/// 53 random bits as a number in [0, 1).
pub(crate) fn unit_interval(bits: u64) -> f64 {
    (bits >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Lorenz, Oscillator};

    #[test]
    fn a_seed_means_the_same_states_for_ever() {
        let states = initial_states(&Lorenz::START, 2, 1);
        // Printed by this test; a change would change every simulation there is.
        assert_eq!(states[..3], [2.269324646527295, 5.925014759888057, 25.865045629333295]);
        assert_ne!(states, initial_states(&Lorenz::START, 2, 2));
        for (value, [from, to]) in states.iter().zip(Lorenz::START.into_iter().cycle()) {
            assert!((from..to).contains(value));
        }
    }
}
