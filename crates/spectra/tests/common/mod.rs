//! Networks with known spectra, and what every spectrum must satisfy.
#![allow(dead_code, reason = "each test file uses its own part")]

use std::f64::consts::PI;
use std::ops::Range;
use std::sync::LazyLock;

use graph::{CouplingMatrix, Network, Normalization};
use spectra::{Modes, Request, Solver, Spectrum, Verification, leading_modes};
use sprs::prod::mul_acc_mat_vec_csr;

pub const BOTH: [Normalization; 2] = [Normalization::Laplacian, Normalization::Normalized];

pub fn network(n_nodes: usize, links: &[(usize, usize, f64)]) -> Network {
    Network::undirected((1..=n_nodes).map(|i| i.to_string()).collect(), links).unwrap()
}

fn unit(n_nodes: usize, links: impl IntoIterator<Item = (usize, usize)>) -> Network {
    network(n_nodes, &links.into_iter().map(|(i, j)| (i, j, 1.0)).collect::<Vec<_>>())
}

/// One hub, node 0.
pub fn star(n_leaves: usize) -> Network {
    unit(n_leaves + 1, (1..=n_leaves).map(|leaf| (0, leaf)))
}

pub fn complete(n_nodes: usize) -> Network {
    unit(n_nodes, (0..n_nodes).flat_map(|i| (0..i).map(move |j| (i, j))))
}

pub fn path(n_nodes: usize) -> Network {
    unit(n_nodes, (1..n_nodes).map(|i| (i - 1, i)))
}

pub fn ring(n_nodes: usize) -> Network {
    unit(n_nodes, (0..n_nodes).map(|i| (i, (i + 1) % n_nodes)))
}

pub fn torus(side: usize) -> Network {
    let node = move |i: usize, j: usize| (i % side) * side + j % side;
    let right_and_down = move |i, j| [(node(i, j), node(i, j + 1)), (node(i, j), node(i + 1, j))];
    let cells = (0..side).flat_map(|i| (0..side).map(move |j| (i, j)));
    unit(side * side, cells.flat_map(move |(i, j)| right_and_down(i, j)))
}

/// Cliques of five nodes; the last node of each is linked to the first of the next.
pub fn ring_of_cliques(n_cliques: usize) -> Network {
    let clique = |c: usize| (0..5).flat_map(move |i| (0..i).map(move |j| (5 * c + i, 5 * c + j)));
    let bridge = |c: usize| (5 * c + 4, 5 * ((c + 1) % n_cliques));
    unit(5 * n_cliques, (0..n_cliques).flat_map(|c| clique(c).chain([bridge(c)])))
}

/// Nodes are linked when their numbers differ in one binary digit.
pub fn hypercube(n_digits: usize) -> Network {
    let bits = move |i: usize| (0..n_digits).map(move |k| (i, i ^ (1 << k)));
    unit(1 << n_digits, (0..1 << n_digits).flat_map(bits).filter(|(i, j)| i < j))
}

pub fn complete_bipartite(n_left: usize, n_right: usize) -> Network {
    let from = move |i: usize| (n_left..n_left + n_right).map(move |j| (i, j));
    unit(n_left + n_right, (0..n_left).flat_map(from))
}

/// A square grid with open ends.
pub fn grid(side: usize) -> Network {
    let cells = (0..side).flat_map(|i| (0..side).map(move |j| (i, j)));
    let links = cells.flat_map(move |(i, j)| {
        let right = (j + 1 < side).then(|| (i * side + j, i * side + j + 1));
        let down = (i + 1 < side).then(|| (i * side + j, (i + 1) * side + j));
        right.into_iter().chain(down)
    });
    unit(side * side, links)
}

/// The leading eigenvalues 2 (cos πa/side − 1) + 2 (cos πb/side − 1) of a square grid, descending.
pub fn grid_eigenvalues(side: usize, n_modes: usize) -> Vec<f64> {
    // −4 sin² loses no digits near 0. Modes with a + b beyond n_modes are not among the leading.
    let along = |a: usize| -4.0 * (0.5 * PI * a as f64 / side as f64).sin().powi(2);
    let top = n_modes.min(side);
    let mut values = descending((0..top).flat_map(|a| (0..top).map(move |b| along(a) + along(b))));
    values.truncate(n_modes);
    values
}

