//! The factors of S − c·1 = L D Lᵀ, panel by panel.

use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{SymbolicCholesky, SymbolicCholeskyRaw};

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

impl<'s> Factors<'s> {
    /// - `values`: what the pattern places.
    pub fn new(cholesky: &'s SymbolicCholesky<u32>, values: Vec<f64>) -> Self {
        Self { cholesky, values }
    }

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
