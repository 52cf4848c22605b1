//! Places of a network's nodes: on one circle, by least stress, on one circle a cluster, or given.
//! All are deterministic.

use super::circle::{circle, ring_radius};
use super::stress::{hop_distances, least_stress};

/// Distance between the circles of linked clusters, over that of neighbours on one circle.
const GROUP_GAP: f64 = 1.5;

/// How nodes find their places.
#[derive(Clone, Debug, Default)]
pub enum Placement {
    /// Evenly on a circle, clockwise from the left.
    #[default]
    Circle,
    /// By least stress: distances follow the number of links between nodes.
    Stress,
    /// Each cluster on a circle of its own; the circles, and the nodes in no cluster, stand by
    /// least stress according to the links between them.
    Grouped,
    /// Given positions (x to the right, y up, any unit), one a node.
    At(Vec<[f64; 2]>),
}

/// Positions with every cluster on a circle of its own, neighbours on it at unit distance.
pub(super) fn grouped(clusters: &[Option<usize>], links: &[(usize, usize)]) -> Vec<[f64; 2]> {
    let groups = groups(clusters);
    let radii: Vec<f64> = groups.iter().map(|g| ring_radius(g.len())).collect();
    let mut group_of = vec![0; clusters.len()];
    for (g, nodes) in groups.iter().enumerate() {
        for &node in nodes {
            group_of[node] = g;
        }
    }
    let between: Vec<_> = links.iter().map(|&(i, j)| (group_of[i], group_of[j])).collect();
    let mut distances = hop_distances(groups.len(), &between);
    for (g, row) in distances.iter_mut().enumerate() {
        for (h, distance) in row.iter_mut().enumerate() {
            *distance = GROUP_GAP * *distance + radii[g] + radii[h];
        }
    }
    let mut places = vec![[0.0; 2]; clusters.len()];
    let centres = set_apart(least_stress(&distances), &radii);
    for ((nodes, radius), [x, y]) in groups.iter().zip(radii).zip(centres) {
        for (&node, [dx, dy]) in nodes.iter().zip(circle(nodes.len())) {
            places[node] = [x + radius * dx, y + radius * dy];
        }
    }
    places
}

/// Centres moved apart, all by one factor, until no two circles are closer than unit distance.
fn set_apart(centres: Vec<[f64; 2]>, radii: &[f64]) -> Vec<[f64; 2]> {
    let pairs = (0..centres.len()).flat_map(|g| (0..g).map(move |h| (g, h)));
    let needed = pairs.map(|(g, h)| {
        let [dx, dy] = [0, 1].map(|c| centres[g][c] - centres[h][c]);
        (radii[g] + radii[h] + 1.0) / dx.hypot(dy)
    });
    let factor = needed.filter(|f| f.is_finite()).fold(1.0, f64::max);
    centres.into_iter().map(|centre| centre.map(|c| factor * c)).collect()
}

/// Nodes of each cluster, clusters in ascending order, then each node that is in none.
fn groups(clusters: &[Option<usize>]) -> Vec<Vec<usize>> {
    let mut numbers: Vec<usize> = clusters.iter().flatten().copied().collect();
    numbers.sort_unstable();
    numbers.dedup();
    let members = |number| (0..clusters.len()).filter(|&i| clusters[i] == number).collect();
    let mut groups: Vec<Vec<usize>> = numbers.into_iter().map(|k| members(Some(k))).collect();
    groups.extend(members(None).into_iter().map(|node| vec![node]));
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    fn length(a: [f64; 2], b: [f64; 2]) -> f64 {
        (a[0] - b[0]).hypot(a[1] - b[1])
    }

    #[test]
    fn neighbours_on_the_ring_of_a_cluster_are_at_unit_distance() {
        let clusters = [Some(4), Some(4), Some(4), Some(4), None, Some(1), Some(1)];
        let places = grouped(&clusters, &[(0, 4), (4, 5)]);
        for (i, j) in [(0, 1), (1, 2), (2, 3), (3, 0), (5, 6)] {
            assert!((length(places[i], places[j]) - 1.0).abs() < 1e-9, "{i}–{j}");
        }
    }

    #[test]
    fn clusters_do_not_overlap() {
        // Each cluster of 8 is linked with the next, and with the one after the next.
        for n_nodes in [24, 48] {
            let clusters: Vec<_> = (0..n_nodes).map(|i| Some(i / 8)).collect();
            let link = |i: usize| [(i, (i + 8) % n_nodes), (i, (i + 16) % n_nodes)];
            let links: Vec<_> = (0..n_nodes).flat_map(link).collect();
            let places = grouped(&clusters, &links);
            for (i, j) in (0..n_nodes).flat_map(|i| (0..i).map(move |j| (i, j))) {
                assert!(length(places[i], places[j]) > 0.95, "{i}–{j} of {n_nodes}");
            }
        }
    }
}
