//! The checked form of a request, which the solvers work from.

pub(crate) mod grouping;
pub(crate) mod wanted;

use graph::SymmetricForm;

use crate::error::SpectraError;
use crate::plan::wanted::Wanted;
use crate::request::{DENSE_NODES, Modes, Request, SolverChoice};

/// Up to this many nodes it is dense for any number of modes: 30 ms.
const FEW_NODES: usize = 500;

/// The strictest relative residual that rounding leaves within reach.
const STRICTEST_TOLERANCE: f64 = 1e-13;
/// The loosest one that still tells eigenvalues apart.
const LOOSEST_TOLERANCE: f64 = 1e-3;

/// A request that has been checked against the matrix.
pub(crate) struct Plan {
    /// Which modes to hand over.
    pub wanted: Wanted,
    /// Dense, or one of the others; Auto leaves the choice among these.
    pub choice: SolverChoice,
    /// max_i |w_ii|, or 1 for a network without links; ‖S‖ is at most twice this.
    pub scale: f64,
    /// Largest ‖S u − λ u‖ of a mode that is returned.
    pub residual_bound: f64,
    /// Eigenvalues closer than this are one eigenspace.
    pub grouping: f64,
    /// As in [`Request`].
    pub tolerance: f64,
    pub max_products: usize,
    pub seed: u64,
}

impl Request {
    /// Checks the request against the matrix and chooses the solver.
    pub(crate) fn resolve(&self, w: &SymmetricForm<'_>) -> Result<Plan, SpectraError> {
        let wanted = self.wanted(w.n_nodes())?;
        let choice = self.choice(wanted, w.n_nodes())?;
        if !(STRICTEST_TOLERANCE..=LOOSEST_TOLERANCE).contains(&self.tolerance) {
            return Err(SpectraError::BadTolerance {
                tolerance: self.tolerance,
                strictest: STRICTEST_TOLERANCE,
                loosest: LOOSEST_TOLERANCE,
            });
        }
        let scale = scale(w)?;
        let relative_bound = match choice {
            SolverChoice::Dense => self.tolerance.max(1e-15 * w.n_nodes() as f64),
            SolverChoice::Auto
            | SolverChoice::Arpack
            | SolverChoice::Chebyshev
            | SolverChoice::ShiftInvert => self.tolerance,
        };
        let residual_bound = relative_bound * scale;
        let grouping = grouping::grouping_tolerance(scale, residual_bound);
        if let Wanted::Above { cutoff, .. } = wanted
            && (cutoff + grouping >= 0.0 || cutoff.is_nan())
        {
            return Err(SpectraError::NothingAbove { cutoff });
        }
        Ok(Plan {
            wanted,
            choice,
            scale,
            residual_bound,
            grouping,
            tolerance: self.tolerance,
            max_products: self.max_products,
            seed: self.seed,
        })
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

    fn choice(&self, wanted: Wanted, n_nodes: usize) -> Result<SolverChoice, SpectraError> {
        let requested = wanted.at_least();
        match self.solver {
            choice if !choice.is_built() => Err(SpectraError::ArpackNotBuilt),
            SolverChoice::Arpack if requested == n_nodes => {
                Err(SpectraError::BeyondArpack { requested, n_nodes })
            }
            SolverChoice::Auto if n_nodes <= FEW_NODES || requested > n_nodes / 2 => {
                Ok(SolverChoice::Dense)
            }
            SolverChoice::Auto if n_nodes <= DENSE_NODES => {
                let few = wanted.cutoff().is_none() && requested <= n_nodes / 20;
                Ok(if few { SolverChoice::Auto } else { SolverChoice::Dense })
            }
            choice => Ok(choice),
        }
    }
}

impl Plan {
    /// Takes products from those allowed.
    ///
    /// - `spent`: the products so far.
    /// - `converged`: the modes so far.
    pub fn spend(
        &self,
        spent: &mut usize,
        products: usize,
        converged: usize,
    ) -> Result<(), SpectraError> {
        if *spent + products > self.max_products {
            return Err(self.exhausted(converged, *spent));
        }
        *spent += products;
        Ok(())
    }

    /// The answer when the products are spent.
    pub fn exhausted(&self, converged: usize, products: usize) -> SpectraError {
        let requested = self.wanted.at_least();
        if converged >= requested {
            return SpectraError::CompletenessUnproven { requested, products };
        }
        SpectraError::NotConverged { converged, requested, tolerance: self.tolerance, products }
    }
}

/// max_i |w_ii|: the largest degree of a laplacian, 1 for a normalized matrix.
pub(crate) fn scale(w: &SymmetricForm<'_>) -> Result<f64, SpectraError> {
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
