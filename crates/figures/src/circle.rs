//! Nodes evenly on one circle.

use std::f64::consts::{PI, TAU};

/// Positions on a unit circle, y down, clockwise from the left.
pub(super) fn circle(n_nodes: usize) -> Vec<[f64; 2]> {
    let angle = |i: usize| TAU * i as f64 / n_nodes as f64;
    (0..n_nodes).map(|i| [-angle(i).cos(), -angle(i).sin()]).collect()
}

/// Radius at which n nodes on a circle have unit distance from their neighbours.
pub(super) fn ring_radius(n_nodes: usize) -> f64 {
    if n_nodes < 2 { 0.0 } else { 0.5 / (PI / n_nodes as f64).sin() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn length(a: [f64; 2], b: [f64; 2]) -> f64 {
        (a[0] - b[0]).hypot(a[1] - b[1])
    }

    #[test]
    fn node_one_of_six_faces_node_four() {
        let places = circle(6);
        assert!(length(places[0], [-1.0, 0.0]) < 1e-12 && length(places[3], [1.0, 0.0]) < 1e-12);
        assert!(places[1][1] < 0.0, "clockwise on a page with y down: node 2 is above");
    }
}
