//! How far apart the nodes of each cluster are: δe, and the distance in the unstable subspace, in every
//! set of unstable modes that the cluster outlasts.
//!
//! One node of each cluster is held against all others of it, mode by mode, so that nodes on their own
//! cost nothing and a set of modes that holds the one before costs no more than the modes it adds.
//! Distances are pseudometrics: no two nodes are further apart than twice the largest distance from
//! one of them.

use spectra::RealModes;

use crate::exact::are_among;
use crate::modes::{chosen_eigenspaces, transverse};
use crate::tolerance::{check_tolerance, exact_tolerance};
use crate::{ClusteringError, Partition, mean_over_bases};

/// How far the nodes of a cluster are from one of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spread {
    /// Largest δe under any of the sets.
    pub(crate) distance: f64,
    /// The node that is so far away.
    pub(crate) farthest: usize,
    /// Whether under every set all are within [`crate::EigenvectorDistance::exact_tolerance`] in the
    /// unstable subspace, and that is small enough to tell.
    pub(crate) is_rounding: bool,
}

/// The spreads of all clusters under sets of unstable modes, which ascend.
///
/// - `from`: one node of each cluster, the one that distances are from.
///
/// # Errors
/// Those of [`crate::EigenvectorDistance::new`] for each of the sets.
pub(crate) fn spreads(
    spectrum: &RealModes<'_>,
    partition: &Partition,
    from: &[usize],
    sets: &[&[usize]],
) -> Result<Vec<Spread>, ClusteringError> {
    let mut spreads: Vec<Spread> = from
        .iter()
        .map(|&farthest| Spread { distance: 0.0, farthest, is_rounding: true })
        .collect();
    let pairs = partition.cluster_of().iter().enumerate();
    let mut pairs: Vec<Pair> = pairs
        .filter(|&(node, &cluster)| node != from[cluster])
        .map(|(node, &cluster)| Pair { cluster, node, from: from[cluster], sum: 0.0, square: 0.0 })
        .collect();
    over_sets(spectrum, sets, partition.n_nodes(), &mut pairs, |pair, distance, is_rounding| {
        let spread = &mut spreads[pair.cluster];
        spread.is_rounding &= is_rounding;
        if distance > spread.distance {
            (spread.distance, spread.farthest) = (distance, pair.node);
        }
    })?;
    Ok(spreads)
}

/// The largest δe of any two of these nodes under any of the sets. O(n² m) for n nodes.
///
/// # Errors
/// Those of [`spreads`].
pub(crate) fn largest_distance(
    spectrum: &RealModes<'_>,
    nodes: &[usize],
    sets: &[&[usize]],
) -> Result<f64, ClusteringError> {
    let to = |(place, &from): (usize, &usize)| {
        let pair = move |&node: &usize| Pair { cluster: 0, node, from, sum: 0.0, square: 0.0 };
        nodes[place + 1..].iter().map(pair)
    };
    let mut pairs: Vec<Pair> = nodes.iter().enumerate().flat_map(to).collect();
    let mut largest = 0.0f64;
    let n_nodes = spectrum.eigenvectors[0].len();
    over_sets(spectrum, sets, n_nodes, &mut pairs, |_, distance, _| {
        largest = largest.max(distance);
    })?;
    Ok(largest)
}

/// Shows every pair under every set, with its δe and whether that is rounding.
fn over_sets(
    spectrum: &RealModes<'_>,
    sets: &[&[usize]],
    n_nodes: usize,
    pairs: &mut [Pair],
    mut show: impl FnMut(&Pair, f64, bool),
) -> Result<(), ClusteringError> {
    let mut before: &[usize] = &[];
    for &modes in sets {
        if !are_among(before, modes) {
            pairs.iter_mut().for_each(|pair| (pair.sum, pair.square) = (0.0, 0.0));
            before = &[];
        }
        let chosen = chosen_eigenspaces(spectrum, modes)?;
        let tolerance = exact_tolerance(spectrum, &chosen);
        let is_known = check_tolerance(tolerance, n_nodes).is_ok();
        for &space in &chosen {
            if before.binary_search(&transverse(&spectrum.eigenspaces[space]).start).is_err() {
                add(spectrum, space, pairs);
            }
        }
        let n_modes = modes.len().max(1) as f64;
        for pair in pairs.iter() {
            show(pair, pair.sum / n_modes, is_known && pair.square.sqrt() <= tolerance);
        }
        before = modes;
    }
    Ok(())
}

/// A node and the one of its cluster that distances are from.
struct Pair {
    cluster: usize,
    node: usize,
    from: usize,
    /// m δe.
    sum: f64,
    /// ‖P(e_i − e_j)‖².
    square: f64,
}

/// Adds the part of one eigenspace to all pairs.
fn add(spectrum: &RealModes<'_>, space: usize, pairs: &mut [Pair]) {
    let modes = spectrum.eigenspaces[space].clone();
    let factor = mean_over_bases(transverse(&modes).len());
    let vectors = &spectrum.eigenvectors[modes];
    for pair in pairs {
        let difference = |v: &&[f64]| v[pair.node] - v[pair.from];
        let norm = match vectors {
            [v] => difference(v).abs(),
            _ => vectors.iter().map(|v| difference(v).powi(2)).sum::<f64>().sqrt(),
        };
        pair.sum += factor * norm;
        pair.square += norm * norm;
    }
}
