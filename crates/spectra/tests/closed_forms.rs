//! Spectra that are known in closed form, by every solver.

mod common;

use std::f64::consts::PI;

use common::{
    BOTH, BUILT, ByMode, ITERATIVE, check_eigenvalues, complete, complete_bipartite, dense,
    descending, grid, grid_eigenvalues, hypercube, nepal, network, path, ring, ring_of_cliques,
    scale, six_node, solve, star, torus, torus_eigenvalues, with,
};
use graph::{CouplingMatrix, Network, Normalization};
use spectra::{Modes, Request, Solver, Verification};

/// Asserts that the number of modes has been verified, and by the means that there are.
fn check_verified(spectrum: &ByMode, n_nodes: usize) {
    match spectrum.verification {
        // Of small networks a block method's basis is one of all space.
        Verification::Dense => assert!(spectrum.solver == Solver::Dense || n_nodes <= 200),
        Verification::Inertia { count } => assert_eq!(count, spectrum.eigenvalues.len()),
        Verification::Probed { confidence, .. } => assert!(confidence > 0.999, "{confidence}"),
    }
}

/// Compares all modes by the dense solver, and several leading counts by all, with λ_1 ≥ λ_2 ≥ ….
fn check_closed_form(network: &Network, normalization: Normalization, expected: &[f64]) {
    let w = CouplingMatrix::new(network, normalization);
    let (n_nodes, bound) = (w.n_nodes(), 1e-13 * scale(&w));
    let all = solve(&w, &dense());
    assert_eq!((all.eigenvalues.len(), all.solver, all.products), (n_nodes, Solver::Dense, 0));
    check_eigenvalues(&all, expected, bound);
    for n_modes in [1, 2, n_nodes / 2, n_nodes - 1].into_iter().filter(|&m| 0 < m && m < n_nodes) {
        let modes = Modes::Leading(n_modes);
        let whole = all.eigenspaces.iter().find(|range| range.end >= n_modes).unwrap().end;
        for &solver in BUILT.iter() {
            let leading = solve(&w, &with(solver, modes));
            assert_eq!(leading.solver, solver);
            assert_eq!(leading.eigenvalues.len(), whole, "{n_modes} modes of {n_nodes}");
            check_eigenvalues(&leading, expected, bound);
            check_verified(&leading, n_nodes);
        }
    }
}

/// Sizes of the eigenspaces, from the largest eigenvalue down.
fn multiplicities(spectrum: &ByMode) -> Vec<usize> {
    spectrum.eigenspaces.iter().map(std::iter::ExactSizeIterator::len).collect()
}

#[test]
fn a_single_node_has_the_eigenvalue_zero() {
    for normalization in BOTH {
        let w = CouplingMatrix::new(&network(1, &[]), normalization);
        let spectrum = solve(&w, &Request::default());
        assert_eq!(spectrum.eigenvalues, [0.0]);
        assert_eq!(spectrum.eigenvectors, [[1.0]]);
    }
}

#[test]
fn two_nodes_have_zero_and_minus_twice_the_weight() {
    let pair = network(2, &[(0, 1, 0.7)]);
    check_closed_form(&pair, Normalization::Laplacian, &[0.0, -1.4]);
    check_closed_form(&pair, Normalization::Normalized, &[0.0, -2.0]);
}

#[test]
fn a_star_has_minus_one_once_less_than_leaves() {
    let mut expected = [-1.0; 9];
    expected[0] = 0.0;
    check_closed_form(&star(9), Normalization::Laplacian, &[&expected[..], &[-10.0]].concat());
    check_closed_form(&star(9), Normalization::Normalized, &[&expected[..], &[-2.0]].concat());
}

#[test]
fn a_complete_graph_has_two_eigenvalues() {
    let with = |lambda: f64| [&[0.0][..], &[lambda; 11]].concat();
    check_closed_form(&complete(12), Normalization::Laplacian, &with(-12.0));
    check_closed_form(&complete(12), Normalization::Normalized, &with(-12.0 / 11.0));
}

