//! What is asked for, and the checked form of it that the solvers work from.

use graph::CouplingMatrix;

use crate::wanted::Wanted;
use crate::{SpectraError, eigenspace};

/// Up to this many nodes [`SolverChoice::Auto`] is dense when more than a twentieth of all modes, or
/// all above a cutoff, are asked for: 2 s and 32 MB a matrix at this size.
pub const DENSE_NODES: usize = 2000;
/// Up to this many nodes it is ARPACK that finds a few modes of a network without small separators.
pub const ARPACK_NODES: usize = 5000;
/// Up to this many nodes it is dense for any number of modes: 30 ms.
const FEW_NODES: usize = 500;

/// The strictest relative residual that rounding leaves within reach.
const STRICTEST_TOLERANCE: f64 = 1e-13;
/// The loosest one that still tells eigenvalues apart.
const LOOSEST_TOLERANCE: f64 = 1e-3;

/// How many modes, counted from the largest eigenvalue down.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub enum Modes {
    /// All N.
    All,
    /// At least this many; more where the last eigenspace would be cut.
    Leading(usize),
    /// All with λ_k > cutoff, a negative number, and at most [`Request::max_modes`]. An eigenvalue
    /// within [`crate::Spectrum::tolerance`] of the cutoff counts as equal to it, and so is left out
    /// unless it belongs to an eigenspace that begins above.
    Above(f64),
}

/// Which solver may be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub enum SolverChoice {
    /// Dense for few nodes (see [`DENSE_NODES`]) or when more than half of all modes are asked for;
    /// otherwise shift-invert where a sparse factorisation is cheap; elsewhere ARPACK up to
    /// [`ARPACK_NODES`], and Chebyshev filters beyond.
    Auto,
    /// The dense solver: N² memory, N³ time.
    Dense,
    /// ARPACK: at most N − 1 modes.
    Arpack,
    /// Long Lanczos sequences, and blocks with Chebyshev filters, for any network.
    Chebyshev,
    /// The block method on a factorised μ − S; refused where the factor would be too large.
    ShiftInvert,
}

/// A request for the leading modes of a coupling matrix.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Request {
    /// How many modes.
    pub modes: Modes,
    /// By which solver.
    pub solver: SolverChoice,
    /// Largest residual ‖S u − λ u‖ of a converged mode, relative to max_i |w_ii|; from 1e-13 to
    /// 1e-3. The dense solver is as accurate as it is, whatever the tolerance.
    pub tolerance: f64,
    /// Most matrix–vector products an iterative solver may spend; ARPACK gives up when the next
    /// restart might need more. A Rayleigh–Ritz step on what ARPACK found comes on top, with one
    /// product a mode.
    pub max_products: usize,
    /// Most modes an iterative solver may add beyond [`Modes::Leading`] to complete the last
    /// eigenspace.
    pub max_extra: usize,
    /// Most modes that [`Modes::Above`] may return.
    pub max_modes: usize,
    /// Seed of the random vectors.
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
            max_modes: 1000,
            seed: 1,
        }
    }
}

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
    pub(crate) fn resolve(&self, w: &CouplingMatrix) -> Result<Plan, SpectraError> {
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
            _ => self.tolerance,
        };
        let residual_bound = relative_bound * scale;
        let grouping = eigenspace::grouping_tolerance(scale, residual_bound);
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
pub(crate) fn scale(w: &CouplingMatrix) -> Result<f64, SpectraError> {
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
