//! Spectra with exact answers, and the random numbers that turn them about.

use graph::formats::edge_list;
use graph::{CouplingMatrix, Network, Normalization, SparseMatrix};
use rand_core::Rng;
use rand_pcg::Pcg64;
use spectra::{Eigenspace, Solver, Spectrum};

const TOLERANCE: f64 = 1e-8;

/// Seeded numbers.
pub struct Random(Pcg64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(Pcg64::new(u128::from(seed), 1))
    }

    /// Uniform in [0, 1).
    pub fn uniform(&mut self) -> f64 {
        graph::unit_interval(self.0.next_u64())
    }

    /// Standard normal, by Box and Muller.
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }

    /// Rows of a random orthogonal matrix, uniform (Haar): Gram–Schmidt on normal vectors, twice.
    pub fn orthogonal(&mut self, dimension: usize) -> Vec<Vec<f64>> {
        let mut rows: Vec<Vec<f64>> = Vec::new();
        for _ in 0..dimension {
            let row = (0..dimension).map(|_| self.normal()).collect();
            rows.push(unit(orthogonal_to(&rows, row)));
        }
        rows
    }
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub fn unit(vector: Vec<f64>) -> Vec<f64> {
    let norm = dot(&vector, &vector).sqrt();
    vector.into_iter().map(|v| v / norm).collect()
}

/// A spectrum from its modes in any order, with the given residuals for all of them.
pub fn spectrum(mut modes: Vec<(f64, Vec<f64>)>, residual: f64) -> Spectrum {
    modes.sort_by(|a, b| b.0.total_cmp(&a.0));
    let (eigenvalues, eigenvectors): (Vec<f64>, Vec<Vec<f64>>) = modes.into_iter().unzip();
    let mut start = 0;
    let ranges: Vec<_> = eigenvalues
        .chunk_by(|a, b| a - b < TOLERANCE)
        .map(|run| {
            start += run.len();
            start - run.len()..start
        })
        .collect();
    let residuals = vec![residual; eigenvalues.len()];
    let none = f64::NEG_INFINITY;
    Spectrum {
        eigenspaces: Eigenspace::divided(&eigenvalues, eigenvectors, &residuals, &ranges, none),
        tolerance: TOLERANCE,
        solver: Solver::Dense,
        cutoff: None,
        products: 0,
        verification: spectra::Verification::Dense,
    }
}

/// The first modes of a spectrum.
pub fn leading(mut spectrum: Spectrum, n_modes: usize) -> Spectrum {
    let mut n_left = n_modes;
    for space in &mut spectrum.eigenspaces {
        space.values.truncate(n_left);
        space.basis.truncate(n_left);
        space.residuals.truncate(n_left);
        n_left -= space.basis.len();
    }
    spectrum.eigenspaces.retain(|space| !space.basis.is_empty());
    spectrum
}

/// The eigenvectors of a spectrum, mode by mode.
pub fn vectors_mut(spectrum: &mut Spectrum) -> impl Iterator<Item = &mut Vec<f64>> {
    spectrum.eigenspaces.iter_mut().flat_map(|space| &mut space.basis)
}

/// The same spectrum with one residual for all its modes.
pub fn with_residuals(mut spectrum: Spectrum, residual: f64) -> Spectrum {
    spectrum.eigenspaces.iter_mut().for_each(|space| space.residuals.fill(residual));
    spectrum
}

/// The same spectrum in other orthonormal bases of its eigenspaces.
pub fn rotated(mut spectrum: Spectrum, seed: u64) -> Spectrum {
    let mut random = Random::new(seed);
    for space in &mut spectrum.eigenspaces {
        let old = space.basis.clone();
        for (new, row) in space.basis.iter_mut().zip(random.orthogonal(old.len())) {
            for (node, component) in new.iter_mut().enumerate() {
                *component = row.iter().zip(&old).map(|(r, v)| r * v[node]).sum();
            }
        }
    }
    spectrum
}

