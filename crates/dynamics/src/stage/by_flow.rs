//! A stage of equations that are chosen at run time: the same operations as those of compiled ones, with
//! the slope in memory. A map has a single stage, whose slope with its inputs is the next state.

use super::{ADVANCES, Stage, Strength, last};
use crate::instruction_set::Work;
use crate::tile::{slices, slices_mut};
use crate::{InstructionSet, NodeDynamics};

/// Does a stage of equations that are chosen at run time: the same operations, with the slope in memory.
pub(crate) fn stage(dynamics: &dyn NodeDynamics, set: InstructionSet, stage: &mut Stage<'_, '_>) {
    let Stage { point, points, runs, slopes, .. } = stage;
    let (n, n_runs) = (slopes.len(), runs.len());
    let here = points[*point * n..][..n].iter();
    let at = slices(here.map(|component| component[runs.clone()].as_flattened()));
    let mut to = slices_mut(slopes.iter_mut().map(|slope| slope[..n_runs].as_flattened_mut()));
    dynamics.flow(set, &at[..n], &mut to[..n]);
    set.run(FromSlopes { stage, is_map: dynamics.is_map() });
}

/// The rest of a stage whose slopes without inputs are known.
struct FromSlopes<'a, 'b, 'c> {
    stage: &'a mut Stage<'b, 'c>,
    is_map: bool,
}

impl Work for FromSlopes<'_, '_, '_> {
    type Output = ();

    // Loops over plain numbers, which the compiler knows how to put into vectors; closures are not compiled
    // for the instruction set of their surroundings.
    #[inline(always)]
    fn run(self) {
        let Stage { point, h, gains, inputs, points, runs, slopes } = self.stage;
        let n = slopes.len();
        for Strength { equation, channel, of } in *gains {
            let slope = slopes[*equation][..runs.len()].as_flattened_mut();
            let of = &of.as_flattened()[..slope.len()];
            let input = &inputs[*channel].as_flattened()[..slope.len()];
            for number in 0..slope.len() {
                slope[number] += of[number] * input[number];
            }
        }
        let (x, ahead) = points.split_at_mut(n);
        for c in 0..n {
            let x = x[c][runs.clone()].as_flattened_mut();
            let slope = &slopes[c].as_flattened()[..x.len()];
            if self.is_map {
                ahead[c][runs.clone()].as_flattened_mut().copy_from_slice(slope);
            } else if *point < ADVANCES.len() {
                let next = &mut ahead[*point * n + c][runs.clone()].as_flattened_mut()[..x.len()];
                let advance = ADVANCES[*point] * *h;
                for number in 0..x.len() {
                    next[number] = x[number] + slope[number] * advance;
                }
            } else {
                let x_1 = &ahead[c][runs.clone()].as_flattened()[..x.len()];
                let x_2 = &ahead[n + c][runs.clone()].as_flattened()[..x.len()];
                let x_3 = &ahead[2 * n + c][runs.clone()].as_flattened()[..x.len()];
                for number in 0..x.len() {
                    let points = [x[number], x_1[number], x_2[number], x_3[number]];
                    x[number] = last(points, slope[number], *h);
                }
            }
        }
    }
}
