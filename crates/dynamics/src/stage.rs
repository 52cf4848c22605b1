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

pub(crate) mod by_flow;
pub(crate) mod fused;

use std::ops::Range;

use crate::Scalar;
use crate::tile::Tile;

/// Runs whose inputs are summed before their equations are evaluated: enough that calling these costs
/// nothing beside, few enough that all stays in the nearest cache.
pub(crate) const RUNS: usize = 32;

/// How far from x the stages put the next point, in h.
pub(crate) const ADVANCES: [f64; 3] = [0.5, 0.5, 1.0];

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
    /// The same in as many tiles as a stage has, beside which a loop over plain numbers can go.
    pub(crate) of: Vec<Tile>,
}

/// x(t + h) from the points and the slope at the last of them.
#[inline(always)]
pub(crate) fn last<S: Scalar>([x, x_1, x_2, x_3]: [S; POINTS], f: S, h: f64) -> S {
    let (d_1, d_2, d_3) = (x_1 - x, x_2 - x, x_3 - x);
    x + (((d_1 + d_3) + (d_2 + d_2)) * (1.0 / 3.0) + f * (h / 6.0))
}
