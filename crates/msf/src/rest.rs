//! Whether oscillators that come to rest by themselves come to the same state. Λ(0) < 0 says that each
//! forgets small disturbances, and not that there is one state only: the Lorenz system with 1 < r < 24
//! has two fixed points with the same exponents, and nodes at different ones are never equal.

use dynamics::{NodeDynamics, settled};

use crate::MsfError;

/// Oscillators are left for this many times 1/|Λ(0)| after the transient: e⁻²⁴ = 4·10⁻¹¹ is left of
/// what the slowest decay began with.
const DECAYS: f64 = 24.0;

/// States closer than this, relative to 1 and the largest component of any, are one.
const SAME: f64 = 1e-6;

/// How many oscillators, of one for each seed, have come to each state, the most frequent first.
pub(crate) fn counts(
    dynamics: &dyn NodeDynamics,
    (step, transient): (f64, f64),
    isolated: f64,
    seeds: &[u64],
) -> Result<Vec<usize>, MsfError> {
    let time = transient + DECAYS / isolated.abs();
    Ok(alike(&settled(dynamics, step, time, seeds)?))
}

/// Sizes of the groups of equal states, the largest first.
fn alike(states: &[Vec<f64>]) -> Vec<usize> {
    let size = states.iter().flatten().fold(1.0, |largest: f64, x| largest.max(x.abs()));
    let is_same = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= SAME * size);
    let mut groups: Vec<(&[f64], usize)> = Vec::new();
    for state in states {
        match groups.iter_mut().find(|(first, _)| is_same(first, state)) {
            Some((_, count)) => *count += 1,
            None => groups.push((state, 1)),
        }
    }
    let mut counts: Vec<usize> = groups.into_iter().map(|(_, count)| count).collect();
    counts.sort_unstable_by(|a, b| b.cmp(a));
    counts
}

#[cfg(test)]
mod tests {
    use dynamics::{Lorenz, Model};

    use super::*;

    #[test]
    fn states_are_told_apart_relative_to_their_size() {
        let states = [vec![1e4, 0.0], vec![1e4 + 1e-3, 0.0], vec![1e4, 1.0], vec![1e4, 1e-3]];
        assert_eq!(alike(&states), [3, 1]);
    }

    #[test]
    fn lorenz_rests_at_two_points_above_r_of_one_and_at_one_below() {
        let seeds: Vec<u64> = (1..=16).collect();
        let of = |r, slowest| {
            let model = Model::Lorenz(Lorenz { r, ..Lorenz::default() });
            counts(&model, (0.01, 100.0), slowest, &seeds).unwrap()
        };
        // Slowest rates: of x³ + (a+b+1)x² + b(r+a)x + 2ab(r−1) at r = 10; of the origin at r = 0.5.
        let two = of(10.0, -0.59);
        assert!(two.len() == 2 && two.iter().sum::<usize>() == 16, "{two:?}");
        assert_eq!(of(0.5, -0.47), [16]);
    }
}
