//! Sparse factorisations of μ − S and S − c·1, where their fill is affordable.
//!
//! The order of elimination is approximate minimum degree; fill and operations are those of the
//! symbolic factorisation, known before any number is computed. Even that costs seconds on networks
//! without small separators, whose factors are nearly full, so a cheap look precedes it
//! ([`crate::separator`]).
//!
//! Source: T. A. Davis, Direct Methods for Sparse Linear Systems (SIAM, 2006).

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::supernodal::{SupernodalLdltRef, SupernodeRef};
use faer::sparse::linalg::cholesky::{
    LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};
use graph::SparseMatrix;

use crate::block::Block;
use crate::separator;

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
        let ordering = SymmetricOrdering::Amd;
        let cholesky =
            factorize_symbolic_cholesky(pattern, Side::Upper, ordering, Default::default()).ok()?;
        let operations = columns(&cholesky).map(|length| 0.5 * (length * length) as f64).sum();
        let affordable = cholesky.len_val() <= MOST_NONZEROS && operations <= MOST_OPERATIONS;
        affordable.then_some(Self { matrix, starts, cholesky, operations, levels: shape.levels })
    }

    /// Number of nodes N.
    pub fn n_rows(&self) -> usize {
        self.matrix.rows()
    }

    /// Nonzeros of the factor.
    pub fn nonzeros(&self) -> usize {
        self.cholesky.len_val()
    }

    /// μ − S = L Lᵀ; none when a pivot is not positive.
    pub fn positive(&self, shift: f64) -> Option<Inverse<'_, 'a>> {
        let values = self.shifted(-1.0, shift);
        let mut factor = vec![0.0; self.cholesky.len_val()];
        let scratch =
            self.cholesky.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        self.cholesky
            .factorize_numeric_llt(
                &mut factor,
                SparseColMatRef::new(pattern(self.matrix, &self.starts), &values),
                Side::Upper,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut MemBuffer::new(scratch)),
                Default::default(),
            )
            .ok()?;
        Some(Inverse { symbolic: self, factor })
    }

    /// S − c·1 = L D Lᵀ; none when a pivot is zero.
    pub fn indefinite(&self, cutoff: f64) -> Option<Indefinite<'_, 'a>> {
        let values = self.shifted(1.0, -cutoff);
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
        Some(Indefinite { symbolic: self, factor })
    }

    /// The stored values of sign · S + shift · 1.
    fn shifted(&self, sign: f64, shift: f64) -> Vec<f64> {
        let mut values: Vec<f64> = self.matrix.data().iter().map(|s_ij| sign * s_ij).collect();
        let columns = self.matrix.indices();
        for (i, start) in self.starts.iter().take(self.matrix.rows()).enumerate() {
            let row = *start as usize..self.starts[i + 1] as usize;
            let diagonal = columns[row.clone()].binary_search(&(i as u32));
            values[row.start + diagonal.expect("a coupling matrix stores its diagonal")] += shift;
        }
        values
    }
}

/// (μ − S)⁻¹ by its factor.
pub(crate) struct Inverse<'s, 'a> {
    symbolic: &'s Symbolic<'a>,
    factor: Vec<f64>,
}

impl Inverse<'_, '_> {
    /// Overwrites a block X with (μ − S)⁻¹ X.
    pub fn apply(&self, block: &mut Block) {
        let cholesky = &self.symbolic.cholesky;
        let (n_rows, width) = (block.n_rows(), block.width());
        let mut columns = vec![0.0; n_rows * width];
        for (i, row) in block.data().chunks(width).enumerate() {
            for (v, &entry) in row.iter().enumerate() {
                columns[v * n_rows + i] = entry;
            }
        }
        let scratch = cholesky.solve_in_place_scratch::<f64>(width, Par::Seq);
        LltRef::new(cholesky, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut columns, n_rows, width),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
        );
        for (i, row) in block.data_mut().chunks_mut(width).enumerate() {
            for (v, entry) in row.iter_mut().enumerate() {
                *entry = columns[v * n_rows + i];
            }
        }
    }
}

/// L and D of S − c·1.
pub(crate) struct Indefinite<'s, 'a> {
    symbolic: &'s Symbolic<'a>,
    factor: Vec<f64>,
}

impl Indefinite<'_, '_> {
    /// Calls with each column of the factor: its pivot d_j, and the entries l_ij below it with their
    /// rows i in the order of elimination.
    pub fn columns(
        &self,
        mut call: impl FnMut(usize, f64, &mut dyn Iterator<Item = (usize, f64)>),
    ) {
        let cholesky = &self.symbolic.cholesky;
        match cholesky.raw() {
            SymbolicCholeskyRaw::Simplicial(pattern) => {
                for (j, range) in pattern.col_ptr().windows(2).enumerate() {
                    let range = range[0] as usize..range[1] as usize;
                    let rows = pattern.row_idx()[range.clone()].iter().map(|&i| i as usize);
                    let mut entries = rows.zip(self.factor[range].iter().copied());
                    let (first, pivot) = entries.next().expect("a column holds its pivot");
                    assert_eq!(first, j, "columns begin with their pivots");
                    call(j, pivot, &mut entries);
                }
            }
            SymbolicCholeskyRaw::Supernodal(pattern) => {
                let factor = SupernodalLdltRef::new(pattern, &self.factor);
                for s in 0..pattern.n_supernodes() {
                    supernode_columns(factor.supernode(s), &mut call);
                }
            }
        }
    }
}

/// The columns of a supernode: a unit lower triangle with the pivots on its diagonal, above the rows
/// that its columns share.
fn supernode_columns(
    node: SupernodeRef<'_, u32, f64>,
    call: &mut impl FnMut(usize, f64, &mut dyn Iterator<Item = (usize, f64)>),
) {
    let (values, start, below) = (node.val(), node.start(), node.pattern());
    let row =
        |k: usize| k.checked_sub(values.ncols()).map_or(start + k, |beyond| below[beyond] as usize);
    for k in 0..values.ncols() {
        let mut entries = (k + 1..values.nrows()).map(|i| (row(i), values[(i, k)]));
        call(start + k, values[(k, k)], &mut entries);
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
