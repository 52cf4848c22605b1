//! Where the slots of a step lie in memory: runs of numbers of a component.

use super::VECTOR;
use crate::Lanes;
use crate::integrators::step::{MOST_SLOTS, Slots};
use crate::tile::Tile;

/// Some runs of one component in every slot of a step; nothing in slots that the step does not have.
pub(crate) type Runs<'a> = [&'a mut [Tile]; MOST_SLOTS];

/// A part of one of the runs, in every slot.
pub(crate) struct Place<'p, 'a> {
    pub(crate) slots: &'p mut Runs<'a>,
    pub(crate) run: usize,
    pub(crate) part: usize,
}

impl Slots<Lanes<VECTOR>> for Place<'_, '_> {
    #[inline(always)]
    fn get(&self, slot: usize) -> Lanes<VECTOR> {
        vector(&self.slots[slot][self.run], self.part)
    }

    #[inline(always)]
    fn set(&mut self, slot: usize, number: Lanes<VECTOR>) {
        self.slots[slot][self.run].as_chunks_mut().0[self.part] = number.0;
    }
}

/// One part of a run.
#[inline(always)]
pub(crate) fn vector(run: &Tile, part: usize) -> Lanes<VECTOR> {
    Lanes(run.as_chunks().0[part])
}
