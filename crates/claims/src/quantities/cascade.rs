//! Predicted clusters, and in which order they are lost.

use clustering::Partition;
use eigensync::numbers::plain;

use crate::answer::Answer;
use crate::found::Found;
use crate::quantity::{ClustersAt, LostBetween};

/// The clusters predicted at an ε, those of both sides where a critical coupling is not known well enough.
pub fn clusters(found: &Found<'_>, epsilon: f64) -> ClustersAt {
    let findings = found.findings;
    let here = findings.predicted_at(epsilon).ok_or_else(|| not_predicted(epsilon))?;
    let near = findings.predicted_about(epsilon).into_iter();
    let all = std::iter::once(Some(here)).chain(near);
    Ok(all.map(|clusters| clusters.map(Partition::nontrivial)).collect())
}

/// The ε below which a cluster is predicted to be lost.
pub fn loss(found: &Found<'_>, at: usize, cluster: &[usize]) -> LostBetween {
    match found.findings.predicted_loss(cluster) {
        Some(lost) => Ok([lost, lost]),
        None if found.findings.is_predicted_everywhere() => Err(Answer::Differs),
        None => Err(Answer::CannotBeJudged(format!(
            "where cluster {} is lost is not predicted: the prediction does not reach so far",
            at + 1
        ))),
    }
}

/// Whether any end of the stable set is not known as well as was asked for.
pub fn is_unrefined(found: &Found<'_>) -> bool {
    found.findings.msf.stable.zeros().any(|zero| !zero.refined)
}

/// That nothing is predicted at an ε.
pub fn not_predicted(epsilon: f64) -> String {
    format!(
        "nothing is predicted at epsilon = {}: modes that may be unstable there were not computed, or \
         their sigma were not looked at",
        plain(epsilon)
    )
}
