//! The coupling's sum, Σ_j w_ij x_j for every node i: the sparse part of a step.
//!
//! - rows with weights of their own: w_ii x_i comes after Σ_{j≠i} w_ij x_j
//! - when the weights within each row are equal (unweighted links): w_i Σ_{j≠i} x_j, then w_ii x_i
//!
//! Terms are added in ascending order of j, whatever the number of lanes: one fixed definition. So
//! that a processor need not wait for one sum to be done before it starts the next, `R` rows are
//! summed side by side; so that rows side by side are about equally long, they are taken in order of
//! their length. The shorter ones are filled up with a node that is always 0, which changes no bits.

use crate::{Lanes, SparseMatrix};

/// The rows of a coupling matrix, `R` side by side.
pub(crate) struct RowSums<const R: usize> {
    groups: Vec<Group<R>>,
    /// Column of each term, group by group.
    columns: Vec<[u32; R]>,
    /// Weight of each term; none when the weights within each row are equal.
    weights: Option<Vec<[f64; R]>>,
}

/// `R` rows of about the same number of terms.
struct Group<const R: usize> {
    /// Which rows.
    nodes: [u32; R],
    /// Where their terms end in `columns`; they begin where those of the group before end.
    end: usize,
    /// Factor of the sum over j ≠ i: the weight that all terms of a row share, or 1.
    common: [f64; R],
    /// w_ii.
    own: [f64; R],
}

/// A row taken apart: its node, w_ii, and the terms j ≠ i.
struct Row {
    node: usize,
    own: f64,
    terms: Vec<(u32, f64)>,
}

impl<const R: usize> RowSums<R> {
    /// `zero_node` is a number beyond all nodes at which signals are always 0 and inputs unused.
    pub(crate) fn new(matrix: &SparseMatrix, zero_node: usize) -> Self {
        let zero = Row { node: zero_node, own: 0.0, terms: Vec::new() };
        let mut rows: Vec<Row> = (0..matrix.rows()).map(|node| Row::new(matrix, node)).collect();
        rows.sort_by_key(|row| row.terms.len());
        let equal = rows.iter().all(Row::has_equal_weights);
        let (mut groups, mut columns, mut weights) = (Vec::new(), Vec::new(), Vec::new());
        for rows in rows.chunks(R) {
            let row: [&Row; R] = std::array::from_fn(|r| rows.get(r).unwrap_or(&zero));
            let n_terms = rows.iter().map(|row| row.terms.len()).max().unwrap_or(0);
            let filling = (narrow(zero_node), 0.0);
            for k in 0..n_terms {
                let terms = row.map(|row| row.terms.get(k).copied().unwrap_or(filling));
                columns.push(terms.map(|(column, _)| column));
                weights.push(terms.map(|(_, weight)| weight));
            }
            groups.push(Group {
                nodes: row.map(|row| narrow(row.node)),
                end: columns.len(),
                common: row.map(|row| if equal { row.common_weight() } else { 1.0 }),
                own: row.map(|row| row.own),
            });
        }
        Self { groups, columns, weights: (!equal).then_some(weights) }
    }

    /// Sums the signals, `[node][lane]`, into the inputs of all nodes.
    #[inline(always)]
    pub(crate) fn sum<const L: usize>(&self, signals: &[[f64; L]], inputs: &mut [[f64; L]]) {
        let signal = |column: u32| Lanes(signals[column as usize]);
        let mut start = 0;
        for group in &self.groups {
            let terms = start..group.end;
            let mut sums = [Lanes([0.0; L]); R];
            match &self.weights {
                None => {
                    for columns in &self.columns[terms] {
                        for r in 0..R {
                            sums[r] = sums[r] + signal(columns[r]);
                        }
                    }
                    for r in 0..R {
                        sums[r] = sums[r] * group.common[r];
                    }
                }
                Some(weights) => {
                    for (columns, weights) in
                        self.columns[terms.clone()].iter().zip(&weights[terms])
                    {
                        for r in 0..R {
                            sums[r] = sums[r] + signal(columns[r]) * weights[r];
                        }
                    }
                }
            }
            for r in 0..R {
                let own = signal(group.nodes[r]) * group.own[r];
                inputs[group.nodes[r] as usize] = (sums[r] + own).0;
            }
            start = group.end;
        }
    }
}

impl Row {
    fn new(matrix: &SparseMatrix, node: usize) -> Self {
        let row = matrix.outer_view(node).expect("the matrix has a row for every node");
        let entries = row.indices().iter().copied().zip(row.data().iter().copied());
        let (own, terms): (Vec<_>, Vec<_>) =
            entries.partition(|&(column, _)| column as usize == node);
        Self { node, own: own.first().map_or(0.0, |&(_, weight)| weight), terms }
    }

    fn has_equal_weights(&self) -> bool {
        self.terms.iter().all(|&(_, weight)| weight == self.common_weight())
    }

    fn common_weight(&self) -> f64 {
        self.terms.first().map_or(0.0, |&(_, weight)| weight)
    }
}

fn narrow(node: usize) -> u32 {
    u32::try_from(node).expect("node numbers fit the 32-bit indices of the matrix")
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const N: usize = 11;

    fn sums<const R: usize, const L: usize>(
        matrix: &SparseMatrix,
        x: &[[f64; L]],
    ) -> Vec<[f64; L]> {
        let mut signals = x.to_vec();
        signals.push([0.0; L]);
        let mut inputs = vec![[0.0; L]; N + 1];
        RowSums::<R>::new(matrix, N).sum(&signals, &mut inputs);
        inputs.truncate(N);
        inputs
    }

    fn sparse(dense: &[f64]) -> SparseMatrix {
        let mut entries = sprs::TriMatI::<f64, u32>::new((N, N));
        for (index, &weight) in dense.iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
            entries.add_triplet(index / N, index % N, weight);
        }
        entries.to_csr()
    }

    proptest! {
        #[test]
        fn the_sparse_sum_is_the_dense_one_to_rounding_and_the_same_for_any_rows_side_by_side(
            kept in prop::collection::vec(any::<bool>(), N * N),
            weights in prop::collection::vec(0.1..2.0, N * N),
            equal in any::<bool>(),
            x in prop::collection::vec(-3.0..3.0, 2 * N),
        ) {
            let weight = |index: usize| if equal { weights[index / N] } else { weights[index] };
            let dense: Vec<f64> =
                (0..N * N).map(|index| if kept[index] { weight(index) } else { 0.0 }).collect();
            let matrix = sparse(&dense);
            let x: Vec<[f64; 2]> = x.chunks(2).map(|x| [x[0], x[1]]).collect();
            let one = sums::<1, 2>(&matrix, &x);
            for (i, sums) in one.iter().enumerate() {
                for lane in 0..2 {
                    let expected: f64 = (0..N).map(|j| dense[i * N + j] * x[j][lane]).sum();
                    prop_assert!((sums[lane] - expected).abs() < 1e-13);
                }
            }
            prop_assert_eq!(&sums::<2, 2>(&matrix, &x), &one);
            prop_assert_eq!(&sums::<8, 2>(&matrix, &x), &one);
            let first: Vec<[f64; 1]> = x.iter().map(|x| [x[0]]).collect();
            let single = sums::<8, 1>(&matrix, &first);
            prop_assert!(single.iter().zip(&one).all(|(single, pair)| single[0] == pair[0]));
        }
    }
}
