//! A solve that is told to stop does, wherever it is.

mod common;

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use common::{ITERATIVE, network, torus, with};
use graph::{CouplingMatrix, Network, Normalization};
use spectra::{
    Advance, Modes, Solver, SpectraError, Spectrum, Verification, leading_modes, leading_modes_with,
};

/// Every node linked to six others far and near, which leaves no small separators.
fn tangle(n_nodes: usize) -> Network {
    let other = |i: usize, k: usize| (i * (2 * k + 3) + 97 * k + 1) % n_nodes;
    let all = (0..n_nodes).flat_map(|i| (0..6).map(move |k| (i, other(i, k))));
    let ordered = all.filter(|(i, j)| i != j).map(|(i, j)| (i.min(j), i.max(j)));
    let links: std::collections::BTreeSet<_> = ordered.collect();
    network(n_nodes, &links.into_iter().map(|(i, j)| (i, j, 1.0)).collect::<Vec<_>>())
}

/// Solves until it has been asked so often whether to go on; how often it was.
fn stopped_after(
    w: &CouplingMatrix,
    solver: Solver,
    questions: usize,
) -> (Result<Spectrum, SpectraError>, usize) {
    let asked = AtomicUsize::new(0);
    let progress = |_: Advance| {
        let earlier = asked.fetch_add(1, Ordering::Relaxed);
        if earlier + 1 < questions { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let solved = leading_modes_with(w, &with(solver, Modes::Leading(12)), &progress);
    (solved, asked.into_inner())
}

#[test]
fn a_solve_does_nothing_more_once_it_was_told_to_stop() {
    for network in [torus(20), tangle(500)] {
        let w = CouplingMatrix::new(&network, Normalization::Laplacian);
        for &solver in ITERATIVE.iter() {
            let (whole, questions) = stopped_after(&w, solver, usize::MAX);
            assert!(whole.is_ok() && questions > 2, "{solver:?} asked {questions} times");
            for stop in [1, 2, questions / 3, questions / 2, questions - 1, questions] {
                let (solved, asked) = stopped_after(&w, solver, stop.max(1));
                assert!(matches!(solved, Err(SpectraError::Cancelled)), "{solver:?} at {stop}");
                assert_eq!(asked, stop.max(1), "{solver:?} goes on after it was stopped");
            }
        }
    }
}

#[test]
fn solvers_that_only_multiply_ask_at_every_product_probes_included() {
    let w = CouplingMatrix::new(&tangle(1800), Normalization::Laplacian);
    let only_multiply = |solver: &&Solver| **solver != Solver::ShiftInvert;
    for &solver in ITERATIVE.iter().filter(only_multiply) {
        let (last, largest) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let progress = |advance: Advance| {
            let before = last.swap(advance.products, Ordering::Relaxed);
            assert!(advance.products >= before, "progress goes back");
            largest.fetch_max(advance.products - before, Ordering::Relaxed);
            ControlFlow::Continue(())
        };
        let request = with(solver, Modes::Leading(3));
        let spectrum = leading_modes_with(&w, &request, &progress).unwrap();
        assert!(matches!(spectrum.verification, Verification::Probed { .. }), "{solver:?}");
        // A block is at most eight vectors wide; a Rayleigh–Ritz step multiplies every mode once.
        let after = spectrum.products - last.into_inner();
        let largest = largest.into_inner().max(after);
        assert!(largest <= 40, "{solver:?}: {largest} products without a question");
    }
}

#[test]
fn a_solve_after_a_stopped_one_has_the_bits_of_an_undisturbed_one() {
    let w = CouplingMatrix::new(&tangle(500), Normalization::Laplacian);
    for &solver in ITERATIVE.iter() {
        let request = with(solver, Modes::Leading(12));
        let undisturbed = leading_modes(&w, &request).unwrap();
        for stop in [1, 7, 40] {
            let _ = stopped_after(&w, solver, stop);
            let again = leading_modes(&w, &request).unwrap();
            let (a, b) = (again.real_modes(), undisturbed.real_modes());
            assert_eq!((a.eigenvalues, a.eigenvectors), (b.eigenvalues, b.eigenvectors));
        }
    }
}
