//! Equitable partitions: every node of a cluster has the same total weight to every cluster,
//! Σ_{j∈C'} w_ij equal for all i ∈ C and each pair (C, C'), its own cluster C' = C included.
//!
//! **What it proves.** Exactly then the states in which every cluster is synchronised stay so under
//! ẋ_i = F(x_i) + ε Σ_j w_ij H(x_j), whatever F, H and ε: nodes of one cluster that start equal see
//! equal sums and remain equal. Two nodes whose components merely agree in the modes looked at, such
//! as nodes far from where all of them are localised, fail it: their equality is no cluster's.
//!
//! **What it does not prove.** Nothing about stability: clusters that stay together when they start
//! together may drift apart after the smallest kick. That is what the unstable modes say. And a
//! partition that is not equitable may still synchronise nearly; the deviation says how unequal the
//! sums are.
//!
//! Where rows of the matrix sum to zero, as those of W do, equal sums to all other clusters imply
//! equal sums to the own one, so that weights within a cluster are free: the partition is called
//! externally equitable.
//!
//! Sources: Stewart, Golubitsky & Pivato, SIAM J. Appl. Dyn. Syst. 2, 609 (2003), for the
//! equivalence; Schaub et al., Chaos 26, 094821 (2016), for its use with Laplacians.

use sprs::CsMatViewI;

use crate::modes::check_threshold;
use crate::{ClusteringError, Partition};

/// How far a partition is from equitable.
#[derive(Clone, Debug, PartialEq)]
pub struct Equitability {
    /// Largest deviation that counts as rounding.
    pub tolerance: f64,
    /// The deviation of every cluster, dimensionless: the largest difference, over two of its nodes
    /// and one cluster, of their total weights to that cluster, divided by the largest Σ_j |w_ij| of
    /// its nodes. Between 0 and 2, and 0 for a cluster of one node.
    pub deviations: Vec<f64>,
}

impl Equitability {
    /// Whether the partition is equitable within the tolerance.
    pub fn holds(&self) -> bool {
        (0..self.deviations.len()).all(|cluster| self.holds_for(cluster))
    }

    /// Whether the nodes of one cluster have the same total weight to every cluster.
    ///
    /// # Panics
    /// If there is no such cluster.
    pub fn holds_for(&self, cluster: usize) -> bool {
        self.deviations[cluster] <= self.tolerance
    }

    /// The largest deviation of a cluster; 0 without clusters.
    pub fn largest_deviation(&self) -> f64 {
        self.deviations.iter().copied().fold(0.0, f64::max)
    }
}

/// Whether a partition is equitable for a matrix: w_ij is what node i receives from node j.
///
/// Sums round: a tolerance of 1e-9 tells rounding from structure unless weights of a node differ by
/// nine orders of magnitude. O(N + links).
///
/// # Errors
/// [`ClusteringError::BadThreshold`] for a tolerance that is negative or not finite, and
/// [`ClusteringError::WeightNotFinite`].
///
/// # Panics
/// If the matrix is not N × N.
pub fn equitable(
    matrix: CsMatViewI<'_, f64, u32, usize>,
    partition: &Partition,
    tolerance: f64,
) -> Result<Equitability, ClusteringError> {
    check_threshold(tolerance)?;
    let n = partition.n_nodes();
    assert!(matrix.shape() == (n, n), "a matrix of shape {:?} for {n} nodes", matrix.shape());
    let by_rows = (!matrix.is_csr()).then(|| matrix.to_csr());
    let matrix = by_rows.as_ref().map_or(matrix, |by_rows| by_rows.view());
    check_weights(matrix)?;
    let mut sums = SumsToClusters::new(partition.n_clusters());
    let members = partition.members();
    let deviation = |cluster: &[u32]| sums.deviation(matrix, partition, cluster);
    let deviations = members.clusters().map(deviation).collect();
    Ok(Equitability { tolerance, deviations })
}

