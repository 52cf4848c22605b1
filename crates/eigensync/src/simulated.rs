//! What a sweep of simulations shows: errors over ε and seeds, clusters, and where these set in.
//!
//! "Synchronised" is defined once: two nodes are when δx_ij is below a bound, a cluster is when δx^c_m
//! is. The bound is `synchronised_below`, a number or a fraction of the largest δx_ij at the same ε
//! (a mean over seeds). Clusters at one ε come from the mean over seeds by single linkage; the range of
//! ε in which clusters were seen is found in every seed by itself, see `simulated/range`.
//!
//! Means are over the runs that stayed bounded, and their number stands beside them. Nodes at ε = 0 are
//! uncoupled: whether their errors are small is a property of each node, and no synchrony.

pub(crate) mod end;
mod groups;
pub(crate) mod range;

use clustering::Partition;
use dynamics::{Errors, Estimate, Outcome, Run};

use crate::{Bound, Sweep};

use groups::groups;

pub use groups::Apart;

/// Errors below this, in units of the component, are what rounding and kicks leave of perfect
/// synchrony: nodes that far apart are together, whatever fraction of the largest error it is.
const PERFECT_SYNCHRONY: f64 = 1e-9;

/// Errors of seeds that differ by less than some of these, in units of the largest error of the sweep,
/// may do so by bursts.
const BURSTS: f64 = 0.05;

/// The runs of a sweep, seed by seed within each ε.
pub struct Simulated {
    /// Coupling strengths, ascending.
    pub epsilon: Vec<f64>,
    /// Seeds of initial states.
    pub seeds: Vec<u64>,
    /// One for each ε and seed.
    pub runs: Vec<Run>,
    /// How far apart groups of seeds must be to count.
    pub apart: Apart,
    synchronised_below: Bound,
    n_nodes: usize,
}

/// An error at one ε over the seeds that stayed bounded.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct OverSeeds {
    /// Mean over these seeds.
    pub mean: f64,
    /// Standard deviation over them; zero for a single one.
    pub spread: f64,
    /// Standard error of the mean: the larger of what the blocks within the runs and the scatter of
    /// the seeds tell.
    pub standard_error: f64,
    /// How many they are.
    pub n_seeds: usize,
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

impl Simulated {
    /// The runs of a sweep of so many nodes.
    pub fn new(sweep: &Sweep, n_nodes: usize, runs: Vec<Run>) -> Self {
        Self {
            epsilon: sweep.epsilon.clone(),
            seeds: sweep.seeds.clone(),
            apart: Apart::UNEXPECTED,
            synchronised_below: sweep.synchronised_below,
            n_nodes,
            runs,
        }
    }

    /// Number of nodes of the network.
    pub fn n_nodes(&self) -> usize {
        self.n_nodes
    }

