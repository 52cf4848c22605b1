//! `[spectrum]`: which modes, by which solver, and what these cannot do.

use msf::StableRegion;
use spectra::{ARPACK_NODES, Modes, Request, SolverChoice};

use super::Checker;
use crate::problem::{Problem, Result};
use crate::spec::{ModesSpec, SolverKind};

/// The most nodes for the dense solver, which at this size needs 20 GB a matrix and a day.
const DENSE_MOST: usize = 50_000;

/// Tolerance of networks that are large, of more than [`ARPACK_NODES`]; in others solvers go to the
/// limit of rounding at no cost to speak of.
const LARGE_TOLERANCE: f64 = 1e-10;

/// The modes to compute.
pub struct SpectrumPlan {
    /// Which modes, if that is known before the stable set is.
    request: Request,
    /// ε at which all unstable modes are to be known.
    unstable_at: Option<f64>,
}

impl SpectrumPlan {
    /// What is asked of the solver: at ε the unstable modes are those with λ_k > −σ/ε, where the
    /// stable set reaches from σ on without end.
    pub fn request(&self, stable: &StableRegion) -> Result<Request> {
        let Some(epsilon) = self.unstable_at else { return Ok(self.request) };
        match stable.intervals.last() {
            Some(interval) if interval.upper().is_none() => {
                Ok(Request { modes: Modes::Above(-interval.lower() / epsilon), ..self.request })
            }
            _ => {
                let message = "`spectrum.modes` asks for the modes that are unstable at some ε, but \
                               the stable set ends: the smallest eigenvalues may be among them";
                Err(Problem::new(message).hint("set `spectrum.modes` to \"all\""))
            }
        }
    }

    /// Largest relative residual of a mode.
    pub fn tolerance(&self) -> f64 {
        self.request.tolerance
    }

    /// The most modes that there may be.
    pub fn most_modes(&self, n_nodes: usize) -> usize {
        match self.request.modes {
            Modes::Leading(modes) => modes,
            _ if self.unstable_at.is_some() => self.request.max_modes.min(n_nodes),
            _ => n_nodes,
        }
    }
}

impl Checker<'_> {
    pub(super) fn spectrum(&self, n_nodes: usize) -> Result<SpectrumPlan> {
        let spec = &self.experiment.spectrum;
        let mut unstable_at = None;
        let modes = match spec.modes {
            ModesSpec::All => Modes::All,
            ModesSpec::Leading(0) => {
                return Err(self.problem("spectrum.modes", "is 0, but must be 1 or more"));
            }
            // A network that has no more shows all of its modes.
            ModesSpec::Leading(modes) => {
                Modes::Leading(usize::try_from(modes).unwrap_or(usize::MAX).min(n_nodes))
            }
            ModesSpec::UnstableAt(epsilon) => {
                self.positive("spectrum.modes.unstable_at", epsilon)?;
                unstable_at = Some(epsilon);
                Modes::All
            }
        };
        let solver = match spec.solver {
            SolverKind::Auto => SolverChoice::Auto,
            SolverKind::Dense => SolverChoice::Dense,
            SolverKind::Arpack => SolverChoice::Arpack,
            SolverKind::Chebyshev => SolverChoice::Chebyshev,
            SolverKind::ShiftInvert => SolverChoice::ShiftInvert,
        };
        if let Some(tolerance) = spec.tolerance
            && !(1e-13..=1e-3).contains(&tolerance)
        {
            let message = format!("is {tolerance:e}, but must be between 1e-13 and 1e-3");
            return Err(self.problem("spectrum.tolerance", message));
        }
        let small = Request::default().tolerance;
        let by_size = if n_nodes > ARPACK_NODES { LARGE_TOLERANCE } else { small };
        let tolerance = spec.tolerance.unwrap_or(by_size);
        let plan = SpectrumPlan {
            request: Request { modes, solver, tolerance, ..Request::default() },
            unstable_at,
        };
        if unstable_at.is_none() {
            self.solvable(solver, plan.most_modes(n_nodes), n_nodes)?;
        }
        Ok(plan)
    }

    /// Refuses what the solvers cannot do for so many modes of so many nodes.
    fn solvable(&self, solver: SolverChoice, modes: usize, n_nodes: usize) -> Result<()> {
        if solver == SolverChoice::Arpack && modes == n_nodes {
            let message = format!(
                "is \"arpack\", which cannot find all {n_nodes} modes of a network, only fewer"
            );
            let hint = format!(
                "set `spectrum.modes` to {} or less, or leave `spectrum.solver` out",
                n_nodes - 1
            );
            return Err(self.problem("spectrum.solver", message).hint(hint));
        }
        let dense = match solver {
            SolverChoice::Dense => true,
            // Half of all modes and more are found by the dense solver, too.
            SolverChoice::Auto => modes > n_nodes / 2,
            _ => false,
        };
        if dense && n_nodes > DENSE_MOST {
            let message = format!(
                "asks for {modes} modes of {n_nodes} nodes from the dense solver, whose matrices \
                 take 8 N² bytes each; the most is {DENSE_MOST} nodes"
            );
            let hint = "set `spectrum.modes` to the number of leading modes you need, or to those \
                        that are unstable_at some ε";
            return Err(self.problem("spectrum.modes", message).hint(hint));
        }
        Ok(())
    }
}