/// Weights are numbers.
pub(crate) fn check_weights(
    matrix: CsMatViewI<'_, f64, u32, usize>,
) -> Result<(), ClusteringError> {
    let mut weights = matrix.iter();
    match weights.find(|(weight, _)| !weight.is_finite()) {
        Some((&weight, (row, column))) => Err(ClusteringError::WeightNotFinite {
            row: row as usize,
            column: column as usize,
            weight,
        }),
        None => Ok(()),
    }
}

/// Total weights of nodes to clusters, for one cluster of nodes at a time. All lists but the last
/// have a place for every cluster, which stays as it is where no node has a link.
struct SumsToClusters {
    /// Σ w_ij of the node at hand.
    sum: Vec<f64>,
    is_summed: Vec<bool>,
    /// The least and the largest sum of the nodes so far that have a link.
    range: Vec<(f64, f64)>,
    /// How many nodes have a link.
    n_linked: Vec<usize>,
    /// The clusters to which some node has a link.
    linked: Vec<u32>,
    /// Those to which the node at hand has one.
    reached: Vec<usize>,
}

impl SumsToClusters {
    fn new(n_clusters: usize) -> Self {
        Self {
            sum: vec![0.0; n_clusters],
            is_summed: vec![false; n_clusters],
            range: vec![(0.0, 0.0); n_clusters],
            n_linked: vec![0; n_clusters],
            linked: Vec::new(),
            reached: Vec::new(),
        }
    }

    /// The deviation of these nodes, which are a cluster.
    fn deviation(
        &mut self,
        matrix: CsMatViewI<'_, f64, u32, usize>,
        partition: &Partition,
        nodes: &[u32],
    ) -> f64 {
        if nodes.len() < 2 {
            return 0.0;
        }
        let mut strongest = 0.0f64;
        for &node in nodes {
            strongest = strongest.max(self.add(matrix, partition, node as usize));
        }
        let largest = self.largest_difference(nodes.len());
        if strongest > 0.0 { largest / strongest } else { 0.0 }
    }

    /// Adds the sums of one node; its Σ_j |w_ij|.
    fn add(
        &mut self,
        matrix: CsMatViewI<'_, f64, u32, usize>,
        partition: &Partition,
        node: usize,
    ) -> f64 {
        let mut strength = 0.0;
        let row = matrix.outer_view(node).expect("one row a node");
        for (neighbour, &weight) in row.iter() {
            let cluster = partition.cluster_of()[neighbour];
            if !std::mem::replace(&mut self.is_summed[cluster], true) {
                self.reached.push(cluster);
            }
            self.sum[cluster] += weight;
            strength += weight.abs();
        }
        while let Some(cluster) = self.reached.pop() {
            let sum = std::mem::take(&mut self.sum[cluster]);
            self.is_summed[cluster] = false;
            self.widen(cluster, sum);
        }
        strength
    }

    fn widen(&mut self, cluster: usize, sum: f64) {
        let (low, high) = &mut self.range[cluster];
        if self.n_linked[cluster] == 0 {
            (*low, *high) = (sum, sum);
            self.linked.push(cluster as u32);
        }
        (*low, *high) = (low.min(sum), high.max(sum));
        self.n_linked[cluster] += 1;
    }

    /// The largest difference of two nodes' sums; forgets the nodes.
    fn largest_difference(&mut self, n_nodes: usize) -> f64 {
        let mut largest = 0.0f64;
        for cluster in std::mem::take(&mut self.linked) {
            let cluster = cluster as usize;
            let (low, high) = self.range[cluster];
            // A node without a link has the sum 0.
            let has_zero = std::mem::take(&mut self.n_linked[cluster]) < n_nodes;
            let (low, high) = if has_zero { (low.min(0.0), high.max(0.0)) } else { (low, high) };
            largest = largest.max(high - low);
        }
        largest
    }
}
