//! A stage of equations that are chosen at run time: the same operations as those of compiled ones, with
//! the slope in memory.

use super::{ADVANCES, Stage, Strength, last};
use crate::instruction_set::Work;
use crate::tile::{slices, slices_mut};
use crate::{InstructionSet, Lanes, NodeDynamics};

/// Does a stage of equations that are chosen at run time: the same operations, with the slope in memory.
pub(crate) fn stage(dynamics: &dyn NodeDynamics, set: InstructionSet, stage: &mut Stage<'_, '_>) {
    let Stage { point, points, runs, slopes, .. } = stage;
    let (n, n_runs) = (slopes.len(), runs.len());
    let here = points[*point * n..][..n].iter();
    let at = slices(here.map(|component| component[runs.clone()].as_flattened()));
    let mut to = slices_mut(slopes.iter_mut().map(|slope| slope[..n_runs].as_flattened_mut()));
    dynamics.flow(set, &at[..n], &mut to[..n]);
    set.run(FromSlopes(stage));
}

/// The rest of a stage whose slopes without inputs are known.
struct FromSlopes<'a, 'b, 'c>(&'a mut Stage<'b, 'c>);

impl Work for FromSlopes<'_, '_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Stage { point, h, gains, inputs, points, runs, slopes } = self.0;
        for Strength { equation, channel, of } in *gains {
            for (slope, input) in slopes[*equation].iter_mut().zip(&inputs[*channel]) {
                let input = Lanes(*of) * Lanes(*input);
                *slope = (Lanes(*slope) + input).0;
            }
        }
        let n = slopes.len();
        for (c, slopes) in slopes.iter().enumerate() {
            for (run, &slope) in runs.clone().zip(slopes) {
                let [x, x_1, x_2, x_3] =
                    [0, 1, 2, 3].map(|point| Lanes(points[point * n + c][run]));
                let slope = Lanes(slope);
                match ADVANCES.get(*point) {
                    Some(advance) => {
                        points[(*point + 1) * n + c][run] = (x + slope * (advance * *h)).0;
                    }
                    None => points[c][run] = last([x, x_1, x_2, x_3], slope, *h).0,
                }
            }
        }
    }
}
