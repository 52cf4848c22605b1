//! Blocks of vectors and a growing orthonormal basis, cut into chunks of nodes.
//!
//! All work goes chunk by chunk in parallel, small dense products within a chunk by faer; sums over
//! chunks run from the first to the last. So no bit depends on the number of threads. Vectors are
//! orthogonalised as blocks, Y ← Y − V (Vᵀ Y), again and again until little is taken away: usually
//! twice (Giraud et al., Numer. Math. 101, 87 (2005)); within the block by the Gram matrix
//! (Stathopoulos & Wu, SIAM J. Sci. Comput. 23, 2165 (2002), SVQB).

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
/// So is what a projection leaves of a unit vector when it is shorter than this.
const NOISE: f64 = 1e-13;
/// A round that leaves so much of every vector has nothing left to take away.
const CLEAN: f64 = 0.7;
/// Rounds after which a block that is never clean counts as dependent.
const MOST_ROUNDS: usize = 5;

/// At most eight vectors of length N, stored node by node.
#[derive(Clone)]
pub(crate) struct Block {
    width: usize,
    data: Vec<f64>,
}

impl Block {
    /// The widest block.
    pub const WIDEST: usize = 8;

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
    fn transform(&mut self, c: MatRef<'_, f64>) {
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
    fn normalise_each(&mut self, noise: f64) -> bool {
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
    fn orthonormalise(&mut self) -> Result<Option<f64>, SpectraError> {
        let gram = self.gram();
        let pairs = symmetric_eigen(self.width, |v, w| gram[(v, w)])?;
        let kept = pairs.values.iter().take_while(|&&l| l > DEPENDENT * pairs.values[0]).count();
        if kept == 0 {
            return Ok(None);
        }
        let coefficient = |v, k: usize| pairs.vectors[k][v] / pairs.values[k].sqrt();
        self.transform(Mat::from_fn(self.width, kept, coefficient).as_ref());
        Ok(Some(pairs.values[pairs.values.len() - 1].max(0.0).sqrt()))
    }
}

/// An orthonormal basis; each chunk of nodes holds its part of the vectors one after another.
pub(crate) struct Basis {
    n_rows: usize,
    n_vectors: usize,
    chunks: Vec<Vec<f64>>,
}

impl Basis {
    /// No vectors of length N.
    pub fn empty(n_rows: usize) -> Self {
        Self { n_rows, n_vectors: 0, chunks: vec![Vec::new(); n_rows.div_ceil(ROWS)] }
    }

    /// Number of vectors.
    pub fn len(&self) -> usize {
        self.n_vectors
    }

    /// Length N of the vectors.
    pub fn n_rows(&self) -> usize {
        self.n_rows
    }

    /// Adds a vector that is orthogonal to all others and of unit norm.
    pub fn push(&mut self, vector: &[f64]) {
        assert_eq!(vector.len(), self.n_rows, "length of a vector of the basis");
        for (chunk, part) in self.chunks.iter_mut().zip(vector.chunks(ROWS)) {
            chunk.extend_from_slice(part);
        }
        self.n_vectors += 1;
    }

    /// Adds the vectors of an orthonormal block that is orthogonal to the basis.
    pub fn append(&mut self, block: &Block) {
        let width = block.width;
        let parts = block.data.par_chunks(ROWS * width);
        self.chunks.par_iter_mut().zip(parts).for_each(|(chunk, part)| {
            for v in 0..width {
                chunk.extend(part.iter().skip(v).step_by(width));
            }
        });
        self.n_vectors += width;
    }

    /// The k-th vector.
    pub fn vector(&self, k: usize) -> Vec<f64> {
        let mut vector = Vec::with_capacity(self.n_rows);
        for (chunk, n_rows) in self.chunks.iter().zip(self.chunk_rows()) {
            vector.extend_from_slice(&chunk[k * n_rows..(k + 1) * n_rows]);
        }
        vector
    }

    /// Vᵀ Y.
    pub fn overlaps(&self, block: &Block) -> Mat<f64> {
        self.overlaps_in(0..self.n_vectors, block)
    }

    /// Vᵀ Y for some vectors of the basis.
    pub fn overlaps_in(&self, range: Range<usize>, block: &Block) -> Mat<f64> {
        let n_vectors = range.len();
        let parts = block.data.par_chunks(ROWS * block.width);
        let partial = |(chunk, part): (&Vec<f64>, &[f64])| {
            let n_rows = part.len() / block.width;
            let chunk = &chunk[n_rows * range.start..n_rows * range.end];
            let v = MatRef::from_column_major_slice(chunk, n_rows, n_vectors);
            product(v.transpose(), MatRef::from_row_major_slice(part, n_rows, block.width))
        };
        let partials: Vec<_> = self.chunks.par_iter().zip(parts).map(partial).collect();
        sum_in_order(&partials, n_vectors, block.width)
    }

    /// V C as a block.
    pub fn combine(&self, c: MatRef<'_, f64>) -> Block {
        let mut block = Block::zeros(self.n_rows, c.ncols());
        self.accumulate(0..c.nrows(), &mut block, c, Accum::Replace, 1.0);
        block
    }

    /// Y ← Y − V C for some vectors of the basis.
    pub fn subtract(&self, range: Range<usize>, block: &mut Block, c: MatRef<'_, f64>) {
        self.accumulate(range, block, c, Accum::Add, -1.0);
    }

    /// Y ← Y − V (Vᵀ Y).
    pub fn project_out(&self, block: &mut Block) {
        self.project_out_first(self.n_vectors, block);
    }

    /// Y ← Y − V (Vᵀ Y) for the first vectors of the basis.
    pub fn project_out_first(&self, n_vectors: usize, block: &mut Block) {
        let overlaps = self.overlaps_in(0..n_vectors, block);
        self.subtract(0..n_vectors, block, overlaps.as_ref());
    }

    /// Y ← Y + factor · V C, or the second term alone, for some vectors of the basis.
    fn accumulate(
        &self,
        range: Range<usize>,
        block: &mut Block,
        c: MatRef<'_, f64>,
        accum: Accum,
        factor: f64,
    ) {
        let width = block.width;
        let parts = block.data.par_chunks_mut(ROWS * width);
        self.chunks.par_iter().zip(parts).for_each(|(chunk, part)| {
            let n_rows = part.len() / width;
            let chunk = &chunk[n_rows * range.start..n_rows * range.end];
            let v = MatRef::from_column_major_slice(chunk, n_rows, c.nrows());
            let part = MatMut::from_row_major_slice_mut(part, n_rows, width);
            matmul(part, accum, v, c, factor, Par::Seq);
        });
    }

    /// V ← V C, which may have fewer vectors.
    pub fn transform(&mut self, c: MatRef<'_, f64>) {
        let (before, after) = (self.n_vectors, c.ncols());
        let rows: Vec<usize> = self.chunk_rows().collect();
        self.chunks.par_iter_mut().zip(rows).for_each(|(chunk, n_rows)| {
            let v = MatRef::from_column_major_slice(chunk, n_rows, before);
            let mut image = vec![0.0; n_rows * after];
            let target = MatMut::from_column_major_slice_mut(&mut image, n_rows, after);
            matmul(target, Accum::Replace, v, c, 1.0, Par::Seq);
            *chunk = image;
        });
        self.n_vectors = after;
    }

    /// Makes a block orthonormal and orthogonal to the basis; what depends on the basis, or on the
    /// rest of the block, is left out. None when nothing is left.
    pub fn orthonormalise(&self, block: Block) -> Result<Option<Block>, SpectraError> {
        self.orthonormalise_against_first(self.n_vectors, block)
    }

    /// The same, with the first vectors of the basis only.
    ///
    /// What little is left of a nearly dependent block carries the rounding of the whole, so rounds go
    /// on until one finds nothing to take away.
    pub fn orthonormalise_against_first(
        &self,
        n_vectors: usize,
        mut block: Block,
    ) -> Result<Option<Block>, SpectraError> {
        if !block.normalise_each(0.0) {
            return Ok(None);
        }
        for _ in 0..MOST_ROUNDS {
            self.project_out_first(n_vectors, &mut block);
            let kept = block.norms().into_iter().fold(1.0, f64::min);
            if !block.normalise_each(NOISE) {
                return Ok(None);
            }
            let Some(least) = block.orthonormalise()? else {
                return Ok(None);
            };
            if kept * least > CLEAN {
                return Ok(Some(block));
            }
        }
        Ok(None)
    }

    /// The same, vector by vector: what is left out is noise, however dependent the vectors are.
    pub fn orthonormalise_one_by_one(
        &mut self,
        block: &Block,
    ) -> Result<Option<Block>, SpectraError> {
        let n_vectors = self.n_vectors;
        for v in 0..block.width {
            let unit = |w, _| if w == v { 1.0 } else { 0.0 };
            let vector = block.combine(Mat::from_fn(block.width, 1, unit).as_ref());
            if let Some(vector) = self.orthonormalise(vector)? {
                self.append(&vector);
            }
        }
        let width = self.n_vectors - n_vectors;
        let unit = |k, v: usize| if k == n_vectors + v { 1.0 } else { 0.0 };
        let found =
            (width > 0).then(|| self.combine(Mat::from_fn(self.n_vectors, width, unit).as_ref()));
        self.truncate(n_vectors);
        Ok(found)
    }

    /// Keeps the first vectors.
    fn truncate(&mut self, n_vectors: usize) {
        let rows: Vec<usize> = self.chunk_rows().collect();
        for (chunk, n_rows) in self.chunks.iter_mut().zip(rows) {
            chunk.truncate(n_vectors * n_rows);
        }
        self.n_vectors = n_vectors;
    }

    fn chunk_rows(&self) -> impl Iterator<Item = usize> + use<> {
        let n_rows = self.n_rows;
        (0..n_rows.div_ceil(ROWS)).map(move |chunk| ROWS.min(n_rows - chunk * ROWS))
    }
}

fn product(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Mat<f64> {
    let mut c = Mat::zeros(a.nrows(), b.ncols());
    matmul(c.as_mut(), Accum::Replace, a, b, 1.0, Par::Seq);
    c
}

fn sum_in_order(partials: &[Mat<f64>], n_rows: usize, n_columns: usize) -> Mat<f64> {
    let mut sum = Mat::zeros(n_rows, n_columns);
    for partial in partials {
        sum += partial;
    }
    sum
}
