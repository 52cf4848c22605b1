//! What kind of cluster each is: exact, where no unstable mode tells its nodes apart and the coarsest
//! equitable refinement of the state does not split it; approximate otherwise, with how far it is from
//! both and how many exact clusters it holds.

use spectra::{RealModes, Spectrum};
use sprs::CsMatViewI;

use crate::spread::{Spread, largest_distance, spreads};
use crate::tolerance::exact_tolerance;
use crate::{ClusterRule, ClusteringError, Equitability, Partition, State, equitable};

/// Up to this many nodes of a cluster all pairs are held against a threshold.
const ALL_PAIRS: usize = 300;

/// The kind of a cluster, from the strictest on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ClusterKind {
    /// One node: nothing to synchronise.
    Single,
    /// Equal components in all unstable modes, as far as residuals can tell, and one cell of an
    /// equitable partition in which all nodes of a cell have them.
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
    /// Largest δe of its first node and any other, and, under a threshold, of the node farthest from
    /// that and any other, and of all pairs of up to 300 nodes where these do not decide whether the
    /// threshold is exceeded; for the kind `exact` it is rounding. No pair is further apart than twice
    /// that.
    pub spread: f64,
    /// Whether some pair exceeds the threshold: its nodes are linked through others only. None where
    /// that is not known, in a cluster of more nodes.
    pub exceeds_threshold: Option<bool>,
    /// Its deviation from equitable, as [`Equitability::deviations`] has it.
    pub deviation: f64,
    /// How many exact clusters of two nodes or more an approximate one holds: the cells it falls into.
    pub n_exact_parts: usize,
}

impl ClusterLabel {
    /// The label of what was labelled twice: the laxer kind and the larger numbers, with the exact
    /// parts that remain.
    pub(crate) fn worse(self, other: Self) -> Self {
        let kind = self.kind.max(other.kind);
        let parts = [self, other].into_iter().filter(|label| label.kind == kind);
        Self {
            kind,
            spread: self.spread.max(other.spread),
            exceeds_threshold: match (self.exceeds_threshold, other.exceeds_threshold) {
                (Some(true), _) | (_, Some(true)) => Some(true),
                (Some(false), Some(false)) => Some(false),
                _ => None,
            },
            deviation: self.deviation.max(other.deviation),
            n_exact_parts: parts.map(|label| label.n_exact_parts).min().unwrap_or(0),
        }
    }
}

/// The labels of all clusters of one predicted state.
#[derive(Clone, Debug, PartialEq)]
pub struct StateLabels {
    /// How far apart nodes of an exact cluster may be in the unstable subspace, as
    /// [`crate::EigenvectorDistance::exact_tolerance`] has it.
    pub exact_tolerance: f64,
    /// Whether the clusters have equal total weights to one another.
    pub equitability: Equitability,
    /// The label of every cluster.
    pub labels: Vec<ClusterLabel>,
}

