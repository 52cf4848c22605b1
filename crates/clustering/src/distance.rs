//! The eigenvector distance δe_ij = (1/m) Σ_{k unstable} |v_k,i − v_k,j| over m transverse modes.
//!
//! Within an eigenspace of dimension d > 1 the sum depends on the basis, which is arbitrary; it is
//! replaced by its mean over all orthonormal bases. Let P be the projector on the eigenspace and
//! x = P(e_i − e_j), in a given basis the vector of components v_k,i − v_k,j. A random orthonormal
//! basis u_1 … u_d has each u_b uniform on the unit sphere of the eigenspace, hence
//!
//! ```text
//! E Σ_b |u_b · x| = d ‖x‖ E|u_1| = ‖x‖ c_d,    c_d = d Γ(d/2) / (√π Γ((d+1)/2)),
//! ```
//!
//! with E|u_1| the mean modulus of one component of a unit vector, from ∫|cos θ| sin^{d−2} θ dθ.
//! At d = 1 this is |v_i − v_j| itself, and for any d it is a pseudometric: a sum of norms of
//! differences.
//!
//! Eigenvalue 0 of a network of several components: the eigenspace also holds the vector of equal
//! components, the synchronous mode. Projecting that out leaves x as it is (it is orthogonal to
//! e_i − e_j) and lowers only d by one.
//!
//! Source: Fan, Wang & Wang (2023), Sec. II, for δe; the mean over bases is ours.

use std::ops::Range;

use spectra::{RealModes, Spectrum};

use crate::cells::Points;
use crate::exact::clusters_of_rows;
use crate::metric::{Block, Metric};
use crate::modes::{
    check_finite, check_shapes, check_synchronous_mode, check_threshold, chosen_eigenspaces,
    interleaved, transverse,
};
use crate::near_pairs::clusters_within_groups;
use crate::tolerance::{check_tolerance, exact_tolerance};
use crate::{ClusteringError, Partition};

/// δe_ij for one set of unstable modes, and the clusters it implies.
#[derive(Clone, Debug)]
pub struct EigenvectorDistance {
    n_nodes: usize,
    n_modes: usize,
    /// Components of node i in all unstable eigenspaces, row i of shape (N, width).
    rows: Vec<f64>,
    /// An eigenspace a block, of factor c_d / m.
    metric: Metric,
    exact_tolerance: f64,
}

impl EigenvectorDistance {
    /// The distance for these unstable transverse modes (from 0, in any order).
    ///
    /// Eigenspaces are unstable as a whole. With no modes all distances are zero. If the spectrum is
    /// partial and its last modes are among those given, the result is that of the basis at hand
    /// where the spectrum cuts an eigenspace. Keeps a copy of shape (N, m).
    ///
    /// # Errors
    /// [`ClusteringError::SynchronousMode`], [`ClusteringError::ModeOutOfRange`],
    /// [`ClusteringError::PartOfEigenspace`], [`ClusteringError::NotFinite`], and
    /// [`ClusteringError::NoSynchronousMode`] for a spectrum whose first eigenspace lacks the vector
    /// of equal components.
    ///
    /// # Panics
    /// If the parts of the spectrum differ in length.
    pub fn new(spectrum: &Spectrum, modes: &[usize]) -> Result<Self, ClusteringError> {
        Self::of(&spectrum.real_modes(), modes)
    }

    /// The same of a spectrum that lies mode by mode.
    pub(crate) fn of(spectrum: &RealModes<'_>, modes: &[usize]) -> Result<Self, ClusteringError> {
        check_shapes(spectrum);
        check_synchronous_mode(spectrum)?;
        let chosen = chosen_eigenspaces(spectrum, modes)?;
        check_finite(spectrum, modes)?;
        let spaces: Vec<_> = chosen.iter().map(|&s| spectrum.eigenspaces[s].clone()).collect();
        let n_modes = spaces.iter().map(|space| transverse(space).len()).sum();
        let nodes: Vec<usize> = (0..spectrum.eigenvectors[0].len()).collect();
        Ok(Self {
            n_nodes: nodes.len(),
            n_modes,
            rows: interleaved(spectrum, &spaces, &nodes),
            metric: metric(&spaces, n_modes),
            exact_tolerance: exact_tolerance(spectrum, &chosen),
        })
    }

    /// Number of nodes N.
    pub fn n_nodes(&self) -> usize {
        self.n_nodes
    }

    /// Number m of unstable transverse modes.
    pub fn n_modes(&self) -> usize {
        self.n_modes
    }

    /// δe_ij, dimensionless.
    pub fn between(&self, i: usize, j: usize) -> f64 {
        self.metric.distance_up_to(f64::INFINITY, self.row(i), self.row(j))
    }

