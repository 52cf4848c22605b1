//! The coupling matrix W: closed forms, row sums, and its similarity to the symmetric form.

use graph::{CouplingMatrix, Network, Normalization, SparseMatrix};
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
    assert_eq!(coupling.symmetric(), coupling.matrix());
    assert_eq!(coupling.scale(), [1.0; 6]);
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
    assert!((entry(coupling.symmetric(), 0, 1) - 0.5).abs() < 1e-15);
    assert!((entry(coupling.symmetric(), 1, 2) - 0.75f64.sqrt()).abs() < 1e-15);
}

#[test]
fn an_isolated_node_receives_no_coupling() {
    for normalization in BOTH {
        let coupling = CouplingMatrix::new(&network(3, &[(0, 2, 2.0)]), normalization);
        for matrix in [coupling.matrix(), coupling.symmetric()] {
            assert_eq!(matrix.get(1, 1), Some(&0.0));
            assert_eq!(matrix.outer_view(1).unwrap().nnz(), 1);
        }
        assert_eq!(coupling.scale()[1], 1.0);
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
            for matrix in [coupling.matrix(), coupling.symmetric()] {
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
            let scale = coupling.scale();
            for i in 0..network.n_nodes() {
                for j in 0..network.n_nodes() {
                    let s = entry(coupling.symmetric(), i, j);
                    prop_assert_eq!(s, entry(coupling.symmetric(), j, i));
                    // S = D^{1/2} W D^{-1/2}, scale = D^{-1/2}.
                    let similar = entry(coupling.matrix(), i, j) * scale[j] / scale[i];
                    prop_assert!((s - similar).abs() <= 1e-14 * s.abs());
                }
            }
        }
    }
}
