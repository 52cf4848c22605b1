//! δe_ij: its mean over bases, its invariances, and that it is a metric.

use clustering::{ClusteringError, EigenvectorDistance, mean_over_bases};
use graph::Normalization;
use proptest::prelude::*;
use spectra::{Eigenvalue, Spectrum};

use crate::fixtures::{
    Random, dot, leading, nepal, random_network, random_spectrum, read, rotated, six_nodes,
    spectrum, spectrum_of, vectors_mut, with_residuals,
};

fn distance(spectrum: &Spectrum, modes: impl IntoIterator<Item = usize>) -> EigenvectorDistance {
    EigenvectorDistance::new(spectrum, &modes.into_iter().collect::<Vec<_>>()).unwrap()
}

#[track_caller]
fn check_close(obtained: f64, expected: f64, tolerance: f64) {
    assert!((obtained - expected).abs() <= tolerance, "{obtained} instead of {expected}");
}

/// A spectrum with one eigenspace of random orthonormal vectors below the synchronous mode.
fn one_eigenspace(n_nodes: usize, dimension: usize, seed: u64) -> Spectrum {
    let spaces = random_spectrum(n_nodes, dimension + 1, seed).eigenspaces;
    let vectors: Vec<_> = spaces.into_iter().flat_map(|space| space.basis).collect();
    let eigenvalue = |k| if k == 0 { 0.0 } else { -1.0 };
    spectrum(vectors.into_iter().enumerate().map(|(k, v)| (eigenvalue(k), v)).collect(), 1e-15)
}

#[test]
fn the_mean_over_bases_is_one_four_over_pi_three_halves() {
    // E|u_1| = 1, 2/π, 1/2, 4/(3π) on the spheres of dimension 1 to 4.
    let pi = std::f64::consts::PI;
    for (d, expected) in [(1, 1.0), (2, 4.0 / pi), (3, 1.5), (4, 16.0 / (3.0 * pi)), (5, 1.875)] {
        check_close(mean_over_bases(d), expected, 1e-15);
    }
}

#[test]
fn the_mean_over_bases_equals_its_gamma_functions() {
    for d in 1..=1000 {
        let half = 0.5 * d as f64;
        let by_gamma = (libm::lgamma(half) - libm::lgamma(half + 0.5)).exp() * d as f64
            / std::f64::consts::PI.sqrt();
        check_close(mean_over_bases(d) / by_gamma, 1.0, 3e-12);
    }
}

#[test]
fn the_mean_over_bases_grows_as_root_two_d_over_pi() {
    // c_d = √(2d/π) (1 + 1/(4d) + O(d⁻²)).
    let d = 1e6;
    let leading = (2.0 * d / std::f64::consts::PI).sqrt() * (1.0 + 0.25 / d);
    check_close(mean_over_bases(1_000_000) / leading, 1.0, 1e-11);
}

#[test]
fn simple_modes_give_the_sum_printed_in_the_paper() {
    let spectrum = six_nodes();
    let distance = distance(&spectrum, [1, 2]);
    let v = spectrum.real_modes().eigenvectors;
    for i in 0..6 {
        for j in 0..6 {
            let sum = (v[1][i] - v[1][j]).abs() + (v[2][i] - v[2][j]).abs();
            check_close(distance.between(i, j), 0.5 * sum, 1e-15);
        }
    }
    // v_2 differs by 2/√6 and v_3 by 3/√12 between nodes 1 and 3.
    check_close(distance.between(0, 2), 0.5 * (2.0 / 6f64.sqrt() + 3.0 / 12f64.sqrt()), 1e-15);
}

#[test]
fn the_matrix_holds_the_distance_of_every_pair() {
    let distance = distance(&nepal(), 3..11);
    let matrix = distance.matrix();
    assert_eq!((matrix.len(), distance.n_modes(), distance.n_nodes()), (225, 8, 15));
    for i in 0..15 {
        for j in 0..15 {
            assert_eq!(matrix[15 * i + j], distance.between(i, j));
        }
    }
    // Two nodes of a clique of zero-sum modes: ‖P(e_i − e_j)‖ = √2, c_4 = 16/(3π), m = 8.
    let expected = 2f64.sqrt() * 16.0 / (3.0 * std::f64::consts::PI) / 8.0;
    check_close(matrix[1], expected, 1e-15);
}

