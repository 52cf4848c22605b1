//! Leading modes of S with every copy of a multiple eigenvalue, from a solver that loses some.
//!
//! A Krylov space from one start vector contains one vector of each eigenspace; further copies
//! appear only through rounding, or not at all. So we solve again from a new start vector on the
//! complement of all that was found, and again, until the largest eigenvalue left in the complement
//! lies below the last eigenvalue kept. That largest eigenvalue is what Lanczos finds first, and a
//! random start vector misses its eigenspace with probability zero.
//!
//! The search starts from the null space of S, which is known.
//!
//! The complement is that of A = S + 3 s·1, s = max_i |w_ii|. Its spectrum lies in [s, 3s]: deflated
//! modes, at 0, are below everything, and ARPACK's test relative to each eigenvalue is as strict at
//! one end of the spectrum as at the other.

use graph::{SymmetricForm, unit_interval};
use rand_core::Rng;
use rand_pcg::Pcg64;

use crate::completeness::claim::Claim;
use crate::error::SpectraError;
use crate::found::{Eigenpairs, Found};
use crate::matrix::null_space::NullSpace;
use crate::plan::Plan;
use crate::plan::wanted::Wanted;
use crate::progress::{Advance, Progress};
use crate::recurrences::spectral_density::SpectralDensity;
use crate::solvers::arpack::library;
use crate::solvers::arpack::library::{Outcome, Settings};
use crate::solvers::arpack::operator::{Deflated, Operator, Shifted};
use crate::solvers::arpack::rayleigh_ritz::rayleigh_ritz;
use crate::solvers::method::Task;
use crate::vectors::basis::Basis;
use crate::vectors::column::orthonormalise_against;
use crate::verification::Verification;

/// Eigenvalues that a look into the complement asks for at first; doubled while all of them belong
/// to the answer.
const FIRST_LOOK: usize = 1;
/// The most it may ask for.
const WIDEST_LOOK: usize = 64;
/// Stream of the generator of start vectors.
const START_VECTORS: u128 = 0x05ec_74a1;

/// The leading modes of S, whole eigenspaces only, by ARPACK; may be stopped at every product.
pub(super) fn leading(task: Task<'_>) -> Result<(Found, Verification), SpectraError> {
    let Task { w, plan, links, mut verifier, mut random, progress, .. } = task;
    verifier.low = SpectralDensity::new(links, plan.scale, &mut random)?.low;
    let shift = 3.0 * plan.scale;
    let shifted = Shifted { matrix: w.symmetric(), shift };
    let mut search = Search::new(w, &shifted, plan, progress)?;
    let mut tries = 0;
    loop {
        let Complete { n_modes, next } = search.run()?;
        // Without the shift, whose size would limit the accuracy of eigenvalues near 0.
        let unshifted = Shifted { shift: 0.0, ..shifted };
        let pairs = rayleigh_ritz(&unshifted, &search.found.vectors[..n_modes])?;
        search.products += n_modes;
        let mut basis = Basis::empty(w.n_nodes());
        pairs.vectors.iter().for_each(|vector| basis.push(vector));
        let last = pairs.values[n_modes - 1];
        let beyond = search.found.values.get(n_modes).copied().unwrap_or(f64::NEG_INFINITY);
        let claim = Claim {
            n_modes,
            last,
            wanted: plan.wanted,
            next: next.max(beyond) - shift,
            top: pairs.values[0],
            beyond: Vec::new(),
            products_left: plan.max_products.saturating_sub(search.products),
            products_spent: search.products,
            tries,
        };
        tries += 1;
        let outcome = verifier.verify(&claim, &basis, &mut random)?;
        search.products += outcome.products;
        if let Some(verification) = outcome.verification {
            return Ok((Found { pairs, products: search.products }, verification));
        }
    }
}

/// Modes among which none is missing, as far as a look into their complement tells.
struct Complete {
    n_modes: usize,
    /// The largest eigenvalue of A in the complement.
    next: f64,
}

/// The modes found so far, eigenvalues those of A.
struct Search<'a> {
    operator: &'a dyn Operator,
    plan: &'a Plan,
    /// What is wanted of A.
    wanted: Wanted,
    found: Eigenpairs,
    products: usize,
    random: Pcg64,
    progress: Progress<'a>,
}

impl<'a> Search<'a> {
    /// A search that knows the null space of S.
    fn new(
        w: &SymmetricForm<'_>,
        operator: &'a Shifted<'a>,
        plan: &'a Plan,
        progress: Progress<'a>,
    ) -> Result<Self, SpectraError> {
        let null_space = NullSpace::of(w);
        let wanted = shifted(plan.wanted, operator.shift);
        let values = vec![operator.shift; null_space.dimension()];
        let search = Self {
            operator,
            plan,
            wanted,
            found: Eigenpairs { values, vectors: null_space.vectors() },
            products: 0,
            random: Pcg64::new(u128::from(plan.seed), START_VECTORS),
            progress,
        };
        search.check()?;
        Ok(search)
    }

