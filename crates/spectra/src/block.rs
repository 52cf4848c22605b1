//! Blocks of vectors, cut into chunks of nodes.
//!
//! All work goes chunk by chunk in parallel, small dense products within a chunk by faer; sums over
//! chunks run from the first to the last. So no bit depends on the number of threads. The vectors of a
//! block are made orthonormal by their Gram matrix (Stathopoulos & Wu, SIAM J. Sci. Comput. 23, 2165
//! (2002), SVQB).

use std::ops::Range;

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatMut, MatRef, Par};
use rayon::prelude::*;

use crate::SpectraError;
use crate::dense::symmetric_eigen;

/// Nodes of a chunk.
pub(crate) const ROWS: usize = 1024;

/// A direction of a normalised block whose share of the block's Gram matrix is below this is noise.
const DEPENDENT: f64 = 1e-12;

/// At most eight vectors of length N, stored node by node.
#[derive(Clone)]
pub(crate) struct Block {
    width: usize,
    data: Vec<f64>,
}

impl Block {
    /// The widest block.
    pub const WIDEST: usize = 8;

    /// The ranges of `n` vectors that fill blocks one after another.
    pub fn ranges(n: usize) -> impl Iterator<Item = Range<usize>> {
        (0..n).step_by(Self::WIDEST).map(move |first| first..n.min(first + Self::WIDEST))
    }

    /// Vectors of zeros.
    pub fn zeros(n_rows: usize, width: usize) -> Self {
        assert!((1..=Self::WIDEST).contains(&width), "a block of {width} vectors");
        Self { width, data: vec![0.0; n_rows * width] }
    }

    /// A block from the entries of node 0, of node 1, ….
    pub fn from_nodes(width: usize, data: Vec<f64>) -> Self {
        assert_eq!(data.len() % width, 0, "entries of a block of {width} vectors");
        Self { width, data }
    }

    /// Length N of the vectors.
    pub fn n_rows(&self) -> usize {
        self.data.len() / self.width
    }

    /// Number of vectors.
    pub fn width(&self) -> usize {
        self.width
    }

    /// All entries, node by node.
    pub fn data(&self) -> &[f64] {
        &self.data
    }

    /// All entries, node by node.
    pub fn data_mut(&mut self) -> &mut [f64] {
        &mut self.data
    }

    /// The entries of a node, one a vector.
    pub fn node(&self, i: usize) -> &[f64] {
        &self.data[i * self.width..(i + 1) * self.width]
    }

    /// Multiplies the entries of every node by its own factor.
    pub fn scale_nodes(&mut self, factor: impl Fn(usize) -> f64 + Sync) {
        let width = self.width;
        self.data.par_chunks_mut(ROWS * width).enumerate().for_each(|(chunk, rows)| {
            for (i, row) in (chunk * ROWS..).zip(rows.chunks_mut(width)) {
                let factor = factor(i);
                row.iter_mut().for_each(|entry| *entry *= factor);
            }
        });
    }

    /// Y ← Y + X diag(c).
    pub fn add_scaled(&mut self, x: &Self, c: &[f64]) {
        let width = self.width;
        assert_eq!((x.width, c.len()), (width, width), "widths of Y + X diag(c)");
        let rows = self.data.par_chunks_mut(ROWS * width).zip(x.data.par_chunks(ROWS * width));
        rows.for_each(|(y, x)| {
            for (y, x) in y.chunks_mut(width).zip(x.chunks(width)) {
                for v in 0..width {
                    y[v] += c[v] * x[v];
                }
            }
        });
    }

    /// Yᵀ Y.
    pub fn gram(&self) -> Mat<f64> {
        self.overlaps(self)
    }

    /// Yᵀ Z.
    pub fn overlaps(&self, z: &Self) -> Mat<f64> {
        assert_eq!(self.n_rows(), z.n_rows(), "lengths of Yᵀ Z");
        let partial = |(y, z): (&[f64], &[f64])| {
            let n_rows = y.len() / self.width;
            let y = MatRef::from_row_major_slice(y, n_rows, self.width);
            product(y.transpose(), MatRef::from_row_major_slice(z, n_rows, z.len() / n_rows))
        };
        let chunks = self.data.par_chunks(ROWS * self.width);
        let partials: Vec<_> = chunks.zip(z.data.par_chunks(ROWS * z.width)).map(partial).collect();
        sum_in_order(&partials, self.width, z.width)
    }

