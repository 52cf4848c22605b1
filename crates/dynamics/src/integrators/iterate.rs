//! The step of a map, whose slope is its next state.

use super::step::{Slots, Step};
use crate::Scalar;

/// A single stage, which puts the next state beside the present one: neighbours still read that.
pub(crate) struct Iterate;

impl Step for Iterate {
    const AT: &'static [usize] = &[0];
    const SLOTS: usize = 2;

    #[inline(always)]
    fn put<const STAGE: usize, S: Scalar>(slots: &mut impl Slots<S>, f: S, _: f64) {
        slots.set(1, f);
    }
}
