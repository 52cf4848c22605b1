//! How the solvers behave: agreement of two routes, repeats, threads, bounds on the work, bad requests.

mod common;

use std::ops::Range;

use common::{
    BOTH, ByMode, ITERATIVE, arpack, check_eigenvalues, complete, condition, dense, dot, network,
    scale, solve, star, torus,
};
use graph::generators::{LinkProbability, communities};
use graph::{CouplingMatrix, Network, Normalization};
use proptest::prelude::*;
use spectra::{Modes, Request, Solver, SpectraError, leading_modes};

/// Asserts that every eigenspace of `leading` is the same subspace of node space as in `all`, up to
/// what the residuals and the gap to its neighbours allow (Davis & Kahan).
fn check_same_eigenspaces(w: &CouplingMatrix, leading: &ByMode, all: &ByMode) {
    for (range, other) in leading.eigenspaces.iter().zip(&all.eigenspaces) {
        assert_eq!(range, other);
        let residual = largest(&leading.residuals) + largest(&all.residuals);
        let bound = 1e-10f64.max(8.0 * condition(w).powi(2) * residual / gap(all, range));
        let distance = projector_distance(&leading.eigenvectors, &all.eigenvectors, range);
        assert!(distance <= bound, "projectors on {range:?} differ by {distance} > {bound}");
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

/// Distance from an eigenspace to the nearest other eigenvalue.
fn gap(all: &ByMode, range: &Range<usize>) -> f64 {
    let lambda = &all.eigenvalues;
    let above =
        range.start.checked_sub(1).map_or(f64::INFINITY, |k| lambda[k] - lambda[range.start]);
    let below = lambda.get(range.end).map_or(f64::INFINITY, |l| lambda[range.end - 1] - l);
    above.min(below)
}

/// ‖V Vᵀ − U Uᵀ‖ in the Frobenius norm, from the principal angles: 2 (d − ‖Vᵀ U‖²) would lose half
/// the digits, so we sum the squares of U − V Vᵀ U instead.
fn projector_distance(v: &[Vec<f64>], u: &[Vec<f64>], range: &Range<usize>) -> f64 {
    let sine_squared = |u_k: &Vec<f64>| {
        let mut rest = u_k.clone();
        for v_k in &v[range.clone()] {
            let overlap = dot(v_k, u_k);
            rest.iter_mut().zip(v_k).for_each(|(r, v)| *r -= overlap * v);
        }
        dot(&rest, &rest)
    };
    (2.0 * u[range.clone()].iter().map(sine_squared).sum::<f64>()).sqrt()
}

/// Networks of 2 to 30 nodes, sparse to dense, connected or not, unit or random weights.
fn any_network() -> impl Strategy<Value = Network> {
    (2..=30usize, 0.02..0.9f64, any::<bool>()).prop_flat_map(|(n_nodes, density, weighted)| {
        let n_pairs = n_nodes * (n_nodes - 1) / 2;
        let draws = proptest::collection::vec((0.0..1.0f64, 0.1..10.0f64), n_pairs);
        draws.prop_map(move |draws| {
            let pairs = (0..n_nodes).flat_map(|i| (0..i).map(move |j| (i, j)));
            let links: Vec<_> = pairs
                .zip(draws)
                .filter(|(_, (draw, _))| *draw < density)
                .map(|((i, j), (_, weight))| (i, j, if weighted { weight } else { 1.0 }))
                .collect();
            network(n_nodes, &links)
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn all_solvers_agree(network in any_network(), part in 0.0..1.0f64, seed in any::<u64>()) {
        for normalization in BOTH {
            let w = CouplingMatrix::new(&network, normalization);
            let all = solve(&w, &dense());
            let n_modes = (1 + (part * (w.n_nodes() - 1) as f64) as usize).min(w.n_nodes() - 1);
            for request in by_iteration(n_modes) {
                let leading = solve(&w, &Request { seed, ..request });
                check_eigenvalues(&leading, &all.eigenvalues, 1e-10 * scale(&w));
                check_same_eigenspaces(&w, &leading, &all);
            }
        }
    }

    #[test]
    fn zero_is_as_often_an_eigenvalue_as_there_are_components(network in any_network()) {
        let n_components = network.components().len();
        for normalization in BOTH {
            let w = CouplingMatrix::new(&network, normalization);
            for request in by_iteration(1).chain([dense()]) {
                let spectrum = solve(&w, &request);
                prop_assert_eq!(spectrum.eigenspaces[0].clone(), 0..n_components);
                prop_assert!(spectrum.eigenvalues[0].abs() < 1e-12 * scale(&w));
            }
        }
    }

    #[test]
    fn all_eigenvalues_sum_to_the_trace(network in any_network()) {
        for normalization in BOTH {
            let w = CouplingMatrix::new(&network, normalization);
            let trace: f64 = w.matrix().diag().iter().map(|(_, w_ii)| w_ii).sum();
            let sum: f64 = solve(&w, &dense()).eigenvalues.iter().sum();
            prop_assert!((sum - trace).abs() <= 1e-12 * scale(&w), "{} {}", sum, trace);
        }
    }
}

/// The bits of all that a spectrum reports.
fn bits(spectrum: &ByMode) -> (Vec<u64>, Vec<u64>, Vec<u64>, usize) {
    let of = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    let ByMode { eigenvalues, eigenvectors, residuals, products, .. } = spectrum;
    (of(eigenvalues), of(&eigenvectors.concat()), of(residuals), *products)
}

/// The request to every iterative solver.
fn by_iteration(n_modes: usize) -> impl Iterator<Item = Request> {
    ITERATIVE.iter().map(move |&solver| common::with(solver, Modes::Leading(n_modes)))
}

fn chebyshev(n_modes: usize) -> Request {
    common::with(Solver::Chebyshev, Modes::Leading(n_modes))
}

fn shift_invert(n_modes: usize) -> Request {
    common::with(Solver::ShiftInvert, Modes::Leading(n_modes))
}

/// Matrices on which solvers meet invariant spaces (complete graph, star) and on which it does not.
fn fixtures() -> Vec<(CouplingMatrix, Request)> {
    let with = |network: &Network, request| {
        (CouplingMatrix::new(network, Normalization::Laplacian), request)
    };
    let all = vec![
        with(&torus(12), arpack(20)),
        with(&complete(30), arpack(2)),
        with(&star(40), arpack(3)),
        with(&torus(12), dense()),
        with(&torus(12), chebyshev(20)),
        with(&star(40), chebyshev(3)),
        with(&complete(30), shift_invert(2)),
        with(&torus(60), chebyshev(9)),
        with(&torus(60), shift_invert(9)),
    ];
    all.into_iter().filter(|(_, request)| request.solver.is_none_or(Solver::is_built)).collect()
}

/// A ring of 400 nodes, which two of them cut in halves, with a leaf on every fifth, and a path of its own.
#[test]
fn halves_of_a_thin_cut_and_what_hangs_on_them_have_the_modes_of_the_dense_solver() {
    let around = (0..400).map(|i| (i, (i + 1) % 400, 1.0 + 0.01 * (i % 7) as f64));
    let leaves = (400..480).map(|i| (i, 5 * (i - 400), 1.0));
    let path = (480..499).map(|i| (i, i + 1, 2.0));
    let network = network(500, &around.chain(leaves).chain(path).collect::<Vec<_>>());
    for normalization in BOTH {
        let w = CouplingMatrix::new(&network, normalization);
        let all = solve(&w, &dense());
        for n_modes in [2, 9, 60] {
            let leading = solve(&w, &shift_invert(n_modes));
            assert_eq!(leading.solver, Solver::ShiftInvert);
            check_eigenvalues(&leading, &all.eigenvalues, 1e-10 * scale(&w));
            check_same_eigenspaces(&w, &leading, &all);
        }
    }
}

/// Long sequences run into the bulk here, past modes that have long converged and come back as copies.
#[test]
fn the_edge_of_a_bulk_behind_well_separated_modes_is_that_of_the_dense_solver() {
    let probability = LinkProbability::Uniform { within: 0.1, between: 0.003 };
    let network = communities(&[150; 6], &probability, 1).unwrap();
    for normalization in BOTH {
        let w = CouplingMatrix::new(&network, normalization);
        let all = solve(&w, &dense());
        for n_modes in [6, 7, 12, 40] {
            let leading = solve(&w, &chebyshev(n_modes));
            check_eigenvalues(&leading, &all.eigenvalues, 1e-10 * scale(&w));
            check_same_eigenspaces(&w, &leading, &all);
        }
    }
}

#[test]
fn a_repeat_is_identical_to_the_last_bit_whatever_came_before() {
    let fixtures = fixtures();
    let first: Vec<_> = fixtures.iter().map(|(w, request)| bits(&solve(w, request))).collect();
    for ((w, request), first) in fixtures.iter().zip(&first).rev() {
        assert!(bits(&solve(w, request)) == *first);
    }
}

#[test]
fn two_threads_that_solve_at_once_get_what_one_gets() {
    let fixtures = fixtures();
    let alone: Vec<_> = fixtures.iter().map(|(w, request)| bits(&solve(w, request))).collect();
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                for _ in 0..5 {
                    for ((w, request), alone) in fixtures.iter().zip(&alone) {
                        assert!(bits(&solve(w, request)) == *alone);
                    }
                }
            });
        }
    });
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let fixtures = fixtures();
    let bits_with = |n_threads: usize| -> Vec<_> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().unwrap();
        pool.install(|| fixtures.iter().map(|(w, request)| bits(&solve(w, request))).collect())
    };
    let one = bits_with(1);
    assert!(bits_with(2) == one);
    assert!(bits_with(5) == one);
}

