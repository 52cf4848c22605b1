//! A stage of RK4 of equations that are compiled, in one go, without a slope that goes through memory: what
//! [`super::by_flow`] does, faster.

use super::{RUNS, Stage, VECTOR};
use crate::instruction_set::Work;
use crate::integrators::rk4_in_slots::{ADVANCES, POINTS, last};
use crate::tile::{TILE, Tile};
use crate::{InstructionSet, Lanes, Oscillator};

/// A stage of nodes whose equations are compiled.
struct Fused<'a, 'b, 'c, O, const D: usize> {
    oscillator: &'a O,
    stage: &'a mut Stage<'b, 'c>,
}

/// Does a stage of RK4 of compiled equations.
pub(crate) fn stage<O: Oscillator<D>, const D: usize>(
    oscillator: &O,
    set: InstructionSet,
    stage: &mut Stage<'_, '_>,
) {
    set.run(Fused { oscillator, stage });
}

impl<O: Oscillator<D>, const D: usize> Work for Fused<'_, '_, '_, O, D> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        match self.stage.number {
            0 => self.at::<0>(),
            1 => self.at::<1>(),
            2 => self.at::<2>(),
            _ => self.at::<3>(),
        }
    }
}

impl<O: Oscillator<D>, const D: usize> Fused<'_, '_, '_, O, D> {
    #[inline(always)]
    fn at<const POINT: usize>(self) {
        let Self { oscillator, stage } = self;
        // Copies, which no number that is written can change.
        let (h, gains, inputs) = (stage.h, stage.gains, stage.inputs);
        let points = Points::<D>::of(stage);
        match gains {
            // Most couplings have one entry, which is then known before the first run.
            [gain] => {
                let gain = [(gain.equation, &inputs[gain.channel], &gain.of[0])];
                points.evaluate::<O, POINT>(oscillator, h, &gain);
            }
            _ => {
                let gains: Vec<_> =
                    gains.iter().map(|g| (g.equation, &inputs[g.channel], &g.of[0])).collect();
                points.evaluate::<O, POINT>(oscillator, h, &gains);
            }
        }
    }
}

/// The points of the nodes of a stage, `[point][component][run]`.
struct Points<'a, const D: usize>([[&'a mut [Tile]; D]; POINTS]);

impl<'a, const D: usize> Points<'a, D> {
    #[inline(always)]
    fn of(stage: &'a mut Stage<'_, '_>) -> Self {
        let (start, n_runs) = (stage.runs.start, stage.runs.len());
        let mut points = stage.slots.iter_mut();
        Self(std::array::from_fn(|_| {
            std::array::from_fn(|_| {
                &mut points.next().expect("a point has D components")[start..][..n_runs]
            })
        }))
    }

    /// Evaluates the equations at one of the points, and puts the next one; from the last, x(t + h). Of
    /// each entry of B: its equation, the inputs of its channel, and its strength.
    #[inline(always)]
    fn evaluate<O: Oscillator<D>, const POINT: usize>(
        self,
        oscillator: &O,
        h: f64,
        gains: &[(usize, &[Tile; RUNS], &Tile)],
    ) {
        let Self(points) = self;
        for run in 0..points[0][0].len() {
            for part in 0..TILE / VECTOR {
                let place = (run, part);
                let (x, at) = (vectors(&points[0], place), vectors(&points[POINT], place));
                let mut f = oscillator.flow(at);
                for &(equation, inputs, strength) in gains {
                    let input = vector(strength, part) * vector(&inputs[run], part);
                    for c in 0..D {
                        if c == equation {
                            f[c] = f[c] + input;
                        }
                    }
                }
                if POINT < ADVANCES.len() {
                    for c in 0..D {
                        put(points[POINT + 1][c], place, x[c] + f[c] * (ADVANCES[POINT] * h));
                    }
                } else {
                    let (x_1, x_2) = (vectors(&points[1], place), vectors(&points[2], place));
                    for c in 0..D {
                        put(points[0][c], place, last([x[c], x_1[c], x_2[c], at[c]], f[c], h));
                    }
                }
            }
        }
    }
}

/// One part of a run of every component.
#[inline(always)]
fn vectors<const D: usize>(
    point: &[&mut [Tile]; D],
    (run, part): (usize, usize),
) -> [Lanes<VECTOR>; D] {
    // A loop, since closures are not compiled for the instruction set of their surroundings.
    let mut vectors = [Lanes([0.0; VECTOR]); D];
    for c in 0..D {
        vectors[c] = vector(&point[c][run], part);
    }
    vectors
}

#[inline(always)]
fn put(component: &mut [Tile], (run, part): (usize, usize), value: Lanes<VECTOR>) {
    component[run].as_chunks_mut().0[part] = value.0;
}

/// One part of a run.
#[inline(always)]
fn vector(run: &Tile, part: usize) -> Lanes<VECTOR> {
    Lanes(run.as_chunks().0[part])
}
