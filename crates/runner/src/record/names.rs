//! Nodes by their labels.

use experiment::Plan;

use claims::labelled;

/// Clusters of nodes as clusters of labels.
pub fn named(clusters: &[Vec<usize>], plan: &Plan) -> Vec<Vec<String>> {
    let labels = labelled(clusters, &plan.study.network).into_iter();
    labels.map(|cluster| cluster.into_iter().map(str::to_owned).collect()).collect()
}