#[test]
fn another_seed_gives_the_same_eigenspaces() {
    let w = CouplingMatrix::new(&torus(12), Normalization::Laplacian);
    let all = solve(&w, &dense());
    for seed in 0..20 {
        for request in by_iteration(20) {
            let leading = solve(&w, &Request { seed, ..request });
            assert_eq!(leading.eigenvalues.len(), 21);
            check_same_eigenspaces(&w, &leading, &all);
        }
    }
}

#[cfg(feature = "arpack")]
#[test]
fn a_cut_eigenspace_is_completed_within_the_bound_and_refused_beyond_it() {
    let w = CouplingMatrix::new(&complete(150), Normalization::Laplacian);
    let whole = solve(&w, &Request { max_extra: 148, ..arpack(2) });
    assert_eq!(whole.eigenspaces, [0..1, 1..150]);
    assert_eq!(solve(&w, &arpack(1)).eigenvalues.len(), 1);
    match leading_modes(&w, &Request { max_extra: 10, ..arpack(2) }) {
        Err(SpectraError::EigenspaceTooLarge {
            requested: 2,
            eigenvalue,
            found,
            max_extra: 10,
        }) => {
            assert!((eigenvalue + 150.0).abs() < 1e-9 && found == 13, "{eigenvalue} {found}");
        }
        other => panic!("{other:?}"),
    }
}

