//! What a sweep of simulations shows: errors over ε and seeds, clusters, and where these set in.
//!
//! "Synchronised" is defined once: two nodes are when δx_ij is below a bound, a cluster is when δx^c_m
//! is. The bound is `synchronised_below`, a number or a fraction of the largest δx_ij at the same ε
//! (a mean over seeds). Clusters at one ε come from the mean over seeds by single linkage; the onset
//! of a cluster is found in every seed by itself and its spread over seeds reported.

use clustering::Partition;
use dynamics::{Errors, Estimate, Outcome, Run};

use crate::plan::Sweep;
use crate::spec::Bound;

/// Errors below this, in units of the component, are what rounding and kicks leave of perfect
/// synchrony: nodes that far apart are together, whatever fraction of the largest error it is.
const PERFECT_SYNCHRONY: f64 = 1e-9;

/// The runs of a sweep, seed by seed within each ε.
pub struct Simulated {
    pub epsilon: Vec<f64>,
    pub seeds: Vec<u64>,
    pub runs: Vec<Run>,
    synchronised_below: Bound,
    n_nodes: usize,
}

/// An error at one ε over all seeds.
#[derive(Clone, Copy, Debug, serde::Serialize)]
pub struct OverSeeds {
    /// Mean over seeds.
    pub mean: f64,
    /// Standard deviation over seeds; zero for a single one.
    pub spread: f64,
    /// Standard error of the mean: the larger of what the blocks within the runs and the scatter of
    /// the seeds tell.
    pub standard_error: f64,
}

/// δx_ij of all pairs i < j.
pub struct MeanPairs {
    n_nodes: usize,
    means: Vec<f64>,
}

impl MeanPairs {
    /// δx_ij, zero for i = j.
    pub fn of(&self, i: usize, j: usize) -> f64 {
        if i == j { 0.0 } else { self.means[dynamics::pair_index(i, j, self.n_nodes)] }
    }

    /// The largest of all.
    pub fn largest(&self) -> f64 {
        self.means.iter().copied().fold(0.0, f64::max)
    }
}

/// ε from which on clusters stay synchronised, over all seeds.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Onset {
    /// Mean over seeds; none unless every seed has an onset within the sweep.
    pub mean: Option<f64>,
    /// Standard deviation over seeds.
    pub spread: Option<f64>,
    /// Of each seed; none where the clusters are not synchronised at the largest ε, and the smallest
    /// ε of the sweep where they are synchronised throughout.
    pub of_seeds: Vec<Option<f64>>,
}

impl Simulated {
    pub fn new(sweep: &Sweep, n_nodes: usize, runs: Vec<Run>) -> Self {
        Self {
            epsilon: sweep.epsilon.clone(),
            seeds: sweep.seeds.clone(),
            synchronised_below: sweep.synchronised_below,
            n_nodes,
            runs,
        }
    }

    /// Position of a coupling strength in the sweep.
    pub fn position(&self, epsilon: f64) -> Option<usize> {
        self.epsilon.iter().position(|&value| value == epsilon)
    }

