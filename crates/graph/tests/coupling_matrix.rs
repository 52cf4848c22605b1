//! The coupling matrix W: closed forms, row sums, and its similarity to the symmetric form.

use graph::{CouplingError, CouplingMatrix, Network, Normalization, SparseMatrix, Symmetry};
use proptest::prelude::*;

const BOTH: [Normalization; 2] = [Normalization::Laplacian, Normalization::Normalized];

fn network(n_nodes: usize, links: &[(usize, usize, f64)]) -> Network {
    Network::undirected((1..=n_nodes).map(|i| i.to_string()).collect(), links).unwrap()
}

fn six_nodes() -> Network {
    let unit = [(1, 2), (1, 4), (1, 6), (2, 3), (3, 4), (4, 5), (5, 6)];
    let mut links: Vec<_> = unit.iter().map(|&(i, j)| (i - 1, j - 1, 1.0)).collect();
    links.extend([(1, 5, 1.5), (2, 4, 1.5)]);
    network(6, &links)
}

fn entry(matrix: &SparseMatrix, i: usize, j: usize) -> f64 {
    matrix.get(i, j).copied().unwrap_or(0.0)
}

fn symmetric(coupling: &CouplingMatrix) -> &SparseMatrix {
    coupling.symmetric_form().unwrap().symmetric()
}

fn scale(coupling: &CouplingMatrix) -> &[f64] {
    coupling.symmetric_form().unwrap().scale()
}

/// Any network of at most 12 nodes, isolated ones and several components included.
fn any_network() -> impl Strategy<Value = Network> {
    let weight = prop::option::of(0.01..100.0);
    (1usize..12).prop_flat_map(move |n| {
        prop::collection::vec(weight.clone(), n * (n - 1) / 2).prop_map(move |weights| {
            let pairs = (0..n).flat_map(|i| (0..i).map(move |j| (i, j)));
            let links: Vec<_> =
                pairs.zip(weights).filter_map(|((i, j), w)| w.map(|w| (i, j, w))).collect();
            network(n, &links)
        })
    })
}

#[test]
fn the_six_node_laplacian_is_the_one_printed_in_the_paper() {
    let printed = [
        [-3.0, 1.0, 0.0, 1.0, 0.0, 1.0],
        [1.0, -3.5, 1.0, 0.0, 0.0, 1.5],
        [0.0, 1.0, -3.5, 1.0, 1.5, 0.0],
        [1.0, 0.0, 1.0, -3.0, 1.0, 0.0],
        [0.0, 0.0, 1.5, 1.0, -3.5, 1.0],
        [1.0, 1.5, 0.0, 0.0, 1.0, -3.5],
    ];
    let coupling = CouplingMatrix::new(&six_nodes(), Normalization::Laplacian);
    for (i, row) in printed.iter().enumerate() {
        for (j, &w) in row.iter().enumerate() {
            assert_eq!(entry(coupling.matrix(), i, j), w, "w_{i}{j}");
        }
    }
    assert_eq!(symmetric(&coupling), coupling.matrix());
    assert_eq!(scale(&coupling), [1.0; 6]);
}

#[test]
fn a_weighted_path_is_normalized_by_its_strengths() {
    // a_12 = 1 and a_23 = 3, so k = (1, 4, 3).
    let coupling =
        CouplingMatrix::new(&network(3, &[(0, 1, 1.0), (2, 1, 3.0)]), Normalization::Normalized);
    let expected = [[-1.0, 1.0, 0.0], [0.25, -1.0, 0.75], [0.0, 1.0, -1.0]];
    for (i, row) in expected.iter().enumerate() {
        for (j, &w) in row.iter().enumerate() {
            assert_eq!(entry(coupling.matrix(), i, j), w, "w_{i}{j}");
        }
    }
    // s_12 = 1/√(1·4), s_23 = 3/√(4·3).
    assert!((entry(symmetric(&coupling), 0, 1) - 0.5).abs() < 1e-15);
    assert!((entry(symmetric(&coupling), 1, 2) - 0.75f64.sqrt()).abs() < 1e-15);
}

#[test]
fn an_isolated_node_receives_no_coupling() {
    for normalization in BOTH {
        let coupling = CouplingMatrix::new(&network(3, &[(0, 2, 2.0)]), normalization);
        for matrix in [coupling.matrix(), symmetric(&coupling)] {
            assert_eq!(matrix.get(1, 1), Some(&0.0));
            assert_eq!(matrix.outer_view(1).unwrap().nnz(), 1);
        }
        assert_eq!(scale(&coupling)[1], 1.0);
    }
}

proptest! {
    #[test]
    fn every_row_sums_to_zero(network in any_network()) {
        for normalization in BOTH {
            let coupling = CouplingMatrix::new(&network, normalization);
            for row in coupling.matrix().outer_iterator() {
                let largest = row.data().iter().fold(0.0, |m: f64, w| m.max(w.abs()));
                prop_assert!(row.data().iter().sum::<f64>().abs() <= 1e-14 * largest);
            }
        }
    }

    #[test]
    fn every_diagonal_entry_is_stored_and_columns_ascend(network in any_network()) {
        for normalization in BOTH {
            let coupling = CouplingMatrix::new(&network, normalization);
            for matrix in [coupling.matrix(), symmetric(&coupling)] {
                prop_assert_eq!(matrix.nnz(), 2 * network.n_links() + network.n_nodes());
                for (i, row) in matrix.outer_iterator().enumerate() {
                    prop_assert!(row.get(i).is_some());
                    prop_assert!(row.indices().is_sorted());
                }
            }
        }
    }

    #[test]
    fn the_symmetric_form_is_symmetric_and_similar_to_the_matrix(network in any_network()) {
        for normalization in BOTH {
            let coupling = CouplingMatrix::new(&network, normalization);
            let scale = scale(&coupling);
            for i in 0..network.n_nodes() {
                for j in 0..network.n_nodes() {
                    let s = entry(symmetric(&coupling), i, j);
                    prop_assert_eq!(s, entry(symmetric(&coupling), j, i));
                    // S = D^{1/2} W D^{-1/2}, scale = D^{-1/2}.
                    let similar = entry(coupling.matrix(), i, j) * scale[j] / scale[i];
                    prop_assert!((s - similar).abs() <= 1e-14 * s.abs());
                }
            }
        }
    }
}

