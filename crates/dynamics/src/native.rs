//! Oscillators whose equations are compiled, as node dynamics.

use std::fmt;

use equations::Program;

use crate::instruction_set::Work;
use crate::integrators::rk4::{self, Flow};
use crate::lyapunov::{Tangents, master_equation};
use crate::stage::{self, Stage};
use crate::{
    Dual, DynamicsError, Estimate, Fused, InstructionSet, Lanes, Linearised, LinearisedMut,
    NodeDynamics, Oscillator, Scalar, trace,
};

/// Numbers on which equations are evaluated together.
const VECTOR: usize = 8;

/// An oscillator as node dynamics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Native<O, const D: usize>(pub O);

impl<O: Oscillator<D>, const D: usize> Native<O, D> {
    /// Of any oscillator with `D` components.
    pub fn new(oscillator: O) -> Self {
        Self(oscillator)
    }
}

impl<O: Oscillator<D> + fmt::Debug, const D: usize> NodeDynamics for Native<O, D> {
    fn components(&self) -> Vec<&str> {
        O::COMPONENTS.to_vec()
    }

    fn start(&self) -> &[[f64; 2]] {
        &O::START
    }

    fn is_map(&self) -> bool {
        O::IS_MAP
    }

    fn flow(&self, set: InstructionSet, x: &[&[f64]], slope: &mut [&mut [f64]]) {
        set.run(Everywhere::<O, D> { oscillator: &self.0, x: first(x), slope });
    }

    fn tangent_flow(&self, set: InstructionSet, at: Linearised<'_>, slope: LinearisedMut<'_, '_>) {
        let (value, tangent) = (first(at.value), first(at.tangent));
        set.run(LinearisedEverywhere::<O, D> { oscillator: &self.0, value, tangent, slope });
    }

    fn program(&self) -> Option<Program> {
        Some(trace(&self.0))
    }

    fn fused(&self) -> Option<&dyn Fused> {
        (!O::IS_MAP).then_some(self as &dyn Fused)
    }
}

impl<O: Oscillator<D>, const D: usize> Fused for Native<O, D> {
    fn advance(&self, state: &mut [f64], h: f64) {
        let x: [f64; D] = std::array::from_fn(|c| state[c]);
        state.copy_from_slice(&rk4::step(&Isolated(&self.0), x, h));
    }

    fn stage(&self, set: InstructionSet, stage: &mut Stage<'_, '_>) {
        stage::fused::stage(&self.0, set, stage);
    }

    fn exponents(
        &self,
        set: InstructionSet,
        tangents: &Tangents<'_>,
    ) -> Result<Vec<Estimate>, DynamicsError> {
        master_equation::exponents(self.0, set, tangents)
    }
}

/// The flow of an oscillator by itself.
struct Isolated<'a, O>(&'a O);

impl<S: Scalar, O: Oscillator<D>, const D: usize> Flow<S, D> for Isolated<'_, O> {
    #[inline(always)]
    fn at(&self, state: [S; D]) -> [S; D] {
        self.0.flow(state)
    }
}

/// The flow at every number of some slices.
struct Everywhere<'a, 'b, O, const D: usize> {
    oscillator: &'a O,
    x: [&'a [f64]; D],
    slope: &'a mut [&'b mut [f64]],
}

impl<O: Oscillator<D>, const D: usize> Work for Everywhere<'_, '_, O, D> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let length = self.x[0].len();
        let whole = length - length % VECTOR;
        for start in (0..whole).step_by(VECTOR) {
            let slope = self.oscillator.flow(load::<D>(&self.x, start));
            for c in 0..D {
                self.slope[c][start..][..VECTOR].copy_from_slice(&slope[c].0);
            }
        }
        for number in whole..length {
            let mut at = [0.0; D];
            for c in 0..D {
                at[c] = self.x[c][number];
            }
            let slope = self.oscillator.flow(at);
            for c in 0..D {
                self.slope[c][number] = slope[c];
            }
        }
    }
}

/// The same with a tangent to each number.
struct LinearisedEverywhere<'a, 'b, 'c, O, const D: usize> {
    oscillator: &'a O,
    value: [&'a [f64]; D],
    tangent: [&'a [f64]; D],
    slope: LinearisedMut<'b, 'c>,
}

impl<O: Oscillator<D>, const D: usize> Work for LinearisedEverywhere<'_, '_, '_, O, D> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let LinearisedMut { value: values, tangent: rates } = self.slope;
        let length = self.value[0].len();
        let whole = length - length % VECTOR;
        for start in (0..whole).step_by(VECTOR) {
            let (value, tangent) = (load(&self.value, start), load(&self.tangent, start));
            let mut at = [Dual { value: value[0], tangent: tangent[0] }; D];
            for c in 0..D {
                at[c] = Dual { value: value[c], tangent: tangent[c] };
            }
            let slope = self.oscillator.flow(at);
            for c in 0..D {
                values[c][start..][..VECTOR].copy_from_slice(&slope[c].value.0);
                rates[c][start..][..VECTOR].copy_from_slice(&slope[c].tangent.0);
            }
        }
        for number in whole..length {
            let at =
                |c: usize| Dual { value: self.value[c][number], tangent: self.tangent[c][number] };
            let slope = self.oscillator.flow(std::array::from_fn(at));
            for c in 0..D {
                values[c][number] = slope[c].value;
                rates[c][number] = slope[c].tangent;
            }
        }
    }
}

/// The numbers of every component from one on.
#[inline(always)]
fn load<const D: usize>(x: &[&[f64]; D], start: usize) -> [Lanes<VECTOR>; D] {
    let mut at = [Lanes([0.0; VECTOR]); D];
    for c in 0..D {
        at[c].0.copy_from_slice(&x[c][start..][..VECTOR]);
    }
    at
}

/// The slices of the first `D` components.
fn first<'a, const D: usize>(x: &'a [&'a [f64]]) -> [&'a [f64]; D] {
    std::array::from_fn(|c| x[c])
}