#[test]
fn rotating_the_bases_of_eigenspaces_changes_nothing() {
    let original = distance(&nepal(), 1..15).matrix();
    for seed in 0..20 {
        let turned = distance(&rotated(nepal(), seed), 1..15).matrix();
        for (a, b) in original.iter().zip(turned) {
            check_close(b, *a, 1e-14);
        }
    }
}

#[test]
fn the_distance_is_the_mean_over_random_bases_of_the_sum() {
    const SAMPLES: usize = 20_000;
    for dimension in [2, 3, 4, 7] {
        let spectrum = one_eigenspace(12, dimension, 5);
        let expected = distance(&spectrum, 1..=dimension).between(2, 9);
        let x: Vec<f64> =
            spectrum.real_modes().eigenvectors[1..].iter().map(|v| v[2] - v[9]).collect();
        let mut random = Random::new(dimension as u64);
        let (mut sum, mut squares) = (0.0, 0.0);
        for _ in 0..SAMPLES {
            // In the basis Σ_k q_bk v_k the components of i and j differ by q_b · x.
            let basis = random.orthogonal(dimension);
            let total: f64 = basis.iter().map(|q| dot(q, &x).abs()).sum();
            let sample = total / dimension as f64;
            sum += sample;
            squares += sample * sample;
        }
        let n = SAMPLES as f64;
        let mean = sum / n;
        let standard_error = ((squares / n - mean * mean) / n).sqrt();
        assert!(standard_error < 0.01 * expected);
        check_close(mean, expected, 4.0 * standard_error);
    }
}

#[test]
fn zero_modes_of_two_components_tell_just_these_apart() {
    // Two triangles: the transverse zero mode is (1, 1, 1, −1, −1, −1)/√6 in any basis.
    let two_triangles = read("1 2\n2 3\n3 1\n4 5\n5 6\n6 4");
    let spectrum = spectrum_of(&two_triangles, Normalization::Laplacian);
    assert_eq!(spectrum.real_modes().eigenspaces, [0..2, 2..6]);
    for seed in 0..20 {
        let distance = distance(&rotated(spectrum.clone(), seed), [1]);
        assert_eq!(distance.n_modes(), 1);
        check_close(distance.between(0, 2), 0.0, 1e-15);
        check_close(distance.between(0, 3), 2.0 / 6f64.sqrt(), 1e-14);
        let clusters = distance.exact_clusters().unwrap();
        assert_eq!(clusters.clusters(), [[0, 1, 2], [3, 4, 5]]);
    }
}

#[test]
fn zero_modes_of_four_components_average_over_three_dimensions() {
    // Four links: the projector on zero modes differs by e_i − e_j spread over pairs: norm 1.
    let four_pairs = read("1 2\n3 4\n5 6\n7 8");
    let spectrum = spectrum_of(&four_pairs, Normalization::Normalized);
    for seed in 0..5 {
        let distance = distance(&rotated(spectrum.clone(), seed), [1, 2, 3]);
        check_close(distance.between(0, 7), mean_over_bases(3) / 3.0, 1e-14);
    }
}

#[test]
fn without_unstable_modes_all_nodes_are_one_cluster() {
    let distance = distance(&six_nodes(), []);
    assert_eq!(distance.between(0, 3), 0.0);
    assert_eq!(distance.exact_clusters().unwrap().n_clusters(), 1);
    assert_eq!(distance.clusters_within(0.0).unwrap().n_clusters(), 1);
}

#[track_caller]
fn check_refused(spectrum: &Spectrum, modes: &[usize], expected: &ClusteringError) {
    assert_eq!(&EigenvectorDistance::new(spectrum, modes).unwrap_err(), expected);
}

#[test]
fn modes_that_make_no_sense_are_refused() {
    check_refused(&nepal(), &[0, 1], &ClusteringError::SynchronousMode);
    let expected = ClusteringError::ModeOutOfRange { mode: 15, n_modes: 15 };
    check_refused(&nepal(), &[1, 15], &expected);
    let expected = ClusteringError::PartOfEigenspace { first: 3, last: 6, missing: 5 };
    check_refused(&nepal(), &[6, 1, 4, 3], &expected);
}