    /// The 2-norm of each vector.
    pub fn norms(&self) -> Vec<f64> {
        let gram = self.gram();
        (0..self.width).map(|v| gram[(v, v)].sqrt()).collect()
    }

    /// Y C.
    pub fn combine(&self, c: MatRef<'_, f64>) -> Self {
        let mut image = self.clone();
        image.transform(c);
        image
    }

    /// Y ← Y C, which may have fewer vectors.
    pub fn transform(&mut self, c: MatRef<'_, f64>) {
        assert!(c.ncols() > 0 && c.nrows() == self.width, "{} × {}", c.nrows(), c.ncols());
        let mut image = Self::zeros(self.n_rows(), c.ncols());
        let chunks = image.data.par_chunks_mut(ROWS * c.ncols());
        chunks.zip(self.data.par_chunks(ROWS * self.width)).for_each(|(image, y)| {
            let n_rows = y.len() / self.width;
            let y = MatRef::from_row_major_slice(y, n_rows, self.width);
            let image = MatMut::from_row_major_slice_mut(image, n_rows, c.ncols());
            matmul(image, Accum::Replace, y, c, 1.0, Par::Seq);
        });
        *self = image;
    }

    /// Divides each vector by its norm and drops those of a norm of at most `noise`; false when all are.
    pub fn normalise_each(&mut self, noise: f64) -> bool {
        let norms = self.norms();
        let kept: Vec<usize> = (0..self.width).filter(|&v| norms[v] > noise).collect();
        if kept.is_empty() {
            return false;
        }
        let factor = |v, k: usize| if kept[k] == v { 1.0 / norms[v] } else { 0.0 };
        self.transform(Mat::from_fn(self.width, kept.len(), factor).as_ref());
        true
    }

    /// An orthonormal basis of the span of its vectors, and how independent they were; none when all
    /// are of norm zero.
    pub fn span(mut self) -> Result<Option<(Self, f64)>, SpectraError> {
        if !self.normalise_each(0.0) {
            return Ok(None);
        }
        Ok(self.orthonormalise()?.map(|least| (self, least)))
    }

    /// These vectors and others.
    pub fn beside(&self, others: &Self) -> Self {
        assert_eq!(self.n_rows(), others.n_rows(), "lengths of vectors side by side");
        let rows = (0..self.n_rows()).flat_map(|i| self.node(i).iter().chain(others.node(i)));
        Self::from_nodes(self.width + others.width, rows.copied().collect())
    }

    /// Makes unit vectors orthonormal, and says how independent they were; none when they were not.
    ///
    /// Y ← Y Q Λ^{-1/2} with Yᵀ Y = Q Λ Qᵀ, where directions of negligible λ are left out. Returns the
    /// root of the smallest λ, those left out included.
    pub fn orthonormalise(&mut self) -> Result<Option<f64>, SpectraError> {
        let gram = self.gram();
        let pairs = symmetric_eigen(self.width, |v, w| gram[(v, w)])?;
        let kept = pairs.values.iter().take_while(|&&l| l > DEPENDENT * pairs.values[0]).count();
        if kept == 0 {
            return Ok(None);
        }
        let coefficient = |v, k: usize| pairs.vectors[(v, k)] / pairs.values[k].sqrt();
        self.transform(Mat::from_fn(self.width, kept, coefficient).as_ref());
        Ok(Some(pairs.values[pairs.values.len() - 1].max(0.0).sqrt()))
    }
}

/// A B, one thread.
pub(crate) fn product(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Mat<f64> {
    let mut c = Mat::zeros(a.nrows(), b.ncols());
    matmul(c.as_mut(), Accum::Replace, a, b, 1.0, Par::Seq);
    c
}

/// The sum of the parts that chunks make.
pub(crate) fn sum_in_order(partials: &[Mat<f64>], n_rows: usize, n_columns: usize) -> Mat<f64> {
    let mut sum = Mat::zeros(n_rows, n_columns);
    for partial in partials {
        sum += partial;
    }
    sum
}
