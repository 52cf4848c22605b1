//! Coincidences: nodes that no unstable mode tells apart for no other reason than that there are many
//! nodes and components are known to a tolerance only.
//!
//! Among nodes without structure the number of pairs within a distance r of one another in the
//! unstable subspace grows as r^m, m its dimension, as long as their density is even on that scale
//! (the correlation sum of Grassberger & Procaccia, Physica D 9, 189 (1983)). So chance brings, within
//! the tolerance t,
//!
//! ```text
//! E = C(t, 2t) / (2^m − 1)
//! ```
//!
//! pairs, where C(t, 2t) counts those at distances from t to 2t, one node a cluster, so that clusters
//! themselves count for nothing. A node then has λ = 2E/n neighbours by chance, n clusters, and chains
//! of q nodes number about E_q = (n/2) λ^{q−1}: E pairs, n λ²/2 of three, ….
//!
//! Clusters that fall into q cells are explained by chance where E_q is at least 1, and at least a
//! tenth of how many there are: m is an upper bound of the dimension in which nodes really lie, so
//! that E is rather too small. In small networks E is of the order of 1e-9: there components that
//! agree do so for a reason, be it that all unstable modes are localised elsewhere.

use spectra::RealModes;

use crate::exact::coordinates;
use crate::metric::Metric;
use crate::modes::{chosen_eigenspaces, interleaved, transverse};
use crate::tolerance::exact_tolerance;
use crate::{ClusteringError, Partition};

/// How many clusters of one number of cells there may be for each that chance explains.
const AT_MOST: f64 = 10.0;

/// Most components that are looked at to count pairs; beyond that every n-th node stands for n.
const MOST_COMPONENTS: usize = 100_000_000;

/// Clusters that chance explains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coincidences {
    /// How many such clusters there were.
    pub n_clusters: usize,
    /// How many nodes or cells they joined to another: q − 1 for a cluster of q cells.
    pub found: usize,
    /// How many pairs are to be expected, E.
    pub expected: f64,
}

/// A partition without the clusters that chance alone explains, which are replaced by their cells, and
/// how many these were; none where all stay.
///
/// - `modes`: the unstable modes that tell no nodes of a cluster apart.
/// - `cells`: the coarsest equitable refinement of the clusters.
///
/// # Errors
/// Those of [`crate::EigenvectorDistance::new`] for the modes.
pub(crate) fn taken_apart(
    clusters: &Partition,
    cells: &Partition,
    spectrum: &RealModes<'_>,
    modes: &[usize],
) -> Result<Option<(Partition, Coincidences)>, ClusteringError> {
    let n_cells = cells_of_each(clusters, cells);
    if n_cells.iter().all(|&q| q == 1) {
        return Ok(None);
    }
    let expected = expected_pairs(spectrum, modes, &clusters.first_nodes())?;
    let most = n_cells.iter().copied().max().unwrap_or(0);
    let mut n_of = vec![0usize; most + 1];
    n_cells.iter().for_each(|&q| n_of[q] += 1);
    let n = clusters.n_clusters() as f64;
    let is_chance = |q: usize| {
        let expected = 0.5 * n * (2.0 * expected / n).powf(q as f64 - 1.0);
        q > 1 && expected >= 1.0 && AT_MOST * expected >= n_of[q] as f64
    };
    let taken: Vec<bool> = n_cells.iter().map(|&q| is_chance(q)).collect();
    if !taken.contains(&true) {
        return Ok(None);
    }
    let nodes = clusters.roots().into_iter().zip(cells.roots()).zip(clusters.cluster_of());
    let roots: Vec<u32> =
        nodes.map(|((root, cell), &cluster)| if taken[cluster] { cell } else { root }).collect();
    let taken_cells = n_cells.iter().zip(&taken).filter(|(_, taken)| **taken);
    let coincidences = Coincidences {
        n_clusters: taken_cells.clone().count(),
        found: taken_cells.map(|(q, _)| q - 1).sum(),
        expected,
    };
    Ok(Some((Partition::from_roots(&roots), coincidences)))
}

/// Into how many cells each cluster falls.
fn cells_of_each(clusters: &Partition, cells: &Partition) -> Vec<usize> {
    let mut n_cells = vec![0; clusters.n_clusters()];
    for first in cells.first_nodes() {
        n_cells[clusters.cluster_of()[first]] += 1;
    }
    n_cells
}

/// How many pairs of nodes chance brings within the tolerance, from the density of these.
fn expected_pairs(
    spectrum: &RealModes<'_>,
    modes: &[usize],
    nodes: &[usize],
) -> Result<f64, ClusteringError> {
    let chosen = chosen_eigenspaces(spectrum, modes)?;
    let spaces: Vec<_> = chosen.iter().map(|&s| spectrum.eigenspaces[s].clone()).collect();
    let dimension: usize = spaces.iter().map(|space| transverse(space).len()).sum();
    let shells = 2f64.powf(dimension as f64) - 1.0;
    // Not even all pairs would make one.
    if dimension == 0 || shells > 0.5 * (nodes.len() as f64).powi(2) {
        return Ok(0.0);
    }
    let tolerance = exact_tolerance(spectrum, &chosen);
    let width = spaces.iter().map(ExactSizeIterator::len).sum();
    let rows = interleaved(spectrum, &spaces, nodes);
    Ok(pairs_in_shell(&rows, width, tolerance) / shells)
}

/// How many pairs of rows are further apart than the tolerance and no further than twice that.
fn pairs_in_shell(rows: &[f64], width: usize, tolerance: f64) -> f64 {
    let reach = 2.0 * tolerance;
    let ([first, second], window) = coordinates(rows, width, reach);
    let mut order: Vec<u32> = (0..first.len() as u32).collect();
    order.sort_unstable_by(|&a, &b| first[a as usize].total_cmp(&first[b as usize]));
    let mut ends = Vec::with_capacity(order.len());
    let mut end = 0;
    for &a in &order {
        while end < order.len() && first[order[end] as usize] - first[a as usize] <= window {
            end += 1;
        }
        ends.push(end);
    }
    let n_near: usize = ends.iter().enumerate().map(|(place, end)| end - place - 1).sum();
    let step = n_near.saturating_mul(width).div_ceil(MOST_COMPONENTS).max(1);
    let metric = Metric::euclidean(width);
    let row = |node: u32| &rows[node as usize * width..][..width];
    let in_shell = |&a: &u32, &b: &u32| {
        (second[a as usize] - second[b as usize]).abs() <= window && {
            let distance = metric.distance_up_to(reach, row(a), row(b));
            tolerance < distance && distance <= reach
        }
    };
    let of_place = |place: usize| {
        let a = &order[place];
        order[place + 1..ends[place]].iter().filter(|b| in_shell(a, b)).count()
    };
    (0..order.len()).step_by(step).map(of_place).sum::<usize>() as f64 * step as f64
}
