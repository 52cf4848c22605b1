//! Partitions of the nodes into clusters, and single linkage: i and j share a cluster when a chain
//! of nodes, each within the threshold of the next, leads from one to the other.
//!
//! Single linkage links chains: two nodes of one cluster may be much further apart than the
//! threshold. It is the one rule whose clusters are those of an equivalence closure, so that it
//! reduces to exact equality at threshold 0 and only ever merges clusters as the threshold grows
//! (Gower & Ross, Appl. Stat. 18, 54 (1969)).

use std::collections::HashMap;

use crate::ClusteringError;
use crate::disjoint_sets::DisjointSets;

/// A partition of nodes 0 … N−1 into clusters numbered by their first node.
///
/// The numbering makes equal partitions equal values.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Partition {
    cluster_of: Vec<usize>,
    n_clusters: usize,
}

impl Partition {
    /// The partition in which nodes of equal marks share a cluster; one mark a node.
    pub fn from_marks(marks: &[usize]) -> Self {
        let mut number = HashMap::new();
        let cluster_of = marks
            .iter()
            .map(|&mark| {
                let next = number.len();
                *number.entry(mark).or_insert(next)
            })
            .collect();
        Self { cluster_of, n_clusters: number.len() }
    }

    /// The partition with these clusters; every node in none of them is a cluster of its own.
    ///
    /// # Errors
    /// [`ClusteringError::NodeOutOfRange`] and [`ClusteringError::NodeListedTwice`].
    pub fn from_clusters(n_nodes: usize, clusters: &[Vec<usize>]) -> Result<Self, ClusteringError> {
        let mut marks: Vec<usize> = (0..n_nodes).collect();
        for (number, cluster) in clusters.iter().enumerate() {
            for &node in cluster {
                let mark =
                    marks.get_mut(node).ok_or(ClusteringError::NodeOutOfRange { node, n_nodes })?;
                if *mark >= n_nodes {
                    return Err(ClusteringError::NodeListedTwice { node });
                }
                *mark = n_nodes + number;
            }
        }
        Ok(Self::from_marks(&marks))
    }

    /// All nodes in one cluster.
    pub fn one_cluster(n_nodes: usize) -> Self {
        Self::from_marks(&vec![0; n_nodes])
    }

    /// Every node a cluster of its own.
    pub fn singletons(n_nodes: usize) -> Self {
        Self { cluster_of: (0..n_nodes).collect(), n_clusters: n_nodes }
    }

    /// Single linkage: chains of nodes with `distance(i, j) ≤ threshold` form the clusters.
    ///
    /// Asks for the distance of a pair i < j at most once, and not where i and j are already
    /// linked; O(N²) questions. A distance that is not a number links nothing.
    pub fn single_linkage(
        n_nodes: usize,
        distance: impl Fn(usize, usize) -> f64,
        threshold: f64,
    ) -> Self {
        let mut sets = DisjointSets::new(n_nodes);
        for i in 0..n_nodes {
            for j in i + 1..n_nodes {
                if !sets.are_joined(i, j) && distance(i, j) <= threshold {
                    sets.join(i, j);
                }
            }
        }
        Self::from_marks(&sets.roots())
    }

    /// Single linkage that only looks at pairs whose coordinates differ by at most `window`.
    ///
    /// Equal to the full one if every linked pair is such a pair. O(N log N + pairs in the window).
    pub(crate) fn single_linkage_along(
        coordinate: &[f64],
        window: f64,
        is_linked: impl Fn(usize, usize) -> bool,
    ) -> Self {
        let order = ascending(coordinate);
        let mut sets = DisjointSets::new(coordinate.len());
        for (place, &i) in order.iter().enumerate() {
            let in_window = |&&j: &&usize| coordinate[j] - coordinate[i] <= window;
            for &j in order[place + 1..].iter().take_while(in_window) {
                if !sets.are_joined(i, j) && is_linked(i, j) {
                    sets.join(i, j);
                }
            }
        }
        Self::from_marks(&sets.roots())
    }

    /// How many pairs [`Self::single_linkage_along`] looks at, O(N log N).
    pub(crate) fn pairs_along(coordinate: &[f64], window: f64) -> usize {
        let order = ascending(coordinate);
        let mut end = 0;
        let mut pairs = 0;
        for (place, &i) in order.iter().enumerate() {
            end = end.max(place + 1);
            while end < order.len() && coordinate[order[end]] - coordinate[i] <= window {
                end += 1;
            }
            pairs += end - place - 1;
        }
        pairs
    }

    /// Number of nodes N.
    pub fn n_nodes(&self) -> usize {
        self.cluster_of.len()
    }

    /// Number of clusters, those of a single node included.
    pub fn n_clusters(&self) -> usize {
        self.n_clusters
    }

    /// The cluster of every node, length N, values below [`Self::n_clusters`].
    pub fn cluster_of(&self) -> &[usize] {
        &self.cluster_of
    }

    /// Every cluster as a sorted list of nodes, ordered by first node.
    pub fn clusters(&self) -> Vec<Vec<usize>> {
        let mut clusters = vec![Vec::new(); self.n_clusters];
        for (node, &cluster) in self.cluster_of.iter().enumerate() {
            clusters[cluster].push(node);
        }
        clusters
    }

    /// The clusters of at least two nodes, in the order of [`Self::clusters`].
    pub fn nontrivial(&self) -> Vec<Vec<usize>> {
        self.clusters().into_iter().filter(|cluster| cluster.len() > 1).collect()
    }

    /// Whether every cluster lies within one cluster of `coarse`. A partition refines itself.
    ///
    /// # Panics
    /// If the partitions are of different numbers of nodes.
    pub fn is_refinement_of(&self, coarse: &Self) -> bool {
        let (n_fine, n_coarse) = (self.n_nodes(), coarse.n_nodes());
        assert_eq!(n_fine, n_coarse, "partitions of {n_fine} and {n_coarse} nodes");
        let mut whole = vec![None; self.n_clusters];
        self.cluster_of
            .iter()
            .zip(&coarse.cluster_of)
            .all(|(&fine, &coarse)| *whole[fine].get_or_insert(coarse) == coarse)
    }
}

/// The nodes in the order of their coordinates.
fn ascending(coordinate: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..coordinate.len()).collect();
    order.sort_unstable_by(|&i, &j| coordinate[i].total_cmp(&coordinate[j]));
    order
}
