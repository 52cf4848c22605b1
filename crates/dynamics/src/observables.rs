//! What is measured on the way: time averages ⟨|x_i − x_j|⟩ of one component, streamed.
//!
//! - pairwise: δx_ij = ⟨|x_i − x_j|⟩
//! - to a reference node: δx_i = ⟨|x_i − x_ref|⟩
//! - within cluster m of n_m nodes: δx^c_m = Σ_{i≠j ∈ C_m} ⟨|x_i − x_j|⟩ / n_m(n_m − 1)
//!
//! Source: Fan, Wang & Wang (2023), Fig. 1 and Sec. III A. Only sums over samples are kept, never a
//! trajectory.

use serde::{Deserialize, Serialize};

use crate::block_means::BlockMeans;
use crate::differences::{Differences, SAMPLES, Samples};
use crate::{Estimate, Lanes};

/// Which synchronisation errors to average.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Observables {
    /// Component whose differences are taken (from 0).
    pub component: usize,
    /// All pairs i < j.
    pub pairs: bool,
    /// Every node against this one.
    pub reference: Option<usize>,
    /// Mean over the pairs within each of these clusters, of two nodes or more.
    pub clusters: Vec<Vec<usize>>,
}

/// Time-averaged synchronisation errors of one replica, in units of the component.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// δx_ij for i < j, ordered (0,1), (0,2), …, (1,2), …; empty unless asked for.
    pub pairs: Vec<Estimate>,
    /// δx_i for every node i; empty unless asked for.
    pub to_reference: Vec<Estimate>,
    /// δx^c_m of each cluster.
    pub within_clusters: Vec<Estimate>,
}

impl Observables {
    /// Numbers of sums that a replica of so many nodes carries along.
    pub(crate) fn n_sums(&self, n_nodes: usize) -> usize {
        let pairs = if self.pairs { n_nodes * n_nodes.saturating_sub(1) / 2 } else { 0 };
        let to_reference = self.reference.map_or(0, |_| n_nodes);
        PARTS * (pairs + to_reference + self.clusters.len())
    }
}

impl Errors {
    /// δx_ij of a network of `n_nodes`; zero for i = j.
    ///
    /// # Panics
    /// When pairs were not observed.
    pub fn pair(&self, i: usize, j: usize, n_nodes: usize) -> f64 {
        if i == j { 0.0 } else { self.pairs[pair_index(i, j, n_nodes)].mean }
    }
}

/// Place of the pair {i, j}, i ≠ j, in the order (0,1), (0,2), …, (1,2), … of [`Errors::pairs`].
pub fn pair_index(i: usize, j: usize, n_nodes: usize) -> usize {
    let (i, j) = (i.min(j), i.max(j));
    i * n_nodes - i * (i + 1) / 2 + j - i - 1
}

/// The averages of `L` lanes as they grow: samples wait in a buffer, see [`Samples`].
pub(crate) struct ErrorSums<const L: usize> {
    n_nodes: usize,
    samples: Samples<L>,
    pairs: Option<Differences<PAIR_ROWS, L>>,
    reference: Option<Differences<1, L>>,
    /// Each cluster with the sum over its pairs.
    clusters: Vec<(Vec<usize>, BlockMeans)>,
    samples_per_block: u64,
    samples_in_block: u64,
}

/// Numbers that a snapshot keeps of each quantity.
const PARTS: usize = 3;

/// Nodes whose differences from all others are taken together.
const PAIR_ROWS: usize = 2;

impl<const L: usize> ErrorSums<L> {
    pub(crate) fn new(observables: &Observables, n_nodes: usize, samples_per_block: u64) -> Self {
        let upper: Vec<_> = (0..n_nodes).map(|i| (i, i + 1)).collect();
        let with_sum = |nodes: &Vec<usize>| (nodes.clone(), BlockMeans::new(L));
        Self {
            n_nodes,
            samples: Samples::new(n_nodes),
            pairs: observables.pairs.then(|| Differences::new(&upper, n_nodes)),
            reference: observables.reference.map(|node| Differences::new(&[(node, 0)], n_nodes)),
            clusters: observables.clusters.iter().map(with_sum).collect(),
            samples_per_block,
            samples_in_block: 0,
        }
    }

