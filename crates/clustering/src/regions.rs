//! Regions of a network under two thresholds: which of them synchronise within, and which of those
//! with one another.
//!
//! With n_m nodes in region m and any symmetric distance δ_ij, the eigenvector distance δe or the
//! synchronisation error δx,
//!
//! ```text
//! ⟨δ⟩_m     = Σ_{i≠j∈m} δ_ij / n_m(n_m − 1),
//! ⟨δ⟩_{m,m'} = Σ_{i∈m, j∈m'} δ_ij / n_m n_m'.
//! ```
//!
//! Region m is synchronisable where ⟨δ⟩_m is below the first threshold; synchronisable regions with
//! ⟨δ⟩_{m,m'} below the second one are linked, and chains of links make the clusters (single linkage,
//! which the paper leaves open). A region of one node has no pair to disagree: its ⟨δ⟩_m is 0. Nodes
//! of other regions, and of none, belong to no cluster; the paper draws them grey.
//!
//! Source: Fan, Wang & Wang (2023), Sec. III C.

use crate::disjoint_sets::DisjointSets;
use crate::modes::check_threshold;
use crate::{ClusteringError, Partition, adjusted_rand_index};

/// Mean distances within and between regions.
#[derive(Clone, Debug, PartialEq)]
pub struct RegionDistances {
    region_of: Vec<Option<usize>>,
    n_regions: usize,
    /// ⟨δ⟩_{m,m'}, and ⟨δ⟩_m on the diagonal; shape (M, M), row by row.
    means: Vec<f64>,
}

impl RegionDistances {
    /// The means of `distance` over regions given as lists of nodes; nodes of no region count for
    /// nothing.
    ///
    /// Asks for the distance once a pair i < j: O(N²) for N nodes, memory O(N + M²) for M regions.
    ///
    /// # Errors
    /// - [`ClusteringError::EmptyRegion`], [`ClusteringError::NodeOutOfRange`] and
    ///   [`ClusteringError::NodeListedTwice`], within a region or among several.
    /// - [`ClusteringError::BadDistance`] for a distance that is negative or not finite.
    pub fn new(
        n_nodes: usize,
        regions: &[Vec<usize>],
        distance: impl Fn(usize, usize) -> f64,
    ) -> Result<Self, ClusteringError> {
        let region_of = region_of(n_nodes, regions)?;
        let mut means = sums(&region_of, regions.len(), distance)?;
        let sizes: Vec<usize> = regions.iter().map(Vec::len).collect();
        divide_by_pairs(&mut means, &sizes);
        Ok(Self { region_of, n_regions: regions.len(), means })
    }

    /// Number of regions M.
    pub fn n_regions(&self) -> usize {
        self.n_regions
    }

    /// ⟨δ⟩_m, in the unit of δ; 0 for a region of one node.
    ///
    /// # Panics
    /// If there is no such region.
    pub fn within(&self, region: usize) -> f64 {
        self.between(region, region)
    }

    /// ⟨δ⟩_{m,m'}, in the unit of δ, and ⟨δ⟩_m where both are the same.
    ///
    /// # Panics
    /// If there is no such region.
    pub fn between(&self, one: usize, other: usize) -> f64 {
        let n = self.n_regions;
        assert!(one < n && other < n, "regions {one} and {other} of {n}");
        self.means[one * n + other]
    }

    /// The synchronisable regions and their clusters.
    ///
    /// Both comparisons are strict, as in the paper: at threshold 0 nothing is below it.
    ///
    /// # Errors
    /// [`ClusteringError::BadThreshold`] when a threshold is negative or not finite.
    pub fn clusters(
        &self,
        thresholds: RegionThresholds,
    ) -> Result<RegionClusters, ClusteringError> {
        check_threshold(thresholds.within)?;
        check_threshold(thresholds.between)?;
        let kept: Vec<usize> =
            (0..self.n_regions).filter(|&m| self.within(m) < thresholds.within).collect();
        let mut sets = DisjointSets::new(kept.len());
        for (a, &one) in kept.iter().enumerate() {
            for (b, &other) in kept.iter().enumerate().skip(a + 1) {
                if self.between(one, other) < thresholds.between {
                    sets.join(a as u32, b as u32);
                }
            }
        }
        let partition = Partition::from_roots(&sets.roots());
        let mut cluster_of = vec![None; self.n_regions];
        for (&region, &cluster) in kept.iter().zip(partition.cluster_of()) {
            cluster_of[region] = Some(cluster);
        }
        let n_clusters = partition.n_clusters();
        Ok(RegionClusters { region_of: self.region_of.clone(), cluster_of, n_clusters })
    }
}

/// The two thresholds, in the unit of the distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegionThresholds {
    /// A region is synchronisable where its ⟨δ⟩_m is below this.
    pub within: f64,
    /// Synchronisable regions are linked where their ⟨δ⟩_{m,m'} is below this.
    pub between: f64,
}

/// Synchronisable regions and their clusters, numbered from 0 by their first region.
///
/// A synchronisable region linked to no other is a cluster of its own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RegionClusters {
    region_of: Vec<Option<usize>>,
    cluster_of: Vec<Option<usize>>,
    n_clusters: usize,
}

impl RegionClusters {
    /// Number of regions M, synchronisable or not.
    pub fn n_regions(&self) -> usize {
        self.cluster_of.len()
    }

