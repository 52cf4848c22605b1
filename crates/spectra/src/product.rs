//! Products of a sparse matrix with a vector or with a block of vectors, rows in parallel.
//!
//! Every row is summed from its first column to its last by one thread, so no bit of a product
//! depends on how many threads there are.
//!
//! A block is stored node by node (`[node][vector]`): one gather then brings a contiguous run, and four
//! vectors cost little more than one. Where all links into a node have one weight, as in any
//! unweighted network, w_ij = g_i, and (W x)_i = g_i Σ_j x_j + (w_ii − g_i) x_i with the sum over the
//! stored pattern, the diagonal included: the product reads 4 bytes a link instead of 12.

use std::borrow::Cow;

use graph::{CouplingMatrix, SparseMatrix};
use rayon::prelude::*;

use crate::block::{Block, ROWS};

/// y = M x for a matrix in compressed rows, each row summed from its first column to its last.
pub(crate) fn multiply(matrix: &SparseMatrix, x: &[f64], y: &mut [f64]) {
    assert_eq!((matrix.rows(), matrix.cols()), (y.len(), x.len()), "shapes of y = M x");
    let rows = Rows::of(matrix);
    y.par_chunks_mut(ROWS).enumerate().for_each(|(chunk, y)| {
        for (i, y_i) in (chunk * ROWS..).zip(y) {
            let (columns, values) = rows.row(i);
            *y_i = columns.iter().zip(values).map(|(&j, &m_ij)| m_ij * x[j as usize]).sum();
        }
    });
}

/// Y = M X.
pub(crate) fn multiply_block(matrix: &SparseMatrix, x: &Block) -> Block {
    assert_eq!(matrix.cols(), x.n_rows(), "shapes of Y = M X");
    let mut y = Block::zeros(matrix.rows(), x.width());
    let step = Step { product: 1.0, same: 0.0, previous: 0.0 };
    Links { matrix, uniform: None }.advance(x, &mut y, step);
    y
}

/// The coefficients of Y ← `product` · W X + `same` · X + `previous` · Y.
#[derive(Clone, Copy)]
pub(crate) struct Step {
    pub product: f64,
    pub same: f64,
    pub previous: f64,
}

/// The coupling matrix W, ready for products with blocks.
pub(crate) struct Links<'a> {
    matrix: &'a SparseMatrix,
    uniform: Option<Uniform>,
}

/// g_i and w_ii − g_i of a matrix whose rows have one weight each.
struct Uniform {
    link: Vec<f64>,
    rest: Vec<f64>,
}

impl<'a> Links<'a> {
    /// Finds out whether the weights need reading.
    pub fn new(w: &'a CouplingMatrix) -> Self {
        Self { matrix: w.matrix(), uniform: Uniform::of(w.matrix()) }
    }

    /// Y ← `product` · W X + `same` · X + `previous` · Y, in one pass.
    pub fn advance(&self, x: &Block, y: &mut Block, step: Step) {
        match x.width() {
            1 => self.advance_wide::<1>(x, y, step),
            2 => self.advance_wide::<2>(x, y, step),
            3 => self.advance_wide::<3>(x, y, step),
            4 => self.advance_wide::<4>(x, y, step),
            5 => self.advance_wide::<5>(x, y, step),
            6 => self.advance_wide::<6>(x, y, step),
            7 => self.advance_wide::<7>(x, y, step),
            8 => self.advance_wide::<8>(x, y, step),
            width => unreachable!("blocks are at most 8 wide, not {width}"),
        }
    }

