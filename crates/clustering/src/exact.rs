//! Exact clusters: nodes whose rows of components agree in the unstable subspace up to a tolerance.
//!
//! Equality up to a tolerance is single linkage of ‖P(e_i − e_j)‖₂, which does not depend on the
//! bases of eigenspaces and knows no boundaries of rounding. Sorting along two coordinates tells most
//! rows apart; only rows without a gap between them there are compared.

use std::ops::Range;

use spectra::Spectrum;

use crate::cells::Points;
use crate::distance::{chosen_eigenspaces, interleaved};
use crate::metric::Metric;
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

/// Those of a set of unstable modes within the clusters of some of them: a cluster that was split by
/// fewer modes stays so. Only rows of clusters of at least two nodes are looked at.
///
/// # Errors
/// Those of [`crate::EigenvectorDistance::new`] but for components, which are not checked, and
/// [`ClusteringError::SpectrumTooRough`].
pub(crate) fn refined_clusters(
    spectrum: &Spectrum,
    modes: &[usize],
    above: &Partition,
) -> Result<Partition, ClusteringError> {
    let chosen = chosen_eigenspaces(spectrum, modes)?;
    let tolerance = exact_tolerance(spectrum, &chosen);
    check_tolerance(tolerance, above.n_nodes())?;
    let spaces: Vec<Range<usize>> =
        chosen.iter().map(|&space| spectrum.eigenspaces[space].clone()).collect();
    let width = spaces.iter().map(ExactSizeIterator::len).sum();
    let sizes = above.sizes();
    let (nodes, group): (Vec<usize>, Vec<usize>) = above
        .cluster_of()
        .iter()
        .enumerate()
        .filter(|&(_, &cluster)| sizes[cluster] > 1)
        .map(|(node, &cluster)| (node, cluster))
        .unzip();
    let rows = interleaved(spectrum, &spaces, &nodes);
    let found = clusters_of_rows(&rows, width, tolerance, &Partition::from_marks(&group));
    let first = found.first_nodes();
    let mut roots: Vec<u32> = (0..).take(above.n_nodes()).collect();
    for (&node, &cluster) in nodes.iter().zip(found.cluster_of()) {
        roots[node] = nodes[first[cluster]] as u32;
    }
    Ok(Partition::from_roots(&roots))
}

/// Two coordinates of every row, and how much they may differ between rows within the tolerance.
///
/// They are the components along (1, 1, 1, …)/√width and (1, −1, 1, …)/√width, which never exceed the
/// norm but for the rounding of their sums. Among many rows the first alone has neighbours by chance.
fn coordinates(rows: &[f64], width: usize, tolerance: f64) -> ([Vec<f64>; 2], f64) {
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
