//! From eigenvectors u of S to those of W in node space: v = D^{-1/2} u, unit 2-norm, fixed sign.

use graph::{SparseMatrix, SymmetricForm};
use rayon::prelude::*;

use crate::eigenspace::Eigenspace;
use crate::error::SpectraError;
use crate::found::{Eigenpairs, Found};
use crate::matrix::product::multiply_block;
use crate::modes::slow_modes;
use crate::plan::{Plan, grouping};
use crate::solvers::Solver;
use crate::spectrum::Spectrum;
use crate::vectors::block::Block;
use crate::vectors::column::orthonormalise_against;
use crate::verification::Verification;

/// Magnitudes this close, relatively, are a tie for the largest component.
const SIGN_TIE: f64 = 1e-6;

/// The spectrum of W from the eigenpairs of S, every residual checked against the plan's bound.
pub(crate) fn spectrum(
    w: &SymmetricForm<'_>,
    found: Found,
    plan: &Plan,
    (solver, verification): (Solver, Verification),
) -> Result<Spectrum, SpectraError> {
    let Found { mut pairs, products } = found;
    let accurate =
        residuals(w.symmetric(), &pairs).iter().filter(|&&r| r <= plan.residual_bound).count();
    if accurate < pairs.len() {
        return Err(SpectraError::NotConverged {
            converged: accurate,
            requested: pairs.len(),
            tolerance: plan.residual_bound / plan.scale,
            products,
        });
    }
    let last = pairs.values[pairs.len() - 1];
    let next = if pairs.len() == w.n_nodes() {
        f64::NEG_INFINITY
    } else {
        plan.wanted.missing_from(last, plan.grouping).min(last - plan.grouping)
    };
    let eigenspaces = grouping::eigenspaces(&pairs.values, plan.grouping);
    let eigenspaces = slow_modes::settle(w, &mut pairs, eigenspaces, plan.grouping)?;
    let mut symmetric_vectors = pairs.vectors.into_iter();
    let spaces: Vec<Vec<Vec<f64>>> = eigenspaces
        .iter()
        .map(|range| symmetric_vectors.by_ref().take(range.len()).collect())
        .collect();
    let in_node_space = |us: Vec<Vec<f64>>| orthonormal_in_node_space(us, w.scale());
    let vectors: Vec<Vec<Vec<f64>>> = spaces.into_par_iter().map(in_node_space).collect();
    let pairs =
        Eigenpairs { values: pairs.values, vectors: vectors.into_iter().flatten().collect() };
    let residuals = residuals(w.matrix(), &pairs);
    let Eigenpairs { values, vectors } = pairs;
    Ok(Spectrum {
        eigenspaces: Eigenspace::divided(&values, vectors, &residuals, &eigenspaces, next),
        tolerance: plan.grouping,
        cutoff: plan.wanted.cutoff(),
        solver,
        products,
        verification,
    })
}

/// An orthonormal basis of the span of D^{-1/2} u over the u of one eigenspace.
fn orthonormal_in_node_space(us: Vec<Vec<f64>>, scale: &[f64]) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for mut v in us {
        for (v_i, scale_i) in v.iter_mut().zip(scale) {
            *v_i *= scale_i;
        }
        orthonormalise_against(&basis, &mut v);
        basis.push(v);
    }
    for v in &mut basis {
        fix_sign(v);
    }
    basis
}

/// Makes the component of largest magnitude positive; the lowest node decides a tie.
fn fix_sign(v: &mut [f64]) {
    let largest = v.iter().fold(0.0f64, |largest, v_i| largest.max(v_i.abs()));
    let decides = v.iter().find(|v_i| v_i.abs() >= (1.0 - SIGN_TIE) * largest);
    if decides.is_some_and(|&v_i| v_i < 0.0) {
        for v_i in v {
            *v_i = -*v_i;
        }
    }
}

/// ‖M v − λ v‖ of each pair.
fn residuals(matrix: &SparseMatrix, pairs: &Eigenpairs) -> Vec<f64> {
    let ranges = Block::ranges(pairs.len());
    let residuals = ranges.flat_map(|range| {
        let vectors = Block::from_vectors(&pairs.vectors[range.clone()]);
        let mut rest = multiply_block(matrix, &vectors);
        let minus: Vec<f64> = pairs.values[range].iter().map(|lambda| -lambda).collect();
        rest.add_scaled(&vectors, &minus);
        rest.norms()
    });
    residuals.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_component_becomes_positive() {
        let mut v = [0.1, -0.9, 0.4];
        fix_sign(&mut v);
        assert_eq!(v, [-0.1, 0.9, -0.4]);
    }

    #[test]
    fn the_lowest_node_decides_a_tie_of_magnitudes() {
        let mut v = [0.0, -0.7, 0.7 * (1.0 + 1e-9), 0.1];
        fix_sign(&mut v);
        assert_eq!(v, [0.0, 0.7, -0.7 * (1.0 + 1e-9), -0.1]);
    }

    #[test]
    fn vectors_of_one_eigenspace_become_orthonormal_after_scaling() {
        let us = vec![vec![0.6, 0.8, 0.0], vec![-0.8, 0.6, 0.0], vec![0.0, 0.0, 1.0]];
        let vs = orthonormal_in_node_space(us, &[1.0, 0.1, 3.0]);
        for (i, v) in vs.iter().enumerate() {
            for (j, other) in vs.iter().enumerate() {
                let product = crate::vectors::column::dot(v, other);
                assert!((product - f64::from(u8::from(i == j))).abs() < 1e-15);
            }
        }
    }
}