impl StateLabels {
    /// Of a state whose cells are those of [`crate::hold_against_links`]; `matrix` is the coupling
    /// matrix and `tolerance` as in [`equitable`].
    ///
    /// - `stretches`: the states that were merged into it, or the state alone.
    ///
    /// O(n m + links) for n nodes in clusters where each stretch has the modes of the one before, and
    /// O(n² m) for clusters of n ≤ 300 nodes of which the largest δe of one node leaves open whether
    /// some pair exceeds the threshold.
    ///
    /// # Errors
    /// Those of [`crate::EigenvectorDistance::new`] and [`equitable`].
    ///
    /// # Panics
    /// If the three are not of the same nodes.
    pub fn of(
        state: &State,
        stretches: &[State],
        spectrum: &Spectrum,
        matrix: CsMatViewI<'_, f64, u32, usize>,
        rule: ClusterRule,
        tolerance: f64,
    ) -> Result<Self, ClusteringError> {
        let spectrum = &spectrum.real_modes();
        let partition = &state.clusters;
        let equitability = equitable(matrix, partition, tolerance)?;
        let sets: Vec<&[usize]> = stretches.iter().map(|s| &s.unstable_modes[..]).collect();
        let mut spreads = spreads(spectrum, partition, &partition.first_nodes(), &sets)?;
        let mut exceeds = vec![Some(false); spreads.len()];
        if let ClusterRule::Threshold(threshold) = rule {
            let bounds: Vec<f64> = spreads.iter().map(|spread| 2.0 * spread.distance).collect();
            spreads = widest(spreads, spectrum, partition, &sets)?;
            for (cluster, nodes) in partition.clusters().iter().enumerate() {
                let spread = &mut spreads[cluster].distance;
                let is_open = *spread <= threshold && threshold < bounds[cluster];
                let is_small = nodes.len() <= ALL_PAIRS;
                if is_open && is_small {
                    *spread = spread.max(largest_distance(spectrum, nodes, &sets)?);
                }
                let is_known = *spread > threshold || !is_open || is_small;
                exceeds[cluster] = is_known.then_some(*spread > threshold);
            }
        }
        let parts = parts(state);
        let label = |((cluster, spread), size): ((usize, Spread), usize)| {
            let Parts { n_cells, n_shared } = parts[cluster];
            let kind = match size {
                1 => ClusterKind::Single,
                _ if n_cells == 1 && spread.is_rounding => ClusterKind::Exact,
                _ => ClusterKind::Approximate,
            };
            ClusterLabel {
                kind,
                spread: spread.distance,
                exceeds_threshold: exceeds[cluster],
                deviation: equitability.deviations[cluster],
                n_exact_parts: if n_cells > 1 { n_shared } else { 0 },
            }
        };
        let spreads = spreads.into_iter().enumerate();
        let labels = spreads.zip(partition.sizes()).map(label).collect();
        let exact_tolerance = largest_tolerance(spectrum, &sets)?;
        Ok(Self { exact_tolerance, equitability, labels })
    }

    /// Number of clusters of one kind.
    pub fn count(&self, kind: ClusterKind) -> usize {
        self.labels.iter().filter(|label| label.kind == kind).count()
    }
}

impl State {
    /// The exact clusters of two nodes or more that a cluster holds but does not equal, by first node.
    ///
    /// # Panics
    /// If there is no such node.
    pub fn exact_parts(&self, cluster: &[usize]) -> Vec<Vec<usize>> {
        let cell_of = self.cells.cluster_of();
        let marks: Vec<usize> = cluster.iter().map(|&node| cell_of[node]).collect();
        let parts = Partition::from_marks(&marks);
        if parts.n_clusters() == 1 {
            return Vec::new();
        }
        let named = |part: Vec<usize>| part.into_iter().map(|place| cluster[place]).collect();
        parts.nontrivial().into_iter().map(named).collect()
    }
}

/// Spreads from the node that is farthest from the first, where these are larger.
fn widest(
    spreads: Vec<Spread>,
    spectrum: &RealModes<'_>,
    partition: &Partition,
    sets: &[&[usize]],
) -> Result<Vec<Spread>, ClusteringError> {
    let from: Vec<usize> = spreads.iter().map(|spread| spread.farthest).collect();
    let from_there = self::spreads(spectrum, partition, &from, sets)?;
    let wider = |(one, other): (Spread, Spread)| Spread {
        distance: one.distance.max(other.distance),
        ..one
    };
    Ok(spreads.into_iter().zip(from_there).map(wider).collect())
}

/// What a cluster falls into.
#[derive(Clone, Copy, Default)]
struct Parts {
    n_cells: usize,
    /// Of two nodes or more.
    n_shared: usize,
}

/// The cells of every cluster.
fn parts(state: &State) -> Vec<Parts> {
    let mut parts = vec![Parts::default(); state.clusters.n_clusters()];
    for (first, size) in state.cells.first_nodes().into_iter().zip(state.cells.sizes()) {
        let parts = &mut parts[state.clusters.cluster_of()[first]];
        parts.n_cells += 1;
        parts.n_shared += usize::from(size > 1);
    }
    parts
}

/// The largest tolerance of any of these sets of modes.
fn largest_tolerance(spectrum: &RealModes<'_>, sets: &[&[usize]]) -> Result<f64, ClusteringError> {
    let mut largest = 0.0f64;
    for modes in sets {
        let chosen = crate::modes::chosen_eigenspaces(spectrum, modes)?;
        largest = largest.max(exact_tolerance(spectrum, &chosen));
    }
    Ok(largest)
}
