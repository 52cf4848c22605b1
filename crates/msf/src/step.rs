//! What the step of RK4 does to a number, seen from the same number at half the step.
//!
//! RK4 errs in proportion to h⁴ for small h, so that nearly all of what the step does is gone at half
//! of it. Spikes and spirals are often not sampled finely enough for that law (Λ(0) of Rössler c = 9 is
//! off by 0.0083 at h = 0.1 and by 0.0007 at 0.05), so that nothing is extrapolated: what half the step
//! changes is measured, with its error, and is part of the error of the number where it is beyond chance.

use dynamics::Estimate;

/// A change counts as real at this many of its standard errors: one of 370 by chance.
const CERTAIN: f64 = 3.0;

/// The step of the integrator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// As asked for.
    Asked,
    /// Half of it, or a thousandth of the tolerance of series, over the same time.
    Halved,
    /// As asked for, of orbits that have settled for longer by the time of an average.
    Later,
}

/// Whether a change is more than chance.
pub(crate) fn is_certain(shift: Estimate) -> bool {
    shift.mean.abs() > CERTAIN * shift.standard_error
}

/// The standard error of a number with what the step does to it, where that is more than chance.
pub(crate) fn with_shift(standard_error: f64, shift: Estimate) -> f64 {
    if is_certain(shift) { standard_error.hypot(shift.mean) } else { standard_error }
}
