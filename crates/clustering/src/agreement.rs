//! Agreement of two partitions of the same nodes: the adjusted Rand index, and the largest overlap
//! of clusters matched one to one.
//!
//! With n_ab nodes in cluster a of the one and b of the other, A = Σ_a C(n_a, 2), B = Σ_b C(n_b, 2),
//! I = Σ_ab C(n_ab, 2) and E = A·B / C(N, 2), the adjusted Rand index is (I − E) / ((A + B)/2 − E).

use crate::Partition;
use crate::assignment::{Weights, maximum_assignment};
use crate::disjoint_sets::DisjointSets;

/// The adjusted Rand index: 1 for equal partitions, 0 on average for independent ones of the same
/// cluster sizes, negative where they agree less than that.
///
/// The ratio is 0/0 only where both partitions are singletons or both are one cluster (and for
/// N < 2); they are equal then, and the index is 1. Where only one of them is such, the index is 0.
///
/// # Panics
/// If the partitions are of different numbers of nodes.
///
/// # Source
/// Hubert & Arabie, J. Classif. 2, 193 (1985), eq. (5).
pub fn adjusted_rand_index(one: &Partition, other: &Partition) -> f64 {
    let overlaps = overlaps(one, other);
    let pairs_within = |sizes: &[usize]| sizes.iter().map(|&n| pairs(n)).sum::<f64>();
    let together: f64 = overlaps.iter().map(|&(_, _, n)| pairs(n)).sum();
    let (in_one, in_other) = (pairs_within(&sizes(one)), pairs_within(&sizes(other)));
    if one == other {
        return 1.0;
    }
    let expected = in_one * in_other / pairs(one.n_nodes());
    (together - expected) / (0.5 * (in_one + in_other) - expected)
}

/// The best one-to-one matching of the clusters of two partitions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MaximumOverlap {
    /// Matched clusters (number in the first, number in the second partition) that share nodes, in
    /// the order of the first.
    pub matches: Vec<(usize, usize)>,
    /// Number of nodes whose two clusters are matched.
    pub n_agreeing: usize,
    /// Number of nodes N.
    pub n_nodes: usize,
}

impl MaximumOverlap {
    /// Fraction of nodes that agree, 1 for a network without nodes.
    pub fn fraction(&self) -> f64 {
        if self.n_nodes == 0 { 1.0 } else { self.n_agreeing as f64 / self.n_nodes as f64 }
    }
}

/// Matches clusters one to one so that as many nodes as possible lie in matched clusters.
///
/// Clusters of a single node match like any other. Clusters that no chain of overlaps connects are
/// matched apart, so that the cost, cubic in the number of clusters, is paid only where they mix.
///
/// # Panics
/// If the partitions are of different numbers of nodes.
///
/// # Source
/// The assignment problem of Kuhn, Nav. Res. Logist. Q. 2, 83 (1955).
pub fn maximum_overlap(one: &Partition, other: &Partition) -> MaximumOverlap {
    let mut matches = Vec::new();
    let mut n_agreeing = 0;
    for group in connected_groups(one, other) {
        for (a, b, n) in matched(&group) {
            matches.push((a, b));
            n_agreeing += n;
        }
    }
    matches.sort_unstable();
    MaximumOverlap { matches, n_agreeing, n_nodes: one.n_nodes() }
}

/// A cluster of the first partition, one of the second, and the number of nodes they share (> 0).
type Overlap = (usize, usize, usize);

/// Every overlap, sorted by clusters.
fn overlaps(one: &Partition, other: &Partition) -> Vec<Overlap> {
    let (n_one, n_other) = (one.n_nodes(), other.n_nodes());
    assert_eq!(n_one, n_other, "partitions of {n_one} and {n_other} nodes");
    let both = one.cluster_of().iter().zip(other.cluster_of());
    let mut cells: Vec<(usize, usize)> = both.map(|(&a, &b)| (a, b)).collect();
    cells.sort_unstable();
    cells.chunk_by(|x, y| x == y).map(|run| (run[0].0, run[0].1, run.len())).collect()
}

fn sizes(partition: &Partition) -> Vec<usize> {
    partition.clusters().iter().map(Vec::len).collect()
}

/// C(n, 2).
fn pairs(n: usize) -> f64 {
    0.5 * n as f64 * (n as f64 - 1.0)
}

/// The overlaps, grouped by the connected components of the graph of clusters they make.
fn connected_groups(one: &Partition, other: &Partition) -> Vec<Vec<Overlap>> {
    let overlaps = overlaps(one, other);
    let mut sets = DisjointSets::new(one.n_clusters() + other.n_clusters());
    for &(a, b, _) in &overlaps {
        sets.join(a as u32, (one.n_clusters() + b) as u32);
    }
    let roots = sets.roots();
    let groups: Vec<usize> = overlaps.iter().map(|o| roots[o.0] as usize).collect();
    let groups = Partition::from_marks(&groups);
    groups.clusters().into_iter().map(|g| g.into_iter().map(|o| overlaps[o]).collect()).collect()
}

/// The overlaps of one group that the best matching uses.
fn matched(group: &[Overlap]) -> Vec<Overlap> {
    let distinct = |of: fn(&Overlap) -> usize| {
        let mut clusters: Vec<usize> = group.iter().map(of).collect();
        clusters.sort_unstable();
        clusters.dedup();
        clusters
    };
    let (first, second) = (distinct(|o| o.0), distinct(|o| o.1));
    let is_wide = first.len() <= second.len();
    let (rows, columns) = if is_wide { (&first, &second) } else { (&second, &first) };
    let place = |&(a, b, _): &Overlap| {
        let (row, column) = if is_wide { (a, b) } else { (b, a) };
        let found = "every overlap is between clusters of its group";
        (rows.binary_search(&row).expect(found), columns.binary_search(&column).expect(found))
    };
    let mut values = vec![0; rows.len() * columns.len()];
    for overlap in group {
        let (row, column) = place(overlap);
        values[row * columns.len() + column] = i64::try_from(overlap.2).expect("nodes fit in i64");
    }
    let weights = Weights { n_rows: rows.len(), n_columns: columns.len(), values };
    let column_of = maximum_assignment(&weights);
    let is_matched = |overlap: &&Overlap| {
        let (row, column) = place(overlap);
        column_of[row] == column
    };
    group.iter().filter(is_matched).copied().collect()
}
