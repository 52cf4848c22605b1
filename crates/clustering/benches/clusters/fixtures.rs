//! Leading modes in closed form or from seeded numbers, shaped as those of four kinds of network: at
//! sizes where no spectrum is computed for a test. Components are of size 1/√N, as in any spectrum.

use rand_core::Rng;
use rand_pcg::Pcg64;
use spectra::{Eigenspace, Solver, Spectrum};

/// One spectrum, and a threshold on δe that tells its clusters apart.
pub struct Fixture {
    pub name: &'static str,
    pub spectrum: Spectrum,
    pub threshold: f64,
}

/// The fixtures with about so many nodes.
pub fn all(n_nodes: usize) -> [Fixture; 5] {
    [
        communities(n_nodes),
        uneven_communities(n_nodes),
        ring_of_cliques(n_nodes),
        grid(n_nodes),
        scale_free(n_nodes),
    ]
}

/// Eight planted communities of equal size: seven modes of ±1/√N on whole communities (the Walsh
/// functions) and normal noise of a tenth of that, which makes eight dense clumps of rows.
pub fn communities(n_nodes: usize) -> Fixture {
    Fixture { name: "communities", ..planted(n_nodes, |i| i * 8 / n_nodes) }
}

/// The same of sizes between a tenth and a fifth of the nodes, so that no median falls between two.
pub fn uneven_communities(n_nodes: usize) -> Fixture {
    let community = |i: usize| (8.0 * (i as f64 / n_nodes as f64).powf(1.3)) as usize;
    Fixture { name: "uneven_communities", ..planted(n_nodes, community) }
}

fn planted(n_nodes: usize, community: impl Fn(usize) -> usize) -> Fixture {
    let mut random = Random::new(1);
    let sign =
        |community: usize, mode: usize| 1.0 - 2.0 * f64::from((community & mode).count_ones() % 2);
    let modes = (1..8).map(|mode| {
        let component = |i: usize| sign(community(i), mode) + 0.1 * random.normal();
        (0..n_nodes).map(component).collect()
    });
    let spectrum = spectrum(n_nodes, modes.collect(), &[1; 7]);
    Fixture { name: "", spectrum, threshold: 0.5 / (n_nodes as f64).sqrt() }
}

/// Cliques of ten nodes in a ring, N/10 of them: waves around the ring in eigenspaces of two, with
/// eight equal rows in each clique and two of their own, those of the nodes with links elsewhere.
pub fn ring_of_cliques(n_nodes: usize) -> Fixture {
    let n_cliques = n_nodes / 10;
    let n_nodes = 10 * n_cliques;
    let place = |node: usize| {
        let lean = match node % 10 {
            0 => -0.1,
            9 => 0.1,
            _ => 0.0,
        };
        std::f64::consts::TAU * ((node / 10) as f64 + lean) / n_cliques as f64
    };
    let wave = |k: usize, phase: f64| {
        (0..n_nodes).map(|i| (k as f64 * place(i) - phase).cos()).collect::<Vec<f64>>()
    };
    let quarter = std::f64::consts::FRAC_PI_2;
    let modes = (1..5).flat_map(|k| [wave(k, 0.0), wave(k, quarter)]).collect();
    let spectrum = spectrum(n_nodes, modes, &[2; 4]);
    // A step along the ring by s turns every pair of waves by k s: Σ_k k s √(2/N) c_2 / 8.
    let step = std::f64::consts::TAU / n_cliques as f64;
    let per_step = 10.0 * (4.0 / std::f64::consts::PI) / 8.0 * (2.0 / n_nodes as f64).sqrt();
    Fixture { name: "ring_of_cliques", spectrum, threshold: 0.5 * step * per_step }
}

/// A square grid with open ends: products of cosines, a continuum of two dimensions.
pub fn grid(n_nodes: usize) -> Fixture {
    let side = (n_nodes as f64).sqrt().round() as usize;
    let cosine = |k: usize, x: usize| {
        (std::f64::consts::PI * k as f64 * (x as f64 + 0.5) / side as f64).cos()
    };
    let product = |(k, l): (usize, usize)| -> Vec<f64> {
        (0..side * side).map(|i| cosine(k, i % side) * cosine(l, i / side)).collect()
    };
    let waves = [(1, 0), (0, 1), (1, 1), (2, 0), (0, 2), (2, 1), (1, 2), (2, 2)];
    let modes = waves.map(product).to_vec();
    let spectrum = spectrum(side * side, modes, &[2, 1, 2, 2, 1]);
    // Near the mean step from node to node, so that some of the grid is linked and some is not.
    Fixture { name: "grid", spectrum, threshold: 3.0 / (side * side) as f64 }
}

/// Modes of a scale-free network: a cloud in all dimensions with a tail of nodes on which a mode is
/// localised. Of any ten nodes in a row the last two hang on one hub alike and have equal rows.
pub fn scale_free(n_nodes: usize) -> Fixture {
    let mut random = Random::new(2);
    let mut mode = || -> Vec<f64> {
        let mut v: Vec<f64> =
            (0..n_nodes).map(|_| random.normal() * (1.0 - random.uniform()).powf(-0.2)).collect();
        for i in (9..n_nodes).step_by(10) {
            v[i] = v[i - 1];
        }
        v
    };
    let modes = (0..8).map(|_| mode()).collect();
    let spectrum = spectrum(n_nodes, modes, &[1; 8]);
    Fixture { name: "scale_free", spectrum, threshold: 0.01 / (n_nodes as f64).sqrt() }
}

/// The constant mode and these, normalised, in eigenspaces of these dimensions.
fn spectrum(n_nodes: usize, modes: Vec<Vec<f64>>, dimensions: &[usize]) -> Spectrum {
    let mut eigenvectors = vec![vec![1.0; n_nodes]];
    eigenvectors.extend(modes);
    for v in &mut eigenvectors {
        let norm = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        v.iter_mut().for_each(|x| *x /= norm);
    }
    let mut eigenvalues = vec![0.0];
    let mut eigenspaces = std::iter::once(0..1).collect::<Vec<_>>();
    for (number, &dimension) in dimensions.iter().enumerate() {
        let start = eigenvalues.len();
        eigenvalues.extend(vec![-1.0 - number as f64; dimension]);
        eigenspaces.push(start..start + dimension);
    }
    Spectrum {
        eigenspaces: Eigenspace::divided(
            &eigenvalues,
            eigenvectors,
            &vec![1e-14; eigenvalues.len()],
            &eigenspaces,
            -1e3,
        ),
        tolerance: 1e-10,
        solver: Solver::Arpack,
        cutoff: None,
        products: 0,
        verification: spectra::Verification::Dense,
    }
}

/// Seeded numbers.
struct Random(Pcg64);

impl Random {
    fn new(seed: u64) -> Self {
        Self(Pcg64::new(u128::from(seed), 1))
    }

    /// Uniform in [0, 1).
    fn uniform(&mut self) -> f64 {
        graph::unit_interval(self.0.next_u64())
    }

    /// Standard normal, by Box and Muller.
    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }
}
