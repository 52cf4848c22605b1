//! Prediction against simulation at each ε of a sweep, in numbers: the correlations of δx_ij with
//! δe_ij over all pairs, the adjusted Rand index of the clusters, and the regions of both.
//!
//! Numbers are kept and matrices are not: δe_ij at one ε has N²/2 values and many modes behind them,
//! and whoever wants it again computes it again, one ε at a time.
//!
//! δx_ij is a mean over seeds, and how far the numbers made from it depend on these is told by the
//! jackknife: with r_s the number without seed s, of n seeds, the standard error is
//! √((n − 1)/n Σ (r_s − r̄)²). Source: B. Efron, The Jackknife, the Bootstrap and Other Resampling Plans
//! (1982), Ch. 3.

use clustering::{
    ClusteringError, Correlation, EigenvectorDistance, Partition, RegionAgreement, RegionClusters,
    RegionDistances, RegionThresholds, State, adjusted_rand_index, correlation_of_pairs,
};
use dynamics::pair_index;
use spectra::Spectrum;

use crate::simulated::{MeanPairs, Simulated};
use crate::{Bound, Error, RegionBounds, Study};

/// Both sides at one ε.
pub struct Agreement {
    /// What the prediction says.
    pub predicted: Predicted,
    /// Of δx_ij with δe_ij; none where either is the same for all pairs.
    pub correlation: Option<Correlation>,
    /// Of predicted and simulated clusters.
    pub rand_index: Option<f64>,
    /// How far these depend on the seeds.
    pub errors: StandardErrors,
    /// The regions of both sides, where the study has thresholds for them.
    pub regions: Option<Regions>,
}

/// What the prediction says of one ε.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Predicted {
    /// Nothing: nodes are uncoupled at ε = 0.
    Uncoupled,
    /// Nothing: modes that may be unstable here were not computed.
    NotReached,
    /// No transverse mode is unstable: all nodes are together, δe_ij = 0.
    AllTogether,
    /// These modes are unstable, counted from 0.
    Unstable(Vec<usize>),
}

/// Standard errors by the jackknife; none with fewer than two seeds.
#[derive(Clone, Copy, Debug, Default)]
pub struct StandardErrors {
    /// Of Pearson's correlation.
    pub pearson: Option<f64>,
    /// Of Spearman's rank correlation.
    pub spearman: Option<f64>,
    /// Of the adjusted Rand index.
    pub rand_index: Option<f64>,
}

/// The two-threshold analysis of both sides.
pub struct Regions {
    /// From δe_ij.
    pub predicted: RegionClusters,
    /// From δx_ij.
    pub simulated: RegionClusters,
    /// How far they agree.
    pub agreement: RegionAgreement,
}

impl Predicted {
    fn at(epsilon: f64, state: Option<&State>) -> Self {
        match state {
            _ if epsilon == 0.0 => Self::Uncoupled,
            None => Self::NotReached,
            Some(state) if state.unstable_modes.is_empty() => Self::AllTogether,
            Some(state) => Self::Unstable(state.unstable_modes.clone()),
        }
    }

    /// δe_ij over the unstable modes; none where there are none, or none are known.
    pub fn distance(
        &self,
        spectrum: &Spectrum,
    ) -> Result<Option<EigenvectorDistance>, ClusteringError> {
        match self {
            Self::Unstable(modes) => EigenvectorDistance::new(spectrum, modes).map(Some),
            _ => Ok(None),
        }
    }
}

/// The agreement at every ε of a sweep whose pairs were observed; empty otherwise.
pub fn at_all(
    study: &Study,
    spectrum: &Spectrum,
    states: &[State],
    simulated: &Simulated,
) -> Result<Vec<Agreement>, Error> {
    let positions = 0..simulated.epsilon.len();
    if !study.sweep.as_ref().is_some_and(|sweep| sweep.observables.pairs) {
        return Ok(Vec::new());
    }
    positions
        .map(|at| at_one(study, spectrum, states, simulated, at).map_err(Error::Agreement))
        .collect()
}

fn at_one(
    study: &Study,
    spectrum: &Spectrum,
    states: &[State],
    simulated: &Simulated,
    position: usize,
) -> Result<Agreement, ClusteringError> {
    let epsilon = simulated.epsilon[position];
    let state = states.iter().find(|state| state.holds_at(epsilon));
    let predicted = Predicted::at(epsilon, state);
    let distance = predicted.distance(spectrum)?.map(|distance| all_pairs(study, &distance));
    let compare = |error: &MeanPairs| {
        Numbers::of(study, state, distance.as_ref(), simulated, position, error)
    };
    let Some(error) = simulated.mean_pairs(position) else {
        let (correlation, rand_index, errors) = (None, None, StandardErrors::default());
        return Ok(Agreement { predicted, correlation, rand_index, errors, regions: None });
    };
    let Numbers { correlation, rand_index } = compare(&error);
    let errors = StandardErrors::of(simulated.bounded(position), |seed| {
        compare(&simulated.mean_pairs_without(position, seed).expect("another seed is left"))
    });
    let regions = match (&distance, &study.regions) {
        (Some(distance), Some(spec)) => {
            let distance = |i, j| value(distance, i, j, study.network.n_nodes());
            Some(regions(study, spec, distance, |i, j| error.of(i, j))?)
        }
        _ => None,
    };
    Ok(Agreement { predicted, correlation, rand_index, errors, regions })
}

