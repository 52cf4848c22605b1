//! Exact clusters: nodes whose rows of components agree in the unstable subspace up to a tolerance.
//!
//! Equality up to a tolerance is single linkage of ‖P(e_i − e_j)‖₂, which does not depend on the
//! bases of eigenspaces and knows no boundaries of rounding. Sorting along two coordinates tells most
//! rows apart; only rows without a gap between them there are compared.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use spectra::RealModes;

use crate::cells::Points;
use crate::metric::Metric;
use crate::modes::{chosen_eigenspaces, interleaved};
use crate::near_pairs::clusters_within_groups;
use crate::tolerance::{check_tolerance, exact_tolerance};
use crate::{ClusteringError, Partition};

/// Those of these rows of `width` components, within the groups of a partition. O(N log N) for few
/// modes.
pub(crate) fn clusters_of_rows(
    rows: &[f64],
    width: usize,
    tolerance: f64,
    groups: &Partition,
) -> Partition {
    if width == 0 {
        return groups.clone();
    }
    let ([first, second], window) = coordinates(rows, width, tolerance);
    let runs = groups.cut_at_gaps([&first, &second], window);
    let points = Points { rows, metric: &Metric::euclidean(width) };
    clusters_within_groups(points, tolerance, &runs, &mut { usize::MAX })
        .expect("no limit to the work")
}

/// Exact clusters of one set of unstable modes after the other.
///
/// Further unstable modes only split clusters: those of a set that holds the set before are looked for
/// within the clusters before, and by the new modes alone. Clusters whose nodes are all within the
/// tolerance of the first are whole; only the others are linked row by row.
pub(crate) struct ExactClusters<'a> {
    spectrum: &'a RealModes<'a>,
    modes: Vec<usize>,
    clusters: Arc<Partition>,
    /// The nodes of clusters of two nodes or more but for the first of each.
    followers: Vec<Follower>,
}

/// A node and the first one of its cluster.
struct Follower {
    node: usize,
    first: usize,
    /// ‖P(e_i − e_j)‖² of the two, P on the unstable subspace.
    square: f64,
}

impl<'a> ExactClusters<'a> {
    /// Before any mode is unstable.
    pub(crate) fn new(spectrum: &'a RealModes<'a>) -> Self {
        let clusters = Arc::new(Partition::one_cluster(spectrum.eigenvectors[0].len()));
        let followers =
            followers(&clusters).map(|(node, first)| Follower { node, first, square: 0.0 });
        Self { followers: followers.collect(), spectrum, modes: Vec::new(), clusters }
    }

    /// Those of these unstable modes, which ascend.
    ///
    /// # Errors
    /// Those of [`crate::EigenvectorDistance::new`] but for components, which are not checked, and
    /// [`ClusteringError::SpectrumTooRough`].
    pub(crate) fn of(&mut self, modes: &[usize]) -> Result<Arc<Partition>, ClusteringError> {
        if !are_among(&self.modes, modes) {
            *self = Self::new(self.spectrum);
        }
        if !self.followers.is_empty() && modes.len() > self.modes.len() {
            let chosen = chosen_eigenspaces(self.spectrum, modes)?;
            let tolerance = exact_tolerance(self.spectrum, &chosen);
            check_tolerance(tolerance, self.clusters.n_nodes())?;
            let new = chosen_eigenspaces(self.spectrum, &without(modes, &self.modes))?;
            self.add(&new);
            self.split(&chosen, tolerance);
        }
        self.modes = modes.to_vec();
        Ok(Arc::clone(&self.clusters))
    }

    /// Adds the parts of some eigenspaces to the distances from first nodes.
    fn add(&mut self, spaces: &[usize]) {
        let modes = spaces.iter().flat_map(|&space| self.spectrum.eigenspaces[space].clone());
        for vector in modes.map(|mode| &self.spectrum.eigenvectors[mode]) {
            for Follower { node, first, square } in &mut self.followers {
                let difference = vector[*node] - vector[*first];
                *square += difference * difference;
            }
        }
    }

