//! Networks with planted symmetries, weighted, some of them spoilt by a few more links.

use graph::Network;

use crate::fixtures::Random;

/// Weights whose sums round, and some that do not.
const WEIGHTS: [f64; 6] = [1.0, 0.5, 2.0, 0.1, 0.3, 1.7];

/// Links in the making.
pub struct Links {
    pub n_nodes: usize,
    pub links: Vec<(usize, usize, f64)>,
}

impl Links {
    pub fn network(&self) -> Network {
        let labels = (0..self.n_nodes).map(|i| (i + 1).to_string()).collect();
        Network::undirected(labels, &self.links).unwrap()
    }

    fn link(&mut self, i: usize, j: usize, weight: f64) {
        let is_there = |&(a, b, _): &(usize, usize, f64)| (a, b) == (i, j) || (a, b) == (j, i);
        if i != j && !self.links.iter().any(is_there) {
            self.links.push((i, j, weight));
        }
    }
}

fn below(random: &mut Random, n: usize) -> usize {
    ((random.uniform() * n as f64) as usize).min(n - 1)
}

fn weight(random: &mut Random) -> f64 {
    WEIGHTS[below(random, WEIGHTS.len())]
}

/// A network of at most about 40 nodes: a quotient blown up, copies of a motif on a stem, or both, in
/// every second case with links that break some of it; nodes in random order.
pub fn network(seed: u64) -> Network {
    let mut random = Random::new(seed);
    let mut links = match below(&mut random, 3) {
        0 => blown_up(&mut random),
        1 => copies(Links { n_nodes: 2, links: vec![(0, 1, 1.0)] }, &mut random),
        _ => {
            let stem = blown_up(&mut random);
            copies(stem, &mut random)
        }
    };
    if below(&mut random, 2) == 0 {
        for _ in 0..1 + below(&mut random, 2) {
            let (i, j) = (below(&mut random, links.n_nodes), below(&mut random, links.n_nodes));
            let weight = weight(&mut random);
            links.link(i, j, weight);
        }
    }
    let mut order: Vec<usize> = (0..links.n_nodes).collect();
    for last in (1..order.len()).rev() {
        order.swap(last, below(&mut random, last + 1));
    }
    links.links.iter_mut().for_each(|(i, j, _)| (*i, *j) = (order[*i], order[*j]));
    links.network()
}

/// Every node of a small random tree becomes a cell: cells that are linked are so all to all, or node
/// by node where they have equal sizes, and some are cycles within.
fn blown_up(random: &mut Random) -> Links {
    let n_cells = 2 + below(random, 4);
    let sizes: Vec<usize> = (0..n_cells).map(|_| 1 + below(random, 5)).collect();
    let starts: Vec<usize> = sizes
        .iter()
        .scan(0, |end, size| {
            *end += size;
            Some(*end - size)
        })
        .collect();
    let mut links = Links { n_nodes: sizes.iter().sum(), links: Vec::new() };
    for cell in 0..n_cells {
        let own = weight(random);
        if sizes[cell] > 2 && below(random, 2) == 0 {
            for k in 0..sizes[cell] {
                links.link(starts[cell] + k, starts[cell] + (k + 1) % sizes[cell], own);
            }
        }
        if cell == 0 {
            continue;
        }
        let (other, between) = (below(random, cell), weight(random));
        let by_node = sizes[cell] == sizes[other] && below(random, 2) == 0;
        for a in 0..sizes[cell] {
            for b in (0..sizes[other]).filter(|&b| !by_node || a == b) {
                links.link(starts[cell] + a, starts[other] + b, between);
            }
        }
    }
    links
}

/// A network with several copies of a random tree hung on one or two of its nodes.
fn copies(mut links: Links, random: &mut Random) -> Links {
    let size = 1 + below(random, 4);
    let motif: Vec<(usize, f64)> = (1..size).map(|k| (below(random, k), weight(random))).collect();
    let tie = weight(random);
    for _ in 0..1 + below(random, 2) {
        let root = below(random, links.n_nodes);
        for _ in 0..1 + below(random, 3) {
            let first = links.n_nodes;
            links.n_nodes += size;
            links.link(root, first, tie);
            for (k, &(parent, weight)) in motif.iter().enumerate() {
                links.link(first + k + 1, first + parent, weight);
            }
        }
    }
    links
}
