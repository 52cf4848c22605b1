//! A growing orthonormal basis, cut into chunks of nodes like the blocks that enter it.
//!
//! Blocks are made orthogonal to the basis as a whole, Y ← Y − V (Vᵀ Y), again and again until little is
//! taken away: usually twice (Giraud et al., Numer. Math. 101, 87 (2005)).

use std::ops::Range;

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatMut, MatRef, Par};
use rayon::prelude::*;

use crate::error::SpectraError;
use crate::vectors::block::{Block, ROWS, product, sum_in_order};

/// What a projection leaves of a unit vector is noise when it is shorter than this.
const NOISE: f64 = 1e-13;
/// A round that leaves so much of every vector has nothing left to take away.
const CLEAN: f64 = 0.7;
/// Rounds after which a block that is never clean counts as dependent.
const MOST_ROUNDS: usize = 5;

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

    /// No vectors yet, and room for some: memory is taken as they come.
    pub fn with_room(n_rows: usize, n_vectors: usize) -> Self {
        let mut basis = Self::empty(n_rows);
        let rows = basis.chunk_rows();
        basis.chunks.iter_mut().zip(rows).for_each(|(chunk, n_rows)| {
            chunk.reserve_exact(n_rows * n_vectors);
        });
        basis
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
        let width = block.width();
        let parts = block.data().par_chunks(ROWS * width);
        self.chunks.par_iter_mut().zip(parts).for_each(|(chunk, part)| {
            if width == 1 {
                return chunk.extend_from_slice(part);
            }
            for v in 0..width {
                chunk.extend(part.chunks_exact(width).map(|row| row[v]));
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

    /// Some neighbouring vectors as a block.
    pub fn block(&self, range: Range<usize>) -> Block {
        let width = range.len();
        let mut block = Block::zeros(self.n_rows, width);
        let parts = block.data_mut().par_chunks_mut(ROWS * width);
        self.chunks.par_iter().zip(parts).for_each(|(chunk, part)| {
            let n_rows = part.len() / width;
            let vectors = chunk[range.start * n_rows..range.end * n_rows].chunks(n_rows);
            for (v, vector) in vectors.enumerate() {
                part.chunks_exact_mut(width).zip(vector).for_each(|(row, entry)| row[v] = *entry);
            }
        });
        block
    }

    /// A basis of the first vectors.
    pub fn first(&self, n_vectors: usize) -> Self {
        let part = |(chunk, n_rows): (&Vec<f64>, usize)| chunk[..n_vectors * n_rows].to_vec();
        let chunks = self.chunks.iter().zip(self.chunk_rows()).map(part).collect();
        Self { n_rows: self.n_rows, n_vectors, chunks }
    }

    /// Vᵀ Y.
    pub fn overlaps(&self, block: &Block) -> Mat<f64> {
        self.overlaps_in(0..self.n_vectors, block)
    }

    /// Vᵀ Y for some vectors of the basis.
    pub fn overlaps_in(&self, range: Range<usize>, block: &Block) -> Mat<f64> {
        let n_vectors = range.len();
        let parts = block.data().par_chunks(ROWS * block.width());
        let partial = |(chunk, part): (&Vec<f64>, &[f64])| {
            let n_rows = part.len() / block.width();
            let chunk = &chunk[n_rows * range.start..n_rows * range.end];
            let v = MatRef::from_column_major_slice(chunk, n_rows, n_vectors);
            product(v.transpose(), MatRef::from_row_major_slice(part, n_rows, block.width()))
        };
        let partials: Vec<_> = self.chunks.par_iter().zip(parts).map(partial).collect();
        sum_in_order(&partials, n_vectors, block.width())
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

    /// ‖y_k − λ_k v_k‖ for the vectors y_k of another basis.
    pub fn residuals(&self, images: &Self, lambda: &[f64]) -> Vec<f64> {
        assert_eq!((self.n_vectors, self.n_vectors), (images.n_vectors, lambda.len()), "pairs");
        let partial = |(v, y): (&Vec<f64>, &Vec<f64>)| -> Vec<f64> {
            let n_rows = v.len() / self.n_vectors;
            let pairs = v.chunks(n_rows).zip(y.chunks(n_rows)).zip(lambda);
            let square = |(y_i, v_i): (&f64, &f64), l: f64| (y_i - l * v_i).powi(2);
            pairs
                .map(|((v, y), &l)| y.iter().zip(v).map(|entries| square(entries, l)).sum())
                .collect()
        };
        let partials: Vec<_> = self.chunks.par_iter().zip(&images.chunks).map(partial).collect();
        let square = |k: usize| partials.iter().map(|partial| partial[k]).sum::<f64>();
        (0..self.n_vectors).map(|k| square(k).sqrt()).collect()
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
        let width = block.width();
        let parts = block.data_mut().par_chunks_mut(ROWS * width);
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
        let mut before = block.norms();
        for _ in 0..MOST_ROUNDS {
            self.project_out_first(n_vectors, &mut block);
            let noise: Vec<f64> = before.iter().map(|norm| NOISE * norm).collect();
            let Some(found) = block.orthonormalise(&noise)? else {
                return Ok(None);
            };
            let is_clean = |(norm, before): (&f64, &f64)| norm * found.least > CLEAN * before;
            if found.norms.iter().zip(&before).all(is_clean) {
                return Ok(Some(block));
            }
            before = vec![1.0; block.width()];
        }
        Ok(None)
    }

    /// The same, vector by vector: what is left out is noise, however dependent the vectors are.
    pub fn orthonormalise_one_by_one(
        &mut self,
        block: &Block,
    ) -> Result<Option<Block>, SpectraError> {
        let n_vectors = self.n_vectors;
        for v in 0..block.width() {
            let unit = |w, _| if w == v { 1.0 } else { 0.0 };
            let vector = block.combine(Mat::from_fn(block.width(), 1, unit).as_ref());
            if let Some(vector) = self.orthonormalise(vector)? {
                self.append(&vector);
            }
        }
        let added = n_vectors..self.n_vectors;
        let found = (!added.is_empty()).then(|| self.block(added));
        self.truncate(n_vectors);
        Ok(found)
    }

    /// Keeps the first vectors.
    pub fn truncate(&mut self, n_vectors: usize) {
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
