//! Networks at the edge of what is sensible: tiny, in pieces, or with weights of all sizes.

mod common;

use std::iter;

use common::{BOTH, BUILT, ITERATIVE, check_eigenvalues, dense, network, scale, solve, with};
use graph::{CouplingMatrix, Normalization};
use spectra::{Modes, Solver, SpectraError, leading_modes, smallest_eigenvalue};

/// Every solver that was built, and the free choice.
fn every() -> impl Iterator<Item = Option<Solver>> {
    iter::once(None).chain(BUILT.iter().copied().map(Some))
}

/// Whether all modes can be asked of it.
fn finds_all(solver: &Option<Solver>) -> bool {
    solver.is_none_or(Solver::finds_all)
}

#[test]
fn one_node_has_one_mode_by_every_solver_that_finds_all() {
    for normalization in BOTH {
        let w = CouplingMatrix::new(&network(1, &[]), normalization);
        for solver in every().filter(finds_all) {
            for modes in [Modes::Leading(1), Modes::All, Modes::Above(-1.0)] {
                let spectrum = solve(&w, &with(solver, modes));
                assert_eq!(spectrum.eigenvalues, [0.0]);
                assert_eq!(spectrum.eigenvectors, [[1.0]]);
            }
        }
    }
}

#[test]
fn two_nodes_have_their_modes_by_every_solver() {
    let w = CouplingMatrix::new(&network(2, &[(0, 1, 0.7)]), Normalization::Laplacian);
    for solver in every() {
        assert_eq!(solve(&w, &with(solver, Modes::Leading(1))).eigenvalues.len(), 1);
        assert_eq!(solve(&w, &with(solver, Modes::Above(-1.0))).eigenvalues.len(), 1);
        if finds_all(&solver) {
            let all = solve(&w, &with(solver, Modes::All));
            check_eigenvalues(&all, &[0.0, -1.4], 1e-15);
        }
    }
}

#[test]
fn pieces_and_isolated_nodes_are_copies_of_zero() {
    // A triangle, a pair, a path of three, and four nodes on their own: seven components.
    let links = [(0, 1), (1, 2), (2, 0), (3, 4), (5, 6), (6, 7)];
    let links: Vec<_> = links.iter().map(|&(i, j)| (i, j, 1.0)).collect();
    let pieces = network(12, &links);
    for normalization in BOTH {
        let w = CouplingMatrix::new(&pieces, normalization);
        let all = solve(&w, &dense());
        for solver in every() {
            for n_modes in [1, 8, 10] {
                let leading = solve(&w, &with(solver, Modes::Leading(n_modes)));
                assert_eq!(leading.eigenspaces[0], 0..7, "{solver:?}");
                check_eigenvalues(&leading, &all.eigenvalues, 1e-13);
            }
        }
    }
}

#[test]
fn more_pieces_than_may_be_returned_are_refused() {
    let w = CouplingMatrix::new(&network(3000, &[(0, 1, 1.0)]), Normalization::Laplacian);
    for &solver in ITERATIVE.iter() {
        assert!(matches!(
            leading_modes(&w, &with(solver, Modes::Leading(5))),
            Err(SpectraError::EigenspaceTooLarge { requested: 5, found: 2999, .. })
        ));
        assert!(matches!(
            leading_modes(&w, &with(solver, Modes::Above(-1.0))),
            Err(SpectraError::TooManyAbove { found: 2999, .. })
        ));
    }
}

/// A ring with chords whose weights go from 10⁻⁶ to 10⁶.
fn uneven(n_nodes: usize) -> graph::Network {
    let weight = |k: usize| 10f64.powf(12.0 * (k * 7919 % 1000) as f64 / 999.0 - 6.0);
    let ring = (0..n_nodes).map(|i| (i, (i + 1) % n_nodes, weight(i)));
    let chords = (0..n_nodes / 3).map(|i| (i, (i + n_nodes / 2) % n_nodes, weight(3 * i + 1)));
    network(n_nodes, &ring.chain(chords).collect::<Vec<_>>())
}

#[test]
fn weights_over_twelve_orders_keep_eigenvalues_to_the_tolerance_of_the_strongest() {
    for normalization in BOTH {
        let w = CouplingMatrix::new(&uneven(120), normalization);
        let all = solve(&w, &dense());
        for solver in [Solver::Chebyshev, Solver::ShiftInvert] {
            let leading = solve(&w, &with(solver, Modes::Leading(30)));
            check_eigenvalues(&leading, &all.eigenvalues, 2e-12 * scale(&w));
            let whole = all.eigenspaces.iter().find(|range| range.end >= 30).unwrap().end;
            assert_eq!(leading.eigenvalues.len(), whole, "{solver:?}");
        }
    }
}

#[test]
fn what_is_weaker_than_the_tolerance_has_an_eigenvalue_of_its_own() {
    // Two strong pairs behind a link 10⁻¹² as strong: 1e-6 (1/2 + 1/2) against each other.
    let w = CouplingMatrix::new(
        &network(4, &[(0, 1, 1e6), (2, 3, 1e6), (1, 2, 1e-6)]),
        Normalization::Laplacian,
    );
    for solver in every() {
        let spectrum = solve(&w, &with(solver, Modes::Leading(1)));
        assert_eq!(spectrum.eigenspaces, [0..1, 1..2], "{solver:?}");
        check_eigenvalues(&spectrum, &[0.0, -1e-6], 1e-15);
        assert!(spectrum.tolerance >= 1e-10 * 1e6);
    }
}

#[test]
fn the_smallest_eigenvalue_by_itself_is_that_of_the_whole_spectrum() {
    let star: Vec<_> = (1..50).map(|leaf| (0, leaf, 1.0)).collect();
    let ring: Vec<_> = (0..400).map(|i| (i, (i + 1) % 400, 1.0 + (i % 7) as f64)).collect();
    let pieces = [(0, 1, 1.0), (2, 3, 5.0)];
    for (n, links) in [(50, &star[..]), (400, &ring), (6, &pieces), (3, &[])] {
        for normalization in BOTH {
            let w = CouplingMatrix::new(&network(n, links), normalization);
            let expected = solve(&w, &dense()).eigenvalues[n - 1];
            let found = smallest_eigenvalue(&w).unwrap();
            assert!((found - expected).abs() < 1e-6 * scale(&w), "{found} for {expected}");
        }
    }
    // The hub and its 49 leaves: −N.
    let w = CouplingMatrix::new(&network(50, &star), Normalization::Laplacian);
    assert!((smallest_eigenvalue(&w).unwrap() + 50.0).abs() < 1e-9);
}