#[test]
fn a_directed_ring_is_similar_to_nothing_symmetric_and_says_where() {
    // Every node is driven by the next one alone.
    let ring = [[-1.0, 1.0, 0.0], [0.0, -1.0, 1.0], [1.0, 0.0, -1.0]];
    let coupling = CouplingMatrix::from_rows(&ring).unwrap();
    assert_eq!(coupling.symmetry(), Symmetry::Neither { at: (0, 1) });
    assert!(coupling.symmetric_form().is_none());
    assert_eq!(entry(coupling.matrix(), 2, 0), 1.0);
}

#[test]
fn a_cycle_whose_links_are_stronger_one_way_round_is_not_balanced() {
    // Both directions of all links, but 2·2·2 one way and 1·1·1 the other (Kolmogorov).
    let cycle = [[-3.0, 2.0, 1.0], [1.0, -3.0, 2.0], [2.0, 1.0, -3.0]];
    let coupling = CouplingMatrix::from_rows(&cycle).unwrap();
    assert!(matches!(coupling.symmetry(), Symmetry::Neither { .. }));
    // 2·1·3 either way: d = (1, 2, 1/2) up to a factor, as w_12 / w_21 = 2 and w_13 / w_31 = 1/2.
    let balanced = [[-3.0, 2.0, 1.0], [1.0, -2.0, 1.0], [2.0, 4.0, -6.0]];
    let coupling = CouplingMatrix::from_rows(&balanced).unwrap();
    assert_eq!(coupling.symmetry(), Symmetry::Similar);
    let d: Vec<f64> = scale(&coupling).iter().map(|s| 1.0 / (s * s)).collect();
    assert!((d[1] / d[0] - 2.0).abs() < 1e-14 && (d[2] / d[0] - 0.5).abs() < 1e-14, "{d:?}");
    assert!((entry(symmetric(&coupling), 0, 1) - 2f64.sqrt()).abs() < 1e-15);
}

#[test]
fn a_row_that_does_not_sum_to_zero_is_named() {
    let refused = CouplingMatrix::from_rows(&[[-1.0, 1.0], [1.0, -0.75]]).unwrap_err();
    assert_eq!(refused, CouplingError::RowSum { row: 1, sum: 0.25, size: 1.75 });
    let message = refused.to_string();
    assert!(message.contains("row 1 (from 0)") && message.contains("sums to 0.25"), "{message}");
}

#[test]
fn rounding_of_a_row_sum_goes_to_the_diagonal_and_zeros_are_no_links() {
    let coupling =
        CouplingMatrix::from_rows(&[[-0.3, 0.1, 0.2], [0.1, -0.1, 0.0], [0.2, 0.0, -0.2]]);
    let coupling = coupling.unwrap();
    assert_eq!(coupling.symmetry(), Symmetry::Symmetric);
    assert_eq!(coupling.matrix().nnz(), 7);
    for row in coupling.matrix().outer_iterator() {
        assert!(row.data().iter().sum::<f64>().abs() < 1e-16);
    }
}

#[test]
fn what_is_no_square_of_numbers_is_refused() {
    let no_rows: [[f64; 0]; 0] = [];
    assert_eq!(CouplingMatrix::from_rows(&no_rows).unwrap_err(), CouplingError::Empty);
    let narrow = CouplingMatrix::from_rows(&[vec![-1.0, 1.0], vec![0.0]]).unwrap_err();
    assert_eq!(narrow, CouplingError::NotSquare { rows: 2, columns: 1 });
    let wide = SparseMatrix::zero((2, 3));
    let wide = CouplingMatrix::as_given(&wide).unwrap_err();
    assert_eq!(wide, CouplingError::NotSquare { rows: 2, columns: 3 });
    let endless = CouplingMatrix::from_rows(&[[f64::INFINITY, 0.0], [0.0, 0.0]]).unwrap_err();
    assert_eq!(endless, CouplingError::NotFinite { row: 0, column: 0, value: f64::INFINITY });
}

proptest! {
    #[test]
    fn matrices_of_networks_are_recognised_when_they_are_given(network in any_network()) {
        for normalization in BOTH {
            let coupling = CouplingMatrix::new(&network, normalization);
            let given = CouplingMatrix::as_given(coupling.matrix()).unwrap();
            let by_columns = CouplingMatrix::as_given(&coupling.matrix().to_csc()).unwrap();
            prop_assert_eq!(by_columns.matrix(), given.matrix());
            prop_assert!(given.symmetric_form().is_some());
            for (i, j) in (0..network.n_nodes()).flat_map(|i| (0..i).map(move |j| (i, j))) {
                let s = entry(symmetric(&given), i, j);
                prop_assert_eq!(s, entry(symmetric(&given), j, i));
                let expected = entry(symmetric(&coupling), i, j);
                prop_assert!((s - expected).abs() <= 1e-14 * expected.abs(), "{} {}", s, expected);
                let w = scale(&given)[i] * s / scale(&given)[j];
                let w_ij = entry(coupling.matrix(), i, j);
                prop_assert!((w - w_ij).abs() <= 1e-12 * w_ij.abs(), "{} {}", w, w_ij);
            }
        }
    }
}
