//! The master equation `ṡ = F(s)`, `δẏ = [DF(s) − σ DH] δy` of many σ side by side.
//!
//! Tangents are lanes of dual numbers. Those about one orbit share it as a plain number, computed
//! once; tangents with orbits of their own carry these in lanes as well. Either way each goes through
//! the same operations, so that its exponent has the same bits.

use std::marker::PhantomData;
use std::ops::Mul;

use super::{MAX_LANES, Plan, Tangent, estimates, normalise};
use crate::instruction_set::Work;
use crate::integrators::rk4::Flow;
use crate::random::initial_states;
use crate::{
    Coupling, Dual, DynamicsError, ESCAPE_RADIUS, Estimate, InstructionSet, Lanes, Oscillator,
    Progress, Scalar,
};

/// `ṡ = F(s)` with `δẏ = [DF(s) − σ DH] δy`, a σ for each tangent.
pub(super) struct MasterEquation<O, const L: usize> {
    pub(super) oscillator: O,
    pub(super) coupling: Coupling,
    pub(super) sigma: Lanes<L>,
}

impl<O: Oscillator<D>, V: Orbit, const D: usize, const L: usize> Flow<Dual<V, Lanes<L>>, D>
    for MasterEquation<O, L>
where
    Lanes<L>: Mul<V, Output = Lanes<L>>,
{
    #[inline(always)]
    fn at(&self, state: [Dual<V, Lanes<L>>; D]) -> [Dual<V, Lanes<L>>; D] {
        let mut slope = self.oscillator.flow(state);
        for c in 0..D {
            if c == self.coupling.to {
                // Named in full, since V might be other lanes.
                let damping = Mul::<Lanes<L>>::mul(self.sigma, state[self.coupling.from].tangent);
                slope[c].tangent = slope[c].tangent - damping;
            }
        }
        slope
    }
}

/// The orbit that tangents follow: a plain number for one orbit, lanes for one to each tangent.
pub(super) trait Orbit: Scalar {
    /// From the same component of the orbit of each tangent.
    fn from_lanes(lanes: &[f64]) -> Self;

    /// Whether all are within [`ESCAPE_RADIUS`]; a NaN is not.
    fn is_bounded(&self) -> bool;
}

impl Orbit for f64 {
    fn from_lanes(lanes: &[f64]) -> Self {
        lanes[0]
    }

    #[inline(always)]
    fn is_bounded(&self) -> bool {
        self.abs() < ESCAPE_RADIUS
    }
}

impl<const L: usize> Orbit for Lanes<L> {
    fn from_lanes(lanes: &[f64]) -> Self {
        Self(std::array::from_fn(|lane| lanes[lane]))
    }

    #[inline(always)]
    fn is_bounded(&self) -> bool {
        self.0.iter().all(f64::is_bounded)
    }
}

/// Tangents advanced together, at most [`MAX_LANES`].
pub(super) struct Batch<'a, O> {
    pub(super) oscillator: O,
    pub(super) coupling: Coupling,
    pub(super) plan: &'a Plan,
    pub(super) tangents: &'a [Tangent],
    pub(super) progress: Progress<'a>,
}

/// A batch in `L` lanes about an orbit of type `V`.
struct InLanes<'a, O, V, const D: usize, const L: usize>(Batch<'a, O>, PhantomData<V>);

impl<O> Batch<'_, O> {
    /// Runs the batch in as many lanes as it needs, about one orbit where its tangents have one.
    pub(super) fn run_with<const D: usize>(
        self,
        instruction_set: InstructionSet,
    ) -> Result<Vec<Estimate>, DynamicsError>
    where
        O: Oscillator<D>,
    {
        let seed = self.tangents[0].seed;
        let one_orbit = self.tangents.iter().all(|tangent| tangent.seed == seed);
        macro_rules! run {
            ($orbit:ty, $lanes:expr) => {
                instruction_set.run(InLanes::<O, $orbit, D, { $lanes }>(self, PhantomData))
            };
        }
        match (one_orbit, self.tangents.len()) {
            (true, 1) => run!(f64, 1),
            (true, 2..=8) => run!(f64, 8),
            (true, _) => run!(f64, MAX_LANES),
            (false, ..=4) => run!(Lanes<4>, 4),
            (false, 5..=8) => run!(Lanes<8>, 8),
            (false, _) => run!(Lanes<MAX_LANES>, MAX_LANES),
        }
    }
}

impl<O: Oscillator<D>, V: Orbit, const D: usize, const L: usize> Work for InLanes<'_, O, V, D, L>
where
    Lanes<L>: Mul<V, Output = Lanes<L>>,
{
    type Output = Result<Vec<Estimate>, DynamicsError>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Batch { oscillator, coupling, plan, tangents, progress } = self.0;
        // Lanes beyond the batch repeat its last tangent and are never read.
        let tangent = |lane: usize| tangents[lane.min(tangents.len() - 1)];
        let sigma = Lanes(std::array::from_fn(|lane| tangent(lane).sigma));
        let equation = MasterEquation { oscillator, coupling, sigma };
        let orbits: [[f64; D]; L] =
            std::array::from_fn(|lane| initial_states::<O, D>(1, tangent(lane).seed)[0]);
        let state = std::array::from_fn(|c| Dual {
            value: V::from_lanes(&orbits.map(|orbit| orbit[c])),
            tangent: Lanes([1.0; L]),
        });
        let count = tangents.len();
        let blocks =
            plan.block_means(&equation, state, normalise, |steps| progress(steps * count as u64))?;
        Ok(estimates(&blocks, count))
    }
}
