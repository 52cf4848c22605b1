//! Prediction against simulation at each ε of a sweep, in numbers: the correlations of δx_ij with
//! δe_ij over all pairs, the adjusted Rand index of the clusters, and the regions of both.

use clustering::{
    Correlation, EigenvectorDistance, RegionAgreement, RegionClusters, RegionDistances,
    RegionThresholds, State, adjusted_rand_index, correlation_of_pairs,
};
use spectra::Spectrum;

use crate::plan::Plan;
use crate::problem::{Problem, Result};
use crate::simulated::Simulated;
use crate::spec::{Bound, RegionsSpec};

/// Both sides at one ε.
pub struct Agreement {
    /// δe_ij over the modes unstable at this ε; none where no transverse mode is, or where the
    /// prediction does not reach.
    pub distance: Option<EigenvectorDistance>,
    /// Of δx_ij with δe_ij; none where either is the same for all pairs.
    pub correlation: Option<Correlation>,
    /// Of predicted and simulated clusters.
    pub rand_index: Option<f64>,
    pub regions: Option<Regions>,
}

/// The two-threshold analysis of both sides.
pub struct Regions {
    pub predicted: RegionClusters,
    pub simulated: RegionClusters,
    pub agreement: RegionAgreement,
}

/// The agreement at every ε of a sweep whose pairs were observed; empty otherwise.
pub fn at_all(
    plan: &Plan,
    spectrum: &Spectrum,
    states: &[State],
    simulated: &Simulated,
) -> Result<Vec<Agreement>> {
    let positions = 0..simulated.epsilon.len();
    if !simulated.has_pairs() {
        return Ok(Vec::new());
    }
    let failed = |error: clustering::ClusteringError| {
        Problem::from_error("prediction and simulation cannot be compared", error)
            .in_file(&plan.file)
    };
    positions.map(|at| at_one(plan, spectrum, states, simulated, at).map_err(failed)).collect()
}

fn at_one(
    plan: &Plan,
    spectrum: &Spectrum,
    states: &[State],
    simulated: &Simulated,
    position: usize,
) -> std::result::Result<Agreement, clustering::ClusteringError> {
    let (n_nodes, epsilon) = (plan.network.n_nodes(), simulated.epsilon[position]);
    let state = states.iter().find(|state| state.holds_at(epsilon));
    let distance = match state {
        Some(state) if !state.unstable_modes.is_empty() => {
            Some(EigenvectorDistance::new(spectrum, &state.unstable_modes)?)
        }
        _ => None,
    };
    let error = simulated.mean_pairs(position);
    let clusters = simulated.clusters(position);
    let rand_index =
        state.zip(clusters).map(|(state, found)| adjusted_rand_index(&state.clusters, &found));
    let mut agreement = Agreement { distance, correlation: None, rand_index, regions: None };
    if let (Some(distance), Some(error)) = (&agreement.distance, &error) {
        let error = |i, j| error.of(i, j);
        let distance = |i, j| distance.between(i, j);
        agreement.correlation = correlation_of_pairs(n_nodes, error, distance);
        if let Some(spec) = &plan.experiment.regions {
            agreement.regions = Some(regions(plan, spec, distance, error)?);
        }
    }
    Ok(agreement)
}

fn regions(
    plan: &Plan,
    spec: &RegionsSpec,
    distance: impl Fn(usize, usize) -> f64,
    error: impl Fn(usize, usize) -> f64,
) -> std::result::Result<Regions, clustering::ClusteringError> {
    let (n_nodes, groups) = (plan.network.n_nodes(), plan.network.groups());
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
