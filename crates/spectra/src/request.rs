//! What is asked for, and the checked form of it that the solvers work from.

use graph::CouplingMatrix;

use crate::{Solver, SpectraError, eigenspace};

/// Up to this many nodes [`SolverChoice::Auto`] is dense: 2 s and 32 MB a matrix at this size.
pub const DENSE_NODES: usize = 2000;

/// The strictest relative residual that rounding leaves within reach.
const STRICTEST_TOLERANCE: f64 = 1e-13;
/// The loosest one that still tells eigenvalues apart.
const LOOSEST_TOLERANCE: f64 = 1e-3;

/// How many modes, counted from the largest eigenvalue down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Modes {
    /// All N.
    All,
    /// At least this many; more where the last eigenspace would be cut.
    Leading(usize),
}

/// Which solver may be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolverChoice {
    /// Dense up to [`DENSE_NODES`] nodes or when more than half of all modes are asked for, ARPACK
    /// otherwise.
    Auto,
    /// The dense solver: N² memory, N³ time.
    Dense,
    /// ARPACK: at most N − 1 modes.
    Arpack,
}

/// A request for the leading modes of a coupling matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Request {
    /// How many modes.
    pub modes: Modes,
    /// By which solver.
    pub solver: SolverChoice,
    /// Largest residual ‖S u − λ u‖ of a converged mode, relative to max_i |w_ii|; from 1e-13 to
    /// 1e-3. The dense solver is as accurate as it is, whatever the tolerance.
    pub tolerance: f64,
    /// Most matrix–vector products ARPACK may spend; it gives up when the next restart might need
    /// more. A Rayleigh–Ritz step on what was found comes on top, with one product a mode.
    pub max_products: usize,
    /// Most modes ARPACK may add beyond those asked for to complete the last eigenspace.
    pub max_extra: usize,
    /// Seed of ARPACK's start vectors.
    pub seed: u64,
}

impl Default for Request {
    fn default() -> Self {
        Self {
            modes: Modes::All,
            solver: SolverChoice::Auto,
            tolerance: 1e-12,
            max_products: 200_000,
            max_extra: 100,
            seed: 1,
        }
    }
}

/// A request that has been checked against the matrix.
pub(crate) struct Plan {
    /// Modes asked for, 1 ≤ n_modes ≤ N.
    pub n_modes: usize,
    pub solver: Solver,
    /// max_i |w_ii|, or 1 for a network without links; ‖S‖ is at most twice this.
    pub scale: f64,
    /// Largest ‖S u − λ u‖ of a mode that is returned.
    pub residual_bound: f64,
    /// Eigenvalues closer than this are one eigenspace.
    pub grouping: f64,
    /// As in [`Request`].
    pub tolerance: f64,
    pub max_products: usize,
    pub max_extra: usize,
    pub seed: u64,
}

impl Request {
    /// Checks the request against the matrix and chooses the solver.
    pub(crate) fn resolve(&self, w: &CouplingMatrix) -> Result<Plan, SpectraError> {
        let n_nodes = w.n_nodes();
        let n_modes = self.n_modes(n_nodes)?;
        let solver = self.solver_for(n_modes, n_nodes)?;
        if !(STRICTEST_TOLERANCE..=LOOSEST_TOLERANCE).contains(&self.tolerance) {
            return Err(SpectraError::BadTolerance {
                tolerance: self.tolerance,
                strictest: STRICTEST_TOLERANCE,
                loosest: LOOSEST_TOLERANCE,
            });
        }
        let scale = scale(w)?;
        let relative_bound = match solver {
            Solver::Arpack => self.tolerance,
            Solver::Dense => self.tolerance.max(1e-15 * n_nodes as f64),
        };
        let residual_bound = relative_bound * scale;
        Ok(Plan {
            n_modes,
            solver,
            scale,
            residual_bound,
            grouping: eigenspace::grouping_tolerance(scale, residual_bound),
            tolerance: self.tolerance,
            max_products: self.max_products,
            max_extra: self.max_extra,
            seed: self.seed,
        })
    }

    fn n_modes(&self, n_nodes: usize) -> Result<usize, SpectraError> {
        match self.modes {
            Modes::All => Ok(n_nodes),
            Modes::Leading(0) => Err(SpectraError::NoModes),
            Modes::Leading(requested) if requested > n_nodes => {
                Err(SpectraError::TooManyModes { requested, n_nodes })
            }
            Modes::Leading(requested) => Ok(requested),
        }
    }

    fn solver_for(&self, n_modes: usize, n_nodes: usize) -> Result<Solver, SpectraError> {
        match self.solver {
            SolverChoice::Dense => Ok(Solver::Dense),
            SolverChoice::Arpack if n_modes == n_nodes => {
                Err(SpectraError::BeyondArpack { requested: n_modes, n_nodes })
            }
            SolverChoice::Arpack => Ok(Solver::Arpack),
            SolverChoice::Auto if n_nodes <= DENSE_NODES || n_modes > n_nodes / 2 => {
                Ok(Solver::Dense)
            }
            SolverChoice::Auto => Ok(Solver::Arpack),
        }
    }
}

/// max_i |w_ii|: the largest degree of a laplacian, 1 for a normalized matrix.
fn scale(w: &CouplingMatrix) -> Result<f64, SpectraError> {
    let mut largest = 0.0f64;
    for (node, row) in w.symmetric().outer_iterator().enumerate() {
        for &value in row.data() {
            if !value.is_finite() {
                return Err(SpectraError::NotFinite { node, value });
            }
            largest = largest.max(value.abs());
        }
    }
    Ok(if largest > 0.0 { largest } else { 1.0 })
}