    /// Number of clusters.
    pub fn n_clusters(&self) -> usize {
        self.n_clusters
    }

    /// The cluster of every region, length M; None where it is not synchronisable.
    pub fn cluster_of_region(&self) -> &[Option<usize>] {
        &self.cluster_of
    }

    /// The cluster of every node, length N; None (grey) where its region is not synchronisable or
    /// it belongs to none.
    pub fn cluster_of_node(&self) -> Vec<Option<usize>> {
        let cluster = |region: &Option<usize>| region.and_then(|m| self.cluster_of[m]);
        self.region_of.iter().map(cluster).collect()
    }

    /// Every cluster as a sorted list of regions, ordered by first region.
    pub fn clusters(&self) -> Vec<Vec<usize>> {
        let mut clusters = vec![Vec::new(); self.n_clusters];
        for (region, cluster) in self.cluster_of.iter().enumerate() {
            if let Some(cluster) = cluster {
                clusters[*cluster].push(region);
            }
        }
        clusters
    }

    /// The nodes of every cluster together, and every grey node a cluster of its own.
    pub fn node_partition(&self) -> Partition {
        let mark =
            |(node, cluster): (usize, Option<usize>)| cluster.unwrap_or(self.n_clusters + node);
        let marks: Vec<usize> = self.cluster_of_node().into_iter().enumerate().map(mark).collect();
        Partition::from_marks(&marks)
    }

    /// Agreement with another analysis of the same regions, such as that of δx with that of δe.
    ///
    /// # Panics
    /// If the numbers of regions differ.
    pub fn agreement(&self, other: &Self) -> RegionAgreement {
        let (n_regions, n_other) = (self.n_regions(), other.n_regions());
        assert_eq!(n_regions, n_other, "analyses of {n_regions} and {n_other} regions");
        let verdicts = || self.cluster_of.iter().zip(&other.cluster_of);
        let n_same_verdict = verdicts().filter(|(a, b)| a.is_some() == b.is_some()).count();
        let (one, two): (Vec<usize>, Vec<usize>) =
            verdicts().filter_map(|(a, b)| a.zip(*b)).unzip();
        let n_in_both = one.len();
        let index =
            || adjusted_rand_index(&Partition::from_marks(&one), &Partition::from_marks(&two));
        RegionAgreement {
            n_regions,
            n_same_verdict,
            n_in_both,
            adjusted_rand_index: (n_in_both > 1).then(index),
        }
    }
}

/// How far two analyses of the same regions agree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegionAgreement {
    /// Number of regions M.
    pub n_regions: usize,
    /// Regions that are synchronisable in both analyses or in neither.
    pub n_same_verdict: usize,
    /// Regions that are synchronisable in both.
    pub n_in_both: usize,
    /// [`adjusted_rand_index`] of the clusters of the regions that are synchronisable in both; None
    /// where these are fewer than two, which leaves nothing to compare.
    pub adjusted_rand_index: Option<f64>,
}

impl RegionAgreement {
    /// Fraction of regions with the same verdict, 1 where there are no regions.
    pub fn verdict_fraction(&self) -> f64 {
        if self.n_regions == 0 { 1.0 } else { self.n_same_verdict as f64 / self.n_regions as f64 }
    }
}

/// The region of every node.
fn region_of(
    n_nodes: usize,
    regions: &[Vec<usize>],
) -> Result<Vec<Option<usize>>, ClusteringError> {
    let mut region_of = vec![None; n_nodes];
    for (region, nodes) in regions.iter().enumerate() {
        if nodes.is_empty() {
            return Err(ClusteringError::EmptyRegion { region });
        }
        for &node in nodes {
            let of_node =
                region_of.get_mut(node).ok_or(ClusteringError::NodeOutOfRange { node, n_nodes })?;
            if of_node.replace(region).is_some() {
                return Err(ClusteringError::NodeListedTwice { node });
            }
        }
    }
    Ok(region_of)
}

/// Σ δ_ij over the pairs i < j of each two regions, shape (M, M), both triangles.
fn sums(
    region_of: &[Option<usize>],
    n_regions: usize,
    distance: impl Fn(usize, usize) -> f64,
) -> Result<Vec<f64>, ClusteringError> {
    let members: Vec<(usize, usize)> =
        region_of.iter().enumerate().filter_map(|(i, region)| Some((i, (*region)?))).collect();
    let mut sums = vec![0.0; n_regions * n_regions];
    for (place, &(i, one)) in members.iter().enumerate() {
        for &(j, other) in &members[place + 1..] {
            let distance = distance(i, j);
            if !(distance.is_finite() && distance >= 0.0) {
                return Err(ClusteringError::BadDistance { i, j, distance });
            }
            sums[one.min(other) * n_regions + one.max(other)] += distance;
        }
    }
    for one in 0..n_regions {
        for other in 0..one {
            sums[one * n_regions + other] = sums[other * n_regions + one];
        }
    }
    Ok(sums)
}

/// Makes means of sums over pairs; a region of one node has none, and keeps its sum of 0.
fn divide_by_pairs(sums: &mut [f64], sizes: &[usize]) {
    for (one, &n_one) in sizes.iter().enumerate() {
        for (other, &n_other) in sizes.iter().enumerate() {
            let n_pairs = if one == other { n_one * (n_one - 1) / 2 } else { n_one * n_other };
            sums[one * sizes.len() + other] /= n_pairs.max(1) as f64;
        }
    }
}
