//! Isolated orbits followed for a while before anything is computed: whether they stay bounded, and how
//! long Λ(0) will take.

use std::fmt;

use dynamics::{DynamicsError, settled};
use eigensync::numbers::{plain, two_digits};
use experiment::Plan;
use rayon::prelude::*;
use serde::Serialize;

use crate::trial::{self, Trial};

/// Orbits, from initial states of their own.
const ORBITS: u64 = 64;
/// Steps of each.
const STEPS: f64 = 5e4;

/// What isolated orbits do.
#[derive(Serialize)]
pub struct Orbits {
    tried: u64,
    /// Time for which each was followed.
    time: f64,
    escaped: usize,
    /// When the first of them did.
    first_escape: Option<f64>,
    /// Time that Λ(0) will take on one thread.
    isolated_seconds: f64,
}

impl Orbits {
    /// Those of a plan, of whose exponents there was a trial.
    pub fn of(plan: &Plan, msf: Trial) -> Self {
        let (node, times) = (&plan.study.node, &plan.study.msf.times);
        let time = (times.transient + times.average).min(STEPS * times.step);
        let end = |seed: u64| {
            let seeds = [plan.study.seed.wrapping_add(seed)];
            match settled(node.dynamics.as_ref(), times.step, time, &seeds) {
                Err(DynamicsError::Escaped { time }) => Some(time),
                _ => None,
            }
        };
        let escapes: Vec<f64> = (0..ORBITS).into_par_iter().filter_map(end).collect();
        Self {
            tried: ORBITS,
            time,
            escaped: escapes.len(),
            first_escape: escapes.iter().copied().reduce(f64::min),
            isolated_seconds: trial::of_isolated(plan, msf),
        }
    }
}

impl fmt::Display for Orbits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { tried, time, escaped, first_escape, isolated_seconds } = self;
        match first_escape {
            None => write!(f, "all {tried} stay bounded for {}", plain(*time))?,
            Some(first) => write!(
                f,
                "{escaped} of {tried} escape, the first after {}: a run would end there; begin nearer to \
                 the attractor, or take a shorter step",
                two_digits(*first)
            )?,
        }
        write!(f, "; Λ(0) takes about {} s on one thread", two_digits(*isolated_seconds))
    }
}
