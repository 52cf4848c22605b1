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

use crate::error::SpectraError;
use crate::vectors::small_eigen::{Eigen, symmetric_eigen};

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

    /// A block of at most eight vectors of one length.
    pub fn from_vectors(vectors: &[Vec<f64>]) -> Self {
        let width = vectors.len();
        let mut block = Self::zeros(vectors[0].len(), width);
        block.data.par_chunks_mut(ROWS * width).enumerate().for_each(|(chunk, rows)| {
            for (v, vector) in vectors.iter().enumerate() {
                let entries = &vector[chunk * ROWS..];
                rows.chunks_exact_mut(width).zip(entries).for_each(|(row, entry)| row[v] = *entry);
            }
        });
        block
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

    /// The rows `order[0]`, `order[1]`, ….
    pub fn reordered(&self, order: &[u32]) -> Self {
        let mut rows = Self::zeros(order.len(), self.width);
        let chunks = rows.data.par_chunks_mut(ROWS * self.width).zip(order.par_chunks(ROWS));
        chunks.for_each(|(rows, order)| {
            for (row, &i) in rows.chunks_mut(self.width).zip(order) {
                row.copy_from_slice(self.node(i as usize));
            }
        });
        rows
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
        let (before, after) = (self.width, c.ncols());
        assert!(after > 0 && c.nrows() == before, "{} × {after}", c.nrows());
        let multiply = |y: &[f64], image: &mut [f64]| {
            let n_rows = y.len() / before;
            let y = MatRef::from_row_major_slice(y, n_rows, before);
            let image = MatMut::from_row_major_slice_mut(image, n_rows, after);
            matmul(image, Accum::Replace, y, c, 1.0, Par::Seq);
        };
        if after == before {
            let in_place = |y: &mut [f64]| {
                let before = y.to_vec();
                multiply(&before, y);
            };
            return self.data.par_chunks_mut(ROWS * before).for_each(in_place);
        }
        let mut image = Self::zeros(self.n_rows(), after);
        let chunks = image.data.par_chunks_mut(ROWS * after);
        chunks.zip(self.data.par_chunks(ROWS * before)).for_each(|(image, y)| multiply(y, image));
        *self = image;
    }

    /// These vectors and others.
    pub fn beside(&self, others: &Self) -> Self {
        assert_eq!(self.n_rows(), others.n_rows(), "lengths of vectors side by side");
        let rows = (0..self.n_rows()).flat_map(|i| self.node(i).iter().chain(others.node(i)));
        Self::from_nodes(self.width + others.width, rows.copied().collect())
    }

    /// How independent the directions of the vectors are: 1 where they are orthogonal, 0 where one is 0.
    pub fn independence(&self) -> Result<f64, SpectraError> {
        let directions = Directions::of(self, &vec![0.0; self.width])?;
        Ok(directions.filter(|found| found.kept.len() == self.width).map_or(0.0, |d| d.least()))
    }

    /// Makes the vectors orthonormal; those no longer than `noise` are left out, and directions that
    /// depend on the others. None when nothing is left.
    ///
    /// Y ← Y N⁻¹ Q Λ^{-1/2} with the norms N and N⁻¹ Yᵀ Y N⁻¹ = Q Λ Qᵀ.
    pub fn orthonormalise(&mut self, noise: &[f64]) -> Result<Option<Cleared>, SpectraError> {
        let Some(found) = Directions::of(self, noise)? else {
            return Ok(None);
        };
        let Eigen { values, vectors } = &found.correlations;
        let n_independent = values.iter().take_while(|&&l| l > DEPENDENT * values[0]).count();
        let mut c = Mat::zeros(self.width, n_independent);
        for (row, &v) in found.kept.iter().enumerate() {
            for k in 0..n_independent {
                c[(v, k)] = vectors[(row, k)] / (values[k].sqrt() * found.norms[v]);
            }
        }
        self.transform(c.as_ref());
        Ok(Some(Cleared { least: found.least(), norms: found.norms }))
    }
}

/// What [`Block::orthonormalise`] found.
pub(crate) struct Cleared {
    /// How independent the directions of the vectors were that were not noise.
    pub least: f64,
    /// The 2-norm that each vector had.
    pub norms: Vec<f64>,
}

/// The directions of the vectors of a block.
struct Directions {
    norms: Vec<f64>,
    /// Vectors longer than noise.
    kept: Vec<usize>,
    /// Eigenpairs of the Gram matrix of their directions.
    correlations: Eigen,
}

impl Directions {
    /// None when all is noise.
    fn of(block: &Block, noise: &[f64]) -> Result<Option<Self>, SpectraError> {
        let gram = block.gram();
        let norms: Vec<f64> = (0..block.width).map(|v| gram[(v, v)].sqrt()).collect();
        let kept: Vec<usize> = (0..block.width).filter(|&v| norms[v] > noise[v]).collect();
        if kept.is_empty() {
            return Ok(None);
        }
        let entry = |i: usize, j: usize| {
            let (v, w) = (kept[i], kept[j]);
            gram[(v, w)] / (norms[v] * norms[w])
        };
        let correlations = symmetric_eigen(kept.len(), entry)?;
        Ok(Some(Self { norms, kept, correlations }))
    }

    /// The root of the smallest eigenvalue.
    fn least(&self) -> f64 {
        self.correlations.values[self.kept.len() - 1].max(0.0).sqrt()
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