    /// Largest distance between neighbouring couplings of the sweep.
    pub fn widest_step(&self) -> f64 {
        self.epsilon.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max)
    }

    /// The runs at one ε, in the order of seeds.
    pub fn at(&self, position: usize) -> &[Run] {
        &self.runs[position * self.seeds.len()..(position + 1) * self.seeds.len()]
    }

    /// One error at one ε over the seeds that stayed bounded; none if none did.
    pub fn over_seeds(
        &self,
        position: usize,
        of: impl Fn(&Errors) -> Estimate,
    ) -> Option<OverSeeds> {
        let estimates: Vec<Estimate> =
            self.at(position).iter().filter_map(completed).map(of).collect();
        let means: Vec<f64> = estimates.iter().map(|estimate| estimate.mean).collect();
        let n = means.len() as f64;
        if means.is_empty() {
            return None;
        }
        let over_seeds = Estimate::from_independent(&means);
        let scatter = if means.len() > 1 { over_seeds.standard_error } else { 0.0 };
        let blocks: f64 = estimates.iter().map(|e| e.standard_error.powi(2)).sum();
        Some(OverSeeds {
            mean: over_seeds.mean,
            spread: scatter * n.sqrt(),
            standard_error: scatter.max(blocks.sqrt() / n),
        })
    }

    /// Whether errors of all pairs were observed.
    pub fn has_pairs(&self) -> bool {
        self.runs.iter().find_map(completed).is_some_and(|errors| !errors.pairs.is_empty())
    }

    /// δx_ij at one ε as means over the seeds that stayed bounded; none if none did.
    pub fn mean_pairs(&self, position: usize) -> Option<MeanPairs> {
        let errors: Vec<&Errors> = self.at(position).iter().filter_map(completed).collect();
        let first = errors.first().filter(|errors| !errors.pairs.is_empty())?;
        let mean = |pair: usize| {
            errors.iter().map(|errors| errors.pairs[pair].mean).sum::<f64>() / errors.len() as f64
        };
        Some(MeanPairs { n_nodes: self.n_nodes, means: (0..first.pairs.len()).map(mean).collect() })
    }

    /// Below which errors at one ε count as synchrony.
    pub fn bound(&self, position: usize) -> f64 {
        let largest = || self.mean_pairs(position).map_or(0.0, |mean| mean.largest());
        self.synchronised_below.value(largest).max(PERFECT_SYNCHRONY)
    }

    /// Clusters at one ε: single linkage of the mean δx_ij over seeds. None unless pairs were observed
    /// and a run stayed bounded.
    pub fn clusters(&self, position: usize) -> Option<Partition> {
        let mean = self.mean_pairs(position)?;
        // Below, not at: a bound belongs to those that are not synchronised.
        let threshold = self.bound(position).next_down();
        Some(Partition::single_linkage(self.n_nodes, |i, j| mean.of(i, j), threshold))
    }

    /// δx^c_m of any set of nodes in one run: the mean over its pairs; infinite if the run escaped.
    pub fn cluster_error(&self, run: &Run, cluster: &[usize]) -> f64 {
        let Some(errors) = completed(run) else { return f64::INFINITY };
        let pairs = cluster
            .iter()
            .enumerate()
            .flat_map(|(position, &i)| cluster[position + 1..].iter().map(move |&j| (i, j)));
        let (mut sum, mut count) = (0.0, 0.0);
        for (i, j) in pairs {
            sum += errors.pair(i, j, self.n_nodes);
            count += 1.0;
        }
        sum / count
    }

    /// Largest δx^c_m of some clusters at one ε, as a mean over seeds.
    pub fn largest_cluster_error(&self, position: usize, clusters: &[Vec<usize>]) -> f64 {
        let runs = self.at(position);
        let mean = |cluster: &Vec<usize>| {
            let sum: f64 = runs.iter().map(|run| self.cluster_error(run, cluster)).sum();
            sum / runs.len() as f64
        };
        clusters.iter().map(mean).fold(0.0, f64::max)
    }

    /// From which ε on all of these clusters stay synchronised: midway between the largest ε of the
    /// sweep at which one of them is not, and the next.
    pub fn onset(&self, clusters: &[Vec<usize>]) -> Onset {
        let bounds: Vec<f64> = (0..self.epsilon.len()).map(|at| self.bound(at)).collect();
        let synchronised = |position: usize, seed: usize| {
            let run = &self.at(position)[seed];
            clusters.iter().all(|c| self.cluster_error(run, c) < bounds[position])
        };
        let of_seed = |seed| {
            let last_lost = (0..self.epsilon.len()).rev().find(|&at| !synchronised(at, seed));
            match last_lost {
                None => self.epsilon.first().copied(),
                Some(lost) => {
                    let kept = self.epsilon.get(lost + 1)?;
                    Some(0.5 * (self.epsilon[lost] + kept))
                }
            }
        };
        let of_seeds: Vec<Option<f64>> = (0..self.seeds.len()).map(of_seed).collect();
        let all: Option<Vec<f64>> = of_seeds.iter().copied().collect();
        let over_seeds = all.as_deref().map(|values| {
            let estimate = Estimate::from_independent(values);
            let root_n = (values.len() as f64).sqrt();
            (estimate.mean, if values.len() > 1 { estimate.standard_error * root_n } else { 0.0 })
        });
        Onset {
            mean: over_seeds.map(|(mean, _)| mean),
            spread: over_seeds.map(|(_, s)| s),
            of_seeds,
        }
    }
}