#[test]
fn a_path_has_cosines_of_half_turns() {
    let n = 17;
    let cosines = |steps: f64| (0..n).map(move |k| (PI * f64::from(k) / steps).cos() - 1.0);
    let laplacian = descending(cosines(f64::from(n)).map(|c| 2.0 * c));
    check_closed_form(&path(17), Normalization::Laplacian, &laplacian);
    check_closed_form(&path(17), Normalization::Normalized, &descending(cosines(f64::from(n - 1))));
}

#[test]
fn a_ring_has_cosines_of_whole_turns_in_pairs() {
    let cosines = |k: u32| (2.0 * PI * f64::from(k) / 18.0).cos() - 1.0;
    let normalized = descending((0..18).map(cosines));
    let laplacian: Vec<f64> = normalized.iter().map(|c| 2.0 * c).collect();
    check_closed_form(&ring(18), Normalization::Laplacian, &laplacian);
    check_closed_form(&ring(18), Normalization::Normalized, &normalized);
    let w = CouplingMatrix::new(&ring(18), Normalization::Laplacian);
    assert_eq!(multiplicities(&solve(&w, &dense())), [1, 2, 2, 2, 2, 2, 2, 2, 2, 1]);
}

#[test]
fn a_network_without_links_is_one_eigenspace() {
    for normalization in BOTH {
        check_closed_form(&network(5, &[]), normalization, &[0.0; 5]);
    }
}

#[test]
fn the_six_node_network_has_the_integers() {
    let expected = [0.0, -2.0, -3.0, -4.0, -5.0, -6.0];
    check_closed_form(&six_node(), Normalization::Laplacian, &expected);
}

#[test]
fn nepal_has_eight_four_times_nine_four_times_and_fourteen_twice() {
    let w = CouplingMatrix::new(&nepal(), Normalization::Laplacian);
    // The paper prints the simple ones to two decimals.
    let simple = [(0, 0.0), (1, -0.94), (2, -3.10), (11, -9.94), (14, -14.03)];
    let leading = |solver| with(solver, Modes::Leading(14));
    for request in ITERATIVE.iter().copied().map(leading).chain([dense()]) {
        let spectrum = solve(&w, &request);
        for &(k, printed) in simple.iter().filter(|(k, _)| *k < spectrum.eigenvalues.len()) {
            assert!((spectrum.eigenvalues[k] - printed).abs() < 0.005);
        }
        for (range, lambda) in [(3..7, -8.0), (7..11, -9.0), (12..14, -14.0)] {
            assert!(spectrum.eigenspaces.contains(&range), "{:?}", spectrum.eigenspaces);
            assert!(spectrum.eigenvalues[range].iter().all(|l| (l - lambda).abs() < 1e-12));
        }
    }
    assert_eq!(multiplicities(&solve(&w, &dense())), [1, 1, 1, 4, 4, 1, 2, 1]);
    for &solver in ITERATIVE.iter() {
        assert_eq!(multiplicities(&solve(&w, &with(solver, Modes::Leading(5)))), [1, 1, 1, 4]);
    }
}

#[test]
fn a_hypercube_has_binomial_multiplicities() {
    let binomial = [1, 6, 15, 20, 15, 6, 1];
    let laplacian: Vec<f64> =
        (0..7u8).flat_map(|k| vec![-2.0 * f64::from(k); binomial[usize::from(k)]]).collect();
    let normalized: Vec<f64> = laplacian.iter().map(|l| l / 6.0).collect();
    check_closed_form(&hypercube(6), Normalization::Laplacian, &laplacian);
    check_closed_form(&hypercube(6), Normalization::Normalized, &normalized);
}

#[test]
fn a_complete_bipartite_network_has_four_eigenvalues() {
    let runs = |parts: &[(f64, usize)]| -> Vec<f64> {
        parts.iter().flat_map(|&(value, count)| vec![value; count]).collect()
    };
    let laplacian = runs(&[(0.0, 1), (-7.0, 11), (-12.0, 6), (-19.0, 1)]);
    check_closed_form(&complete_bipartite(12, 7), Normalization::Laplacian, &laplacian);
    let normalized = runs(&[(0.0, 1), (-1.0, 17), (-2.0, 1)]);
    check_closed_form(&complete_bipartite(12, 7), Normalization::Normalized, &normalized);
}

