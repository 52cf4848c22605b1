//! Spectra that are known in closed form, by both solvers.

mod common;

use std::f64::consts::PI;

use common::{
    BOTH, arpack, check_eigenvalues, complete, dense, descending, nepal, network, path, ring,
    ring_of_cliques, scale, six_node, solve, star, torus, torus_eigenvalues,
};
use graph::{CouplingMatrix, Network, Normalization};
use spectra::{Modes, Request, Solver, Spectrum};

/// Compares all modes by the dense solver, and several leading counts by both, with λ_1 ≥ λ_2 ≥ ….
fn check_closed_form(network: &Network, normalization: Normalization, expected: &[f64]) {
    let w = CouplingMatrix::new(network, normalization);
    let (n_nodes, bound) = (w.n_nodes(), 1e-13 * scale(&w));
    let all = solve(&w, &dense());
    assert_eq!((all.eigenvalues.len(), all.solver, all.products), (n_nodes, Solver::Dense, 0));
    check_eigenvalues(&all, expected, bound);
    for n_modes in [1, 2, n_nodes / 2, n_nodes - 1].into_iter().filter(|&m| 0 < m && m < n_nodes) {
        let modes = Modes::Leading(n_modes);
        let whole = all.eigenspaces.iter().find(|range| range.end >= n_modes).unwrap().end;
        for (request, solver) in
            [(Request { modes, ..dense() }, Solver::Dense), (arpack(n_modes), Solver::Arpack)]
        {
            let leading = solve(&w, &request);
            assert_eq!(leading.solver, solver);
            assert_eq!(leading.eigenvalues.len(), whole, "{n_modes} modes of {n_nodes}");
            check_eigenvalues(&leading, expected, bound);
        }
    }
}

/// Sizes of the eigenspaces, from the largest eigenvalue down.
fn multiplicities(spectrum: &Spectrum) -> Vec<usize> {
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
    for request in [dense(), arpack(14)] {
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
    assert_eq!(multiplicities(&solve(&w, &arpack(5))), [1, 1, 1, 4]);
}

#[test]
fn arpack_loses_none_of_the_leading_torus_modes() {
    let w = CouplingMatrix::new(&torus(40), Normalization::Laplacian);
    let expected = torus_eigenvalues(40);
    for n_modes in [10, 41] {
        let spectrum = solve(&w, &arpack(n_modes));
        check_eigenvalues(&spectrum, &expected, 1e-12);
        // Pairs (a, b) and signs: the eigenvalue continues as long as the closed form does.
        let n = spectrum.eigenvalues.len();
        assert!(n >= n_modes && expected[n - 1] - expected[n] > 1e-6);
        assert!(expected[n_modes - 1] - expected[n - 1] < 1e-9);
    }
}

#[test]
fn arpack_loses_none_of_two_hundred_joined_cliques() {
    let w = CouplingMatrix::new(&ring_of_cliques(200), Normalization::Laplacian);
    let all = solve(&w, &dense());
    for n_modes in [40, 200] {
        let leading = solve(&w, &arpack(n_modes));
        let n = leading.eigenspaces.len();
        assert_eq!(leading.eigenspaces, all.eigenspaces[..n]);
        assert!(all.eigenspaces[n - 1].contains(&(n_modes - 1)));
        check_eigenvalues(&leading, &all.eigenvalues, 1e-11);
    }
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
