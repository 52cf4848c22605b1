//! Leading modes of S with every copy of a multiple eigenvalue, from a solver that loses some.
//!
//! A Krylov space from one start vector contains one vector of each eigenspace; further copies
//! appear only through rounding, or not at all. So we solve again from a new start vector on the
//! complement of all that was found, and again, until the largest eigenvalue left in the complement
//! lies below the last eigenvalue kept. That largest eigenvalue is what Lanczos finds first, and a
//! random start vector misses its eigenspace with probability zero.
//!
//! The search starts from the kernel of S, which is known.
//!
//! The complement is that of A = S + 3 s·1, s = max_i |w_ii|. Its spectrum lies in [s, 3s]: deflated
//! modes, at 0, are below everything, and ARPACK's test relative to each eigenvalue is as strict at
//! one end of the spectrum as at the other.

use graph::CouplingMatrix;
use rand_core::Rng;
use rand_pcg::Pcg64;

use crate::arpack::{self, Outcome, Settings};
use crate::basis::{Eigenpairs, orthonormalise_against, rayleigh_ritz};
use crate::kernel::{components, kernel};
use crate::operator::{Deflated, Operator, Shifted};
use crate::request::Plan;
use crate::{SpectraError, eigenspace};

/// Eigenvalues that a look into the complement asks for at first; doubled while all of them belong
/// to the answer.
const FIRST_LOOK: usize = 1;
/// The most it may ask for.
const WIDEST_LOOK: usize = 64;
/// Stream of the generator of start vectors.
const START_VECTORS: u128 = 0x05ec_74a1;

/// Modes of S as a solver hands them over.
pub(crate) struct Found {
    pub pairs: Eigenpairs,
    pub products: usize,
}

/// The leading modes of S, whole eigenspaces only, by ARPACK.
pub(crate) fn leading(w: &CouplingMatrix, plan: &Plan) -> Result<Found, SpectraError> {
    let shifted = Shifted { matrix: w.symmetric(), shift: 3.0 * plan.scale };
    let mut search = Search::new(w, &shifted, plan)?;
    let n_whole = search.run()?;
    search.found.truncate(n_whole);
    // Without the shift, whose size would limit the accuracy of eigenvalues near 0.
    let unshifted = Shifted { shift: 0.0, ..shifted };
    let pairs = rayleigh_ritz(&unshifted, &search.found.vectors)?;
    Ok(Found { pairs, products: search.products + n_whole })
}

/// The modes found so far, eigenvalues those of A.
struct Search<'a> {
    operator: &'a dyn Operator,
    plan: &'a Plan,
    found: Eigenpairs,
    products: usize,
    random: Pcg64,
}

impl<'a> Search<'a> {
    /// A search that knows the kernel of S.
    fn new(
        w: &CouplingMatrix,
        operator: &'a Shifted<'a>,
        plan: &'a Plan,
    ) -> Result<Self, SpectraError> {
        let components = components(w);
        check_extension(plan, components.count, operator.shift)?;
        let vectors = kernel(w, &components);
        let found = Eigenpairs { values: vec![operator.shift; vectors.len()], vectors };
        let random = Pcg64::new(u128::from(plan.seed), START_VECTORS);
        Ok(Self { operator, plan, found, products: 0, random })
    }

    /// Solves until nothing is missing; returns how many of the modes found to keep.
    fn run(&mut self) -> Result<usize, SpectraError> {
        let mut look = self.plan.n_modes.saturating_sub(self.found.len()).max(FIRST_LOOK);
        let mut next_look = FIRST_LOOK;
        loop {
            let n_left = self.operator.n_rows() - self.found.len();
            if n_left == 0 {
                return Ok(self.n_whole().expect("all modes are more than those asked for"));
            }
            let missing = self.largest_in_complement(look.min(n_left))?;
            if let Some(n_whole) = self.n_whole()
                && missing.values[0] < self.found.values[n_whole - 1] - self.plan.grouping
            {
                return Ok(n_whole);
            }
            let smallest = missing.values[missing.len() - 1];
            self.found.merge(missing);
            let n_whole = self.n_whole();
            if let Some(n_whole) = n_whole {
                check_extension(self.plan, n_whole, self.found.values[self.plan.n_modes - 1])?;
            }
            let all_belong = n_whole.is_none_or(|n| smallest >= self.found.values[n - 1]);
            look = if all_belong { next_look } else { FIRST_LOOK };
            next_look = (2 * look).min(WIDEST_LOOK);
        }
    }

    /// Modes found down to the end of the eigenspace of the last one asked for, as far as known.
    fn n_whole(&self) -> Option<usize> {
        let (values, n_modes) = (&self.found.values, self.plan.n_modes);
        (values.len() >= n_modes)
            .then(|| eigenspace::end_of_eigenspace(values, n_modes, self.plan.grouping))
    }

    /// Eigenpairs of A on the complement of the modes found, the largest among them, at least one.
    fn largest_in_complement(&mut self, n_wanted: usize) -> Result<Eigenpairs, SpectraError> {
        let n_rows = self.operator.n_rows();
        let n_wanted = n_wanted.min(n_rows - 1);
        let internal_tolerance = 0.1 * self.plan.tolerance;
        let settings = Settings {
            n_wanted,
            n_basis: (2 * n_wanted + 20).max(40).min(n_rows),
            tolerance: internal_tolerance / 3.0,
            invariance: internal_tolerance * self.plan.scale,
            max_products: self.plan.max_products.saturating_sub(self.products),
        };
        let start = self.start_vector();
        let deflated = Deflated { operator: self.operator, found: &self.found.vectors };
        let (outcome, products) = arpack::largest(&deflated, start, &settings)?;
        self.products += products;
        match outcome {
            Outcome::Converged(pairs) => Ok(pairs),
            Outcome::Invariant(basis) => {
                let mut pairs = rayleigh_ritz(&deflated, &basis)?;
                self.products += basis.len();
                pairs.truncate(n_wanted);
                Ok(pairs)
            }
            Outcome::Exhausted(converged) => Err(self.exhausted(converged)),
        }
    }

    /// A random unit vector in the complement of the modes found, components even in (−1, 1) before
    /// projection.
    fn start_vector(&mut self) -> Vec<f64> {
        let mut start: Vec<f64> = (0..self.operator.n_rows())
            .map(|_| (self.random.next_u64() >> 11) as f64 / (1u64 << 52) as f64 - 1.0)
            .collect();
        orthonormalise_against(&self.found.vectors, &mut start);
        start
    }

    /// The answer when the products are spent, with `converged_now` modes of an unfinished solve.
    fn exhausted(&self, converged_now: usize) -> SpectraError {
        let (requested, products) = (self.plan.n_modes, self.products);
        let converged = self.found.len() + converged_now;
        if converged >= requested {
            return SpectraError::CompletenessUnproven { requested, products };
        }
        SpectraError::NotConverged {
            converged,
            requested,
            tolerance: self.plan.tolerance,
            products,
        }
    }
}

/// Refuses an eigenspace, of eigenvalue θ of A, that goes on to mode `n_whole` and so too far.
fn check_extension(plan: &Plan, n_whole: usize, theta: f64) -> Result<(), SpectraError> {
    let &Plan { n_modes: requested, max_extra, scale, .. } = plan;
    if n_whole <= requested.saturating_add(max_extra) {
        return Ok(());
    }
    let eigenvalue = theta - 3.0 * scale;
    Err(SpectraError::EigenspaceTooLarge { requested, eigenvalue, found: n_whole, max_extra })
}
