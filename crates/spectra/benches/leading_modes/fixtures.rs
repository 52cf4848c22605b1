//! Four kinds of network from 10³ to 10⁶ nodes, each with its own kind of leading spectrum: modes far
//! above a bulk, pairs close to 0, a continuum, and modes at the edge of a bulk.

use graph::Network;
use graph::generators::{LinkProbability, communities};
use rand_core::Rng;
use rand_pcg::Pcg64;

/// Builds a network of about so many nodes.
pub type Builder = fn(usize) -> Network;

/// All of them, by name.
pub const ALL: [(&str, Builder); 4] = [
    ("communities", planted),
    ("ring_of_cliques", ring_of_cliques),
    ("grid", grid),
    ("scale_free", scale_free),
];

/// Eight planted communities of equal size and mean degree 20; of five links four stay inside.
pub fn planted(n_nodes: usize) -> Network {
    let size = n_nodes / 8;
    let within = 16.0 / size as f64;
    let between = 4.0 / (7 * size) as f64;
    let probability = LinkProbability::Uniform { within, between };
    communities(&[size; 8], &probability, 1).expect("probabilities are below 1")
}

/// Cliques of ten nodes, the last node of each linked to the first of the next.
pub fn ring_of_cliques(n_nodes: usize) -> Network {
    let n_cliques = n_nodes / 10;
    let clique = |c| (0..10).flat_map(move |i| (0..i).map(move |j| (10 * c + i, 10 * c + j)));
    let bridge = |c| (10 * c + 9, 10 * ((c + 1) % n_cliques));
    let links = (0..n_cliques).flat_map(|c| clique(c).chain([bridge(c)]));
    unit(10 * n_cliques, links)
}

/// A square grid with open ends.
pub fn grid(n_nodes: usize) -> Network {
    let side = (n_nodes as f64).sqrt().round() as usize;
    let right = (0..side * side).filter(|i| i % side + 1 < side).map(|i| (i, i + 1));
    let down = (0..side * (side - 1)).map(|i| (i, i + side));
    unit(side * side, right.chain(down))
}

/// Barabási & Albert, Science 286, 509 (1999): every new node links to five old ones, chosen in
/// proportion to their degrees.
pub fn scale_free(n_nodes: usize) -> Network {
    const NEW: usize = 5;
    let mut random = Pcg64::new(5, 1);
    let mut links: Vec<(usize, usize)> =
        (0..=NEW).flat_map(|i| (0..i).map(move |j| (i, j))).collect();
    let mut ends: Vec<usize> = links.iter().flat_map(|&(i, j)| [i, j]).collect();
    for i in NEW + 1..n_nodes {
        let mut targets = [usize::MAX; NEW];
        for k in 0..NEW {
            while targets[k] == usize::MAX || targets[..k].contains(&targets[k]) {
                targets[k] = ends[(random.next_u64() >> 11) as usize % ends.len()];
            }
        }
        links.extend(targets.map(|j| (i, j)));
        ends.extend(targets.iter().flat_map(|&j| [i, j]));
    }
    unit(n_nodes, links.into_iter())
}

fn unit(n_nodes: usize, links: impl Iterator<Item = (usize, usize)>) -> Network {
    let links: Vec<_> = links.map(|(i, j)| (i, j, 1.0)).collect();
    let labels = (1..=n_nodes).map(|i| i.to_string()).collect();
    Network::undirected(labels, &links).expect("links join different nodes")
}
