//! Positions of nodes such that distances on the page follow given ones, numbers of links between
//! nodes for example, as closely as they can.
//!
//! Minimises the stress Σ_{i<j} d_ij⁻² (|x_i − x_j| − d_ij)² one node at a time by
//! `x_i ← Σ_j d_ij⁻² (x_j + d_ij (x_i − x_j)/|x_i − x_j|) / Σ_j d_ij⁻²`,
//! which never raises it, from the two leading components of classical scaling, as Gansner, Koren
//! & North advise (Graph Drawing 2004, LNCS 3383, 239). No random numbers: the same distances
//! give the same positions.

use std::collections::VecDeque;

use super::circle::circle;

/// Sweeps over all nodes at most; small networks settle in a few dozen.
const MAX_SWEEPS: usize = 500;
/// Pairs of nodes looked at in all sweeps together, at most: a second of work. The first sweeps of a
/// large network do what can be seen.
const MAX_PAIRS: usize = 100_000_000;
/// Relative fall of the stress in one sweep below which it has settled.
const SETTLED: f64 = 1e-6;
/// Power iterations for the start, which needs no accuracy.
const ITERATIONS: usize = 100;
/// Share of a circle in the start: nodes with equal distances to all others would stay together.
const CIRCLE_SHARE: f64 = 0.1;

/// Positions whose distances are as close to the given ones (symmetric, positive between any
/// two nodes) as is found from classical scaling, turned so that they extend farthest along x.
pub(super) fn least_stress(distances: &[Vec<f64>]) -> Vec<[f64; 2]> {
    let n_nodes = distances.len();
    let mut places = classical_scaling(distances);
    for (place, [x, y]) in places.iter_mut().zip(circle(n_nodes)) {
        *place = [place[0] + CIRCLE_SHARE * x, place[1] + CIRCLE_SHARE * y];
    }
    let mut before = stress(&places, distances);
    for _ in 0..n_sweeps(n_nodes) {
        for i in 0..n_nodes {
            places[i] = majorised(i, &places, &distances[i]);
        }
        let now = stress(&places, distances);
        if before - now <= SETTLED * before {
            break;
        }
        before = now;
    }
    turned(&places)
}

fn n_sweeps(n_nodes: usize) -> usize {
    (MAX_PAIRS / n_nodes.pow(2).max(1)).clamp(1, MAX_SWEEPS)
}

/// The two leading components of −½ J D² J, D² the squared distances and J = 1 − 1/N, by
/// orthogonal iteration: positions with exactly these distances if there are any in the plane.
fn classical_scaling(distances: &[Vec<f64>]) -> Vec<[f64; 2]> {
    let centred = |mut v: Vec<f64>| {
        let mean = v.iter().sum::<f64>() / v.len() as f64;
        v.iter_mut().for_each(|x| *x -= mean);
        v
    };
    let product = |v: Vec<f64>| {
        let v = centred(v);
        let row = |row: &Vec<f64>| -0.5 * row.iter().zip(&v).map(|(d, x)| d * d * x).sum::<f64>();
        centred(distances.iter().map(row).collect())
    };
    // Unequal starts that are symmetric under no exchange of two nodes.
    let start = |power: i32| (1..=distances.len()).map(|i| (i as f64).powi(power)).collect();
    let [mut first, mut second] = [start(1), start(2)].map(centred);
    for _ in 0..ITERATIONS {
        first = normalised(product(first));
        let overlap: f64 = first.iter().zip(&second).map(|(a, b)| a * b).sum();
        second = second.iter().zip(&first).map(|(b, a)| b - overlap * a).collect();
        second = normalised(product(second));
    }
    let lengths = [&first, &second].map(|v| {
        let image = product(v.clone());
        v.iter().zip(image).map(|(a, b)| a * b).sum::<f64>().max(0.0).sqrt()
    });
    first.iter().zip(&second).map(|(a, b)| [lengths[0] * a, lengths[1] * b]).collect()
}

fn normalised(v: Vec<f64>) -> Vec<f64> {
    let norm = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    if norm > 0.0 { v.into_iter().map(|x| x / norm).collect() } else { v }
}

/// Where node i's share of the stress, majorised about its present place, is least.
fn majorised(i: usize, places: &[[f64; 2]], distances: &[f64]) -> [f64; 2] {
    let [x, y] = places[i];
    let (mut sum, mut weights) = ([0.0; 2], 0.0);
    for (j, (&[to_x, to_y], &distance)) in places.iter().zip(distances).enumerate() {
        if j == i {
            continue;
        }
        let (dx, dy) = (x - to_x, y - to_y);
        let length = (dx * dx + dy * dy).sqrt();
        let stretch = if length > 0.0 { distance / length } else { 0.0 };
        let weight = 1.0 / (distance * distance);
        sum[0] += weight * (to_x + stretch * dx);
        sum[1] += weight * (to_y + stretch * dy);
        weights += weight;
    }
    if weights > 0.0 { sum.map(|s| s / weights) } else { [x, y] }
}