#[test]
fn a_square_grid_has_sums_of_those_of_a_path() {
    let all = grid_eigenvalues(12, 144);
    assert_eq!(all.len(), 144);
    check_closed_form(&grid(12), Normalization::Laplacian, &all);
}

#[test]
fn no_solver_loses_any_of_the_leading_torus_modes() {
    let w = CouplingMatrix::new(&torus(40), Normalization::Laplacian);
    let expected = torus_eigenvalues(40);
    for (solver, n_modes) in
        ITERATIVE.iter().copied().flat_map(|solver| [(solver, 10), (solver, 41)])
    {
        let spectrum = solve(&w, &with(solver, Modes::Leading(n_modes)));
        check_eigenvalues(&spectrum, &expected, 1e-12);
        // Pairs (a, b) and signs: the eigenvalue continues as long as the closed form does.
        let n = spectrum.eigenvalues.len();
        assert!(n >= n_modes && expected[n - 1] - expected[n] > 1e-6);
        assert!(expected[n_modes - 1] - expected[n - 1] < 1e-9);
        check_verified(&spectrum, 1600);
    }
}

#[test]
fn no_solver_loses_any_of_two_hundred_joined_cliques() {
    let w = CouplingMatrix::new(&ring_of_cliques(200), Normalization::Laplacian);
    let all = solve(&w, &dense());
    for (solver, n_modes) in
        ITERATIVE.iter().copied().flat_map(|solver| [(solver, 40), (solver, 200)])
    {
        let leading = solve(&w, &with(solver, Modes::Leading(n_modes)));
        let n = leading.eigenspaces.len();
        assert_eq!(leading.eigenspaces, all.eigenspaces[..n]);
        assert!(all.eigenspaces[n - 1].contains(&(n_modes - 1)));
        check_eigenvalues(&leading, &all.eigenvalues, 1e-11);
    }
}

#[test]
fn the_grid_of_ninety_thousand_nodes_keeps_its_pairs_by_shift_invert() {
    let w = CouplingMatrix::new(&grid(300), Normalization::Laplacian);
    let spectrum = solve(&w, &with(None, Modes::Leading(10)));
    assert_eq!(spectrum.solver, Solver::ShiftInvert);
    check_eigenvalues(&spectrum, &grid_eigenvalues(300, 12), 1e-13);
    assert_eq!(multiplicities(&spectrum), [1, 2, 1, 2, 2, 1, 2]);
    assert_eq!(spectrum.verification, Verification::Inertia { count: 11 });
}

#[test]
fn the_path_of_a_hundred_thousand_nodes_has_simple_eigenvalues_a_billionth_apart() {
    let n = 100_000;
    let w = CouplingMatrix::new(&path(n), Normalization::Laplacian);
    let spectrum = solve(&w, &with(None, Modes::Leading(10)));
    assert_eq!(spectrum.solver, Solver::ShiftInvert);
    let expected: Vec<f64> =
        (0..11).map(|k| -4.0 * (0.5 * PI * f64::from(k) / n as f64).sin().powi(2)).collect();
    check_eigenvalues(&spectrum, &expected, 1e-14);
    assert_eq!(multiplicities(&spectrum), [1; 10]);
    assert_eq!(spectrum.verification, Verification::Inertia { count: 10 });
}

#[test]
fn the_trace_is_the_sum_of_all_eigenvalues() {
    for (network, normalization) in [(nepal(), BOTH[0]), (nepal(), BOTH[1]), (star(300), BOTH[0])] {
        let w = CouplingMatrix::new(&network, normalization);
        let spectrum = solve(&w, &Request { modes: Modes::All, ..Request::default() });
        let trace: f64 = w.matrix().diag().iter().map(|(_, w_ii)| w_ii).sum();
        let sum: f64 = spectrum.eigenvalues.iter().sum();
        assert!((sum - trace).abs() < 1e-12 * trace.abs(), "{sum} {trace}");
    }
}