/// The network of the paper's Fig. 1(a1).
pub fn six_node() -> Network {
    let unit_links = [(1, 2), (1, 4), (1, 6), (2, 3), (3, 4), (4, 5), (5, 6)];
    let mut links: Vec<_> = unit_links.iter().map(|&(i, j)| (i - 1, j - 1, 1.0)).collect();
    links.extend([(1, 5, 1.5), (2, 4, 1.5)]);
    network(6, &links)
}

/// The Nepal power grid of the paper's Fig. 1(b1).
pub fn nepal() -> Network {
    let (left, middle, right) = (1..=5, 6..=8, 9..=13);
    let within = |nodes: std::ops::RangeInclusive<usize>| {
        nodes.clone().flat_map(move |i| (*nodes.start()..i).map(move |j| (i, j)))
    };
    let to_middle = left.clone().chain(right.clone()).chain([14]);
    let links = within(left)
        .chain(within(middle.clone()))
        .chain(within(right.clone()))
        .chain(to_middle.flat_map(move |i| middle.clone().map(move |j| (i, j))))
        .chain(right.map(|i| (14, i)))
        .chain([(14, 15)]);
    unit(15, links.map(|(i, j)| (i - 1, j - 1)))
}

/// Eigenvalues 2 (cos 2πa/side − 1) + 2 (cos 2πb/side − 1) of a torus, descending.
pub fn torus_eigenvalues(side: usize) -> Vec<f64> {
    let along = |a: usize| 2.0 * ((2.0 * PI * a as f64 / side as f64).cos() - 1.0);
    descending((0..side).flat_map(|a| (0..side).map(move |b| along(a) + along(b))))
}

pub fn descending(values: impl IntoIterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(|a, b| b.total_cmp(a));
    values
}

pub fn dense() -> Request {
    with(Solver::Dense, Modes::All)
}

pub fn arpack(n_modes: usize) -> Request {
    with(Solver::Arpack, Modes::Leading(n_modes))
}

pub fn with(solver: impl Into<Option<Solver>>, modes: Modes) -> Request {
    Request { modes, solver: solver.into(), ..Request::default() }
}

/// Every solver that was built.
pub static BUILT: LazyLock<Vec<Solver>> =
    LazyLock::new(|| Solver::ALL.iter().copied().filter(|solver| solver.is_built()).collect());

/// Those of them that are iterative.
pub static ITERATIVE: LazyLock<Vec<Solver>> =
    LazyLock::new(|| BUILT.iter().copied().filter(|solver| !solver.is_dense()).collect());

/// A spectrum mode by mode, as closed forms are stated.
#[derive(Clone, Debug)]
pub struct ByMode {
    pub eigenvalues: Vec<f64>,
    pub eigenvectors: Vec<Vec<f64>>,
    pub residuals: Vec<f64>,
    pub eigenspaces: Vec<Range<usize>>,
    pub tolerance: f64,
    pub cutoff: Option<f64>,
    pub solver: Solver,
    pub products: usize,
    pub verification: Verification,
}

pub fn by_mode(spectrum: &Spectrum) -> ByMode {
    let modes = spectrum.real_modes();
    ByMode {
        eigenvectors: modes.eigenvectors.iter().map(|v| v.to_vec()).collect(),
        eigenvalues: modes.eigenvalues,
        residuals: modes.residuals,
        eigenspaces: modes.eigenspaces,
        tolerance: spectrum.tolerance,
        cutoff: spectrum.cutoff,
        solver: spectrum.solver,
        products: spectrum.products,
        verification: spectrum.verification,
    }
}

/// Solves, and checks what every spectrum must satisfy.
pub fn solve(w: &CouplingMatrix, request: &Request) -> ByMode {
    let spectrum = leading_modes(w, request).unwrap();
    check_separations(w, &spectrum);
    let spectrum = by_mode(&spectrum);
    check_spectrum(w, &spectrum);
    spectrum
}

/// Eigenspaces lie as far apart as they say, and know of what was not computed.
fn check_separations(w: &CouplingMatrix, spectrum: &Spectrum) {
    let values: Vec<f64> = spectrum.eigenspaces.iter().map(|s| s.eigenvalue().re).collect();
    for (k, space) in spectrum.eigenspaces.iter().enumerate() {
        let others = values.iter().enumerate().filter(|&(other, _)| other != k);
        let nearest = others.map(|(_, l)| (l - values[k]).abs()).fold(f64::INFINITY, f64::min);
        assert!(space.separation <= nearest + 1e-15 * scale(w), "{} > {nearest}", space.separation);
        assert!(space.separation > 0.0 && space.multiplicity() == space.basis.len());
        if k + 1 < values.len() || spectrum.is_whole() {
            let rounding = 2.0 * spectrum.tolerance.max(1e-12 * scale(w));
            let close = nearest - space.separation <= rounding || nearest == f64::INFINITY;
            assert!(close, "{nearest} is said to be {}", space.separation);
        }
    }
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    // In parts, so that rounding does not grow with the length of long vectors.
    let part = |(a, b): (&[f64], &[f64])| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    a.chunks(300).zip(b.chunks(300)).map(part).sum()
}