    /// Solves until nothing is missing; returns how many of the modes found to keep.
    fn run(&mut self) -> Result<Complete, SpectraError> {
        let mut look = self.wanted.at_least().saturating_sub(self.found.len()).max(FIRST_LOOK);
        let mut next_look = FIRST_LOOK;
        loop {
            let n_left = self.operator.n_rows() - self.found.len();
            if n_left == 0 {
                let next = f64::NEG_INFINITY;
                let n_modes = self.complete(next).expect("all modes are complete");
                return Ok(Complete { n_modes, next });
            }
            let missing = self.largest_in_complement(look.min(n_left))?;
            let next = missing.values[0];
            if let Some(n_modes) = self.complete(next) {
                return Ok(Complete { n_modes, next });
            }
            let smallest = missing.values[missing.len() - 1];
            merge(&mut self.found, missing);
            self.check()?;
            let all_belong = self.complete(smallest).is_none();
            look = if all_belong { next_look } else { FIRST_LOOK };
            next_look = (2 * look).min(WIDEST_LOOK);
        }
    }

    /// How many modes to keep when `next` is the largest eigenvalue of the complement.
    fn complete(&self, next: f64) -> Option<usize> {
        self.wanted.complete(&self.found.values, next, self.plan.grouping)
    }

    /// Refuses more modes than allowed, by eigenvalues of S.
    fn check(&self) -> Result<(), SpectraError> {
        let shift = 3.0 * self.plan.scale;
        let values: Vec<f64> = self.found.values.iter().map(|theta| theta - shift).collect();
        self.plan.wanted.check(&values, self.plan.grouping)
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
        let (products, converged) = (self.products, self.found.len());
        let wanted = self.wanted.at_least().max(converged);
        let asked = Advance { products, converged, wanted }.asked(self.progress);
        let deflated = Deflated { operator: self.operator, found: &self.found.vectors };
        let (outcome, products) = library::largest(&deflated, start, &settings, &asked)?;
        self.products += products;
        match outcome {
            Outcome::Converged(pairs) => Ok(pairs),
            Outcome::Invariant(basis) => {
                let mut pairs = rayleigh_ritz(&deflated, &basis)?;
                self.products += basis.len();
                pairs.values.truncate(n_wanted);
                pairs.vectors.truncate(n_wanted);
                Ok(pairs)
            }
            Outcome::Exhausted(converged) => {
                Err(self.plan.exhausted(self.found.len() + converged, self.products))
            }
        }
    }

    /// A random unit vector in the complement of the modes found, components even in (−1, 1) before
    /// projection.
    fn start_vector(&mut self) -> Vec<f64> {
        let mut start: Vec<f64> = (0..self.operator.n_rows())
            .map(|_| 2.0 * unit_interval(self.random.next_u64()) - 1.0)
            .collect();
        orthonormalise_against(&self.found.vectors, &mut start);
        start
    }
}

/// The same wanted of S + shift · 1.
fn shifted(wanted: Wanted, shift: f64) -> Wanted {
    match wanted {
        Wanted::Above { cutoff, max_modes } => Wanted::Above { cutoff: cutoff + shift, max_modes },
        leading @ Wanted::Leading { .. } => leading,
    }
}

/// Adds pairs whose vectors, made orthogonal to those already found, keep most of their length.
fn merge(found: &mut Eigenpairs, others: Eigenpairs) {
    for (value, mut vector) in others.values.into_iter().zip(others.vectors) {
        if orthonormalise_against(&found.vectors, &mut vector) > 0.5 {
            let place = found.values.partition_point(|&other| other >= value);
            found.values.insert(place, value);
            found.vectors.insert(place, vector);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn merged_pairs_stay_in_order_and_repeats_are_dropped() {
        let pairs = |values: &[f64], axes: &[usize]| Eigenpairs {
            values: values.to_vec(),
            vectors: axes
                .iter()
                .map(|&k| (0..4).map(|i| f64::from(u8::from(i == k))).collect())
                .collect(),
        };
        let mut found = pairs(&[5.0, 2.0], &[0, 1]);
        merge(&mut found, pairs(&[4.0, 2.0, 1.0], &[2, 1, 3]));
        assert_eq!(found.values, [5.0, 4.0, 2.0, 1.0]);
        assert_eq!(found.vectors, pairs(&[0.0; 4], &[0, 2, 1, 3]).vectors);
    }
}