#[cfg(feature = "arpack")]
#[test]
fn bounded_work_reports_how_many_modes_converged() {
    let w = CouplingMatrix::new(&common::ring(1000), Normalization::Laplacian);
    let with = |max_products| leading_modes(&w, &Request { max_products, ..arpack(10) });
    for max_products in [0, 7, 60, 1000] {
        match with(max_products) {
            Err(SpectraError::NotConverged { converged, requested, tolerance, products }) => {
                assert_eq!((requested, tolerance), (10, 1e-12));
                assert!(converged < 10 && products <= max_products, "{converged} {products}");
            }
            other => panic!("{max_products}: {other:?}"),
        }
    }
}

#[cfg(feature = "arpack")]
#[test]
fn a_looser_tolerance_is_kept_and_finds_the_same_eigenspaces() {
    let w = CouplingMatrix::new(&torus(12), Normalization::Laplacian);
    let strict = solve(&w, &arpack(20));
    let loose = leading_modes(&w, &Request { tolerance: 1e-5, ..arpack(20) }).unwrap();
    let loose = common::by_mode(&loose);
    assert!(loose.residuals.iter().all(|&residual| residual <= 1e-5 * scale(&w)));
    assert_eq!((strict.tolerance, loose.tolerance), (1e-10 * 4.0, 10.0 * (1e-5 * 4.0)));
    assert_eq!(loose.eigenspaces, strict.eigenspaces);
    check_eigenvalues(&loose, &strict.eigenvalues, 1e-5 * scale(&w));
}

#[cfg(feature = "arpack")]
#[test]
fn work_that_ends_during_the_check_leaves_completeness_unproven() {
    let w = CouplingMatrix::new(&torus(12), Normalization::Laplacian);
    let enough = solve(&w, &arpack(9)).products;
    let errors: Vec<_> = (0..enough)
        .filter_map(|max_products| leading_modes(&w, &Request { max_products, ..arpack(9) }).err())
        .collect();
    let unproven = |error: &&SpectraError| {
        matches!(error, SpectraError::CompletenessUnproven { requested: 9, .. })
    };
    let partly = |error: &&SpectraError| {
        matches!(error, SpectraError::NotConverged { converged: 1..9, requested: 9, .. })
    };
    assert!(errors.iter().filter(unproven).count() > 10, "{errors:?}");
    assert!(errors.iter().filter(partly).count() > 1, "{errors:?}");
}

#[test]
fn the_solver_is_chosen_by_size_and_count() {
    let solver = |n_nodes, modes| {
        let w = CouplingMatrix::new(&star(n_nodes - 1), Normalization::Laplacian);
        solve(&w, &Request { modes, ..Request::default() }).solver
    };
    assert_eq!(solver(300, Modes::Leading(1)), Solver::Dense);
    assert_eq!(solver(600, Modes::All), Solver::Dense);
    assert_eq!(solver(600, Modes::Above(-0.5)), Solver::Dense);
    assert_eq!(solver(600, Modes::Leading(1)), Solver::ShiftInvert);
    assert_eq!(solver(spectra::DENSE_NODES + 1, Modes::Above(-0.5)), Solver::ShiftInvert);
}

