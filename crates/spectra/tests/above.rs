//! Modes above a cutoff, and the number of them against the dense spectrum of random networks.

mod common;

use common::{
    BOTH, BUILT, ByMode, ITERATIVE, check_eigenvalues, dense, grid, nepal, network,
    ring_of_cliques, scale, solve, star, with,
};
use graph::generators::{LinkProbability, communities, hierarchical};
use graph::{CouplingMatrix, Network, Normalization};
use rand_core::Rng;
use rand_pcg::Pcg64;
use spectra::{
    Modes, Request, Solver, SpectraError, Verification, leading_modes, leading_modes_with,
};

/// Eigenvalues of a dense spectrum that count as above a cutoff, whole eigenspaces.
fn expected_above(all: &ByMode, cutoff: f64) -> usize {
    let begins_above = |&k: &usize| all.eigenvalues[k] > cutoff + all.tolerance;
    let spaces = all.eigenspaces.iter().take_while(|range| begins_above(&range.start));
    spaces.last().map_or(0, |range| range.end)
}

#[test]
fn every_solver_finds_all_modes_above_a_cutoff() {
    for (network, normalization, cutoff) in [
        (nepal(), Normalization::Laplacian, -8.5),
        (star(50), Normalization::Laplacian, -0.5),
        (star(50), Normalization::Normalized, -1.5),
        (grid(20), Normalization::Laplacian, -0.3),
        (ring_of_cliques(40), Normalization::Laplacian, -1.0),
        (ring_of_cliques(40), Normalization::Normalized, -0.3),
    ] {
        let w = CouplingMatrix::new(&network, normalization);
        let all = solve(&w, &dense());
        let expected = expected_above(&all, cutoff);
        for solver in BUILT.iter().copied() {
            let above = solve(&w, &with(solver, Modes::Above(cutoff)));
            assert_eq!(above.eigenvalues.len(), expected, "{solver:?} above {cutoff}");
            check_eigenvalues(&above, &all.eigenvalues, 1e-11 * scale(&w));
        }
    }
}

#[test]
fn a_cutoff_on_an_eigenvalue_leaves_all_its_copies_out() {
    let w = CouplingMatrix::new(&nepal(), Normalization::Laplacian);
    for solver in BUILT.iter().copied() {
        // −8 and −9 have four copies each.
        for (cutoff, expected) in [(-8.0, 3), (-8.0 - 1e-6, 7), (-9.0, 7), (-9.0 + 1e-6, 7)] {
            let above = solve(&w, &with(solver, Modes::Above(cutoff)));
            assert_eq!(above.eigenvalues.len(), expected, "{solver:?} above {cutoff}");
        }
    }
}

#[test]
fn a_cutoff_that_nothing_exceeds_is_refused() {
    let w = CouplingMatrix::new(&nepal(), Normalization::Laplacian);
    for cutoff in [0.0, 1.0] {
        let refused = leading_modes(&w, &with(None, Modes::Above(cutoff)));
        assert_eq!(refused.unwrap_err(), SpectraError::NothingAbove { cutoff });
    }
    let not_a_number = leading_modes(&w, &with(None, Modes::Above(f64::NAN)));
    assert!(matches!(not_a_number, Err(SpectraError::NothingAbove { .. })));
}

#[test]
fn more_modes_above_a_cutoff_than_allowed_are_refused_with_numbers() {
    let w = CouplingMatrix::new(&ring_of_cliques(40), Normalization::Laplacian);
    for solver in BUILT.iter().copied() {
        let request = Request { max_modes: 10, ..with(solver, Modes::Above(-1.0)) };
        match leading_modes(&w, &request) {
            Err(SpectraError::TooManyAbove { cutoff, found, max_modes: 10 }) => {
                assert!(cutoff == -1.0 && found > 10, "{found}");
            }
            other => panic!("{solver:?}: {other:?}"),
        }
    }
}

/// Erdős & Rényi: every pair is linked with the same probability.
fn erdos_renyi(n_nodes: usize, probability: f64, random: &mut Pcg64) -> Network {
    let mut links = Vec::new();
    for i in 0..n_nodes {
        for j in 0..i {
            if uniform(random) < probability {
                links.push((i, j, 1.0));
            }
        }
    }
    network(n_nodes, &links)
}