/// max_i |w_ii|.
pub fn scale(w: &CouplingMatrix) -> f64 {
    let largest = w.matrix().iter().fold(0.0f64, |largest, (w_ij, _)| largest.max(w_ij.abs()));
    if largest > 0.0 { largest } else { 1.0 }
}

/// √(max k_i / min k_i): by how much D^{-1/2} may enlarge a residual.
pub fn condition(w: &CouplingMatrix) -> f64 {
    let scale = w.symmetric_form().unwrap().scale();
    let largest = scale.iter().copied().fold(0.0, f64::max);
    largest / scale.iter().copied().fold(f64::INFINITY, f64::min)
}

fn check_spectrum(w: &CouplingMatrix, spectrum: &ByMode) {
    let ByMode { eigenvalues, eigenvectors, residuals, eigenspaces, tolerance, .. } = spectrum;
    assert_eq!((eigenvectors.len(), residuals.len()), (eigenvalues.len(), eigenvalues.len()));
    assert!(eigenvalues.windows(2).all(|pair| pair[0] >= pair[1]), "{eigenvalues:?}");
    check_residuals(w, spectrum);
    let covered: Vec<usize> = eigenspaces.iter().cloned().flatten().collect();
    assert_eq!(covered, (0..eigenvalues.len()).collect::<Vec<_>>());
    // Those that the tolerance does not tell from 0 are told apart on their own scale.
    let n_slow = 1 + eigenvalues.windows(2).take_while(|p| p[0] - p[1] <= *tolerance).count();
    for pair in eigenspaces.windows(2) {
        let gap = eigenvalues[pair[0].end - 1] - eigenvalues[pair[1].start];
        let least = if pair[1].start < n_slow { 0.0 } else { *tolerance };
        assert!(gap > least, "{gap} is within {least}");
    }
    for range in eigenspaces {
        check_orthonormal(&eigenvectors[range.clone()]);
    }
    eigenvectors.iter().for_each(|v| check_sign(v));
}

fn check_residuals(w: &CouplingMatrix, spectrum: &ByMode) {
    let bound = 1e-12 * scale(w) * condition(w);
    for ((lambda, v), reported) in
        spectrum.eigenvalues.iter().zip(&spectrum.eigenvectors).zip(&spectrum.residuals)
    {
        let mut image = vec![0.0; v.len()];
        mul_acc_mat_vec_csr(w.matrix().view(), v.as_slice(), &mut image);
        let residual = image.iter().zip(v).map(|(y, x)| (y - lambda * x).powi(2)).sum::<f64>();
        assert!(residual.sqrt() <= bound, "{} > {bound} at {lambda}", residual.sqrt());
        assert!((residual.sqrt() - reported).abs() <= 1e-14 * scale(w) * condition(w));
    }
}

fn check_orthonormal(vectors: &[Vec<f64>]) {
    for (i, v) in vectors.iter().enumerate() {
        for (j, other) in vectors.iter().enumerate() {
            let expected = if i == j { 1.0 } else { 0.0 };
            assert!((dot(v, other) - expected).abs() < 1e-13, "{i} {j}: {}", dot(v, other));
        }
    }
}

fn check_sign(v: &[f64]) {
    let largest = v.iter().fold(0.0f64, |largest, v_i| largest.max(v_i.abs()));
    let decides = v.iter().find(|v_i| v_i.abs() >= (1.0 - 1e-6) * largest).unwrap();
    assert!(*decides > 0.0, "{v:?}");
}

/// Asserts |λ_k − expected_k| ≤ bound for the modes computed.
pub fn check_eigenvalues(spectrum: &ByMode, expected: &[f64], bound: f64) {
    assert!(spectrum.eigenvalues.len() <= expected.len());
    for (k, (lambda, expected)) in spectrum.eigenvalues.iter().zip(expected).enumerate() {
        assert!((lambda - expected).abs() <= bound, "λ_{} = {lambda}, not {expected}", k + 1);
    }
}