fn stress(places: &[[f64; 2]], distances: &[Vec<f64>]) -> f64 {
    let pairs = (0..places.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    pairs
        .map(|(i, j)| {
            let [dx, dy] = [places[i][0] - places[j][0], places[i][1] - places[j][1]];
            ((dx * dx + dy * dy).sqrt() / distances[i][j] - 1.0).powi(2)
        })
        .sum()
}

/// Links on a shortest path between every two nodes; between components, one more than the
/// longest of these, which sets them side by side.
pub(super) fn hop_distances(n_nodes: usize, links: &[(usize, usize)]) -> Vec<Vec<f64>> {
    let mut neighbours = vec![Vec::new(); n_nodes];
    for &(i, j) in links {
        neighbours[i].push(j);
        neighbours[j].push(i);
    }
    let hops: Vec<_> = (0..n_nodes).map(|from| hops_from(from, &neighbours)).collect();
    let longest = hops.iter().flatten().flatten().max().copied().unwrap_or(0);
    let length = |hop: &Option<u32>| f64::from(hop.unwrap_or(longest + 1));
    hops.iter().map(|row| row.iter().map(length).collect()).collect()
}

/// Breadth-first search from one node; none for nodes out of reach.
fn hops_from(from: usize, neighbours: &[Vec<usize>]) -> Vec<Option<u32>> {
    let mut hops = vec![None; neighbours.len()];
    hops[from] = Some(0);
    let mut queue = VecDeque::from([(from, 0)]);
    while let Some((node, hop)) = queue.pop_front() {
        for &next in &neighbours[node] {
            if hops[next].is_none() {
                hops[next] = Some(hop + 1);
                queue.push_back((next, hop + 1));
            }
        }
    }
    hops
}

/// The places about their mean, their principal axis along x.
fn turned(places: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let n = places.len() as f64;
    let mean = [0, 1].map(|c| places.iter().map(|p| p[c]).sum::<f64>() / n);
    let centred: Vec<_> = places.iter().map(|p| [p[0] - mean[0], p[1] - mean[1]]).collect();
    let moment = |a: usize, b: usize| centred.iter().map(|p| p[a] * p[b]).sum::<f64>();
    // Angle of the principal axis of a symmetric 2 × 2 matrix.
    let angle = 0.5 * (2.0 * moment(0, 1)).atan2(moment(0, 0) - moment(1, 1));
    let (sin, cos) = angle.sin_cos();
    centred.iter().map(|[x, y]| [cos * x + sin * y, cos * y - sin * x]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(n_nodes: usize) -> Vec<(usize, usize)> {
        (1..n_nodes).map(|i| (i - 1, i)).collect()
    }

    fn length(a: [f64; 2], b: [f64; 2]) -> f64 {
        (a[0] - b[0]).hypot(a[1] - b[1])
    }

    #[test]
    fn a_path_becomes_a_straight_line_along_x() {
        // Stress zero is reached only where every distance on the page is the number of links.
        let places = least_stress(&hop_distances(5, &path(5)));
        assert!((length(places[0], places[4]) - 4.0).abs() < 0.02, "{places:?}");
        assert!(places.iter().all(|p| p[1].abs() < 0.1), "{places:?}");
    }

    #[test]
    fn classical_scaling_recovers_distances_of_a_plane() {
        let plane = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [0.5, 2.0], [-1.0, 0.3]];
        let distances: Vec<Vec<f64>> =
            plane.iter().map(|&a| plane.iter().map(|&b| length(a, b)).collect()).collect();
        let places = classical_scaling(&distances);
        for (i, j) in (0..5).flat_map(|i| (0..i).map(move |j| (i, j))) {
            assert!((length(places[i], places[j]) - distances[i][j]).abs() < 1e-9, "{i}–{j}");
        }
    }

    #[test]
    fn a_triangle_becomes_equilateral_with_unit_sides() {
        let places = least_stress(&hop_distances(3, &[(0, 1), (1, 2), (2, 0)]));
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            assert!((length(places[i], places[j]) - 1.0).abs() < 1e-3);
        }
    }

    #[test]
    fn the_work_for_a_large_network_is_bounded() {
        assert_eq!([n_sweeps(1), n_sweeps(300), n_sweeps(1000)], [500, 500, 100]);
        assert_eq!(n_sweeps(1_000_000), 1);
    }

    #[test]
    fn stress_never_rises() {
        // Two cliques joined by a link, and a node apart.
        let mut links = vec![(0, 4)];
        for start in [0, 4] {
            links.extend((0..4).flat_map(|i| (0..i).map(move |j| (start + i, start + j))));
        }
        let distances = hop_distances(9, &links);
        let mut places = circle(9);
        let mut before = stress(&places, &distances);
        for _ in 0..50 {
            for i in 0..9 {
                places[i] = majorised(i, &places, &distances[i]);
                let now = stress(&places, &distances);
                assert!(now <= before * (1.0 + 1e-12), "{now} > {before}");
                before = now;
            }
        }
    }

    #[test]
    fn components_stand_apart_and_a_single_node_stands_still() {
        assert_eq!(hop_distances(3, &[(0, 1)])[0], [0.0, 1.0, 2.0]);
        assert_eq!(least_stress(&hop_distances(1, &[])), [[0.0, 0.0]]);
    }
}