    /// Adds one sample of the observed component, the lanes of one node after the other.
    #[inline(always)]
    pub(crate) fn sample<'a>(&mut self, sample: impl Iterator<Item = &'a [f64; L]>) {
        self.samples.push(sample);
        self.samples_in_block += 1;
        let block_ends = self.samples_in_block == self.samples_per_block;
        if self.samples.len() == SAMPLES || block_ends {
            self.add_samples();
        }
        if block_ends {
            self.close_block();
        }
    }

    #[inline(always)]
    fn add_samples(&mut self) {
        if let Some(pairs) = &mut self.pairs {
            pairs.add(&self.samples);
        }
        if let Some(reference) = &mut self.reference {
            reference.add(&self.samples);
        }
        for (nodes, means) in &mut self.clusters {
            let [sum] = means.sums.as_chunks_mut::<L>().0 else { unreachable!("one sum a lane") };
            *sum = add_pairs(Lanes(*sum), nodes, &self.samples).0;
        }
        self.samples.clear();
    }

    #[inline(always)]
    fn close_block(&mut self) {
        let samples = self.samples_per_block as f64;
        if let Some(pairs) = &mut self.pairs {
            pairs.close(samples);
        }
        if let Some(reference) = &mut self.reference {
            reference.close(samples);
        }
        for (nodes, means) in &mut self.clusters {
            means.close((nodes.len() * (nodes.len() - 1) / 2) as f64 * samples);
        }
        self.samples_in_block = 0;
    }

    /// All that one lane has come to, [`Observables::n_sums`] numbers. Samples that wait are added
    /// first, which changes no bit: every sum takes them in their order.
    #[cold]
    #[inline(never)]
    pub(crate) fn kept(&mut self, lane: usize) -> Vec<f64> {
        self.add_samples();
        let mut kept = Vec::new();
        self.each(lane, |means, index| kept.extend(means.parts(index)));
        kept
    }

    /// Takes up a lane where [`Self::kept`] left it.
    #[cold]
    #[inline(never)]
    pub(crate) fn restore(&mut self, lane: usize, kept: &[f64]) {
        let mut parts = kept.as_chunks::<PARTS>().0.iter();
        self.each(lane, |means, index| {
            means.put(index, *parts.next().expect("a snapshot has all sums"));
        });
    }

    /// Goes on after so many samples.
    #[cold]
    #[inline(never)]
    pub(crate) fn go_on_after(&mut self, samples: u64) {
        self.samples_in_block = samples % self.samples_per_block;
        let blocks = u32::try_from(samples / self.samples_per_block).expect("there are few blocks");
        let of_pairs = self.pairs.iter_mut().map(|pairs| &mut pairs.means);
        let of_reference = self.reference.iter_mut().map(|reference| &mut reference.means);
        let of_clusters = self.clusters.iter_mut().map(|(_, means)| means);
        for means in of_pairs.chain(of_reference).chain(of_clusters) {
            means.go_on_after(blocks);
        }
    }

    /// Visits the quantities of a lane, in the order of [`Errors`].
    fn each(&mut self, lane: usize, mut visit: impl FnMut(&mut BlockMeans, usize)) {
        let n = self.n_nodes;
        if let Some(pairs) = &mut self.pairs {
            for (i, j) in (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j))) {
                let index = pairs.index(i, j, lane);
                visit(&mut pairs.means, index);
            }
        }
        if let Some(reference) = &mut self.reference {
            for node in 0..n {
                let index = reference.index(0, node, lane);
                visit(&mut reference.means, index);
            }
        }
        for (_, means) in &mut self.clusters {
            visit(means, lane);
        }
    }

    /// The averages of one lane.
    pub(crate) fn errors(&self, lane: usize) -> Errors {
        let n = self.n_nodes;
        let upper = || (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
        Errors {
            pairs: self
                .pairs
                .iter()
                .flat_map(|pairs| upper().map(|(i, j)| pairs.estimate(i, j, lane)))
                .collect(),
            to_reference: self
                .reference
                .iter()
                .flat_map(|reference| (0..n).map(|node| reference.estimate(0, node, lane)))
                .collect(),
            within_clusters: self.clusters.iter().map(|(_, means)| means.estimate(lane)).collect(),
        }
    }
}