    /// Position of a coupling strength in the sweep.
    pub fn position(&self, epsilon: f64) -> Option<usize> {
        self.epsilon.iter().position(|&value| value == epsilon)
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
            n_seeds: means.len(),
        })
    }

    /// Whether the errors of all pairs were observed.
    pub fn has_pairs(&self) -> bool {
        self.runs.iter().filter_map(completed).any(|errors| !errors.pairs.is_empty())
    }

    /// How many runs at one ε escaped.
    pub fn escaped(&self, position: usize) -> usize {
        let escaped = |run: &&Run| matches!(run.outcome, Outcome::Escaped { .. });
        self.at(position).iter().filter(escaped).count()
    }

    /// How many runs at one ε came to no end: they escaped, or the integrator gave up.
    pub fn broken_off(&self, position: usize) -> usize {
        self.at(position).iter().filter(|run| completed(run).is_none()).count()
    }

    /// What runs did that came to no end, in a word.
    pub fn broke_off(&self) -> &'static str {
        let has_failed = self.runs.iter().any(|run| matches!(run.outcome, Outcome::Failed { .. }));
        if has_failed { "broke off" } else { "escaped" }
    }

    /// How many runs at one ε stayed bounded.
    pub fn bounded(&self, position: usize) -> usize {
        self.seeds.len() - self.broken_off(position)
    }

    /// δx_ij at one ε as means over the seeds that stayed bounded; none if none did.
    pub fn mean_pairs(&self, position: usize) -> Option<MeanPairs> {
        self.mean_pairs_but(position, None)
    }

    /// The same means with one of these seeds, counted from 0, left out.
    pub fn mean_pairs_without(&self, position: usize, seed: usize) -> Option<MeanPairs> {
        self.mean_pairs_but(position, Some(seed))
    }

    fn mean_pairs_but(&self, position: usize, left_out: Option<usize>) -> Option<MeanPairs> {
        let bounded = self.at(position).iter().filter_map(completed).enumerate();
        let errors: Vec<&Errors> =
            bounded.filter(|(seed, _)| Some(*seed) != left_out).map(|(_, errors)| errors).collect();
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
    /// and a run stayed bounded; every node by itself at ε = 0, where there is nothing to synchronise
    /// by.
    pub fn clusters(&self, position: usize) -> Option<Partition> {
        Some(self.clusters_of(position, &self.mean_pairs(position)?))
    }

    /// The same clusters of other means at this ε, such as those with a seed left out.
    pub fn clusters_of(&self, position: usize, mean: &MeanPairs) -> Partition {
        if self.epsilon[position] == 0.0 {
            return Partition::from_marks(&(0..self.n_nodes).collect::<Vec<_>>());
        }
        let bound = self.synchronised_below.value(|| mean.largest()).max(PERFECT_SYNCHRONY);
        // Below, not at: a bound belongs to those that are not synchronised.
        Partition::single_linkage(self.n_nodes, |i, j| mean.of(i, j), bound.next_down())
    }

    /// δx^c_m of a set of two nodes or more in one run: the mean over its pairs; none if the run
    /// escaped.
    pub fn cluster_error(&self, run: &Run, cluster: &[usize]) -> Option<f64> {
        completed(run).map(|errors| self.within(errors, cluster).mean)
    }

    /// The mean error over the pairs of a cluster. Errors of one run rise and fall together: their
    /// standard errors are averaged as they are.
    fn within(&self, errors: &Errors, cluster: &[usize]) -> Estimate {
        assert!(cluster.len() > 1, "{} nodes have no pair", cluster.len());
        let pairs = cluster
            .iter()
            .enumerate()
            .flat_map(|(position, &i)| cluster[position + 1..].iter().map(move |&j| (i, j)));
        let (mut sum, mut standard_error, mut count) = (0.0, 0.0, 0.0);
        for (i, j) in pairs {
            let pair = errors.pairs[dynamics::pair_index(i, j, self.n_nodes)];
            sum += pair.mean;
            standard_error += pair.standard_error;
            count += 1.0;
        }
        Estimate { mean: sum / count, standard_error: standard_error / count }
    }

    /// Largest δx^c_m of some clusters at one ε, over seeds; none without clusters, or where a run
    /// escaped.
    pub fn largest_cluster_error(
        &self,
        position: usize,
        clusters: &[Vec<usize>],
    ) -> Option<OverSeeds> {
        if self.broken_off(position) > 0 {
            return None;
        }
        let of = |cluster: &Vec<usize>| self.over_seeds(position, |e| self.within(e, cluster));
        clusters.iter().filter_map(of).max_by(|a, b| a.mean.total_cmp(&b.mean))
    }

    /// The two groups into which runs at one ε fall, each from its least to its most of their largest
    /// errors, and how many they are; none unless they do, far apart also against the errors of the
    /// whole sweep, since bursts scatter as well.
    pub fn parted(&self, position: usize) -> Option<Vec<(usize, [f64; 2])>> {
        let largest = |run: &Run| {
            let errors = observed(completed(run)?).copied();
            errors.reduce(|a, b| if b.mean > a.mean { b } else { a })
        };
        let errors: Vec<Estimate> = self.at(position).iter().filter_map(largest).collect();
        let values: Vec<f64> = errors.iter().map(|error| error.mean).collect();
        let own = errors.iter().map(|error| error.standard_error).fold(0.0, f64::max);
        let of_sweep = self.runs.iter().filter_map(largest).map(|e| e.mean).fold(0.0, f64::max);
        let found = groups(&values, own.max(BURSTS * of_sweep), self.apart)?;
        let range = |seeds: Vec<usize>| {
            let of = || seeds.iter().map(|&seed| values[seed]);
            (seeds.len(), [of().fold(f64::INFINITY, f64::min), of().fold(0.0, f64::max)])
        };
        Some(found.into_iter().map(range).collect())
    }

    /// Below which errors of this sweep are rounding.
    pub fn rounding(&self) -> f64 {
        let errors = self.runs.iter().filter_map(completed).flat_map(observed);
        let largest = errors.map(|error| error.mean).fold(0.0, f64::max);
        PERFECT_SYNCHRONY * largest.max(1.0)
    }
}

/// The errors of a run that stayed bounded.
pub fn completed(run: &Run) -> Option<&Errors> {
    match &run.outcome {
        Outcome::Completed(errors) => Some(errors),
        Outcome::Escaped { .. } | Outcome::Failed { .. } => None,
    }
}