    fn advance_wide<const B: usize>(&self, x: &Block, y: &mut Block, step: Step) {
        assert_eq!((x.n_rows(), B), (y.n_rows(), y.width()), "shapes of Y = W X");
        let (x, _) = x.data().as_chunks::<B>();
        let rows = Rows::of(self.matrix);
        let (y, _) = y.data_mut().as_chunks_mut::<B>();
        y.par_chunks_mut(ROWS).enumerate().for_each(|(chunk, y)| {
            for (i, y_i) in (chunk * ROWS..).zip(y) {
                let (columns, values) = rows.row(i);
                let image = match &self.uniform {
                    Some(uniform) => uniform.row(i, columns, x),
                    None => weighted_row(columns, values, x),
                };
                for v in 0..B {
                    y_i[v] = step.product * image[v] + step.same * x[i][v] + step.previous * y_i[v];
                }
            }
        });
    }
}

impl Uniform {
    /// What is left to read when every row has one weight; none otherwise.
    fn of(matrix: &SparseMatrix) -> Option<Self> {
        let rows = Rows::of(matrix);
        let coefficients = (0..matrix.rows()).into_par_iter().map(|i| {
            let (columns, values) = rows.row(i);
            let (mut link, mut diagonal) = (None, 0.0);
            for (&j, &value) in columns.iter().zip(values) {
                match link {
                    _ if j as usize == i => diagonal = value,
                    Some(first) if first != value => return None,
                    _ => link = Some(value),
                }
            }
            let link = link.unwrap_or(0.0);
            Some((link, diagonal - link))
        });
        let coefficients: Option<Vec<(f64, f64)>> = coefficients.collect();
        let (link, rest) = coefficients?.into_iter().unzip();
        Some(Self { link, rest })
    }

    #[inline]
    fn row<const B: usize>(&self, i: usize, columns: &[u32], x: &[[f64; B]]) -> [f64; B] {
        let mut sum = [0.0; B];
        for &j in columns {
            let x_j = &x[j as usize];
            for v in 0..B {
                sum[v] += x_j[v];
            }
        }
        for v in 0..B {
            sum[v] = self.link[i] * sum[v] + self.rest[i] * x[i][v];
        }
        sum
    }
}

#[inline]
fn weighted_row<const B: usize>(columns: &[u32], values: &[f64], x: &[[f64; B]]) -> [f64; B] {
    let mut sum = [0.0; B];
    for (&j, &value) in columns.iter().zip(values) {
        let x_j = &x[j as usize];
        for v in 0..B {
            sum[v] += value * x_j[v];
        }
    }
    sum
}

/// The slices of a matrix in compressed rows.
struct Rows<'a> {
    starts: Cow<'a, [usize]>,
    columns: &'a [u32],
    values: &'a [f64],
}

impl<'a> Rows<'a> {
    fn of(matrix: &'a SparseMatrix) -> Self {
        assert!(matrix.is_csr(), "products read compressed rows");
        let starts = matrix.proper_indptr();
        Self { starts, columns: matrix.indices(), values: matrix.data() }
    }

    #[inline]
    fn row(&self, i: usize) -> (&'a [u32], &'a [f64]) {
        let range = self.starts[i]..self.starts[i + 1];
        (&self.columns[range.clone()], &self.values[range])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use graph::{CouplingMatrix, Network, Normalization};

    #[test]
    fn the_product_is_that_of_sprs() {
        let labels = (0..7).map(|i| i.to_string()).collect();
        let links = [(0, 1, 0.3), (1, 2, 1.7), (2, 0, 2.1), (3, 4, 0.9), (4, 6, 5.0)];
        let network = Network::undirected(labels, &links).unwrap();
        let w = CouplingMatrix::new(&network, Normalization::Laplacian);
        let x: Vec<f64> = (0..7).map(|i| (f64::from(i) * 1.3).sin()).collect();
        let mut y = vec![f64::NAN; 7];
        multiply(w.matrix(), &x, &mut y);
        let mut expected = vec![0.0; 7];
        sprs::prod::mul_acc_mat_vec_csr(w.matrix().view(), x.as_slice(), &mut expected);
        for (y_i, expected_i) in y.iter().zip(&expected) {
            assert!((y_i - expected_i).abs() < 1e-15, "{y:?} {expected:?}");
        }
    }
}
