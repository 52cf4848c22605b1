//! A stage of equations that are chosen at run time: the same operations as those of compiled ones, with
//! the slope in memory.

use super::place::{Place, Runs, vector};
use super::{Stage, Strength, VECTOR};
use crate::instruction_set::Work;
use crate::integrators::fixed::AtStage;
use crate::integrators::step::Step;
use crate::tile::{TILE, slices, slices_mut};
use crate::{InstructionSet, NodeDynamics};

/// Does a stage of equations that are chosen at run time: the same operations, with the slope in memory.
pub(crate) fn stage(dynamics: &dyn NodeDynamics, set: InstructionSet, stage: &mut Stage<'_, '_>) {
    let Stage { method, number, slots, runs, slopes, .. } = stage;
    let (n, n_runs) = (slopes.len(), runs.len());
    let here = slots[method.points()[*number] * n..][..n].iter();
    let at = slices(here.map(|component| component[runs.clone()].as_flattened()));
    let mut to = slices_mut(slopes.iter_mut().map(|slope| slope[..n_runs].as_flattened_mut()));
    dynamics.flow(set, &at[..n], &mut to[..n]);
    set.run(FromSlopes(stage));
}

/// The rest of a stage whose slopes without inputs are known.
struct FromSlopes<'a, 'b, 'c>(&'a mut Stage<'b, 'c>);

impl Work for FromSlopes<'_, '_, '_> {
    type Output = ();

    // Loops over plain numbers, which the compiler knows how to put into vectors; closures are not compiled
    // for the instruction set of their surroundings.
    #[inline(always)]
    fn run(self) {
        let Stage { method, number, gains, inputs, runs, slopes, .. } = &mut *self.0;
        let (method, number) = (*method, *number);
        for Strength { equation, channel, of } in *gains {
            let slope = slopes[*equation][..runs.len()].as_flattened_mut();
            let of = &of.as_flattened()[..slope.len()];
            let input = &inputs[*channel].as_flattened()[..slope.len()];
            for number in 0..slope.len() {
                slope[number] += of[number] * input[number];
            }
        }
        method.at_stage(number, self);
    }
}

impl AtStage for FromSlopes<'_, '_, '_> {
    type Output = ();

    #[inline(always)]
    fn at<M: Step, const STAGE: usize>(self) {
        let Stage { h, slots, runs, slopes, .. } = self.0;
        let n = slopes.len();
        for c in 0..n {
            let mut component = slots.iter_mut().skip(c).step_by(n);
            let mut slots: Runs<'_> = std::array::from_fn(|_| {
                component.next().map_or(&mut [][..], |slot| &mut slot[runs.clone()])
            });
            for run in 0..runs.len() {
                for part in 0..TILE / VECTOR {
                    let f = vector(&slopes[c][run], part);
                    M::put::<STAGE, _>(&mut Place { slots: &mut slots, run, part }, f, *h);
                }
            }
        }
    }
}