/// Eigenvalues and eigenvectors of a symmetric matrix by cyclic Jacobi rotations.
fn jacobi(mut a: Vec<Vec<f64>>) -> Vec<(f64, Vec<f64>)> {
    let n = a.len();
    let mut v: Vec<Vec<f64>> =
        (0..n).map(|i| (0..n).map(|j| f64::from(i == j)).collect()).collect();
    for _ in 0..60 {
        for p in 0..n {
            for q in p + 1..n {
                if a[p][q] == 0.0 {
                    continue;
                }
                let theta = 0.5 * (2.0 * a[p][q]).atan2(a[q][q] - a[p][p]);
                let (s, c) = theta.sin_cos();
                for row in &mut a {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
                for k in 0..n {
                    (a[p][k], a[q][k]) = (c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]);
                    (v[p][k], v[q][k]) = (c * v[p][k] - s * v[q][k], s * v[p][k] + c * v[q][k]);
                }
            }
        }
    }
    (0..n).map(|i| (a[i][i], v[i].clone())).collect()
}

fn dense(matrix: &SparseMatrix) -> Vec<Vec<f64>> {
    let n = matrix.rows();
    let entry = |i, j| matrix.get(i, j).copied().unwrap_or(0.0);
    (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
}

/// The spectrum of a network's coupling matrix, by Jacobi.
pub fn spectrum_of(network: &Network, normalization: Normalization) -> Spectrum {
    let coupling = CouplingMatrix::new(network, normalization);
    let form = coupling.symmetric_form().unwrap();
    let scaled = |v: Vec<f64>| unit(v.iter().zip(form.scale()).map(|(v, s)| v * s).collect());
    let modes = jacobi(dense(form.symmetric()));
    let mut spectrum = spectrum(modes.into_iter().map(|(l, v)| (l, scaled(v))).collect(), 0.0);
    // Scaling leaves eigenvectors of one eigenvalue at an angle.
    for space in &mut spectrum.eigenspaces {
        for k in 0..space.basis.len() {
            let (earlier, rest) = space.basis.split_at_mut(k);
            for other in earlier.iter() {
                let along = dot(&rest[0], other);
                rest[0].iter_mut().zip(other).for_each(|(v, o)| *v -= along * o);
            }
            rest[0] = unit(std::mem::take(&mut rest[0]));
        }
    }
    set_residuals(&mut spectrum, coupling.matrix());
    spectrum
}

/// ‖Wv − λv‖ of every mode.
fn set_residuals(spectrum: &mut Spectrum, w: &SparseMatrix) {
    let w = dense(w);
    for space in &mut spectrum.eigenspaces {
        for ((l, v), residual) in space.values.iter().zip(&space.basis).zip(&mut space.residuals) {
            let row = |(r, v_i): (&Vec<f64>, &f64)| dot(r, v) - l.re * v_i;
            *residual = w.iter().zip(v).map(row).map(|x| x * x).sum::<f64>().sqrt();
        }
    }
}

/// The constant and random orthonormal vectors, one eigenvalue −1, −2, … each.
pub fn random_spectrum(n_nodes: usize, n_modes: usize, seed: u64) -> Spectrum {
    let mut random = Random::new(seed);
    let mut basis = vec![unit(vec![1.0; n_nodes])];
    while basis.len() < n_modes {
        let v = (0..n_nodes).map(|_| random.normal()).collect();
        basis.push(unit(orthogonal_to(&basis, v)));
    }
    spectrum(basis.into_iter().enumerate().map(|(k, v)| (-(k as f64), v)).collect(), 1e-13)
}

/// Leading modes that only tell equal blocks of nodes apart.
pub fn block_spectrum(n_nodes: usize, n_blocks: usize) -> Spectrum {
    let mut random = Random::new(3);
    let mut basis = vec![unit(vec![1.0; n_nodes])];
    while basis.len() < n_blocks {
        let levels: Vec<f64> = (0..n_blocks).map(|_| random.normal()).collect();
        let v = (0..n_nodes).map(|i| levels[i * n_blocks / n_nodes]).collect();
        basis.push(unit(orthogonal_to(&basis, v)));
    }
    spectrum(basis.into_iter().enumerate().map(|(k, v)| (-(k as f64), v)).collect(), 1e-13)
}

/// What is left of a vector without its parts along an orthonormal basis, twice for rounding.
pub fn orthogonal_to(basis: &[Vec<f64>], mut v: Vec<f64>) -> Vec<f64> {
    for _ in 0..2 {
        for b in basis {
            let along = dot(&v, b);
            v.iter_mut().zip(b).for_each(|(v, b)| *v -= along * b);
        }
    }
    v
}

/// A network of `n` nodes, each pair linked with this probability, weights between 0.5 and 1.5.
pub fn random_network(n: usize, density: f64, seed: u64) -> Network {
    let mut random = Random::new(seed);
    let mut links = Vec::new();
    for i in 0..n {
        for j in 0..i {
            if random.uniform() < density {
                links.push((i, j, 0.5 + random.uniform()));
            }
        }
    }
    Network::undirected((0..n).map(|i| i.to_string()).collect(), &links).unwrap()
}

pub fn read(text: &str) -> Network {
    edge_list::read(text.as_bytes()).unwrap()
}

/// Checks closed-form modes against a network's laplacian.
fn checked(modes: Vec<(f64, Vec<f64>)>, edges: &str) -> Spectrum {
    let modes = modes.into_iter().map(|(l, v)| (l, unit(v))).collect();
    let mut spectrum = spectrum(modes, 0.0);
    let coupling = CouplingMatrix::new(&read(edges), Normalization::Laplacian);
    set_residuals(&mut spectrum, coupling.matrix());
    assert!(spectrum.largest_residual() < 1e-13, "{}", spectrum.largest_residual());
    assert!(spectrum.is_whole() && spectrum.n_nodes() == coupling.n_nodes());
    spectrum
}

/// The six nodes of Fig. 1(a1), from the eigenvectors printed in the paper as closed forms.
pub fn six_nodes() -> Spectrum {
    let modes = vec![
        (0.0, vec![1.0; 6]),
        (-2.0, vec![-1., -1., 1., 1., 1., -1.]),
        (-3.0, vec![2., -1., -1., 2., -1., -1.]),
        (-4.0, vec![0., 1., 1., 0., -1., -1.]),
        (-5.0, vec![2., -1., 1., -2., 1., -1.]),
        (-6.0, vec![0., 1., -1., 0., 1., -1.]),
    ];
    checked(modes, include_str!("../../../../experiments/networks/six-node.edges"))
}

/// The Nepal grid of Fig. 1(b1): five modes from its quotient of the cells {1–5}, {6–8}, {9–13},
/// {14}, {15}, the others any basis of the vectors of zero sum on a clique.
pub fn nepal() -> Spectrum {
    let cells = [0..5, 5..8, 8..13, 13..14, 14..15];
    // Links of a node of one cell with each node of another: all or none.
    let linked = [(0, 1), (1, 2), (1, 3), (2, 3), (3, 4)];
    let mut quotient = vec![vec![0.0; 5]; 5];
    for (a, b) in linked {
        let (n_a, n_b) = (cells[a].len() as f64, cells[b].len() as f64);
        quotient[a][b] = (n_a * n_b).sqrt();
        quotient[b][a] = quotient[a][b];
        quotient[a][a] -= n_b;
        quotient[b][b] -= n_a;
    }
    let spread = |q: Vec<f64>| {
        let node = |(cell, q): (&std::ops::Range<usize>, f64)| {
            vec![q / (cell.len() as f64).sqrt(); cell.len()]
        };
        cells.iter().zip(q).flat_map(node).collect::<Vec<f64>>()
    };
    let mut modes: Vec<_> = jacobi(quotient).into_iter().map(|(l, q)| (l, spread(q))).collect();
    for (cell, lambda) in [(0..5, -8.0), (5..8, -14.0), (8..13, -9.0)] {
        modes.extend(zero_sum(15, cell).into_iter().map(|v| (lambda, v)));
    }
    checked(modes, include_str!("../../../../experiments/networks/nepal.edges"))
}

/// An orthogonal basis (Helmert's) of the vectors that vanish off the cell and sum to zero on it.
fn zero_sum(n_nodes: usize, cell: std::ops::Range<usize>) -> Vec<Vec<f64>> {
    let vector = |k: usize| {
        let mut v = vec![0.0; n_nodes];
        v[cell.start..cell.start + k].fill(1.0);
        v[cell.start + k] = -(k as f64);
        v
    };
    (1..cell.len()).map(vector).collect()
}
