//! One stage of the Runge–Kutta step of a network, for the nodes of some runs whose inputs are known.
//!
//! Written with the points at which stages evaluate the equations, f(x) being the right-hand side, the
//! classical step of fourth order is
//!
//! ```text
//! x_1 = x + h/2 f(x)    x_2 = x + h/2 f(x_1)    x_3 = x + h f(x_2)
//! x(t + h) = x + [(x_1 − x) + 2 (x_2 − x) + (x_3 − x)] / 3 + h/6 f(x_3)
//! ```
//!
//! so that a stage reads points that are there already and writes one, and nothing else.
//!
//! Source: W. Kutta, Z. Math. Phys. 46, 435 (1901).

use std::ops::Range;

use crate::instruction_set::Work;
use crate::node::MAX_COMPONENTS;
use crate::{InstructionSet, Lanes, NodeDynamics, Oscillator};

/// Numbers that are handed to equations together: sixteen nodes of a single replica, or one node of
/// sixteen, or what lies between. Numbers of lanes divide it.
pub const TILE: usize = 16;

/// Numbers of one component, of some nodes and lanes: equations need not know which.
pub type Tile = [f64; TILE];

/// Runs whose inputs are summed before their equations are evaluated: enough that calling these costs
/// nothing beside, few enough that all stays in the nearest cache.
pub(crate) const RUNS: usize = 32;

/// Numbers on which equations are evaluated together: one AVX-512 or four SSE2 registers.
const VECTOR: usize = 8;

/// How far from x the stages put the next point, in h.
const ADVANCES: [f64; 3] = [0.5, 0.5, 1.0];

/// Points at which a step evaluates the equations.
pub(crate) const POINTS: usize = ADVANCES.len() + 1;

/// A stage of the nodes of some runs.
pub struct Stage<'a, 'b> {
    /// The point at which the equations are evaluated.
    pub(crate) point: usize,
    pub(crate) h: f64,
    pub(crate) gains: &'a [Strength],
    /// Σ_j w_ij h(x_j) of each channel, `[channel][run]`, from the first of `runs` on.
    pub(crate) inputs: &'a [[Tile; RUNS]],
    /// x, x_1, x_2, x_3 as `[point · D + component][run]`.
    pub(crate) points: &'a mut [&'b mut [Tile]],
    pub(crate) runs: Range<usize>,
    /// Room for the slopes of these runs, component by component.
    pub(crate) slopes: &'a mut [[Tile; RUNS]],
}

/// What a channel adds to an equation, ε B of every number in a tile.
pub(crate) struct Strength {
    pub(crate) equation: usize,
    pub(crate) channel: usize,
    pub(crate) of: Tile,
}

/// A stage of nodes whose equations are compiled.
struct Fused<'a, 'b, 'c, O, const D: usize> {
    oscillator: &'a O,
    stage: &'a mut Stage<'b, 'c>,
}

/// Does a stage of compiled equations in one go, without a slope that goes through memory.
pub(crate) fn fused<O: Oscillator<D>, const D: usize>(
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
        match self.stage.point {
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
                let gain = [(gain.equation, &inputs[gain.channel], &gain.of)];
                points.evaluate::<O, POINT>(oscillator, h, &gain);
            }
            _ => {
                let gains: Vec<_> =
                    gains.iter().map(|g| (g.equation, &inputs[g.channel], &g.of)).collect();
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
        let mut points = stage.points.iter_mut();
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

/// Does a stage of equations that are chosen at run time: the same operations, with the slope in memory.
pub(crate) fn by_flow<N: NodeDynamics + ?Sized>(
    dynamics: &N,
    set: InstructionSet,
    stage: &mut Stage<'_, '_>,
) {
    let Stage { point, points, runs, slopes, .. } = stage;
    let (n, n_runs) = (slopes.len(), runs.len());
    let mut at: [&[f64]; MAX_COMPONENTS] = [&[]; MAX_COMPONENTS];
    for (at, component) in at.iter_mut().zip(&points[*point * n..][..n]) {
        *at = component[runs.clone()].as_flattened();
    }
    let mut to: [&mut [f64]; MAX_COMPONENTS] = std::array::from_fn(|_| &mut [][..]);
    for (to, slope) in to.iter_mut().zip(slopes.iter_mut()) {
        *to = slope[..n_runs].as_flattened_mut();
    }
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

/// x(t + h) from the points and the slope at the last of them.
#[inline(always)]
fn last<const L: usize>([x, x_1, x_2, x_3]: [Lanes<L>; POINTS], f: Lanes<L>, h: f64) -> Lanes<L> {
    let (d_1, d_2, d_3) = (x_1 - x, x_2 - x, x_3 - x);
    x + (((d_1 + d_3) + (d_2 + d_2)) * (1.0 / 3.0) + f * (h / 6.0))
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
