//! The sparse part of a step: Σ_j w_ij x_j for the nodes of one run after the other.
//!
//! So that a processor need not wait for one sum to be done before it starts the next, `R` rows are
//! summed side by side. The shorter ones are filled up with a place that is always 0, which changes
//! no bits. So that little is filled up, nodes of few lanes are placed in order of their number of
//! terms, within windows that leave neighbours near one another.
//!
//! Source of the windows: M. Kreutzer et al., SIAM J. Sci. Comput. 36, C401 (2014), SELL-C-σ.

use std::ops::Range;

use crate::Lanes;
use crate::links::{Links, Row, work};
use crate::tile::{TILE, Tile};

/// Nodes that are placed in order of their number of terms.
const WINDOW: usize = 256;

/// The rows of a network of `L` lanes, `R` side by side.
///
/// Signals are laid out `[place][lane]`: first the nodes in runs of [`TILE`] numbers, then the place
/// that is always 0, then the shared sums.
pub(crate) struct RowSums<const L: usize, const R: usize> {
    /// Place of each node.
    places: Vec<u32>,
    n_runs: usize,
    /// `TILE / L / R` for each run.
    groups: Vec<Group<R>>,
    /// Place of each term, group by group.
    terms: Vec<[u32; R]>,
    /// Weight of each term, where terms have weights of their own.
    weights: Vec<[f64; R]>,
    weighted: bool,
    /// Places of the two terms of each shared sum.
    shared: Vec<[u32; 2]>,
}

/// `R` rows in neighbouring places, of about the same number of terms.
struct Group<const R: usize> {
    /// Where their terms end; they begin where those of the group before end.
    end: usize,
    /// [`Row::common`] of each.
    common: [f64; R],
    /// [`Row::own`] of each.
    own: [f64; R],
}

impl<const L: usize, const R: usize> RowSums<L, R> {
    const NODES_IN_RUN: usize = TILE / L;
    const GROUPS_IN_RUN: usize = Self::NODES_IN_RUN / R;

    pub(crate) fn new(links: &Links) -> Self {
        let mut order: Vec<usize> = (0..links.n_nodes()).collect();
        if R > 1 {
            for window in order.chunks_mut(WINDOW) {
                window.sort_by_key(|&node| links.rows[node].terms.len());
            }
        }
        let mut places = vec![0; order.len()];
        for (place, &node) in order.iter().enumerate() {
            places[node] = narrow(place);
        }
        let n_runs = order.len().div_ceil(Self::NODES_IN_RUN);
        let zero = n_runs * Self::NODES_IN_RUN;
        let place = |number: u32| match (number as usize).checked_sub(places.len()) {
            None => places[number as usize],
            Some(shared) => narrow(zero + 1 + shared),
        };
        let shared = links.shared.iter().map(|pair| pair.map(place)).collect();
        let empty = Row { own: 0.0, common: 0.0, terms: Vec::new() };
        let (mut groups, mut terms, mut weights) = (Vec::new(), Vec::new(), Vec::new());
        for first in (0..zero).step_by(R) {
            let row: [&Row; R] = std::array::from_fn(|r| {
                order.get(first + r).map_or(&empty, |&node| &links.rows[node])
            });
            for k in 0..row.map(|row| row.terms.len()).into_iter().max().unwrap_or(0) {
                let term = row.map(|row| row.terms.get(k));
                terms
                    .push(term.map(|term| term.map_or(narrow(zero), |&(number, _)| place(number))));
                weights.push(term.map(|term| term.map_or(0.0, |&(_, weight)| weight)));
            }
            groups.push(Group {
                end: terms.len(),
                common: row.map(|row| row.common),
                own: row.map(|row| row.own),
            });
        }
        Self { places, n_runs, groups, terms, weights, weighted: links.weighted, shared }
    }

    /// Runs of numbers that all nodes take.
    pub(crate) fn n_runs(&self) -> usize {
        self.n_runs
    }

    /// The runs cut into so many pieces of about the same work.
    pub(crate) fn shares(&self, n: usize) -> Vec<Range<usize>> {
        let work_before = |run: usize| {
            let groups = run * Self::GROUPS_IN_RUN;
            let terms = if groups == 0 { 0 } else { self.groups[groups - 1].end * R };
            work(terms, run * Self::NODES_IN_RUN)
        };
        let runs: Vec<usize> = (0..self.n_runs).collect();
        let all = work_before(self.n_runs);
        let end = |k: usize| {
            let most = all * k as f64 / n as f64;
            runs.partition_point(|&run| work_before(run + 1) <= most * (1.0 + 1e-9))
        };
        (0..n).map(|k| end(k)..end(k + 1)).collect()
    }

    /// Numbers that the signals take, a multiple of [`TILE`].
    pub(crate) fn n_signals(&self) -> usize {
        (self.n_runs * TILE + (1 + self.shared.len()) * L).next_multiple_of(TILE)
    }