#[test]
fn without_small_separators_medium_networks_go_to_arpack_and_large_ones_to_filters() {
    let medium = if Solver::Arpack.is_built() { Solver::Arpack } else { Solver::Chebyshev };
    for (n_nodes, expected) in [(3000, medium), (6000, Solver::Chebyshev)] {
        let size = n_nodes / 3;
        let probability =
            LinkProbability::Uniform { within: 16.0 / size as f64, between: 1.0 / size as f64 };
        let network = communities(&[size; 3], &probability, 1).unwrap();
        let w = CouplingMatrix::new(&network, Normalization::Normalized);
        let request = Request { modes: Modes::Leading(3), ..Request::default() };
        assert_eq!(solve(&w, &request).solver, expected);
    }
}

#[test]
fn requests_that_cannot_be_met_say_so_with_numbers() {
    let w = CouplingMatrix::new(&star(4), Normalization::Laplacian);
    let message = |request| leading_modes(&w, &request).unwrap_err().to_string();
    let leading = |m| Request { modes: Modes::Leading(m), ..Request::default() };
    assert_eq!(message(leading(0)), "0 modes were asked for; a spectrum has at least one");
    assert_eq!(message(leading(6)), "6 modes were asked for, but a network of 5 nodes has 5");
    let all_of_arpack = Request { solver: Some(Solver::Arpack), ..Request::default() };
    for request in
        [all_of_arpack, arpack(5)].into_iter().filter(|r| r.solver.is_none_or(Solver::is_built))
    {
        assert_eq!(
            leading_modes(&w, &request).unwrap_err(),
            SpectraError::AllButOne { solver: "arpack", requested: 5, n_nodes: 5 }
        );
    }
    for tolerance in [0.0, -1.0, f64::NAN, 0.1] {
        assert!(matches!(
            leading_modes(&w, &Request { tolerance, ..chebyshev(1) }),
            Err(SpectraError::BadTolerance { .. })
        ));
    }
}

#[cfg(not(feature = "arpack"))]
#[test]
fn a_build_without_arpack_says_so_and_solves_by_the_others() {
    let w = CouplingMatrix::new(&torus(30), Normalization::Laplacian);
    let found = leading_modes(&w, &arpack(4));
    assert_eq!(found.unwrap_err(), SpectraError::NotBuilt { solver: "arpack" });
    let free = Request { modes: Modes::Leading(4), ..Request::default() };
    assert_eq!(solve(&w, &free).eigenspaces, [0..1, 1..5]);
}

#[test]
fn a_matrix_given_as_it_is_has_the_spectrum_of_its_network() {
    for normalization in BOTH {
        let w = CouplingMatrix::new(&common::nepal(), normalization);
        let given = CouplingMatrix::as_given(w.matrix()).unwrap();
        let (all, found) = (solve(&w, &dense()), solve(&given, &dense()));
        assert_eq!(found.eigenspaces, all.eigenspaces);
        check_eigenvalues(&found, &all.eigenvalues, 1e-14 * scale(&w));
        check_same_eigenspaces(&w, &found, &all);
    }
}

#[test]
fn a_directed_and_a_signed_matrix_are_refused_with_the_entry_that_makes_them_so() {
    let directed = [[-1.0, 1.0, 0.0], [0.0, -1.0, 1.0], [1.0, 0.0, -1.0]];
    let signed = [[-1.0, 1.5, -0.5], [1.5, -2.5, 1.0], [-0.5, 1.0, -0.5]];
    let given = |rows| CouplingMatrix::from_rows(rows).unwrap();
    let (directed, signed) = (given(&directed), given(&signed));
    let expected = SpectraError::NotSymmetric { row: 0, column: 1, value: 1.0, transposed: 0.0 };
    assert_eq!(leading_modes(&directed, &dense()).unwrap_err(), expected);
    assert_eq!(spectra::smallest_eigenvalue(&directed).unwrap_err(), expected);
    let expected = SpectraError::NegativeLink { row: 0, column: 2, value: -0.5 };
    assert_eq!(leading_modes(&signed, &dense()).unwrap_err(), expected);
}

#[test]
fn a_matrix_that_overflows_is_refused() {
    let heavy = network(3, &[(0, 1, f64::MAX), (0, 2, f64::MAX)]);
    let w = CouplingMatrix::new(&heavy, Normalization::Laplacian);
    let expected = SpectraError::NotFinite { node: 0, value: f64::NEG_INFINITY };
    assert_eq!(leading_modes(&w, &dense()).unwrap_err(), expected);
}
