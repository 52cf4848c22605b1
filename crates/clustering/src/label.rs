//! What kind of cluster each is: exact, where no unstable mode tells its nodes apart and its nodes
//! have the same total weight to every cluster; approximate otherwise, with how far it is from both.

use crate::distance::Spread;
use crate::{EigenvectorDistance, Equitability, Partition};

/// The kind of a cluster, from the strictest on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ClusterKind {
    /// One node: nothing to synchronise.
    Single,
    /// Equal components in all unstable modes, as far as residuals can tell, and equal total weights
    /// to every cluster.
    Exact,
    /// Any other.
    Approximate,
}

impl ClusterKind {
    /// Its name in files: `single`, `exact` or `approximate`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Single => "single",
            Self::Exact => "exact",
            Self::Approximate => "approximate",
        }
    }
}

/// The kind of a cluster and the numbers behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClusterLabel {
    /// Its kind.
    pub kind: ClusterKind,
    /// Largest δe of its first node and any other; for the kind `exact` it is rounding.
    pub spread: f64,
    /// Its deviation from equitable, as [`Equitability::deviations`] has it.
    pub deviation: f64,
}

impl ClusterLabel {
    /// The label of what was labelled twice: the laxer kind and the larger numbers.
    pub(crate) fn worse(self, other: Self) -> Self {
        Self {
            kind: self.kind.max(other.kind),
            spread: self.spread.max(other.spread),
            deviation: self.deviation.max(other.deviation),
        }
    }
}

/// The label of every cluster of a partition. O(N m).
///
/// # Panics
/// If the three are not of the same nodes and clusters.
pub fn label_clusters(
    distance: &EigenvectorDistance,
    partition: &Partition,
    equitability: &Equitability,
) -> Vec<ClusterLabel> {
    let (n_clusters, n_checked) = (partition.n_clusters(), equitability.deviations.len());
    assert_eq!(n_clusters, n_checked, "{n_clusters} clusters, {n_checked} of them checked");
    let spreads = distance.spreads(partition);
    let label = |(cluster, (spread, size)): (usize, (Spread, usize))| {
        let is_exact = spread.is_rounding && equitability.holds_for(cluster);
        let kind = match (size, is_exact) {
            (1, _) => ClusterKind::Single,
            (_, true) => ClusterKind::Exact,
            (_, false) => ClusterKind::Approximate,
        };
        let deviation = equitability.deviations[cluster];
        ClusterLabel { kind, spread: spread.distance, deviation }
    };
    spreads.into_iter().zip(partition.sizes()).enumerate().map(label).collect()
}
