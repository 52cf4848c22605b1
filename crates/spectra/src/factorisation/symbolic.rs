//! The pattern of a sparse factorisation S − c·1 = L D Lᵀ, where its fill is affordable.
//!
//! The order of elimination is approximate minimum degree; fill and operations are those of the
//! symbolic factorisation, known before any number is computed. Even that costs seconds on networks
//! without small separators, whose factors are nearly full, so a cheap look precedes it
//! ([`crate::factorisation::separator`]).
//!
//! Source: T. A. Davis, Direct Methods for Sparse Linear Systems (SIAM, 2006).

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::sparse::linalg::cholesky::{
    SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Par, Side};
use graph::SparseMatrix;

use crate::factorisation::factors::Factors;
use crate::factorisation::{dissection, separator};

/// Most nonzeros of a factor: 800 MB, twice while a count is verified.
pub(crate) const MOST_NONZEROS: usize = 100_000_000;
/// Most multiplications of a factorisation: about half a minute on one core.
pub(crate) const MOST_OPERATIONS: f64 = 1e11;
/// Multiplications in a factorisation that take the time of one in a sparse product.
pub(crate) const DENSE_SPEED: f64 = 4.0;

/// The pattern of a factor of S + any diagonal.
pub(crate) struct Symbolic<'a> {
    matrix: &'a SparseMatrix,
    starts: Vec<u32>,
    cholesky: SymbolicCholesky<u32>,
    /// Multiplications of a factorisation, Σ_j c_j² / 2 over the lengths c_j of the columns.
    pub operations: f64,
    /// Levels of a breadth-first search through the longest component.
    pub levels: usize,
}

impl<'a> Symbolic<'a> {
    /// The pattern, or none where the factor would be beyond the budget, or the network's separators
    /// alone say that it has more than `most_fill` nonzeros.
    pub fn within_budget(matrix: &'a SparseMatrix, most_fill: f64) -> Option<Self> {
        let shape = separator::shape(matrix);
        if shape.fill > most_fill.min(MOST_NONZEROS as f64) {
            return None;
        }
        let starts: Option<Vec<u32>> =
            matrix.proper_indptr().iter().map(|&start| u32::try_from(start).ok()).collect();
        let starts = starts?;
        let pattern = pattern(matrix, &starts);
        let order = match &shape.cut {
            Some(cut) => Some(dissection::order(pattern, cut)?),
            None => None,
        };
        let ordering = match &order {
            Some(order) => SymmetricOrdering::Custom(order.as_ref()),
            None => SymmetricOrdering::Amd,
        };
        let cholesky =
            factorize_symbolic_cholesky(pattern, Side::Upper, ordering, Default::default()).ok()?;
        let operations = columns(&cholesky).map(|length| 0.5 * (length * length) as f64).sum();
        let affordable = cholesky.len_val() <= MOST_NONZEROS && operations <= MOST_OPERATIONS;
        affordable.then_some(Self { matrix, starts, cholesky, operations, levels: shape.levels })
    }

    /// Nonzeros of the factor.
    pub fn nonzeros(&self) -> usize {
        self.cholesky.len_val()
    }

    /// S − c·1 = L D Lᵀ; none when a pivot is zero.
    pub fn factors(&self, c: f64) -> Option<Factors<'_>> {
        let values = self.shifted(-c);
        let mut factor = vec![0.0; self.cholesky.len_val()];
        let scratch =
            self.cholesky.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, Default::default());
        self.cholesky
            .factorize_numeric_ldlt(
                &mut factor,
                SparseColMatRef::new(pattern(self.matrix, &self.starts), &values),
                Side::Upper,
                LdltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut MemBuffer::new(scratch)),
                Default::default(),
            )
            .ok()?;
        Some(Factors::new(&self.cholesky, factor))
    }

    /// The stored values of S + shift · 1.
    fn shifted(&self, shift: f64) -> Vec<f64> {
        let mut values = self.matrix.data().to_vec();
        let columns = self.matrix.indices();
        for (i, start) in self.starts.iter().take(self.matrix.rows()).enumerate() {
            let row = *start as usize..self.starts[i + 1] as usize;
            let diagonal = columns[row.clone()].binary_search(&(i as u32));
            values[row.start + diagonal.expect("a coupling matrix stores its diagonal")] += shift;
        }
        values
    }
}

fn pattern<'m>(matrix: &'m SparseMatrix, starts: &'m [u32]) -> SymbolicSparseColMatRef<'m, u32> {
    // Rows of a symmetric matrix are its columns.
    let n_rows = matrix.rows();
    SymbolicSparseColMatRef::new_checked(n_rows, n_rows, starts, None, matrix.indices())
}

/// The length of each column of the factor.
fn columns(cholesky: &SymbolicCholesky<u32>) -> Box<dyn Iterator<Item = usize> + '_> {
    match cholesky.raw() {
        SymbolicCholeskyRaw::Simplicial(pattern) => {
            Box::new(pattern.col_ptr().windows(2).map(|range| (range[1] - range[0]) as usize))
        }
        SymbolicCholeskyRaw::Supernodal(pattern) => {
            Box::new((0..pattern.n_supernodes()).flat_map(|s| {
                let width = pattern.supernode_end()[s] - pattern.supernode_begin()[s];
                let rows = pattern.supernode(s).pattern().len();
                (0..width as usize).map(move |k| rows + k + 1)
            }))
        }
    }
}
