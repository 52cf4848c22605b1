//! The classical step of fourth order, written with the points at which stages evaluate the equations:
//!
//! ```text
//! x_1 = x + h/2 f(x)    x_2 = x + h/2 f(x_1)    x_3 = x + h f(x_2)
//! x(t + h) = x + [(x_1 − x) + 2 (x_2 − x) + (x_3 − x)] / 3 + h/6 f(x_3)
//! ```
//!
//! so that a stage reads points that are there already and writes one, and nothing else.
//!
//! Source: W. Kutta, Z. Math. Phys. 46, 435 (1901).

use super::step::{Slots, Step};
use crate::Scalar;

/// RK4, whose slots hold x, x_1, x_2 and x_3.
pub(crate) struct Rk4;

/// How far from x the stages put the next point, in h.
pub(crate) const ADVANCES: [f64; 3] = [0.5, 0.5, 1.0];

/// Points at which a step evaluates the equations.
pub(crate) const POINTS: usize = ADVANCES.len() + 1;

impl Step for Rk4 {
    const AT: &'static [usize] = &[0, 1, 2, 3];
    const SLOTS: usize = POINTS;

    #[inline(always)]
    fn put<const STAGE: usize, S: Scalar>(slots: &mut impl Slots<S>, f: S, h: f64) {
        let x = slots.get(0);
        if STAGE < ADVANCES.len() {
            slots.set(STAGE + 1, x + f * (ADVANCES[STAGE] * h));
        } else {
            slots.set(0, last([x, slots.get(1), slots.get(2), slots.get(3)], f, h));
        }
    }
}

/// x(t + h) from the points and the slope at the last of them.
#[inline(always)]
pub(crate) fn last<S: Scalar>([x, x_1, x_2, x_3]: [S; POINTS], f: S, h: f64) -> S {
    let (d_1, d_2, d_3) = (x_1 - x, x_2 - x, x_3 - x);
    x + (((d_1 + d_3) + (d_2 + d_2)) * (1.0 / 3.0) + f * (h / 6.0))
}