/// Barabási & Albert: a new node links to old ones in proportion to their degrees.
fn scale_free(n_nodes: usize, links_per_node: usize, random: &mut Pcg64) -> Network {
    let mut links = Vec::new();
    let mut ends = vec![0];
    for i in 1..n_nodes {
        let mut targets = Vec::new();
        for _ in 0..4 * links_per_node {
            let target = ends[(uniform(random) * ends.len() as f64) as usize];
            if targets.len() < links_per_node && !targets.contains(&target) {
                targets.push(target);
            }
        }
        for target in targets {
            links.push((i, target, 1.0));
            ends.extend([i, target]);
        }
    }
    network(n_nodes, &links)
}

/// Watts & Strogatz: a ring of second neighbours, some links rewired.
fn small_world(n_nodes: usize, rewired: f64, random: &mut Pcg64) -> Network {
    let mut links = std::collections::BTreeSet::new();
    for (i, step) in (0..n_nodes).flat_map(|i| [(i, 1), (i, 2)]) {
        let far = (uniform(random) * n_nodes as f64) as usize;
        let j = if uniform(random) < rewired { far } else { (i + step) % n_nodes };
        if i != j {
            links.insert((i.min(j), i.max(j)));
        }
    }
    network(n_nodes, &links.into_iter().map(|(i, j)| (i, j, 1.0)).collect::<Vec<_>>())
}

fn uniform(random: &mut Pcg64) -> f64 {
    graph::unit_interval(random.next_u64())
}

/// One network of each family; the generators of this project first.
fn families(random: &mut Pcg64) -> Vec<Network> {
    let n = 30 + (uniform(random) * 100.0) as usize;
    let between = 0.02 * uniform(random);
    let sizes = [n / 3, n / 3, n - 2 * (n / 3)];
    let probability = LinkProbability::Uniform { within: 0.3, between };
    vec![
        communities(&sizes, &probability, random.next_u64()).unwrap(),
        hierarchical(&ring_of_cliques(2), n / 10, 0.5, 0.05, random.next_u64()).unwrap(),
        erdos_renyi(n, 3.0 / n as f64, random),
        scale_free(n, 2, random),
        small_world(n, 0.1, random),
    ]
}

#[test]
fn the_verified_number_is_that_of_the_dense_spectrum_on_networks_of_every_family() {
    let mut random = Pcg64::new(5, 11);
    let mut by_inertia = 0;
    for round in 0..100 {
        for network in families(&mut random) {
            let normalization = BOTH[round % 2];
            let w = CouplingMatrix::new(&network, normalization);
            let all = solve(&w, &dense());
            let cutoff = -uniform(&mut random) * 0.6 * scale(&w) - 1e-3;
            let expected = expected_above(&all, cutoff);
            let solver = ITERATIVE[round / 2 % ITERATIVE.len()];
            // Isolated nodes and leaves make eigenspaces larger than the usual limit.
            let request = Request { max_modes: 200, ..with(solver, Modes::Above(cutoff)) };
            let above = match leading_modes(&w, &request) {
                Err(SpectraError::FactorTooLarge { .. }) => continue,
                answer => answer.unwrap(),
            };
            assert_eq!(above.n_modes(), expected, "{round} {solver:?} {cutoff}");
            match above.verification {
                Verification::Inertia { count } => {
                    by_inertia += 1;
                    assert_eq!(count, expected);
                }
                Verification::Probed { confidence, .. } => assert!(confidence > 0.999),
                // The basis came to span all space.
                Verification::Dense => assert!(above.solver != Solver::Dense),
            }
        }
    }
    assert!(by_inertia > 250, "{by_inertia}");
}

#[test]
fn progress_tells_products_and_modes_and_never_goes_back() {
    let w = CouplingMatrix::new(&grid(40), Normalization::Laplacian);
    let calls = std::sync::Mutex::new(Vec::new());
    let request = with(Solver::Chebyshev, Modes::Leading(6));
    let spectrum = leading_modes_with(&w, &request, &|advance| {
        calls.lock().unwrap().push(advance);
        std::ops::ControlFlow::Continue(())
    })
    .unwrap();
    let calls = calls.into_inner().unwrap();
    assert!(calls.len() > 3 && calls.windows(2).all(|pair| pair[0].products < pair[1].products));
    let last = calls[calls.len() - 1];
    assert!(last.products <= spectrum.products && last.wanted <= spectrum.n_modes());
    assert!(last.converged >= spectrum.n_modes());
}
