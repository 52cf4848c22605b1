//! Sparse factorisations S − c·1 = L D Lᵀ, where their fill is affordable.
//!
//! The order of elimination is approximate minimum degree; fill and operations are those of the
//! symbolic factorisation, known before any number is computed. Even that costs seconds on networks
//! without small separators, whose factors are nearly full, so a cheap look precedes it
//! ([`crate::separator`]).
//!
//! Source: T. A. Davis, Direct Methods for Sparse Linear Systems (SIAM, 2006).

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Par, Side};
use graph::SparseMatrix;

use crate::{dissection, separator};

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
        Some(Factors { cholesky: &self.cholesky, values: factor })
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

/// L and D of S − c·1, their rows and columns in the order of elimination.
pub(crate) struct Factors<'s> {
    cholesky: &'s SymbolicCholesky<u32>,
    values: Vec<f64>,
}

/// Neighbouring columns of L that share their rows: a unit lower triangle, with the pivots on its
/// diagonal, above a rectangle.
pub(crate) struct Panel<'s> {
    /// Its first column.
    pub start: usize,
    /// Its number of columns.
    pub width: usize,
    /// The rows of the rectangle.
    pub below: &'s [u32],
    /// Triangle and rectangle, column by column.
    pub values: &'s [f64],
}

impl<'s> Panel<'s> {
    /// Rows of triangle and rectangle together.
    pub fn n_rows(&self) -> usize {
        self.width + self.below.len()
    }

    /// The k-th column, from its pivot down.
    pub fn column(&self, k: usize) -> &'s [f64] {
        &self.values[k * self.n_rows() + k..(k + 1) * self.n_rows()]
    }

    /// The row of S − c·1, in the order of elimination, that is the r-th of the panel.
    pub fn row(&self, r: usize) -> usize {
        r.checked_sub(self.width).map_or(self.start + r, |beyond| self.below[beyond] as usize)
    }
}

impl Factors<'_> {
    /// Number of rows N.
    pub fn n_rows(&self) -> usize {
        self.cholesky.nrows()
    }

    /// Which row of S is eliminated first, second, …, and when each row is; none where their own order
    /// is that of elimination.
    pub fn order(&self) -> Option<(&[u32], &[u32])> {
        self.cholesky.perm().map(PermRef::arrays)
    }

    /// Number of panels.
    pub fn n_panels(&self) -> usize {
        match self.cholesky.raw() {
            SymbolicCholeskyRaw::Simplicial(pattern) => pattern.ncols(),
            SymbolicCholeskyRaw::Supernodal(pattern) => pattern.n_supernodes(),
        }
    }

    /// A panel, in the order of elimination.
    #[inline]
    pub fn panel(&self, p: usize) -> Panel<'_> {
        match self.cholesky.raw() {
            SymbolicCholeskyRaw::Simplicial(pattern) => {
                let range = pattern.col_ptr()[p] as usize..pattern.col_ptr()[p + 1] as usize;
                let (first, below) = pattern.row_idx()[range.clone()].split_at(1);
                debug_assert_eq!(first[0] as usize, p, "columns begin with their pivots");
                Panel { start: p, width: 1, below, values: &self.values[range] }
            }
            SymbolicCholeskyRaw::Supernodal(pattern) => {
                let node = pattern.supernode(p);
                let starts = pattern.col_ptr_for_val();
                let width = pattern.supernode_end()[p] - pattern.supernode_begin()[p];
                Panel {
                    start: node.start(),
                    width: width as usize,
                    below: node.pattern(),
                    values: &self.values[starts[p] as usize..starts[p + 1] as usize],
                }
            }
        }
    }

    /// All panels, in the order of elimination.
    pub fn panels(&self) -> impl DoubleEndedIterator<Item = Panel<'_>> {
        (0..self.n_panels()).map(|p| self.panel(p))
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
