//! The range in which each number of an experiment makes sense, and why it ends where it does.

use super::checker::Checker;
use crate::spec::{RegionsSpec, SweepSpec};
use eigensync::Bound;
use eigensync::numbers::plain;
use user::Result;

/// A range of sensible values, both ends among them, and the reason for it.
#[derive(Clone, Copy)]
pub(super) struct Range {
    from: f64,
    to: f64,
    why: &'static str,
}

const fn range(from: f64, to: f64, why: &'static str) -> Range {
    Range { from, to, why }
}

/// Beyond it an orbit counts as escaped (`docs/model.md`, Integrators).
const LARGEST_COMPONENT: f64 = 1e6;

const STEP: Range = range(
    1e-9,
    10.0,
    "an oscillation takes about one to ten units of time, and below 1e-9 steps are lost in rounding",
);
const RENORMALISE: Range = range(
    1e-9,
    1e3,
    "perturbations grow by a factor of about e in a unit of time and must stay finite",
);
const RELATIVE_ERROR: Range =
    range(1e-6, 1.0, "an error of 1 tells nothing, and one of 1e-6 would take 10¹⁰ units of time");
const TOLERANCE: Range = range(
    1e-14,
    1e-2,
    "it is a relative error of each step: 1e-16 is that of rounding, and 1 is no accuracy at all",
);
const KICK: Range = range(
    1e-16,
    1e-3,
    "it is the relative size of what stands for rounding: below 1e-16 it rounds to nothing, and \
     beyond 1e-3 it is a noise of its own; 0 turns it off",
);
const ERROR: Range = range(
    1e-300,
    LARGEST_COMPONENT,
    "it is a difference of two components, and orbits with components beyond 1e6 count as escaped",
);
const PARAMETER: Range = range(
    -LARGEST_COMPONENT,
    LARGEST_COMPONENT,
    "with larger ones orbits leave the bounds within which they count as finite",
);
/// A figure is scaled to its page whatever the unit of its positions.
const FARTHEST: f64 = 1e9;

impl Checker<'_> {
    pub(super) fn within(&self, key: &str, value: f64, range: Range) -> Result<()> {
        let Range { from, to, why } = range;
        if (from..=to).contains(&value) {
            return Ok(());
        }
        let message =
            format!("is {}, but must be between {} and {}", plain(value), plain(from), plain(to));
        Err(self.problem(key, message).hint(why))
    }

    pub(super) fn msf_ranges(&self, step: f64, renormalise: f64) -> Result<()> {
        let spec = &self.experiment.msf;
        self.within("msf.step", step, STEP)?;
        self.within("msf.tolerance", spec.tolerance, TOLERANCE)?;
        self.within("msf.renormalise", renormalise, RENORMALISE)?;
        self.within("msf.relative_error", spec.relative_error, RELATIVE_ERROR)
    }

    pub(super) fn sweep_ranges(&self, spec: &SweepSpec, step: f64) -> Result<()> {
        self.within("sweep.step", step, STEP)?;
        self.within("sweep.tolerance", spec.tolerance(), TOLERANCE)?;
        if spec.kick != 0.0 {
            self.within("sweep.kick", spec.kick, KICK)?;
        }
        self.fixed("sweep.synchronised_below", spec.synchronised_below, ERROR)
    }

    pub(super) fn region_ranges(&self, spec: &RegionsSpec, n_nodes: usize) -> Result<()> {
        let distance = distance(n_nodes);
        self.fixed("regions.distance_within", spec.distance_within, distance)?;
        self.fixed("regions.distance_between", spec.distance_between, distance)?;
        self.fixed("regions.error_within", spec.error_within, ERROR)?;
        self.fixed("regions.error_between", spec.error_between, ERROR)
    }

    pub(super) fn threshold_range(&self, threshold: f64, n_nodes: usize) -> Result<()> {
        self.within("prediction.threshold", threshold, distance(n_nodes))
    }

    pub(super) fn parameter_range(&self, key: &str, value: f64) -> Result<()> {
        self.within(key, value, PARAMETER)
    }

    pub(super) fn position_range(&self, label: &str, [x, y]: [f64; 2]) -> Result<()> {
        if [x, y].iter().all(|at| at.abs() <= FARTHEST) {
            return Ok(());
        }
        let message = format!(
            "has the position of node \"{label}\" at [{}, {}], but both must be between {} and {}",
            plain(x),
            plain(y),
            plain(-FARTHEST),
            plain(FARTHEST)
        );
        Err(self.problem("figure.layout", message))
    }

    fn fixed(&self, key: &str, bound: Bound, range: Range) -> Result<()> {
        match bound {
            Bound::Fixed(value) => self.within(key, value, range),
            Bound::OfLargest(_) => Ok(()),
        }
    }
}

/// δe_ij adds up |v_k,i − v_k,j| ≤ √2 over at most N modes.
fn distance(n_nodes: usize) -> Range {
    let why = "it is an eigenvector distance, at most √2 for each mode";
    range(1e-300, 2.0 * n_nodes as f64, why)
}
