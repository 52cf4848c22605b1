//! Orbits of an isolated oscillator that close: it comes to rest, runs round a limit cycle, or, where it is a
//! map, round a cycle of finite length. Λ(σ) on them needs no average.

mod cyclic_product;
mod mesh;
mod near;
mod orbit;
mod radau;
mod search;
mod solve;

use std::sync::Arc;

use rayon::prelude::*;

pub use orbit::{ClosedOrbit, Closes};

use crate::{Coupling, DynamicsError, NodeDynamics, Progress};
use search::Follower;

/// A closed orbit, and who settles on it.
pub struct Settled {
    /// The orbit.
    pub orbit: ClosedOrbit,
    /// Places of their seeds among those given.
    pub seeds: Vec<usize>,
}

/// The closed orbits on which isolated oscillators settle, one from the initial state of each seed, that of
/// most of them first. None where one of them is not seen to be on any, or where time is a component.
///
/// - `step`, `transient`: of RK4, and before orbits are looked at, in model time units; a map goes in steps of 1.
///
/// Runs on the current rayon pool; the result does not depend on the number of threads.
///
/// # Errors
/// [`DynamicsError::Escaped`] when an orbit leaves the ball of [`NodeDynamics::escape_radius`];
/// [`DynamicsError::Cancelled`] when whoever is told of progress wants to stop.
pub fn closed_orbits(
    dynamics: &Arc<dyn NodeDynamics>,
    coupling: &Coupling,
    times: (f64, f64),
    seeds: &[u64],
    progress: Progress<'_>,
) -> Result<Option<Vec<Settled>>, DynamicsError> {
    if dynamics.has_clock() {
        return Ok(None);
    }
    let node = (dynamics, coupling, progress);
    let mut found: Vec<Settled> = Vec::new();
    let mut left: Vec<usize> = (0..seeds.len()).collect();
    while let Some(&first) = left.first() {
        let Some(orbit) = Follower::after(node, times, seeds[first])?.settles()? else {
            return Ok(None);
        };
        let on_it = left[1..]
            .par_iter()
            .with_max_len(1)
            .map(|&at| Follower::after(node, times, seeds[at])?.settles_on(&orbit));
        let on_it: Vec<bool> = on_it.collect::<Result<_, _>>()?;
        let (on, off): (Vec<_>, Vec<_>) =
            left[1..].iter().copied().zip(on_it).partition(|(_, is_on)| *is_on);
        left = off.into_iter().map(|(at, _)| at).collect();
        let seeds = [first].into_iter().chain(on.into_iter().map(|(at, _)| at)).collect();
        found.push(Settled { orbit, seeds });
    }
    found.sort_by_key(|settled| std::cmp::Reverse(settled.seeds.len()));
    Ok(Some(found))
}

#[cfg(test)]
mod tests;