#[test]
fn a_spectrum_without_the_constant_vector_is_refused() {
    let modes = vec![(0.0, vec![1.0, 0.0]), (-1.0, vec![0.0, 1.0])];
    let expected = ClusteringError::NoSynchronousMode { overlap: 0.5 };
    check_refused(&spectrum(modes, 0.0), &[1], &expected);
    // Of three zero modes only two were computed, in a basis that mixes all three.
    let three_pairs = spectrum_of(&read("1 2\n3 4\n5 6"), Normalization::Laplacian);
    let error = EigenvectorDistance::new(&leading(rotated(three_pairs, 3), 2), &[1]).unwrap_err();
    assert!(matches!(error, ClusteringError::NoSynchronousMode { overlap } if overlap < 0.999));
}

#[test]
fn exact_clusters_survive_the_solver_they_allow_for() {
    // Noise of a known size on the eigenvectors; residuals bound it, as gap = 1 and ‖W‖ = 6.
    let noise = 1e-7;
    let mut rough = six_nodes();
    let mut random = Random::new(2);
    vectors_mut(&mut rough).flatten().for_each(|v| *v += noise * random.normal());
    let rough = with_residuals(rough, 6.0 * noise);
    let distance = distance(&rough, [1, 2]);
    assert!((1e-6..1e-4).contains(&distance.exact_tolerance()));
    assert_eq!(distance.exact_clusters().unwrap().nontrivial(), [[1, 5], [2, 4]]);
    assert_eq!(distance.clusters_within(0.0).unwrap().n_clusters(), 6);
}

#[test]
fn the_exact_tolerance_is_residual_over_gap() {
    // Unstable −2 and −2.5, the next is −4: gap 1.5, whatever lies between the unstable ones.
    // R = √(3² + 3²)·1e-8, tolerance 10 √2 R / gap.
    let mut spectrum = six_nodes();
    spectrum.eigenspaces[2].values[0] = Eigenvalue::real(-2.5);
    let spectrum = with_residuals(spectrum, 3e-8);
    check_close(distance(&spectrum, [1, 2]).exact_tolerance() / 40e-8, 1.0, 1e-12);
    let spectrum = with_residuals(spectrum, 0.0);
    assert_eq!(distance(&spectrum, [1, 2]).exact_tolerance(), 1e-12);
}

#[test]
fn exact_clusters_are_refused_when_eigenvectors_cannot_tell() {
    let spectrum = with_residuals(six_nodes(), 1e-3);
    let error = distance(&spectrum, [1]).exact_clusters().unwrap_err();
    assert!(matches!(error, ClusteringError::SpectrumTooRough { tolerance, limit }
        if tolerance > 0.01 && limit < 5e-4));
    let spectrum = with_residuals(spectrum, f64::NAN);
    assert!(distance(&spectrum, [1]).exact_clusters().is_err());
}

#[test]
fn a_threshold_must_be_a_size() {
    for threshold in [-1e-9, f64::INFINITY, f64::NAN] {
        let error = distance(&six_nodes(), [1]).clusters_within(threshold).unwrap_err();
        assert!(matches!(error, ClusteringError::BadThreshold { .. }));
    }
}

proptest! {
    #[test]
    fn the_distance_is_a_metric(seed in any::<u64>(), n in 3usize..12, density in 0.1..1.0) {
        let spectrum = spectrum_of(&random_network(n, density, seed), Normalization::Normalized);
        let distance = distance(&spectrum, 1..n);
        for i in 0..n {
            prop_assert_eq!(distance.between(i, i), 0.0);
            for j in 0..n {
                // With all transverse modes unstable, only equal nodes have distance zero.
                prop_assert!(i == j || distance.between(i, j) > 1e-3 / n as f64);
                prop_assert_eq!(distance.between(i, j), distance.between(j, i));
                for k in 0..n {
                    let detour = distance.between(i, k) + distance.between(k, j);
                    prop_assert!(distance.between(i, j) <= detour + 1e-14);
                }
            }
        }
    }
}

/// What a matrix of distances costs; run with `--ignored --nocapture` to see it.
#[test]
#[ignore = "a measurement"]
fn matrices_of_a_thousand_nodes() {
    let spectrum = random_spectrum(1000, 1000, 1);
    for n_modes in [1, 5, 20, 999] {
        let distance = distance(&spectrum, 1..=n_modes);
        let start = std::time::Instant::now();
        let largest = distance.matrix().into_iter().fold(0.0, f64::max);
        println!("{n_modes} modes, largest distance {largest}: {:?}", start.elapsed());
    }
}
