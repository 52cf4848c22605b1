//! `[spectrum]`: which modes, by which solver, and what these cannot do.

use eigensync::{Wanted, WantedModes};
use spectra::Solver;

use super::checker::Checker;
use user::Result;

/// The most nodes for the dense solver, which at this size needs 20 GB a matrix and a day.
const DENSE_MOST: usize = 50_000;

impl Checker<'_> {
    pub(super) fn spectrum(&self, n_nodes: usize, n_components: usize) -> Result<WantedModes> {
        let spec = &self.experiment.spectrum;
        match spec.modes {
            Some(Wanted::Leading(0)) => {
                return Err(self.problem("spectrum.modes", "is 0, but must be 1 or more"));
            }
            Some(Wanted::UnstableAt(epsilon)) => {
                self.positive("spectrum.modes.unstable_at", epsilon)?;
            }
            _ => {}
        }
        let solver = spec.solver.0;
        if let Some(solver) = solver
            && !solver.is_built()
        {
            let name = solver.name();
            let message =
                format!("is \"{name}\", but this program was built without its feature `{name}`");
            let hint = "leave `spectrum.solver` out, or set it to \"chebyshev\"";
            return Err(self.problem("spectrum.solver", message).hint(hint));
        }
        if let Some(tolerance) = spec.tolerance
            && !(1e-13..=1e-3).contains(&tolerance)
        {
            let message = format!("is {tolerance:e}, but must be between 1e-13 and 1e-3");
            return Err(self.problem("spectrum.tolerance", message));
        }
        let size = (n_nodes, n_components);
        let plan = WantedModes::new(size, spec.modes, solver, spec.tolerance);
        let is_dense = solver.is_some_and(Solver::is_dense);
        if !matches!(plan.wanted(), Wanted::UnstableAt(_)) || is_dense {
            self.solvable(solver, plan.most_modes(n_nodes), n_nodes)?;
        }
        Ok(plan)
    }

    /// Refuses what the solvers cannot do for so many modes of so many nodes.
    fn solvable(&self, solver: Option<Solver>, modes: usize, n_nodes: usize) -> Result<()> {
        if let Some(solver) = solver
            && !solver.finds_all()
            && modes == n_nodes
        {
            let message = format!(
                "is \"{}\", which cannot find all {n_nodes} modes of a network, only fewer",
                solver.name()
            );
            let hint = format!(
                "set `spectrum.modes` to {} or less, or leave `spectrum.solver` out",
                n_nodes - 1
            );
            return Err(self.problem("spectrum.solver", message).hint(hint));
        }
        // Where the choice is free, half of all modes and more are found by the dense solver, too.
        let dense = solver.map_or(modes > n_nodes / 2, Solver::is_dense);
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
