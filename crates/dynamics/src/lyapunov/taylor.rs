//! The master equation by Taylor series, with a step for each orbit.
//!
//! With s(t + τ) = Σ s_k τ^k the entries of DF and DH along the orbit are series too, and those of a
//! tangent follow from them:
//!
//! ```text
//! δ_{k+1} = 1/(k + 1) Σ_{j=0..k} [DF_j − σ DH_j] δ_{k−j}
//! ```
//!
//! The step is as long as the last two coefficients of the orbit allow (Jorba & Zou, Exp. Math. 14, 99
//! (2005), Sec. 3.2), and no longer than lets a polynomial of this order damp what DF − σ DH damps. It
//! follows from the orbit and from a bound on σ that neighbouring σ have in common, so that tangents
//! which share an orbit, and those that have it for themselves, go through the same operations.

mod clock;
mod orbit;
mod steps;
mod tangents;

use super::growth::{Tangent, Tangents, estimates};
use crate::coupling::Channels;
use crate::instruction_set::Work;
use crate::random::initial_states;
use crate::{Coupling, DynamicsError, Estimate, InstructionSet, NodeDynamics};
use clock::Clock;
use orbit::{Orbit, Programs};
use steps::{Levels, Steps};
use tangents::{Jacobian, Piece};

/// Tangents of one orbit that are advanced together.
const MOST: usize = 128;
/// Orbits that are advanced together.
const ORBITS: usize = 16;
/// Tangents in vectors beside one another, where they share an orbit.
const SHARED: usize = 32;

/// Steps between looks at an orbit and at the lengths of its tangents: few enough that no length leaves
/// the range of numbers.
const BETWEEN: usize = 8;

/// A master equation that has series.
struct Equations {
    programs: Programs,
    jacobian: Jacobian,
    /// The size of B.
    weight: f64,
}

impl Equations {
    /// None where the equations are not known as a program, or have pieces.
    fn of(dynamics: &dyn NodeDynamics, coupling: &Coupling) -> Option<Self> {
        if dynamics.is_map() {
            return None;
        }
        let flow = dynamics.program()?;
        let sent = match coupling.channels() {
            Channels::Components(_) => None,
            Channels::Formulas(program) => Some(program.as_ref().clone()),
        };
        let of_sent = match &sent {
            None => None,
            Some(program) => Some(program.series()?),
        };
        let jacobian = Jacobian::new(flow.series()?, (coupling, of_sent), dynamics.n_free());
        let squares = coupling.gains().iter().map(|gain| gain.weight * gain.weight);
        let weight = squares.sum::<f64>().sqrt();
        let programs = Programs { flow, sent, n_components: dynamics.start().len() };
        Some(Self { programs, jacobian, weight })
    }
}

/// A master equation with the rule by which its steps are chosen.
pub(super) struct Followed<'a> {
    dynamics: &'a dyn NodeDynamics,
    equations: Equations,
    levels: Levels,
    tolerance: f64,
}

impl<'a> Followed<'a> {
    /// None where there are no series.
    pub(super) fn new(
        dynamics: &'a dyn NodeDynamics,
        coupling: &Coupling,
        tolerance: f64,
    ) -> Option<Self> {
        let equations = Equations::of(dynamics, coupling)?;
        let middle: Vec<f64> =
            dynamics.start().iter().map(|[from, to]| 0.5 * (from + to)).collect();
        let mut orbit = Orbit::<1>::new(&equations.programs, 1);
        orbit.begin(0, &middle);
        orbit.expand(&equations.programs, 1);
        let [[of_flow], _] = equations.jacobian.sizes(&orbit);
        let levels = Levels::new(of_flow, equations.weight);
        Some(Self { dynamics, equations, levels, tolerance })
    }

    /// The mean step of an orbit without coupling, over some steps behind its first ones.
    pub(super) fn mean_step(&self) -> f64 {
        const TRIED: usize = 128;
        let steps = Steps::new(self.tolerance, self.dynamics.start(), f64::INFINITY);
        let mut orbit = Orbit::<1>::new(&self.equations.programs, steps.order());
        orbit.begin(0, &initial_states(self.dynamics.start(), 1, 0));
        let mut time = 0.0;
        for tried in 0..2 * TRIED {
            orbit.expand(&self.equations.programs, steps.order());
            let h = steps.of(&orbit, &self.equations.jacobian, &[self.levels.of(0.0)]);
            orbit.advance(&h, steps.order());
            time += if tried < TRIED { 0.0 } else { h[0] };
        }
        time / TRIED as f64
    }

    fn shares_steps(&self, a: Tangent, b: Tangent) -> bool {
        let level = |tangent: Tangent| self.levels.of(tangent.sigma).to_bits();
        (a.seed, level(a)) == (b.seed, level(b))
    }

