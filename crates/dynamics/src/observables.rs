//! What is measured on the way: time averages ⟨|x_i − x_j|⟩ of one component, streamed.
//!
//! - pairwise: δx_ij = ⟨|x_i − x_j|⟩
//! - to a reference node: δx_i = ⟨|x_i − x_ref|⟩
//! - within cluster m of n_m nodes: δx^c_m = Σ_{i≠j ∈ C_m} ⟨|x_i − x_j|⟩ / n_m(n_m − 1)
//!
//! Source: Fan, Wang & Wang (2023), Fig. 1 and Sec. III A. Only sums over samples are kept, never a
//! trajectory.

use crate::statistics::BLOCKS;
use crate::{Estimate, Lanes};

/// Which synchronisation errors to average.
#[derive(Clone, Debug, Default, PartialEq)]
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
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Errors {
    /// δx_ij for i < j, ordered (0,1), (0,2), …, (1,2), …; empty unless asked for.
    pub pairs: Vec<Estimate>,
    /// δx_i for every node i; empty unless asked for.
    pub to_reference: Vec<Estimate>,
    /// δx^c_m of each cluster.
    pub within_clusters: Vec<Estimate>,
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

/// Channels, each the mean of |x_i − x_j| over its own list of pairs, and their running sums.
pub(crate) struct ErrorSums<const L: usize> {
    component: usize,
    n_pairs: usize,
    n_reference: usize,
    /// Pairs of all channels, one channel after the other.
    pairs: Vec<[u32; 2]>,
    /// Where each channel ends in `pairs`.
    ends: Vec<usize>,
    /// Sum over the samples of the block in progress.
    block: Vec<Lanes<L>>,
    /// Mean of the finished blocks and sum of squared deviations from it (Welford 1962).
    mean: Vec<Lanes<L>>,
    squares: Vec<Lanes<L>>,
    samples_per_block: u64,
    samples_in_block: u64,
    blocks: usize,
}

impl<const L: usize> ErrorSums<L> {
    pub(crate) fn new(observables: &Observables, n_nodes: usize, samples_per_block: u64) -> Self {
        let (mut pairs, mut ends) = (Vec::new(), Vec::new());
        if observables.pairs {
            for pair in pairs_of(&(0..n_nodes).collect::<Vec<_>>()) {
                pairs.push(pair);
                ends.push(pairs.len());
            }
        }
        let n_pairs = ends.len();
        if let Some(reference) = observables.reference {
            for node in 0..n_nodes {
                pairs.push([narrow(node), narrow(reference)]);
                ends.push(pairs.len());
            }
        }
        let n_reference = ends.len() - n_pairs;
        for cluster in &observables.clusters {
            pairs.extend(pairs_of(cluster));
            ends.push(pairs.len());
        }
        let zeros = vec![Lanes([0.0; L]); ends.len()];
        Self {
            component: observables.component,
            n_pairs,
            n_reference,
            pairs,
            ends,
            block: zeros.clone(),
            mean: zeros.clone(),
            squares: zeros,
            samples_per_block,
            samples_in_block: 0,
            blocks: 0,
        }
    }

    /// Adds one sample of the network's state, `[component][node]`.
    #[inline(always)]
    pub(crate) fn sample<const D: usize>(&mut self, state: [&[Lanes<L>]; D]) {
        let x = state[self.component];
        let mut start = 0;
        for (block, &end) in self.block.iter_mut().zip(&self.ends) {
            for &[i, j] in &self.pairs[start..end] {
                *block = *block + (x[i as usize] - x[j as usize]).abs();
            }
            start = end;
        }
        self.samples_in_block += 1;
        if self.samples_in_block == self.samples_per_block {
            self.close_block();
        }
    }

    fn close_block(&mut self) {
        self.blocks += 1;
        let mut start = 0;
        for (channel, &end) in self.ends.iter().enumerate() {
            let terms = (end - start) as f64 * self.samples_per_block as f64;
            let value = self.block[channel] * (1.0 / terms);
            let before = value - self.mean[channel];
            self.mean[channel] = self.mean[channel] + before * (1.0 / self.blocks as f64);
            self.squares[channel] = self.squares[channel] + before * (value - self.mean[channel]);
            self.block[channel] = Lanes([0.0; L]);
            start = end;
        }
        self.samples_in_block = 0;
    }

    /// The averages of one lane.
    pub(crate) fn errors(&self, lane: usize) -> Errors {
        let blocks = BLOCKS as f64;
        let estimates = |range: std::ops::Range<usize>| {
            range
                .map(|channel| Estimate {
                    mean: self.mean[channel].0[lane],
                    standard_error: (self.squares[channel].0[lane].max(0.0)
                        / (blocks - 1.0)
                        / blocks)
                        .sqrt(),
                })
                .collect()
        };
        let (first, second) = (self.n_pairs, self.n_pairs + self.n_reference);
        Errors {
            pairs: estimates(0..first),
            to_reference: estimates(first..second),
            within_clusters: estimates(second..self.ends.len()),
        }
    }
}

fn pairs_of(nodes: &[usize]) -> impl Iterator<Item = [u32; 2]> + '_ {
    nodes.iter().enumerate().flat_map(move |(position, &i)| {
        nodes[position + 1..].iter().map(move |&j| [narrow(i), narrow(j)])
    })
}

fn narrow(node: usize) -> u32 {
    u32::try_from(node).expect("node numbers fit the 32-bit indices of the matrix")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn observed(observables: &Observables, samples: &[[f64; 3]]) -> Errors {
        let mut sums = ErrorSums::<1>::new(observables, 3, (samples.len() / BLOCKS) as u64);
        for sample in samples {
            sums.sample([&sample.map(|x| Lanes([x]))]);
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
}
