//! `[spectrum]`: which modes, by which solver, and what these cannot do.

use msf::StableRegion;
use spectra::{ARPACK_NODES, Modes, Request, SolverChoice};

use super::Checker;
use crate::problem::Result;
use crate::spec::{ModesSpec, SolverKind};

/// The most nodes for the dense solver, which at this size needs 20 GB a matrix and a day.
const DENSE_MOST: usize = 50_000;

/// Tolerance of networks that are large, of more than [`ARPACK_NODES`]; in others solvers go to the
/// limit of rounding at no cost to speak of.
const LARGE_TOLERANCE: f64 = 1e-10;

/// Up to this many nodes all modes are computed where nobody says how many: half a minute and 1 GB.
const ALL_MODES: usize = 5000;

/// Leading modes where nobody says how many, and all are not needed or too many, beyond one zero mode
/// for each component.
const LEADING_MODES: usize = 20;
/// Zero modes beyond which the network must be prepared, or the number of modes be said.
const MOST_ZERO_MODES: usize = 1000;

/// The modes to compute.
pub struct SpectrumPlan {
    request: Request,
    wanted: ModesSpec,
    /// Where a few will do and nobody says how many.
    leading: usize,
}

impl SpectrumPlan {
    /// What is asked of the solver once the stable set is known. At ε the unstable modes are those
    /// with λ_k > −σ/ε, where the stable set reaches from σ on; where it ends again, the fastest modes
    /// are unstable as well, and are left out unless all are computed.
    pub fn request(&self, stable: &StableRegion, n_nodes: usize) -> Request {
        let lower = match &stable.intervals[..] {
            [] => None,
            [.., last] if stable.is_unbounded() => Some(last.lower()),
            [first, ..] => Some(first.lower()),
        };
        let modes = match (self.wanted, lower) {
            (ModesSpec::UnstableAt(epsilon), Some(lower)) if lower > 0.0 => {
                Modes::Above(-lower / epsilon)
            }
            (ModesSpec::UnstableAt(_) | ModesSpec::Auto, _) => {
                let few_will_do = stable.is_unbounded() || n_nodes > ALL_MODES;
                if few_will_do { Modes::Leading(self.leading) } else { Modes::All }
            }
            (ModesSpec::All | ModesSpec::Leading(_), _) => self.request.modes,
        };
        Request { modes, ..self.request }
    }

    /// Largest relative residual of a mode.
    pub fn tolerance(&self) -> f64 {
        self.request.tolerance
    }

    /// Whether matrices of N × N numbers will be taken.
    pub fn is_dense(&self, n_nodes: usize) -> bool {
        matches!(self.request.solver, SolverChoice::Dense) || self.most_modes(n_nodes) > n_nodes / 2
    }

    /// The modes asked for, or by default.
    pub fn wanted(&self) -> ModesSpec {
        self.wanted
    }

    /// The most modes that there may be.
    pub fn most_modes(&self, n_nodes: usize) -> usize {
        match (self.wanted, self.request.modes) {
            (ModesSpec::Leading(_), Modes::Leading(modes)) => modes,
            (ModesSpec::UnstableAt(_), _) => self.request.max_modes.min(n_nodes),
            (ModesSpec::Auto, _) if n_nodes > ALL_MODES => self.leading,
            _ => n_nodes,
        }
    }
}

impl Checker<'_> {
    pub(super) fn spectrum(&self, n_nodes: usize, n_components: usize) -> Result<SpectrumPlan> {
        let spec = &self.experiment.spectrum;
        let by_size = if n_nodes > ALL_MODES { ModesSpec::Auto } else { ModesSpec::All };
        let wanted = spec.modes.unwrap_or(by_size);
        let modes = match wanted {
            ModesSpec::All | ModesSpec::Auto => Modes::All,
            ModesSpec::Leading(0) => {
                return Err(self.problem("spectrum.modes", "is 0, but must be 1 or more"));
            }
            // A network that has no more shows all of its modes.
            ModesSpec::Leading(modes) => {
                Modes::Leading(usize::try_from(modes).unwrap_or(usize::MAX).min(n_nodes))
            }
            ModesSpec::UnstableAt(epsilon) => {
                self.positive("spectrum.modes.unstable_at", epsilon)?;
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
        if !solver.is_built() {
            let message = "is \"arpack\", but this program was built without its feature `arpack`";
            let hint = "leave `spectrum.solver` out, or set it to \"chebyshev\"";
            return Err(self.problem("spectrum.solver", message).hint(hint));
        }
        if let Some(tolerance) = spec.tolerance
            && !(1e-13..=1e-3).contains(&tolerance)
        {
            let message = format!("is {tolerance:e}, but must be between 1e-13 and 1e-3");
            return Err(self.problem("spectrum.tolerance", message));
        }
        let small = Request::default().tolerance;
        let by_size = if n_nodes > ARPACK_NODES { LARGE_TOLERANCE } else { small };
        let tolerance = spec.tolerance.unwrap_or(by_size);
        let zero_modes = if n_components > MOST_ZERO_MODES { 0 } else { n_components - 1 };
        let plan = SpectrumPlan {
            request: Request { modes, solver, tolerance, ..Request::default() },
            wanted,
            leading: (LEADING_MODES + zero_modes).min(n_nodes),
        };
        if !matches!(wanted, ModesSpec::UnstableAt(_)) || matches!(solver, SolverChoice::Dense) {
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