    /// Tangents that are advanced together, by their places: about one orbit where that is worth it.
    pub(super) fn batches(&self, tangents: &[Tangent]) -> Vec<Vec<usize>> {
        let mut order: Vec<usize> = (0..tangents.len()).collect();
        order.sort_by(|&a, &b| {
            let key = |index: usize| (tangents[index].seed, self.levels.of(tangents[index].sigma));
            key(a).0.cmp(&key(b).0).then(key(a).1.total_cmp(&key(b).1))
        });
        let (shared, alone): (Vec<_>, Vec<_>) = order
            .chunk_by(|&a, &b| self.shares_steps(tangents[a], tangents[b]))
            .partition(|of_one_orbit| of_one_orbit.len() > ORBITS);
        let share = tangents.len().div_ceil(rayon::current_num_threads());
        let at_once = share.next_multiple_of(SHARED).min(MOST);
        let alone = alone.concat();
        let chunks = shared
            .iter()
            .flat_map(|of_one_orbit| of_one_orbit.chunks(at_once))
            .chain(alone.chunks(ORBITS));
        chunks.map(<[usize]>::to_vec).collect()
    }

    /// Exponents of a batch.
    pub(super) fn exponents(
        &self,
        set: InstructionSet,
        tangents: &Tangents<'_>,
    ) -> Result<Vec<Estimate>, DynamicsError> {
        let of = tangents.tangents;
        let is_shared = of.iter().all(|&tangent| self.shares_steps(tangent, of[0]));
        match (is_shared, of.len() > ORBITS) {
            (true, true) => set.run(InLanes::<1, SHARED>(self, tangents)),
            (true, false) => set.run(InLanes::<1, ORBITS>(self, tangents)),
            (false, _) => set.run(InLanes::<ORBITS, ORBITS>(self, tangents)),
        }
    }
}

/// `W` orbits, whose tangents are in vectors of `L`.
struct InLanes<'a, const W: usize, const L: usize>(&'a Followed<'a>, &'a Tangents<'a>);

impl<const W: usize, const L: usize> Work for InLanes<'_, W, L> {
    type Output = Result<Vec<Estimate>, DynamicsError>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Self(Followed { dynamics, equations, levels, tolerance }, all) = self;
        let plan = all.plan;
        // Numbers beyond the tangents repeat the last one and are never read.
        let tangent = |number: usize| all.tangents[number.min(all.tangents.len() - 1)];
        let count = all.tangents.len();
        let steps = Steps::new(*tolerance, dynamics.start(), plan.transient_and_block()[1] / 64.0);
        let mut orbit = Orbit::<W>::new(&equations.programs, steps.order());
        for lane in 0..W {
            let Tangent { seed, .. } = tangent(lane);
            orbit.begin(lane, &initial_states(dynamics.start(), 1, seed));
        }
        let bounds: [f64; W] = std::array::from_fn(|lane| levels.of(tangent(lane).sigma));
        let mut pieces: Vec<Piece<L>> = (0..count.div_ceil(L))
            .map(|piece| {
                let sigma = std::array::from_fn(|lane| tangent(piece * L + lane).sigma);
                Piece::new(&equations.jacobian, sigma, steps.order())
            })
            .collect();
        let mut clock = Clock::<W>::new(plan.transient_and_block());
        let mut means: Vec<Vec<[f64; L]>> = vec![Vec::new(); pieces.len()];
        let mut told = 0;
        while !clock.is_over() {
            for _ in 0..BETWEEN {
                orbit.expand(&equations.programs, steps.order());
                let mut h = steps.of(&orbit, &equations.jacobian, &bounds);
                clock.advance(&mut h);
                for piece in &mut pieces {
                    piece.advance(&equations.jacobian, &orbit, &h, steps.order());
                }
                orbit.advance(&h, steps.order());
            }
            if !orbit.is_bounded(dynamics.n_free(), all.escape_radius) {
                return Err(DynamicsError::Escaped { time: clock.latest() });
            }
            for piece in &mut pieces {
                piece.renormalise();
            }
            let ended = clock.ended();
            for (lane, ended) in ended.into_iter().enumerate() {
                let Some(ended) = ended else { continue };
                for (piece, means) in pieces.iter_mut().zip(&mut means) {
                    // Each has its own orbit, or all have one.
                    for tangent in if W == 1 { 0..L } else { lane..lane + 1 } {
                        let growth = piece.take_growth(tangent);
                        if let Some(block) = ended.block {
                            if means.len() <= block {
                                means.resize(block + 1, [0.0; L]);
                            }
                            means[block][tangent] = growth / ended.time;
                        }
                    }
                }
            }
            let done = plan.steps_until(clock.earliest());
            if (all.progress)((done - told) * count as u64).is_break() {
                return Err(DynamicsError::Cancelled);
            }
            told = done;
        }
        let of_piece = means.iter().map(|blocks| estimates(blocks, L));
        Ok(of_piece.flatten().take(count).collect())
    }
}

#[cfg(test)]
mod tests;
