//! The coupling matrix W = {w_ij}: w_ij > 0 when j drives i, every row sums to zero.
//!
//! - laplacian: w_ij = a_ij, w_ii = −Σ_j a_ij
//! - normalized: w_ij = a_ij / k_i, w_ii = −1, with k_i = Σ_j a_ij
//! - as given: any W whose rows sum to zero
//!
//! A normalized matrix of a symmetric network is similar to a symmetric one, and so has a real
//! spectrum: W = D^{-1/2} S D^{1/2} with S = D^{-1/2} A D^{-1/2} − I and D = diag(k_i). If u is an
//! eigenvector of S, v = D^{-1/2} u is one of W. Of a given matrix [`balance`] finds out.

mod balance;
mod given;

use crate::{Network, SparseMatrix};

/// How the coupling matrix follows from the adjacency matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Normalization {
    /// w_ij = a_ij.
    Laplacian,
    /// w_ij = a_ij / k_i: every node receives the same total coupling.
    Normalized,
}

/// What is known of the symmetry of a coupling matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Symmetry {
    /// W = Wᵀ.
    Symmetric,
    /// W = D^{-1/2} S D^{1/2} with S = Sᵀ and a positive diagonal matrix D.
    Similar,
    /// Neither: no D balances d_i w_ij = d_j w_ji at these two nodes. Eigenvalues may be complex.
    Neither {
        /// The nodes i and j, from 0.
        at: (usize, usize),
    },
}

/// The coupling matrix W, with the symmetric matrix that it is similar to where there is one.
#[derive(Clone, Debug)]
pub struct CouplingMatrix {
    matrix: SparseMatrix,
    form: Form,
}

#[derive(Clone, Debug)]
enum Form {
    /// With D = 1.
    Symmetric {
        scale: Vec<f64>,
    },
    Similar {
        symmetric: SparseMatrix,
        scale: Vec<f64>,
    },
    Neither {
        at: (usize, usize),
    },
}

impl CouplingMatrix {
    /// Builds W from a network. An isolated node receives no coupling: its row is zero.
    pub fn new(network: &Network, normalization: Normalization) -> Self {
        let strengths = network.strengths();
        let adjacency = network.adjacency();
        match normalization {
            Normalization::Laplacian => {
                let matrix = with_diagonal(adjacency, |_, _, a| a, |i| -strengths[i]);
                Self { matrix, form: Form::Symmetric { scale: vec![1.0; network.n_nodes()] } }
            }
            Normalization::Normalized => {
                let is_linked = |i: usize| strengths[i] > 0.0;
                let scale_of = |&k: &f64| if k > 0.0 { 1.0 / k.sqrt() } else { 1.0 };
                let scale: Vec<f64> = strengths.iter().map(scale_of).collect();
                let diagonal = |i| if is_linked(i) { -1.0 } else { 0.0 };
                let matrix = with_diagonal(adjacency, |i, _, a| a / strengths[i], diagonal);
                let symmetric =
                    with_diagonal(adjacency, |i, j, a| scale[i] * scale[j] * a, diagonal);
                Self { matrix, form: Form::Similar { symmetric, scale } }
            }
        }
    }

    /// Number of nodes N.
    pub fn n_nodes(&self) -> usize {
        self.matrix.rows()
    }

    /// W itself, shape (N, N), every diagonal entry stored.
    pub fn matrix(&self) -> &SparseMatrix {
        &self.matrix
    }

    /// What is known of its symmetry.
    pub fn symmetry(&self) -> Symmetry {
        match self.form {
            Form::Symmetric { .. } => Symmetry::Symmetric,
            Form::Similar { .. } => Symmetry::Similar,
            Form::Neither { at } => Symmetry::Neither { at },
        }
    }

    /// W together with the symmetric matrix that it is similar to, where there is one.
    pub fn symmetric_form(&self) -> Option<SymmetricForm<'_>> {
        let (symmetric, scale) = match &self.form {
            Form::Symmetric { scale } => (&self.matrix, scale),
            Form::Similar { symmetric, scale } => (symmetric, scale),
            Form::Neither { .. } => return None,
        };
        Some(SymmetricForm { matrix: &self.matrix, symmetric, scale })
    }
}

/// W = D^{-1/2} S D^{1/2}.
#[derive(Clone, Copy, Debug)]
pub struct SymmetricForm<'a> {
    matrix: &'a SparseMatrix,
    symmetric: &'a SparseMatrix,
    scale: &'a [f64],
}

impl<'a> SymmetricForm<'a> {
    /// Number of nodes N.
    pub fn n_nodes(&self) -> usize {
        self.scale.len()
    }

    /// W itself, shape (N, N), every diagonal entry stored.
    pub fn matrix(&self) -> &'a SparseMatrix {
        self.matrix
    }

    /// The symmetric matrix S similar to W, shape (N, N), every diagonal entry stored: same
    /// eigenvalues, and v = `scale` · u (elementwise) is an eigenvector of W when u is one of S.
    pub fn symmetric(&self) -> &'a SparseMatrix {
        self.symmetric
    }

    /// D^{-1/2}, length N: what takes eigenvectors of [`Self::symmetric`] to those of W. All ones
    /// for a symmetric W.
    pub fn scale(&self) -> &'a [f64] {
        self.scale
    }
}

/// The adjacency matrix with its weights mapped and a stored diagonal, columns ascending.
fn with_diagonal(
    adjacency: &SparseMatrix,
    off_diagonal: impl Fn(usize, usize, f64) -> f64,
    diagonal: impl Fn(usize) -> f64,
) -> SparseMatrix {
    let n_nodes = adjacency.rows();
    let n_entries = adjacency.nnz() + n_nodes;
    let mut row_starts = Vec::with_capacity(n_nodes + 1);
    let mut columns = Vec::with_capacity(n_entries);
    let mut values = Vec::with_capacity(n_entries);
    row_starts.push(0);
    for (i, row) in adjacency.outer_iterator().enumerate() {
        let node = u32::try_from(i).expect("a network's nodes fit in u32");
        let n_before = row.indices().partition_point(|&j| j < node);
        let (before, after) = row.indices().split_at(n_before);
        columns.extend(before);
        columns.push(node);
        columns.extend(after);
        let (before, after) = row.data().split_at(n_before);
        let linked = |(&j, &a): (&u32, &f64)| off_diagonal(i, j as usize, a);
        values.extend(row.indices().iter().zip(before).map(linked));
        values.push(diagonal(i));
        values.extend(row.indices()[n_before..].iter().zip(after).map(linked));
        row_starts.push(columns.len());
    }
    SparseMatrix::new((n_nodes, n_nodes), row_starts, columns, values)
}
