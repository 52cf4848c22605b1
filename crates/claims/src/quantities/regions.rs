//! Regions under two thresholds, predicted and simulated.

use clustering::RegionClusters;
use eigensync::Regions;

use super::agreement::not_compared;
use crate::Number;
use crate::found::Found;
use crate::quantity::ClustersAt;

/// Fraction of regions of the same verdict on both sides.
pub fn same_verdict(found: &Found<'_>) -> Vec<Number> {
    numbers(found, |regions| {
        // Regions that are not there agree about nothing.
        let has_any = regions.agreement.n_regions > 0;
        has_any.then(|| regions.agreement.verdict_fraction())
    })
}

/// Nodes in regions that are not predicted to synchronise.
pub fn predicted_grey(found: &Found<'_>) -> Vec<Number> {
    numbers(found, |regions| Some(grey_nodes(&regions.predicted)))
}

/// Nodes in regions that do not synchronise in simulation.
pub fn simulated_grey(found: &Found<'_>) -> Vec<Number> {
    numbers(found, |regions| Some(grey_nodes(&regions.simulated)))
}

/// Mean number of nodes of the predicted clusters of regions.
pub fn predicted_size(found: &Found<'_>) -> Vec<Number> {
    numbers(found, |regions| mean_cluster_size(&regions.predicted))
}

/// The same of the simulated ones.
pub fn simulated_size(found: &Found<'_>) -> Vec<Number> {
    numbers(found, |regions| mean_cluster_size(&regions.simulated))
}

/// Predicted clusters of regions.
pub fn predicted(found: &Found<'_>, epsilon: f64) -> ClustersAt {
    clusters(found, epsilon, |regions| &regions.predicted)
}

/// Simulated ones.
pub fn simulated(found: &Found<'_>, epsilon: f64) -> ClustersAt {
    clusters(found, epsilon, |regions| &regions.simulated)
}

/// Clusters of regions as clusters of their nodes.
fn clusters(
    found: &Found<'_>,
    epsilon: f64,
    of: impl Fn(&Regions) -> &RegionClusters,
) -> ClustersAt {
    let simulated = found.findings.simulated.as_ref().ok_or(None)?;
    let position = simulated.position(epsilon).ok_or(None)?;
    let regions = of_both(found, position).ok_or_else(|| not_compared(found, position))?;
    let groups = found.study.network.groups();
    let nodes = |regions: Vec<usize>| {
        regions.iter().flat_map(|&region| groups[region].nodes.iter().copied()).collect()
    };
    Ok(vec![Some(of(regions).clusters().into_iter().map(nodes).collect())])
}

/// A number of both sides' regions at each ε of the claim; it has no error of its own.
fn numbers(found: &Found<'_>, of: impl Fn(&Regions) -> Option<f64>) -> Vec<Number> {
    found.at_each_epsilon(|_, position| match of_both(found, position) {
        Some(regions) => of(regions).map_or(Number::None, Number::exactly),
        None => not_compared(found, position).map_or(Number::None, Number::Unknown),
    })
}

fn of_both<'a>(found: &Found<'a>, position: usize) -> Option<&'a Regions> {
    found.findings.agreement.get(position).and_then(|agreement| agreement.regions.as_ref())
}

/// Nodes whose regions do not synchronise, or that belong to none.
fn grey_nodes(regions: &RegionClusters) -> f64 {
    regions.cluster_of_node().iter().filter(|cluster| cluster.is_none()).count() as f64
}

/// Nodes of a cluster of regions in the mean; none where there is no cluster.
fn mean_cluster_size(regions: &RegionClusters) -> Option<f64> {
    let nodes = regions.cluster_of_node();
    let coloured = nodes.iter().flatten().count() as f64;
    (regions.n_clusters() > 0).then(|| coloured / regions.n_clusters() as f64)
}
