//! The master equation `ṡ = F(s)`, `δẏ = [DF(s) − σ DH] δy` of many σ side by side, for equations that
//! are compiled.
//!
//! Tangents are lanes of dual numbers. Those about one orbit share it as a plain number, computed
//! once; tangents with orbits of their own carry these in lanes as well. Either way each goes through
//! the same operations, so that its exponent has the same bits.

use std::marker::PhantomData;
use std::ops::Mul;

use super::growth::{Growing, Tangents, estimates, length, log, vanished};
use crate::instruction_set::Work;
use crate::integrators::rk4::{self, Flow};
use crate::random::initial_states;
use crate::tile::TILE;
use crate::{Dual, DynamicsError, Estimate, InstructionSet, Lanes, Oscillator, Scalar};

/// Exponents of compiled equations, in as many lanes as they need, about one orbit where they have one.
pub(crate) fn exponents<O: Oscillator<D>, const D: usize>(
    oscillator: O,
    set: InstructionSet,
    tangents: &Tangents<'_>,
) -> Result<Vec<Estimate>, DynamicsError> {
    let of = tangents.tangents;
    let one_orbit = of.iter().all(|tangent| tangent.seed == of[0].seed);
    macro_rules! run {
        ($orbit:ty, $lanes:expr) => {
            set.run(InLanes::<O, $orbit, D, { $lanes }>(oscillator, tangents, PhantomData))
        };
    }
    match (one_orbit, of.len()) {
        (true, 1) => run!(f64, 1),
        (true, 2..=8) => run!(f64, 8),
        // Where vectors are this wide, an orbit beside each tangent costs less than one that is spread over
        // all of them.
        (true, _) if set == InstructionSet::Avx512 => run!(Lanes<TILE>, TILE),
        (true, _) => run!(f64, TILE),
        (false, ..=4) => run!(Lanes<4>, 4),
        (false, 5..=8) => run!(Lanes<8>, 8),
        (false, _) => run!(Lanes<TILE>, TILE),
    }
}

/// `ṡ = F(s)` with `δẏ = [DF(s) − σ DH] δy`, a σ for each tangent.
struct MasterEquation<O, const L: usize> {
    oscillator: O,
    /// Equation, component and σ B of every entry of DH.
    damping: Vec<(usize, usize, Lanes<L>)>,
}

impl<O: Oscillator<D>, V: Orbit, const D: usize, const L: usize> Flow<Dual<V, Lanes<L>>, D>
    for MasterEquation<O, L>
where
    Lanes<L>: Mul<V, Output = Lanes<L>>,
{
    #[inline(always)]
    fn at(&self, state: [Dual<V, Lanes<L>>; D]) -> [Dual<V, Lanes<L>>; D] {
        let mut slope = self.oscillator.flow(state);
        for &(equation, component, sigma) in &self.damping {
            for c in 0..D {
                if c == equation {
                    // Named in full, since V might be other lanes.
                    let damping = Mul::<Lanes<L>>::mul(sigma, state[component].tangent);
                    slope[c].tangent = slope[c].tangent - damping;
                }
            }
        }
        slope
    }
}

/// The orbit that tangents follow: a plain number for one orbit, lanes for one to each tangent.
trait Orbit: Scalar {
    /// From the same component of the orbit of each tangent.
    fn from_lanes(lanes: &[f64]) -> Self;

    /// Whether all are within a radius; a NaN is not.
    fn is_within(&self, radius: f64) -> bool;
}

impl Orbit for f64 {
    fn from_lanes(lanes: &[f64]) -> Self {
        lanes[0]
    }

    #[inline(always)]
    fn is_within(&self, radius: f64) -> bool {
        self.abs() < radius
    }
}

impl<const L: usize> Orbit for Lanes<L> {
    fn from_lanes(lanes: &[f64]) -> Self {
        Self(std::array::from_fn(|lane| lanes[lane]))
    }

    #[inline(always)]
    fn is_within(&self, radius: f64) -> bool {
        self.0.iter().all(|x| x.is_within(radius))
    }
}

/// Tangents in `L` lanes about an orbit of type `V`.
struct InLanes<'a, O, V, const D: usize, const L: usize>(O, &'a Tangents<'a>, PhantomData<V>);

impl<O: Oscillator<D>, V: Orbit, const D: usize, const L: usize> Work for InLanes<'_, O, V, D, L>
where
    Lanes<L>: Mul<V, Output = Lanes<L>>,
{
    type Output = Result<Vec<Estimate>, DynamicsError>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Self(oscillator, Tangents { coupling, plan, tangents, escape_radius, progress }, _) =
            self;
        // Lanes beyond the batch repeat its last tangent and are never read.
        let tangent = |lane: usize| tangents[lane.min(tangents.len() - 1)];
        let sigma = |weight| Lanes(std::array::from_fn(|lane| tangent(lane).sigma * weight));
        let entries = coupling.constant_derivative().expect("others are evaluated in tiles");
        let damping = entries.map(|(d, c, weight)| (d, c, sigma(weight)));
        let equation = MasterEquation { oscillator, damping: damping.collect() };
        let orbits: [Vec<f64>; L] =
            std::array::from_fn(|lane| initial_states(&O::START, 1, tangent(lane).seed));
        let state = std::array::from_fn(|c| Dual {
            value: V::from_lanes(&std::array::from_fn::<f64, L, _>(|lane| orbits[lane][c])),
            tangent: Lanes([1.0; L]),
        });
        let count = tangents.len();
        let mut growth = Growth { equation, state, escape_radius: *escape_radius };
        let blocks = plan.block_means(&mut growth, |steps| progress(steps * count as u64))?;
        Ok(estimates(&blocks, count))
    }
}

/// Orbits and tangents as they are, from a cache line on: sixteen lanes that straddle two lines cost half
/// as much again, and where they come to lie would else be chance.
#[repr(align(64))]
struct Growth<O, V, const D: usize, const L: usize> {
    equation: MasterEquation<O, L>,
    state: [Dual<V, Lanes<L>>; D],
    escape_radius: f64,
}

impl<O: Oscillator<D>, V: Orbit, const D: usize, const L: usize> Growing<L> for Growth<O, V, D, L>
where
    Lanes<L>: Mul<V, Output = Lanes<L>>,
{
    #[inline(always)]
    fn advance(&mut self, n_steps: u64, h: f64) {
        let mut state = self.state;
        for _ in 0..n_steps {
            state = rk4::step(&self.equation, state, h);
        }
        self.state = state;
    }

    #[inline(always)]
    fn is_bounded(&self) -> bool {
        self.state.iter().all(|component| component.value.is_within(self.escape_radius))
    }

    #[inline(always)]
    fn renormalise(&mut self) -> [f64; L] {
        let mut logs = [0.0; L];
        for lane in 0..L {
            let length = length(self.state.iter().map(|x| x.tangent.0[lane]));
            for x in &mut self.state {
                let tangent = &mut x.tangent.0[lane];
                *tangent = if vanished(length) { 1.0 } else { *tangent / length };
            }
            logs[lane] = log(length);
        }
        logs
    }
}
