//! Simulated clusters, where they begin, in which order they are lost, and the errors within them.

use eigensync::numbers::plain;
use eigensync::{End, Known, Simulated};

use crate::Number;
use crate::answer::Answer;
use crate::found::Found;
use crate::quantity::{ClustersAt, LostBetween};

/// The clusters simulated at an ε.
pub fn clusters(found: &Found<'_>, epsilon: f64) -> ClustersAt {
    let simulated = found.findings.simulated.as_ref().ok_or(None)?;
    let position = simulated.position(epsilon).ok_or(None)?;
    let clusters = simulated.clusters(position);
    Ok(vec![Some(clusters.ok_or_else(|| nothing_left(simulated, position))?.nontrivial())])
}

/// ε from which on all of the claimed clusters stay synchronised.
pub fn onset(found: &Found<'_>) -> Vec<Number> {
    let simulated = found.findings.simulated.as_ref();
    let seen = found.findings.seen(&found.at.clusters);
    vec![match (simulated, seen) {
        (Some(simulated), Some(seen)) => of_onset(&seen.onset, simulated),
        _ => Number::None,
    }]
}

/// Largest δx^c_m of the claimed clusters, at each ε of the claim.
pub fn errors(found: &Found<'_>) -> Vec<Number> {
    found.at_each_epsilon(|simulated, at| cluster_error(simulated, at, &found.at.clusters))
}

/// Between which ε a cluster is lost.
pub fn loss(found: &Found<'_>, at: usize, cluster: &[usize]) -> LostBetween {
    let seen = found.findings.seen(&[cluster.to_vec()]).ok_or(Answer::Differs)?;
    let why = match (seen.onset.bound, seen.onset.interval) {
        // Where runs escape below it, it may be lost anywhere there.
        (Known::Measured, Some([_, kept])) if seen.onset.n_escaped > 0 => return Ok([0.0, kept]),
        (_, Some(interval)) => return Ok(interval),
        (Known::Escaped, None) => "runs escaped wherever it was looked for",
        (Known::NotSwept, None) => "the sweep has no point where it is predicted",
        _ => "it was not seen in every seed",
    };
    let which = at + 1;
    Err(Answer::CannotBeJudged(format!("where cluster {which} is lost is not known: {why}")))
}

/// Runs that are bounded at the ε of the claim at which they are fewest.
pub fn bounded_at_epsilon(found: &Found<'_>) -> Option<usize> {
    let simulated = found.findings.simulated.as_ref()?;
    let bounded = |&epsilon: &f64| Some(simulated.bounded(simulated.position(epsilon)?));
    found.at.epsilon.iter().filter_map(bounded).min()
}

/// Runs that do not escape at the onset of all claimed clusters.
pub fn bounded_at_onset(found: &Found<'_>) -> Option<usize> {
    bounded_where_seen(found, &found.at.clusters)
}

/// Runs that do not escape at the onset of the cluster of which they are fewest.
pub fn bounded_at_onsets(found: &Found<'_>) -> Option<usize> {
    let clusters = found.at.clusters.chunks(1);
    clusters.filter_map(|cluster| bounded_where_seen(found, cluster)).min()
}

fn bounded_where_seen(found: &Found<'_>, clusters: &[Vec<usize>]) -> Option<usize> {
    let of = found.findings.simulated.as_ref()?.seeds.len();
    Some(of.saturating_sub(found.findings.seen(clusters)?.onset.n_escaped))
}

/// Where no run came to its end, that.
pub fn nothing_left(simulated: &Simulated, position: usize) -> Option<String> {
    (simulated.bounded(position) == 0).then(|| lost(simulated, position))
}

fn lost(simulated: &Simulated, position: usize) -> String {
    let (lost, all) = (simulated.broken_off(position), simulated.seeds.len());
    let runs = if all == 1 { "run" } else { "runs" };
    let epsilon = plain(simulated.epsilon[position]);
    format!("at epsilon = {epsilon} {lost} of {all} {runs} {}", simulated.broke_off())
}

/// The largest error of some clusters. An average over runs that did not escape is none of the network,
/// and none is known better than rounding.
fn cluster_error(simulated: &Simulated, position: usize, clusters: &[Vec<usize>]) -> Number {
    match simulated.largest_cluster_error(position, clusters) {
        Some(error) => Number::Known {
            value: error.mean,
            error: error.standard_error.max(simulated.rounding()),
        },
        None => Number::Unknown(lost(simulated, position)),
    }
}

/// An onset that begins where runs escape may lie anywhere below.
fn of_onset(onset: &End, simulated: &Simulated) -> Number {
    let largest = simulated.epsilon[simulated.epsilon.len() - 1];
    let known = match (onset.bound, onset.interval) {
        (Known::Measured, Some([_, kept])) if onset.n_escaped > 0 => Some(Number::at_most(kept)),
        (Known::Measured, _) => {
            let error = onset.uncertainty();
            onset.mean.zip(error).map(|(value, error)| Number::Known { value, error })
        }
        (Known::AtMost, _) => onset.limit.map(Number::at_most),
        (Known::AtLeast, _) => onset.limit.map(Number::at_least),
        (Known::Groups, Some([least, most])) => {
            let words = onset.groups.iter().map(ToString::to_string).collect::<Vec<_>>();
            Some(Number::Between { least, most, words: words.join(", ") })
        }
        (Known::Unseen, _) => Some(Number::NoneUpTo {
            limit: largest,
            words: format!("not seen in every seed, up to epsilon = {}", plain(largest)),
        }),
        (Known::Escaped, _) => Some(Number::Unknown(format!(
            "in {} of {} seeds every orbit that was looked at escaped",
            onset.n_escaped,
            simulated.seeds.len()
        ))),
        (Known::NotSwept, _) => Some(Number::Unknown(
            "the sweep has no point that was integrated where these clusters are predicted".into(),
        )),
        (Known::Groups, None) => None,
    };
    known.unwrap_or(Number::None)
}