/// δe_ij of all pairs i < j, each computed once.
fn all_pairs(study: &Study, distance: &EigenvectorDistance) -> Vec<f64> {
    let n_nodes = study.network.n_nodes();
    let pairs = (0..n_nodes).flat_map(|i| (i + 1..n_nodes).map(move |j| (i, j)));
    pairs.map(|(i, j)| distance.between(i, j)).collect()
}

fn value(pairs: &[f64], i: usize, j: usize, n_nodes: usize) -> f64 {
    if i == j { 0.0 } else { pairs[pair_index(i, j, n_nodes)] }
}

/// What one mean of δx_ij says of the prediction.
struct Numbers {
    correlation: Option<Correlation>,
    rand_index: Option<f64>,
}

impl Numbers {
    fn of(
        study: &Study,
        state: Option<&State>,
        distance: Option<&Vec<f64>>,
        simulated: &Simulated,
        position: usize,
        error: &MeanPairs,
    ) -> Self {
        let n_nodes = study.network.n_nodes();
        let found: Partition = simulated.clusters_of(position, error);
        let correlation = distance.and_then(|distance| {
            correlation_of_pairs(
                n_nodes,
                |i, j| error.of(i, j),
                |i, j| value(distance, i, j, n_nodes),
            )
        });
        let rand_index = state.map(|state| adjusted_rand_index(&state.clusters, &found));
        Self { correlation, rand_index }
    }
}

impl StandardErrors {
    fn of(n_seeds: usize, without: impl Fn(usize) -> Numbers) -> Self {
        if n_seeds < 2 {
            return Self::default();
        }
        let numbers: Vec<Numbers> = (0..n_seeds).map(without).collect();
        let error = |of: &dyn Fn(&Numbers) -> Option<f64>| jackknife(numbers.iter().map(of));
        Self {
            pearson: error(&|numbers| Some(numbers.correlation?.pearson)),
            spearman: error(&|numbers| Some(numbers.correlation?.spearman)),
            rand_index: error(&|numbers| numbers.rand_index),
        }
    }
}

/// √((n − 1)/n Σ (r_s − r̄)²); none unless every r_s is there.
fn jackknife(numbers: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    let numbers: Vec<f64> = numbers.collect::<Option<_>>()?;
    let n = numbers.len() as f64;
    let mean = numbers.iter().sum::<f64>() / n;
    let squares: f64 = numbers.iter().map(|x| (x - mean) * (x - mean)).sum();
    Some(((n - 1.0) / n * squares).sqrt())
}

fn regions(
    study: &Study,
    spec: &RegionBounds,
    distance: impl Fn(usize, usize) -> f64,
    error: impl Fn(usize, usize) -> f64,
) -> Result<Regions, ClusteringError> {
    let (n_nodes, groups) = (study.network.n_nodes(), study.network.groups());
    let nodes: Vec<Vec<usize>> = groups.iter().map(|group| group.nodes.clone()).collect();
    let predicted = RegionDistances::new(n_nodes, &nodes, &distance)?.clusters(thresholds(
        [spec.distance_within, spec.distance_between],
        n_nodes,
        distance,
    ))?;
    let simulated = RegionDistances::new(n_nodes, &nodes, &error)?.clusters(thresholds(
        [spec.error_within, spec.error_between],
        n_nodes,
        error,
    ))?;
    let agreement = predicted.agreement(&simulated);
    Ok(Regions { predicted, simulated, agreement })
}

/// Bounds within and between regions as numbers.
fn thresholds(
    [within, between]: [Bound; 2],
    n_nodes: usize,
    of: impl Fn(usize, usize) -> f64,
) -> RegionThresholds {
    let pairs = || (0..n_nodes).flat_map(|i| (i + 1..n_nodes).map(move |j| (i, j)));
    let largest = || pairs().map(|(i, j)| of(i, j)).fold(0.0, f64::max);
    RegionThresholds { within: within.value(largest), between: between.value(largest) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_jackknife_of_a_mean_is_its_standard_error() {
        let values: [f64; 4] = [1.0, 2.0, 4.0, 9.0];
        let sum: f64 = values.iter().sum();
        let error = jackknife(values.iter().map(|x| Some((sum - x) / 3.0))).unwrap();
        let expected = dynamics::Estimate::from_independent(&values).standard_error;
        assert!((error - expected).abs() < 1e-12, "{error} against {expected}");
        assert_eq!(jackknife([Some(1.0), None].into_iter()), None);
    }
}
