//! Products of a sparse matrix with a vector or with a block of vectors, rows in parallel.
//!
//! Every row is summed from its first column to its last by one thread, so no bit of a product
//! depends on how many threads there are.
//!
//! A block is stored node by node (`[node][vector]`): one gather then brings a contiguous run, and four
//! vectors cost little more than one. Where all links into a node have one weight, as in any
//! unweighted network, w_ij = g_i, and (W x)_i = g_i Σ_j x_j + w_ii x_i with the sum over neighbours:
//! the product reads 4 bytes a link instead of 12.

use std::borrow::Cow;
use std::ops::Range;

use graph::{SparseMatrix, SymmetricForm};
use rayon::prelude::*;

use crate::vectors::block::{Block, ROWS};

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
    Links { matrix, uniform: None, scale: &[] }.advance(x, &mut y, step);
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
    /// D^{-1/2}.
    scale: &'a [f64],
}

/// A matrix whose rows have one weight each, beside the diagonal.
struct Uniform {
    /// g.
    link: Vec<f64>,
    /// w_ii.
    diagonal: Vec<f64>,
    /// Where the neighbours of each node start; N + 1 numbers.
    starts: Vec<usize>,
    neighbours: Vec<u32>,
}

impl<'a> Links<'a> {
    /// Finds out whether the weights need reading.
    pub fn new(w: &'a SymmetricForm<'a>) -> Self {
        Self { matrix: w.matrix(), uniform: Uniform::of(w.matrix()), scale: w.scale() }
    }

    /// D^{-1/2}, which takes S to node space: W = D^{-1/2} S D^{1/2}.
    pub fn scale(&self) -> &'a [f64] {
        self.scale
    }

    /// D^{-1/2} X.
    pub fn to_node_space(&self, mut x: Block) -> Block {
        x.scale_nodes(|i| self.scale[i]);
        x
    }

    /// D^{1/2} X.
    pub fn to_symmetric(&self, mut x: Block) -> Block {
        x.scale_nodes(|i| 1.0 / self.scale[i]);
        x
    }

    /// Cleans vectors in node space in the coordinates of S.
    pub fn clean(&self, x: &mut Block, clean: impl Fn(&mut Block)) {
        x.scale_nodes(|i| 1.0 / self.scale[i]);
        clean(x);
        x.scale_nodes(|i| self.scale[i]);
    }

    /// S X.
    pub fn multiply(&self, x: &Block) -> Block {
        let mut image = Block::zeros(x.n_rows(), x.width());
        let step = Step { product: 1.0, same: 0.0, previous: 0.0 };
        self.advance(&self.to_node_space(x.clone()), &mut image, step);
        self.to_symmetric(image)
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
        self.advance_and::<B, ()>(x, y, step, |_, _| ());
    }

    /// The same for single vectors, and Σ_i d_i x_i y_i.
    pub fn advance_and_weigh(&self, x: &Block, y: &mut Block, step: Step, d: &[f64]) -> f64 {
        assert_eq!(x.width(), 1, "one vector");
        let partials = self.advance_and::<1, f64>(x, y, step, |rows, y| -> f64 {
            weighted_sum(&d[rows.clone()], &x.data()[rows], y.as_flattened())
        });
        partials.iter().sum()
    }

    /// The same, and what a function makes of each chunk of Y while it is at hand.
    fn advance_and<const B: usize, T: Send>(
        &self,
        x: &Block,
        y: &mut Block,
        step: Step,
        then: impl Fn(Range<usize>, &[[f64; B]]) -> T + Sync,
    ) -> Vec<T> {
        assert_eq!((x.n_rows(), B), (y.n_rows(), y.width()), "shapes of Y = W X");
        let (x, _) = x.data().as_chunks::<B>();
        let rows = Rows::of(self.matrix);
        let (y, _) = y.data_mut().as_chunks_mut::<B>();
        let chunks = y.par_chunks_mut(ROWS).enumerate().map(|(chunk, y)| {
            let first = chunk * ROWS;
            for (i, y_i) in (first..).zip(y.iter_mut()) {
                let image = match &self.uniform {
                    Some(uniform) => uniform.row(i, x),
                    None => weighted_row(rows.row(i), x),
                };
                for v in 0..B {
                    y_i[v] = step.product * image[v] + step.same * x[i][v] + step.previous * y_i[v];
                }
            }
            then(first..first + y.len(), y)
        });
        chunks.collect()
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
            Some((link.unwrap_or(0.0), diagonal))
        });
        let coefficients: Option<Vec<(f64, f64)>> = coefficients.collect();
        let (link, diagonal) = coefficients?.into_iter().unzip();
        let (mut starts, mut neighbours) = (vec![0], Vec::with_capacity(matrix.nnz()));
        for i in 0..matrix.rows() {
            neighbours.extend(rows.row(i).0.iter().filter(|&&j| j as usize != i));
            starts.push(neighbours.len());
        }
        Some(Self { link, diagonal, starts, neighbours })
    }

    #[inline(always)]
    fn row<const B: usize>(&self, i: usize, x: &[[f64; B]]) -> [f64; B] {
        let mut sum = [0.0; B];
        for &j in &self.neighbours[self.starts[i]..self.starts[i + 1]] {
            let x_j = &x[j as usize];
            for v in 0..B {
                sum[v] += x_j[v];
            }
        }
        for v in 0..B {
            sum[v] = self.link[i] * sum[v] + self.diagonal[i] * x[i][v];
        }
        sum
    }
}

#[inline(always)]
fn weighted_row<const B: usize>(row: (&[u32], &[f64]), x: &[[f64; B]]) -> [f64; B] {
    let mut sum = [0.0; B];
    for (&j, &value) in row.0.iter().zip(row.1) {
        let x_j = &x[j as usize];
        for v in 0..B {
            sum[v] += value * x_j[v];
        }
    }
    sum
}

/// Σ_i d_i x_i y_i as eight sums side by side.
pub(crate) fn weighted_sum(d: &[f64], x: &[f64], y: &[f64]) -> f64 {
    const LANES: usize = 8;
    let ((d, d_rest), (x, x_rest), (y, y_rest)) =
        (d.as_chunks::<LANES>(), x.as_chunks::<LANES>(), y.as_chunks::<LANES>());
    let mut sums = [0.0; LANES];
    for ((d, x), y) in d.iter().zip(x).zip(y) {
        for lane in 0..LANES {
            sums[lane] += d[lane] * x[lane] * y[lane];
        }
    }
    let rest = d_rest.iter().zip(x_rest).zip(y_rest).map(|((d, x), y)| d * x * y);
    sums.into_iter().chain(rest).sum()
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
