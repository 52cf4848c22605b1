//! One stage of the step of a network, for the nodes of some runs whose inputs are known: the equations
//! are evaluated, the inputs added, and what follows put into the slots of a
//! [`Step`](crate::integrators::step::Step).

pub(crate) mod by_flow;
pub(crate) mod fused;
mod place;

use std::ops::Range;

use crate::integrators::fixed::Fixed;
use crate::tile::Tile;

/// Runs whose inputs are summed before their equations are evaluated: enough that calling these costs
/// nothing beside, few enough that all stays in the nearest cache.
pub(crate) const RUNS: usize = 32;

/// Numbers on which a stage works together: one AVX-512 or four SSE2 registers.
pub(crate) const VECTOR: usize = 8;

/// A stage of the nodes of some runs.
pub struct Stage<'a, 'b> {
    pub(crate) method: Fixed,
    /// Which of its stages this is.
    pub(crate) number: usize,
    pub(crate) h: f64,
    pub(crate) gains: &'a [Strength],
    /// Σ_j w_ij h(x_j) of each channel, `[channel][run]`, from the first of `runs` on.
    pub(crate) inputs: &'a [[Tile; RUNS]],
    /// The slots of the step as `[slot · D + component][run]`.
    pub(crate) slots: &'a mut [&'b mut [Tile]],
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