/// Everything that was observed of a run: pairs where they were, else what the figure shows.
pub fn observed(errors: &Errors) -> impl Iterator<Item = &Estimate> {
    let Errors { pairs, to_reference, within_clusters } = errors;
    let others = to_reference.iter().chain(within_clusters);
    pairs.iter().chain(others.take(if pairs.is_empty() { usize::MAX } else { 0 }))
}

#[cfg(test)]
pub(crate) mod tests {
    use dynamics::Replica;

    use super::*;

    /// Two nodes whose error is given for each ε, from 0 in steps of 1, and each of two seeds; an
    /// infinite one is a run that escaped.
    pub(crate) fn simulated(errors: &[[f64; 2]]) -> Simulated {
        from(0.0, errors)
    }

    /// The same from another ε on.
    pub(crate) fn from(first: f64, errors: &[[f64; 2]]) -> Simulated {
        let run = |epsilon: f64, seed: u64, mean: f64| {
            let pairs = vec![Estimate { mean, standard_error: 0.0 }];
            let outcome = if mean.is_finite() {
                Outcome::Completed(Errors { pairs, ..Errors::default() })
            } else {
                Outcome::Escaped { time: 1.0 }
            };
            Run { replica: Replica { epsilon, seed }, outcome }
        };
        let epsilon: Vec<f64> = (0..errors.len()).map(|k| first + k as f64).collect();
        let runs = errors
            .iter()
            .zip(&epsilon)
            .flat_map(|(pair, &epsilon)| [run(epsilon, 1, pair[0]), run(epsilon, 2, pair[1])]);
        Simulated {
            runs: runs.collect(),
            epsilon,
            seeds: vec![1, 2],
            apart: Apart::UNEXPECTED,
            synchronised_below: Bound::Fixed(0.1),
            n_nodes: 2,
        }
    }

    #[test]
    fn a_relative_bound_follows_the_largest_error_down_to_perfect_synchrony() {
        let mut sweep = from(1.0, &[[4.0, 2.0], [1e-12, 3e-12]]);
        sweep.synchronised_below = Bound::OfLargest(0.1);
        assert_eq!(sweep.bound(0), 0.1 * 3.0);
        assert_eq!(sweep.bound(1), PERFECT_SYNCHRONY);
        assert_eq!(sweep.clusters(1).unwrap().nontrivial(), [vec![0, 1]]);
    }

    #[test]
    fn nodes_cluster_when_their_mean_error_is_below_the_threshold() {
        let sweep = from(1.0, &[[0.0, 0.19], [0.0, 0.2]]);
        assert_eq!(sweep.clusters(0).unwrap().nontrivial(), [vec![0, 1]]);
        assert!(sweep.clusters(1).unwrap().nontrivial().is_empty());
    }

    #[test]
    fn nodes_at_zero_coupling_are_never_synchronised() {
        let sweep = simulated(&[[0.0, 0.0], [0.0, 0.0]]);
        assert!(sweep.clusters(0).unwrap().nontrivial().is_empty());
        assert_eq!(sweep.clusters(1).unwrap().nontrivial(), [vec![0, 1]]);
    }

    #[test]
    fn every_mean_says_of_how_many_seeds_it_is() {
        let sweep = from(1.0, &[[2.0, f64::INFINITY], [f64::INFINITY; 2]]);
        let error = sweep.over_seeds(0, |errors| errors.pairs[0]).unwrap();
        assert_eq!((error.mean, error.n_seeds), (2.0, 1));
        assert!(sweep.over_seeds(1, |errors| errors.pairs[0]).is_none());
        assert_eq!([0, 1].map(|at| sweep.escaped(at)), [1, 2]);
        // An average over those that happened to survive is no error of the network.
        assert_eq!(sweep.largest_cluster_error(0, &[vec![0, 1]]), None);
    }

    #[test]
    fn runs_on_different_attractors_part_and_runs_that_burst_do_not() {
        let mut sweep = from(1.0, &[[8.0, 1e-13], [0.4, 1e-13], [8.0, 8.2]]);
        // Of two seeds one may have burst.
        assert_eq!(sweep.parted(0), None);
        sweep.apart = Apart::EXPECTED;
        assert_eq!(sweep.parted(0), Some(vec![(1, [1e-13; 2]), (1, [8.0; 2])]));
        assert_eq!([1, 2].map(|at| sweep.parted(at)), [None, None]);
    }

    #[test]
    fn no_clusters_have_no_error() {
        assert_eq!(from(1.0, &[[2.0, 2.0]]).largest_cluster_error(0, &[]), None);
    }
}
