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

    /// [`Self::from_marks`] for marks that are nodes.
    pub(crate) fn from_roots(roots: &[u32]) -> Self {
        let mut number = vec![usize::MAX; roots.len()];
        let mut n_clusters = 0;
        let numbered = |&root: &u32| {
            let number = &mut number[root as usize];
            if *number == usize::MAX {
                *number = n_clusters;
                n_clusters += 1;
            }
            *number
        };
        let cluster_of = roots.iter().map(numbered).collect();
        Self { cluster_of, n_clusters }
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
        Self { cluster_of: vec![0; n_nodes], n_clusters: n_nodes.min(1) }
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
                let (a, b) = (i as u32, j as u32);
                if sets.root(a) != sets.root(b) && distance(i, j) <= threshold {
                    sets.join(a, b);
                }
            }
        }
        Self::from_roots(&sets.roots())
    }

    /// Every cluster cut wherever one coordinate of its nodes, in ascending order, leaves a gap wider
    /// than `window`, and then wherever the other does. O(N log N).
    pub(crate) fn cut_at_gaps(&self, coordinates: [&[f64]; 2], window: f64) -> Self {
        let [first, second] = coordinates;
        // Whole numbers in the order of the coordinates: those are faster to sort.
        let mut places: Vec<(u32, i64, u32)> = (0..)
            .zip(&self.cluster_of)
            .zip(first)
            .map(|((node, &c), &x)| (c as u32, ordered(x), node))
            .collect();
        places.sort_unstable();
        let is_near = |a: i64, b: i64| from_ordered(b) - from_ordered(a) <= window;
        let mut roots: Vec<u32> = (0..).take(places.len()).collect();
        for run in places.chunk_by_mut(|a, b| a.0 == b.0 && is_near(a.1, b.1)) {
            if run.len() == 1 {
                continue;
            }
            for place in &mut *run {
                place.1 = ordered(second[place.2 as usize]);
            }
            run.sort_unstable();
            for run in run.chunk_by(|a, b| is_near(a.1, b.1)) {
                run.iter().for_each(|place| roots[place.2 as usize] = run[0].2);
            }
        }
        Self::from_roots(&roots)
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

    /// The first node of the cluster of every node.
    pub(crate) fn roots(&self) -> Vec<u32> {
        let first = self.first_nodes();
        self.cluster_of.iter().map(|&cluster| first[cluster] as u32).collect()
    }

    /// The coarsest partition that refines both: nodes that share a cluster in each.
    ///
    /// # Panics
    /// If the partitions are of different numbers of nodes.
    pub fn intersection(&self, other: &Self) -> Self {
        let (n, n_other) = (self.n_nodes(), other.n_nodes());
        assert_eq!(n, n_other, "partitions of {n} and {n_other} nodes");
        let pairs = self.cluster_of.iter().zip(&other.cluster_of);
        let marks: Vec<usize> = pairs.map(|(a, b)| a * other.n_clusters + b).collect();
        Self::from_marks(&marks)
    }

    /// Number of nodes of every cluster.
    pub fn sizes(&self) -> Vec<usize> {
        let mut sizes = vec![0; self.n_clusters];
        self.cluster_of.iter().for_each(|&cluster| sizes[cluster] += 1);
        sizes
    }

    /// The lowest node of every cluster, ascending.
    pub fn first_nodes(&self) -> Vec<usize> {
        let mut first_nodes = Vec::with_capacity(self.n_clusters);
        for (node, &cluster) in self.cluster_of.iter().enumerate() {
            if cluster == first_nodes.len() {
                first_nodes.push(node);
            }
        }
        first_nodes
    }

    /// Every cluster as a sorted list of nodes, ordered by first node.
    pub fn clusters(&self) -> Vec<Vec<usize>> {
        self.clusters_of_at_least(1)
    }

    /// The clusters of at least two nodes, in the order of [`Self::clusters`].
    pub fn nontrivial(&self) -> Vec<Vec<usize>> {
        self.clusters_of_at_least(2)
    }

    fn clusters_of_at_least(&self, n_nodes: usize) -> Vec<Vec<usize>> {
        let members = self.members();
        let lists = members.clusters().filter(|cluster| cluster.len() >= n_nodes);
        lists.map(|cluster| cluster.iter().map(|&node| node as usize).collect()).collect()
    }

    /// All clusters in one list. O(N).
    ///
    /// # Panics
    /// If there are 2³² nodes or more.
    pub(crate) fn members(&self) -> Members {
        let end = u32::try_from(self.n_nodes()).expect("fewer than 2^32 nodes");
        let mut starts = vec![0; self.n_clusters + 1];
        self.cluster_of.iter().for_each(|&cluster| starts[cluster + 1] += 1);
        (0..self.n_clusters).for_each(|cluster| starts[cluster + 1] += starts[cluster]);
        let mut next = starts.clone();
        let mut nodes = vec![0; self.n_nodes()];
        for (node, &cluster) in (0..end).zip(&self.cluster_of) {
            nodes[next[cluster] as usize] = node;
            next[cluster] += 1;
        }
        Members { starts, nodes }
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

/// The nodes of every cluster, ascending, one cluster after the other.
pub(crate) struct Members {
    /// Where each cluster starts, and the end of the last, length clusters + 1.
    pub(crate) starts: Vec<u32>,
    pub(crate) nodes: Vec<u32>,
}

impl Members {
    pub(crate) fn clusters(&self) -> impl Iterator<Item = &[u32]> {
        self.starts.windows(2).map(|ends| &self.nodes[ends[0] as usize..ends[1] as usize])
    }
}
/// A whole number in whose order numbers have that of [`f64::total_cmp`].
fn ordered(x: f64) -> i64 {
    let bits = x.to_bits() as i64;
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}

/// The inverse of [`ordered`].
fn from_ordered(key: i64) -> f64 {
    f64::from_bits((key ^ (((key >> 63) as u64) >> 1) as i64) as u64)
}
