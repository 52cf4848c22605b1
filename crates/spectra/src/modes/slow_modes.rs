//! The modes next to 0. How many zero modes there are is known from the links alone, one for each
//! component; what else a solver cannot tell from 0 beside the largest weight is found by differences.
//!
//! Where weights span twelve decades, rounding in S is 10⁻¹⁶ of the strongest link and may exceed
//! eigenvalues that weak links make. But a solver finds the span of the slow modes well, as all others
//! are far away, and on that
//!
//! ```text
//! uᵀ S u' = − Σ_{i<j} a_ij (v_i − v_j) (v'_i − v'_j),    v = D^{-1/2} u,
//! ```
//!
//! is a sum in which nothing cancels: strong links multiply squares of differences that are as small as
//! rounding. So the null space, known exactly, is taken out of the span, and the Rayleigh–Ritz method with
//! these entries gives the rest, again for what it cannot tell from 0 beside its own largest value.
//! An eigenvalue is off by r²/gap, r the residual and gap the distance to those outside of the span
//! (Parlett, The Symmetric Eigenvalue Problem (1980), Sec. 11.7).

use std::ops::Range;

use graph::SymmetricForm;

use crate::error::SpectraError;
use crate::found::Eigenpairs;
use crate::matrix::null_space::NullSpace;
use crate::matrix::product::multiply;
use crate::plan::grouping::end_of_eigenspace;
use crate::vectors::column::{add_scaled, dot, norm, normalise, orthonormalise_against};
use crate::vectors::small_eigen::symmetric_eigen;

/// Eigenvalues that differ by less, relative to the largest of a span, are not told apart in it.
const RESOLVED: f64 = 1e-10;

/// Makes as many of the leading modes zero modes as there are components, finds the eigenvalues of
/// the others in the first of these eigenspaces, and divides it.
pub(crate) fn settle(
    w: &SymmetricForm<'_>,
    pairs: &mut Eigenpairs,
    eigenspaces: Vec<Range<usize>>,
    grouping: f64,
) -> Result<Vec<Range<usize>>, SpectraError> {
    let null_space = NullSpace::of(w);
    let (n_zero, n_slow) = (null_space.dimension(), eigenspaces[0].len());
    assert!(n_zero <= n_slow, "{n_zero} components, but only {n_slow} modes of eigenvalue 0");
    let zero_modes = null_space.vectors();
    let mut settled = std::iter::once(0..n_zero).collect::<Vec<_>>();
    if n_zero < n_slow {
        let span = complement(w, &null_space, &pairs.vectors[..n_slow]);
        let next = pairs.values.get(n_slow).map_or(grouping, |next| next.abs());
        let slow = Slow { w, next };
        let mut found = Eigenpairs::default();
        slow.resolve(&span, n_zero, &mut found, &mut settled)?;
        pairs.values.splice(n_zero..n_slow, found.values);
        pairs.vectors.splice(n_zero..n_slow, found.vectors);
    }
    pairs.values[..n_zero].fill(0.0);
    pairs.vectors.splice(..n_zero, zero_modes);
    settled.extend(eigenspaces.into_iter().skip(1));
    Ok(settled)
}

/// An orthonormal basis of what the span of some vectors, which nearly contains the null space, holds
/// beside it.
fn complement(
    w: &SymmetricForm<'_>,
    null_space: &NullSpace<'_>,
    vectors: &[Vec<f64>],
) -> Vec<Vec<f64>> {
    let overlaps: Vec<Vec<f64>> = vectors.iter().map(|u| null_space.overlaps(u)).collect();
    // The eigenvectors of the smallest eigenvalues, 0 up to rounding, are orthogonal to the null space.
    let squares = symmetric_eigen(vectors.len(), |a, b| dot(&overlaps[a], &overlaps[b]))
        .expect("a small matrix of finite numbers has eigenvalues");
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for column in null_space.dimension()..vectors.len() {
        let mut vector = vec![0.0; w.n_nodes()];
        for (k, other) in vectors.iter().enumerate() {
            add_scaled(squares.vectors[(k, column)], other, &mut vector);
        }
        for _ in 0..2 {
            null_space.project_out(&mut vector);
            orthonormalise_against(&basis, &mut vector);
        }
        normalise(&mut vector);
        basis.push(vector);
    }
    basis
}

/// The modes of a span beside the null space.
struct Slow<'a> {
    w: &'a SymmetricForm<'a>,
    /// The smallest |λ| outside of the span.
    next: f64,
}

impl Slow<'_> {
    /// Finds the modes of the span of a basis, the first of them mode `first`, and their eigenspaces.
    fn resolve(
        &self,
        basis: &[Vec<f64>],
        first: usize,
        found: &mut Eigenpairs,
        spaces: &mut Vec<Range<usize>>,
    ) -> Result<(), SpectraError> {
        let Eigenpairs { values, vectors } = self.ritz(basis)?;
        let largest = -values[values.len() - 1];
        let is_lost = |value: &&f64| -**value <= RESOLVED * largest;
        let n_lost = values.iter().take_while(is_lost).count();
        let (mut values, mut vectors) = (values, vectors);
        let mut start = first;
        // All are lost only where nothing differs at all.
        if 0 < n_lost && n_lost < values.len() {
            let rest = vectors.split_off(n_lost);
            self.resolve(&vectors, first, found, spaces)?;
            (values, vectors) = (values.split_off(n_lost), rest);
            start += n_lost;
        }
        let tolerance = (RESOLVED * largest).max(10.0 * self.error(&values, &vectors));
        let mut place = 0;
        while place < values.len() {
            let end = end_of_eigenspace(&values, place + 1, tolerance);
            spaces.push(start + place..start + end);
            place = end;
        }
        found.values.extend(values);
        found.vectors.extend(vectors);
        Ok(())
    }

    /// The Rayleigh–Ritz method with entries by differences.
    fn ritz(&self, basis: &[Vec<f64>]) -> Result<Eigenpairs, SpectraError> {
        let n = basis.len();
        let scale = self.w.scale();
        let mut entries = vec![0.0; n * n];
        let mut differences = vec![0.0; n];
        for (i, row) in self.w.symmetric().outer_iterator().enumerate() {
            for (j, &s_ij) in row.iter().filter(|&(j, _)| j > i) {
                let weight = s_ij / scale[i] / scale[j];
                for (difference, u) in differences.iter_mut().zip(basis) {
                    *difference = scale[i] * u[i] - scale[j] * u[j];
                }
                for a in 0..n {
                    for b in 0..=a {
                        entries[a * n + b] -= weight * differences[a] * differences[b];
                    }
                }
            }
        }
        let eigen = symmetric_eigen(n, |a, b| entries[a * n + b])?;
        let vector = |column: usize| {
            let mut vector = vec![0.0; self.w.n_nodes()];
            for (k, other) in basis.iter().enumerate() {
                add_scaled(eigen.vectors[(k, column)], other, &mut vector);
            }
            vector
        };
        let values = eigen.values.iter().map(|&value| value.min(0.0)).collect();
        Ok(Eigenpairs { values, vectors: (0..n).map(vector).collect() })
    }

    /// By how much these eigenvalues may be off.
    fn error(&self, values: &[f64], vectors: &[Vec<f64>]) -> f64 {
        let residual = |(value, vector): (&f64, &Vec<f64>)| {
            let mut rest = vec![0.0; vector.len()];
            multiply(self.w.symmetric(), vector, &mut rest);
            add_scaled(-value, vector, &mut rest);
            norm(&rest)
        };
        let largest = values.iter().zip(vectors).map(residual).fold(0.0, f64::max);
        largest.min(largest * largest / self.next)
    }
}