/// Adds |x_i − x_j| of all pairs of some nodes to a sum, sample after sample.
#[inline(always)]
fn add_pairs<const L: usize>(mut sum: Lanes<L>, nodes: &[usize], samples: &Samples<L>) -> Lanes<L> {
    for sample in 0..samples.len() {
        for (position, &i) in nodes.iter().enumerate() {
            let x = samples.node(i, sample);
            for &j in &nodes[position + 1..] {
                sum = sum + (x - samples.node(j, sample)).abs();
            }
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::BLOCKS;

    fn observed(observables: &Observables, samples: &[[f64; 3]]) -> Errors {
        let mut sums = ErrorSums::<1>::new(observables, 3, (samples.len() / BLOCKS) as u64);
        for sample in samples {
            sums.sample(sample.as_chunks().0.iter());
        }
        sums.errors(0)
    }

    #[test]
    fn errors_of_constant_nodes_are_their_distances() {
        let observables = Observables {
            component: 0,
            pairs: true,
            reference: Some(1),
            clusters: vec![vec![0, 1, 2]],
        };
        let errors = observed(&observables, &[[1.0, 3.0, 7.0]; 2 * BLOCKS]);
        let means = |estimates: &[Estimate]| estimates.iter().map(|e| e.mean).collect::<Vec<_>>();
        assert_eq!(means(&errors.pairs), [2.0, 6.0, 4.0]);
        assert_eq!(means(&errors.to_reference), [2.0, 0.0, 4.0]);
        assert_eq!(means(&errors.within_clusters), [4.0]);
        assert_eq!(
            [errors.pair(2, 1, 3), errors.pair(0, 2, 3), errors.pair(1, 1, 3)],
            [4.0, 6.0, 0.0]
        );
        assert!(errors.pairs.iter().all(|estimate| estimate.standard_error == 0.0));
    }

    #[test]
    fn standard_errors_are_those_of_the_block_means() {
        let samples: Vec<_> = (0..BLOCKS).map(|k| [k as f64, 0.0, 0.0]).collect();
        let errors = observed(&Observables { pairs: true, ..Default::default() }, &samples);
        let blocks: Vec<_> = (0..BLOCKS).map(|k| k as f64).collect();
        let expected = Estimate::from_independent(&blocks);
        assert!((errors.pairs[0].mean - expected.mean).abs() < 1e-13);
        assert!((errors.pairs[0].standard_error - expected.standard_error).abs() < 1e-13);
    }

    /// Errors made by adding every sample to every sum as it comes.
    fn unbuffered(samples: &[Vec<f64>], per_block: usize, pairs: &[(usize, usize)]) -> Vec<f64> {
        let mean = |&(i, j): &(usize, usize)| {
            let block = |(before, block): (f64, usize), samples: &[Vec<f64>]| {
                let sum = samples.iter().fold(0.0, |sum, x| sum + (x[i] - x[j]).abs());
                let value = sum * (1.0 / per_block as f64);
                (before + (value - before) * (1.0 / block as f64), block + 1)
            };
            samples.chunks(per_block).fold((0.0, 1), block).0
        };
        pairs.iter().map(mean).collect()
    }

    fn check_buffer<const L: usize>() {
        // Blocks of 70 samples fill the buffer twice and a bit; 21 nodes fill no run of numbers.
        let (n_nodes, per_block) = (21, 70);
        let value = |sample: usize, node: usize, lane: usize| {
            ((sample * 31 + node * 17 + lane * 7) as f64).sin() * (1.0 + node as f64)
        };
        let observables = Observables { pairs: true, reference: Some(4), ..Observables::default() };
        let mut sums = ErrorSums::<L>::new(&observables, n_nodes, per_block as u64);
        for sample in 0..per_block * BLOCKS {
            let numbers: Vec<f64> = (0..n_nodes * L).map(|k| value(sample, k / L, k % L)).collect();
            sums.sample(numbers.as_chunks().0.iter());
        }
        let pairs: Vec<_> =
            (0..n_nodes).flat_map(|i| (i + 1..n_nodes).map(move |j| (i, j))).collect();
        let to_reference: Vec<_> = (0..n_nodes).map(|node| (node, 4)).collect();
        for lane in 0..L {
            let samples: Vec<Vec<f64>> = (0..per_block * BLOCKS)
                .map(|sample| (0..n_nodes).map(|node| value(sample, node, lane)).collect())
                .collect();
            let errors = sums.errors(lane);
            for (estimates, pairs) in [(errors.pairs, &pairs), (errors.to_reference, &to_reference)]
            {
                let means: Vec<f64> = estimates.iter().map(|estimate| estimate.mean).collect();
                assert_eq!(means, unbuffered(&samples, per_block, pairs), "lane {lane} of {L}");
            }
        }
    }

    #[test]
    fn buffered_samples_give_the_bits_of_samples_added_one_by_one() {
        check_buffer::<1>();
        check_buffer::<2>();
        check_buffer::<16>();
    }
}
