//! Weights over many decades: the number of zero modes is that of the components, whatever rounding
//! beside the largest weight leaves of the others.

mod common;

use common::{BOTH, BUILT, ByMode, by_mode, network};
use graph::{CouplingMatrix, Network, Normalization};
use spectra::{Modes, Request, Solver, leading_modes};

fn solved(network: &Network, normalization: Normalization, n: usize, by: Solver) -> ByMode {
    let w = CouplingMatrix::new(network, normalization);
    let request = Request { modes: Modes::Leading(n), solver: Some(by), ..Request::default() };
    by_mode(&leading_modes(&w, &request).unwrap_or_else(|error| panic!("{by:?}: {error}")))
}

#[track_caller]
fn check_close(found: f64, expected: f64, relative: f64) {
    assert!((found / expected - 1.0).abs() < relative, "{found:e} instead of {expected:e}");
}

/// Two rings of 40 strong links each, tied by one weak link.
fn tied_rings(first: usize, strong: f64, weak: f64) -> Vec<(usize, usize, f64)> {
    let ring = |start: usize| (0..40).map(move |k| (start + k, start + (k + 1) % 40, strong));
    ring(first).chain(ring(first + 40)).chain([(first, first + 40, weak)]).collect()
}

#[test]
fn a_node_tied_by_a_link_twelve_decades_weaker_has_an_eigenvalue_of_its_own() {
    // a — b by 1.4e12, c to b by 1: c against the pair, λ = −(1 + 1/2) up to 1e-12.
    let network = network(3, &[(0, 1, 1.4e12), (1, 2, 1.0)]);
    let found = by_mode(
        &leading_modes(
            &CouplingMatrix::new(&network, Normalization::Laplacian),
            &Request::default(),
        )
        .unwrap(),
    );
    assert_eq!(found.eigenspaces, [0..1, 1..2, 2..3]);
    assert_eq!(found.eigenvalues[0], 0.0);
    check_close(found.eigenvalues[1], -1.5, 1e-11);
    check_close(found.eigenvalues[2], -2.8e12, 1e-11);
    check_close(found.eigenvectors[1][2], (2.0f64 / 3.0).sqrt(), 1e-11);
}

#[test]
fn zero_modes_are_as_many_as_components_by_every_solver() {
    // Two tied pairs of rings and a node alone: three components.
    let mut links = tied_rings(0, 1e12, 1.0);
    links.extend(tied_rings(80, 1e12, 3.0));
    let network = network(161, &links);
    for solver in BUILT.iter().copied() {
        let found = solved(&network, Normalization::Laplacian, 5, solver);
        assert_eq!(found.eigenspaces[..3], [0..3, 3..4, 4..5], "{solver:?}");
        assert_eq!(found.eigenvalues[..3], [0.0; 3]);
        // Rings against each other: weak (1/40 + 1/40).
        check_close(found.eigenvalues[3], -0.05, 1e-6);
        check_close(found.eigenvalues[4], -0.15, 1e-6);
        // Strengths are 2e12 nearly everywhere.
        let found = solved(&network, Normalization::Normalized, 5, solver);
        assert_eq!(found.eigenspaces[..3], [0..3, 3..4, 4..5], "{solver:?}");
        check_close(found.eigenvalues[3], -0.05 / 2e12, 1e-6);
        check_close(found.eigenvalues[4], -0.15 / 2e12, 1e-6);
    }
}

#[test]
fn links_of_every_decade_have_eigenvalues_of_their_own() {
    // A path whose links weaken by a factor of 10³ each: the last nodes of what is left of a cut
    // at link k of weight w_k against all k + 1 nodes before it, λ ≈ −w_k (1 + 1/(k + 1)).
    let n = 8;
    let links: Vec<_> = (1..n).map(|k| (k - 1, k, 1e15 * 1e-3f64.powi(k as i32 - 1))).collect();
    for normalization in BOTH {
        let w = CouplingMatrix::new(&network(n, &links), normalization);
        let found = by_mode(&leading_modes(&w, &Request::default()).unwrap());
        assert_eq!(found.eigenspaces.len(), n, "{:?}", found.eigenvalues);
        assert!(found.eigenvalues[1..].iter().all(|&lambda| lambda < 0.0));
        if normalization == Normalization::Laplacian {
            for (k, &lambda) in found.eigenvalues.iter().rev().enumerate().take(n - 1) {
                check_close(
                    lambda,
                    -1e15 * 1e-3f64.powi(k as i32) * (1.0 + 1.0 / (k + 1) as f64),
                    1e-2,
                );
            }
        }
    }
}

#[test]
fn copies_of_a_weak_eigenvalue_are_one_eigenspace() {
    // Three nodes tied by equal weak links to one of a strong pair: λ = −w twice, and once with it.
    let links = [(0, 1, 1e13), (0, 2, 2.0), (0, 3, 2.0), (0, 4, 2.0)];
    let w = CouplingMatrix::new(&network(5, &links), Normalization::Laplacian);
    let found = by_mode(&leading_modes(&w, &Request::default()).unwrap());
    assert_eq!(found.eigenspaces, [0..1, 1..3, 3..4, 4..5]);
    check_close(found.eigenvalues[1], -2.0, 1e-10);
    // Against the pair as one node of twice the mass: −2 (1 + 3/2).
    check_close(found.eigenvalues[3], -5.0, 1e-10);
}
