//! Replicas cut into batches of lanes, and a batch run from its initial states to its end.

use crate::instruction_set::Work;
use crate::kernel::{Network, WIDTH};
use crate::kicks::Kicks;
use crate::links::Links;
use crate::observables::ErrorSums;
use crate::{Oscillator, Outcome, Progress, Replica, Simulation};

/// Numbers of lanes, and what a step of so many costs beside that of a single one: measured on
/// networks of 90 and 989 nodes with AVX-512, and rounded.
const COSTS: [(usize, f64); 5] = [(1, 1.0), (2, 1.1), (4, 1.6), (8, 2.25), (WIDTH, 3.8)];

/// Sizes of the batches into which replicas are cut so that the slowest thread ends earliest: every
/// thread gets an equal share, and each share is cut as costs least.
pub(crate) fn sizes(n_replicas: usize, n_threads: usize) -> Vec<usize> {
    let share = |thread: usize| (n_replicas + thread) / n_threads;
    (0..n_threads).rev().flat_map(|thread| cheapest(share(thread))).collect()
}

/// Sizes of the batches of one thread, large ones first.
fn cheapest(n_replicas: usize) -> Vec<usize> {
    // Of each number of replicas: the least cost, and the batch with which its cut begins.
    let mut best = vec![(0.0, 0)];
    for n in 1..=n_replicas {
        let cut = |&(lanes, cost): &(usize, f64)| {
            let batch = lanes.min(n);
            (cost + best[n - batch].0, batch)
        };
        let cheaper = |a: &(f64, usize), b: &(f64, usize)| a.0.total_cmp(&b.0);
        best.push(COSTS.iter().map(cut).min_by(cheaper).expect("there are costs"));
    }
    let next = |&left: &usize| Some(left - best[left].1);
    let left = std::iter::successors(Some(n_replicas), next).take_while(|&left| left > 0);
    let mut sizes: Vec<usize> = left.map(|left| best[left].1).collect();
    sizes.sort_unstable_by(|a, b| b.cmp(a));
    sizes
}

/// Replicas advanced side by side in `L` lanes, their rows summed `R` side by side.
pub(crate) struct Batch<'a, O, const D: usize, const L: usize, const R: usize> {
    pub(crate) simulation: &'a Simulation<'a>,
    pub(crate) links: &'a Links,
    pub(crate) oscillator: O,
    /// At most `L`.
    pub(crate) replicas: &'a [Replica],
    pub(crate) progress: Progress<'a>,
}

impl<O: Oscillator<D>, const D: usize, const L: usize, const R: usize> Work
    for Batch<'_, O, D, L, R>
{
    type Output = Vec<Outcome>;

    #[inline(always)]
    fn run(self) -> Vec<Outcome> {
        let Self { simulation, links, oscillator, replicas, progress } = self;
        let Simulation { schedule, observables, coupling, kick, .. } = simulation;
        // Lanes beyond the batch repeat its last replica and are never read.
        let in_lanes = std::array::from_fn(|lane| replicas[lane.min(replicas.len() - 1)]);
        let mut network = Network::<O, D, L, R>::new(oscillator, *coupling, links, in_lanes);
        let mut sums =
            ErrorSums::<L>::new(observables, links.n_nodes(), schedule.samples_per_block());
        let mut kicks = Kicks::new(*kick, schedule.sampling_interval(), in_lanes);
        let mut escaped_at = [None; L];
        for sample in 1..=schedule.transient_samples() + schedule.samples() {
            network.advance(schedule.stride, schedule.step);
            for (escaped_at, bounded) in escaped_at.iter_mut().zip(network.bounded()) {
                if escaped_at.is_none() && !bounded {
                    *escaped_at = Some(schedule.time_of(sample));
                }
            }
            if escaped_at.iter().all(Option::is_some) {
                break;
            }
            if sample > schedule.transient_samples() {
                sums.sample(network.component(observables.component));
            }
            if kicks.due(sample) {
                network.change_state(|_, _, lanes| kicks.apply(lanes));
            }
            progress(u64::from(schedule.stride) * replicas.len() as u64);
        }
        let outcome = |lane: usize| match escaped_at[lane] {
            Some(time) => Outcome::Escaped { time },
            None => Outcome::Completed(sums.errors(lane)),
        };
        (0..replicas.len()).map(outcome).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cost(sizes: &[usize]) -> f64 {
        let of = |&size: &usize| {
            COSTS.iter().find(|(lanes, _)| *lanes >= size).expect("no batch is wider").1
        };
        sizes.iter().map(of).sum()
    }

    #[test]
    fn every_replica_is_in_one_batch_and_no_batch_is_wider_than_the_lanes() {
        for (n_replicas, n_threads) in (0..70).flat_map(|n| [1, 2, 3, 8].map(|t| (n, t))) {
            let sizes = sizes(n_replicas, n_threads);
            assert_eq!(sizes.iter().sum::<usize>(), n_replicas);
            assert!(sizes.iter().all(|size| (1..=WIDTH).contains(size)), "{sizes:?}");
        }
    }

    #[test]
    fn threads_share_replicas_equally_and_lanes_stay_empty_only_where_that_costs_less() {
        assert_eq!(sizes(4, 2), [2, 2]);
        assert_eq!(sizes(40, 2), [16, 4, 16, 4]);
        assert_eq!(sizes(5, 8), [1; 5]);
        // One lane of sixteen empty costs less than batches of 8, 4, 2 and 1.
        assert_eq!(sizes(15, 1), [15]);
        assert_eq!(sizes(9, 1), [8, 1]);
    }

    #[test]
    fn no_cut_into_full_batches_costs_less() {
        for n in 1..50usize {
            let binary: Vec<usize> =
                (0..4).map(|bit| 1 << bit).filter(|size| n & size != 0).collect();
            let full = [vec![WIDTH; n / WIDTH], binary].concat();
            assert!(cost(&cheapest(n)) <= cost(&full) + 1e-12, "{n}: {:?}", cheapest(n));
        }
    }
}
