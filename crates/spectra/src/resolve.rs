//! From a request to the plan that solvers work from, and to the solver as far as it is decided.

use graph::SymmetricForm;

use crate::choice;
use crate::error::SpectraError;
use crate::plan::wanted::Wanted;
use crate::plan::{Plan, grouping, scale};
use crate::request::{Modes, Request};
use crate::solvers::Solver;

/// The strictest relative residual that rounding leaves within reach.
const STRICTEST_TOLERANCE: f64 = 1e-13;
/// The loosest one that still tells eigenvalues apart.
const LOOSEST_TOLERANCE: f64 = 1e-3;

impl Request {
    /// Checks the request against the matrix; no solver where its separators are to decide.
    pub(crate) fn resolve(
        &self,
        w: &SymmetricForm<'_>,
    ) -> Result<(Plan, Option<Solver>), SpectraError> {
        let wanted = self.wanted(w.n_nodes())?;
        let solver = choice::by_size(self.solver, wanted, w.n_nodes())?;
        if !(STRICTEST_TOLERANCE..=LOOSEST_TOLERANCE).contains(&self.tolerance) {
            return Err(SpectraError::BadTolerance {
                tolerance: self.tolerance,
                strictest: STRICTEST_TOLERANCE,
                loosest: LOOSEST_TOLERANCE,
            });
        }
        let scale = scale(w)?;
        let rounding = solver.map_or(0.0, |solver| solver.method().rounding);
        let residual_bound = self.tolerance.max(rounding * w.n_nodes() as f64) * scale;
        let grouping = grouping::grouping_tolerance(scale, residual_bound);
        if let Wanted::Above { cutoff, .. } = wanted
            && (cutoff + grouping >= 0.0 || cutoff.is_nan())
        {
            return Err(SpectraError::NothingAbove { cutoff });
        }
        let Self { tolerance, max_products, seed, .. } = *self;
        let plan = Plan { wanted, scale, residual_bound, grouping, tolerance, max_products, seed };
        Ok((plan, solver))
    }

    fn wanted(&self, n_nodes: usize) -> Result<Wanted, SpectraError> {
        let leading = |modes| Wanted::Leading { modes, max_extra: self.max_extra };
        match self.modes {
            Modes::All => Ok(leading(n_nodes)),
            Modes::Leading(0) => Err(SpectraError::NoModes),
            Modes::Leading(requested) if requested > n_nodes => {
                Err(SpectraError::TooManyModes { requested, n_nodes })
            }
            Modes::Leading(requested) => Ok(leading(requested)),
            Modes::Above(cutoff) => Ok(Wanted::Above { cutoff, max_modes: self.max_modes }),
        }
    }
}