    /// Place of each node, in the order of nodes.
    pub(crate) fn places(&self) -> &[u32] {
        &self.places
    }

    /// Makes the shared sums of signals whose nodes are known.
    #[inline(always)]
    pub(crate) fn share(&self, signals: &mut [[f64; L]]) {
        let first = self.n_runs * Self::NODES_IN_RUN + 1;
        for (k, [a, b]) in self.shared.iter().enumerate() {
            let sum = Lanes(signals[*a as usize]) + Lanes(signals[*b as usize]);
            signals[first + k] = sum.0;
        }
    }

    /// Puts the inputs of the nodes of a run.
    #[inline(always)]
    pub(crate) fn put_inputs(&self, run: usize, signals: &[[f64; L]], inputs: &mut Tile) {
        let (of_nodes, _) = inputs.as_chunks_mut::<L>();
        for group in 0..Self::GROUPS_IN_RUN {
            let sums = self.group(run * Self::GROUPS_IN_RUN + group, signals);
            for r in 0..R {
                of_nodes[group * R + r] = sums[r].0;
            }
        }
    }

    #[inline(always)]
    fn group(&self, index: usize, signals: &[[f64; L]]) -> [Lanes<L>; R] {
        let start = if index == 0 { 0 } else { self.groups[index - 1].end };
        let group = &self.groups[index];
        let terms = &self.terms[start..group.end];
        let mut sums = [Lanes([0.0; L]); R];
        if self.weighted {
            for (places, weights) in terms.iter().zip(&self.weights[start..group.end]) {
                for r in 0..R {
                    sums[r] = sums[r] + Lanes(signals[places[r] as usize]) * weights[r];
                }
            }
        } else {
            for places in terms {
                for r in 0..R {
                    sums[r] = sums[r] + Lanes(signals[places[r] as usize]);
                }
            }
            for r in 0..R {
                sums[r] = sums[r] * group.common[r];
            }
        }
        for r in 0..R {
            sums[r] = sums[r] + Lanes(signals[index * R + r]) * group.own[r];
        }
        sums
    }
}

fn narrow(place: usize) -> u32 {
    u32::try_from(place).expect("places fit the 32-bit indices of the matrix")
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::SparseMatrix;

    const N: usize = 21;

    /// Inputs of all nodes, for signals of as many lanes.
    fn inputs<const L: usize, const R: usize>(
        matrix: &SparseMatrix,
        x: &[[f64; L]],
    ) -> Vec<[f64; L]> {
        let rows = RowSums::<L, R>::new(&Links::new(matrix));
        let mut signals = vec![[0.0; L]; rows.n_signals() / L];
        for (&place, x) in rows.places().iter().zip(x) {
            signals[place as usize] = *x;
        }
        rows.share(&mut signals);
        let mut runs = vec![[0.0; TILE]; rows.n_runs()];
        for (run, inputs) in runs.iter_mut().enumerate() {
            rows.put_inputs(run, &signals, inputs);
        }
        let placed = runs.as_flattened().as_chunks().0;
        rows.places().iter().map(|&place| placed[place as usize]).collect()
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
        fn the_sparse_sum_is_the_dense_one_to_rounding_and_the_same_in_any_number_of_lanes(
            kept in prop::collection::vec(prop::bool::weighted(0.7), N * N),
            weights in prop::collection::vec(0.1..2.0, N * N),
            equal in any::<bool>(),
            x in prop::collection::vec(-3.0..3.0, 16 * N),
        ) {
            let weight = |index: usize| if equal { weights[index / N] } else { weights[index] };
            let dense: Vec<f64> =
                (0..N * N).map(|index| if kept[index] { weight(index) } else { 0.0 }).collect();
            let matrix = sparse(&dense);
            let x: &[[f64; 16]] = x.as_chunks().0;
            let all = inputs::<16, 1>(&matrix, x);
            for (i, sums) in all.iter().enumerate() {
                for lane in 0..16 {
                    let expected: f64 = (0..N).map(|j| dense[i * N + j] * x[j][lane]).sum();
                    prop_assert!((sums[lane] - expected).abs() < 1e-12);
                }
            }
            macro_rules! agree {
                ($($lanes:literal lanes, $rows:literal rows;)*) => {$({
                    let first: Vec<[f64; $lanes]> = x.iter().map(|x| x.as_chunks().0[0]).collect();
                    let sums = inputs::<$lanes, $rows>(&matrix, &first);
                    let expected: Vec<[f64; $lanes]> =
                        all.iter().map(|sums| sums.as_chunks().0[0]).collect();
                    prop_assert_eq!(sums, expected);
                })*};
            }
            agree!(1 lanes, 8 rows; 2 lanes, 4 rows; 4 lanes, 4 rows; 8 lanes, 2 rows; 16 lanes, 1 rows;);
        }
    }
}