    /// δe_ij of all pairs, shape (N, N), row by row. O(N² m / 2).
    pub fn matrix(&self) -> Vec<f64> {
        let n = self.n_nodes;
        let mut matrix = vec![0.0; n * n];
        for i in 0..n {
            for j in i + 1..n {
                let distance = self.between(i, j);
                matrix[i * n + j] = distance;
                matrix[j * n + i] = distance;
            }
        }
        matrix
    }

    /// How far apart two nodes of an exact cluster may be in the unstable subspace: a bound on what
    /// the solver's residuals can have done to ‖P(e_i − e_j)‖, P the projector on that subspace.
    ///
    /// It is √2 ‖R‖ / gap (Davis & Kahan, SIAM J. Numer. Anal. 7, 1 (1970)), R the residuals of the
    /// unstable modes and gap their distance to the other transverse eigenvalues, times 10 for
    /// matrices that are only similar to symmetric ones, and at least 1e-12. A gap below 1e-4 of
    /// the largest |λ| counts as that: where two eigenvalues are so close, the only harm is that
    /// clusters lost with the second may be lost already with the first, within 1e-4 of its
    /// critical coupling.
    pub fn exact_tolerance(&self) -> f64 {
        self.exact_tolerance
    }

    /// Clusters of nodes that no unstable mode tells apart: δe_ij = 0.
    ///
    /// δe_ij vanishes exactly when ‖P(e_i − e_j)‖ does, and the latter is what the residuals bound:
    /// single linkage of it at [`Self::exact_tolerance`].
    ///
    /// O(N log N) for few modes.
    ///
    /// # Errors
    /// [`ClusteringError::SpectrumTooRough`] when that tolerance exceeds 1e-3/√N.
    pub fn exact_clusters(&self) -> Result<Partition, ClusteringError> {
        let one_cluster = Partition::one_cluster(self.n_nodes);
        if self.n_modes == 0 {
            return Ok(one_cluster);
        }
        check_tolerance(self.exact_tolerance, self.n_nodes)?;
        let width = self.metric.width();
        Ok(clusters_of_rows(&self.rows, width, self.exact_tolerance, &one_cluster))
    }

    /// Clusters by single linkage of δe_ij ≤ `threshold`; chains link.
    ///
    /// O(N log N) for few modes; for many, or where much of the network is only just not linked, up
    /// to O(N² m).
    ///
    /// # Errors
    /// [`ClusteringError::BadThreshold`] when it is negative or not finite.
    pub fn clusters_within(&self, threshold: f64) -> Result<Partition, ClusteringError> {
        let clusters = self.clusters_with_work(threshold, &mut { usize::MAX })?;
        Ok(clusters.expect("no limit to the work"))
    }

    /// The same if it takes no more than so many components to be looked at, which are taken off
    /// `work`, otherwise None.
    pub(crate) fn clusters_with_work(
        &self,
        threshold: f64,
        work: &mut usize,
    ) -> Result<Option<Partition>, ClusteringError> {
        check_threshold(threshold)?;
        let one_cluster = Partition::one_cluster(self.n_nodes);
        if self.n_modes == 0 {
            return Ok(Some(one_cluster));
        }
        let points = Points { rows: &self.rows, metric: &self.metric };
        Ok(clusters_within_groups(points, threshold, &one_cluster, work))
    }

    fn row(&self, i: usize) -> &[f64] {
        let width = self.metric.width();
        &self.rows[i * width..][..width]
    }
}

/// c_d = d Γ(d/2) / (√π Γ((d+1)/2)): the mean of Σ_b |u_b · x| over orthonormal bases u_1 … u_d, for
/// a unit vector x in d dimensions.
///
/// From c_1 = 1, c_2 = 4/π and c_{d+2} = c_d (d+2)/(d+1), which loses no digits at large d; O(d).
///
/// # Panics
/// At d = 0.
pub fn mean_over_bases(dimension: usize) -> f64 {
    assert!(dimension > 0, "an eigenspace has at least one dimension, found {dimension}");
    let start = if dimension % 2 == 1 { 1.0 } else { 4.0 / std::f64::consts::PI };
    let first = if dimension % 2 == 1 { 1 } else { 2 };
    (first..dimension).step_by(2).fold(start, |c, d| c * (d as f64 + 2.0) / (d as f64 + 1.0))
}

fn metric(spaces: &[Range<usize>], n_modes: usize) -> Metric {
    let mut start = 0;
    let block = |space: &Range<usize>| {
        let columns = start..start + space.len();
        start = columns.end;
        Block { columns, factor: mean_over_bases(transverse(space).len()) / n_modes as f64 }
    };
    Metric { blocks: spaces.iter().map(block).collect() }
}