    /// Splits the clusters that hold a node beyond the tolerance from the first.
    fn split(&mut self, chosen: &[usize], tolerance: f64) {
        let cluster_of = self.clusters.cluster_of();
        let mut is_doubtful = vec![false; self.clusters.n_clusters()];
        for Follower { node, square, .. } in &self.followers {
            is_doubtful[cluster_of[*node]] |= square.sqrt() > SURELY * tolerance;
        }
        if !is_doubtful.contains(&true) {
            return;
        }
        let is_looked_at = |node: &usize| is_doubtful[cluster_of[*node]];
        let nodes: Vec<usize> = (0..cluster_of.len()).filter(is_looked_at).collect();
        let groups: Vec<usize> = nodes.iter().map(|&node| cluster_of[node]).collect();
        let spaces: Vec<Range<usize>> =
            chosen.iter().map(|&space| self.spectrum.eigenspaces[space].clone()).collect();
        let width = spaces.iter().map(ExactSizeIterator::len).sum();
        let rows = interleaved(self.spectrum, &spaces, &nodes);
        let found = clusters_of_rows(&rows, width, tolerance, &Partition::from_marks(&groups));
        let first = found.first_nodes();
        let mut roots = self.clusters.roots();
        for (&node, &cluster) in nodes.iter().zip(found.cluster_of()) {
            roots[node] = nodes[first[cluster]] as u32;
        }
        let row = |node: usize| {
            let place = nodes.binary_search(&node).expect("a node of a cluster that is looked at");
            &rows[place * width..][..width]
        };
        let clusters = Partition::from_roots(&roots);
        let known: HashMap<usize, f64> = self
            .followers
            .iter()
            .filter(|follower| !is_looked_at(&follower.node))
            .map(|follower| (follower.node, follower.square))
            .collect();
        let square = |(node, first): (usize, usize)| Follower {
            node,
            first,
            square: known.get(&node).copied().unwrap_or_else(|| square(row(node), row(first))),
        };
        self.followers = followers(&clusters).map(square).collect();
        self.clusters = Arc::new(clusters);
    }
}

/// Nodes nearer than this share of the tolerance are so whatever the order of the sum.
const SURELY: f64 = 1.0 - 1e-9;

fn square(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

/// Every node but the first of its cluster, with that.
fn followers(clusters: &Partition) -> impl Iterator<Item = (usize, usize)> {
    let first = clusters.first_nodes();
    let pairs = clusters.cluster_of().iter().enumerate();
    pairs.map(move |(node, &cluster)| (node, first[cluster])).filter(|(node, first)| node != first)
}

/// Whether all modes of the first set are in the second; both ascend.
pub(crate) fn are_among(some: &[usize], all: &[usize]) -> bool {
    some.iter().all(|mode| all.binary_search(mode).is_ok())
}

/// The modes of a set that are not among others; both ascend.
fn without(modes: &[usize], others: &[usize]) -> Vec<usize> {
    modes.iter().copied().filter(|mode| others.binary_search(mode).is_err()).collect()
}

/// Two coordinates of every row, and how much they may differ between rows within the tolerance.
///
/// They are the components along (1, 1, 1, …)/√width and (1, −1, 1, …)/√width, which never exceed the
/// norm but for the rounding of their sums. Among many rows the first alone has neighbours by chance.
pub(crate) fn coordinates(rows: &[f64], width: usize, tolerance: f64) -> ([Vec<f64>; 2], f64) {
    let n = width as f64;
    let (mut first, mut second) = (Vec::new(), Vec::new());
    let mut largest = tolerance;
    for row in rows.chunks_exact(width) {
        let sum_from = |start: usize| row.iter().skip(start).step_by(2).sum::<f64>();
        let (even, odd) = (sum_from(0), sum_from(1));
        first.push((even + odd) / n.sqrt());
        second.push((even - odd) / n.sqrt());
        largest = largest.max(row.iter().map(|x| x.abs()).sum());
    }
    ([first, second], tolerance + 4.0 * (n + 1.0) * f64::EPSILON * largest)
}