/// The errors of a run that stayed bounded.
pub fn completed(run: &Run) -> Option<&Errors> {
    match &run.outcome {
        Outcome::Completed(errors) => Some(errors),
        Outcome::Escaped { .. } => None,
    }
}

#[cfg(test)]
mod tests {
    use dynamics::Replica;

    use super::*;

    /// Two nodes whose error is given for each ε and seed.
    fn simulated(errors: &[[f64; 2]]) -> Simulated {
        let run = |epsilon: f64, seed: u64, mean: f64| {
            let pairs = vec![Estimate { mean, standard_error: 0.0 }];
            let outcome = Outcome::Completed(Errors { pairs, ..Errors::default() });
            Run { replica: Replica { epsilon, seed }, outcome }
        };
        let epsilon: Vec<f64> = (0..errors.len()).map(|k| k as f64).collect();
        let runs = errors
            .iter()
            .zip(&epsilon)
            .flat_map(|(pair, &epsilon)| [run(epsilon, 1, pair[0]), run(epsilon, 2, pair[1])]);
        Simulated {
            runs: runs.collect(),
            epsilon,
            seeds: vec![1, 2],
            synchronised_below: Bound::Fixed(0.1),
            n_nodes: 2,
        }
    }

    #[test]
    fn an_onset_lies_above_the_last_coupling_at_which_synchrony_is_lost() {
        // Seed 2 bursts once more at ε = 3 after looking synchronised at 2.
        let sweep = simulated(&[[5.0, 5.0], [5.0, 5.0], [0.0, 0.0], [0.0, 0.2], [0.0, 0.0]]);
        let onset = sweep.onset(&[vec![0, 1]]);
        assert_eq!(onset.of_seeds, [Some(1.5), Some(3.5)]);
        assert_eq!(onset.mean, Some(2.5));
        assert_eq!(onset.spread, Some(2f64.sqrt()));
    }

    #[test]
    fn there_is_no_onset_where_the_largest_coupling_does_not_synchronise() {
        let sweep = simulated(&[[5.0, 5.0], [5.0, 0.0]]);
        let onset = sweep.onset(&[vec![0, 1]]);
        assert_eq!(onset.of_seeds, [None, Some(0.5)]);
        assert_eq!(onset.mean, None);
    }

    #[test]
    fn a_relative_bound_follows_the_largest_error_down_to_perfect_synchrony() {
        let mut sweep = simulated(&[[4.0, 2.0], [1e-12, 3e-12]]);
        sweep.synchronised_below = Bound::OfLargest(0.1);
        assert_eq!(sweep.bound(0), 0.1 * 3.0);
        assert_eq!(sweep.bound(1), PERFECT_SYNCHRONY);
        assert_eq!(sweep.clusters(1).unwrap().nontrivial(), [vec![0, 1]]);
    }

    #[test]
    fn nodes_cluster_when_their_mean_error_is_below_the_threshold() {
        let sweep = simulated(&[[0.0, 0.19], [0.0, 0.2]]);
        assert_eq!(sweep.clusters(0).unwrap().nontrivial(), [vec![0, 1]]);
        assert!(sweep.clusters(1).unwrap().nontrivial().is_empty());
    }
}
