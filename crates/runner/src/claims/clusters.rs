//! Claims about clusters: which there are, in which order they are lost, and their names.

use eigensync::Known;
use eigensync::numbers::plain;
use std::collections::BTreeSet;

use clustering::{Partition, RegionClusters};
use graph::Network;
use serde_json::{Value, json};

use super::obtained::{not_predicted, nothing_left};
use super::{Answer, Judge, Judged};
use experiment::nodes_named;
use experiment::spec::{Name, Quantity};
use user::Result;

/// Clusters without an order.
type Clusters = BTreeSet<BTreeSet<usize>>;

/// Clusters that are found, or none where nothing is predicted.
type Found = Option<Vec<Vec<usize>>>;

impl Judge<'_> {
    pub(super) fn clusters(&self) -> Result<Judged> {
        let paper: Vec<Vec<Name>> = self.equals("a list of clusters")?;
        let stated = as_sets(&self.nodes(&paper));
        let epsilon = self.epsilon().first().copied().unwrap_or_default();
        let (obtained, answer) = match self.clusters_at(epsilon) {
            Ok(found) => {
                let clusters = found[0].as_deref().unwrap_or_default();
                let shown = json!(named(clusters, &self.plan.study.network));
                (shown, self.is_one_of(&stated, &found))
            }
            Err(why) => (Value::Null, why.map_or(Answer::Differs, Answer::CannotBeJudged)),
        };
        Ok(Judged::new(json!(texts(&paper)), obtained, "exact", answer))
    }

    /// Whether these are the clusters, whichever of those found is right; the first is shown.
    fn is_one_of(&self, stated: &Clusters, found: &[Found]) -> Answer {
        let is_stated = |found: &&Found| found.as_ref().is_some_and(|f| as_sets(f) == *stated);
        let holds = found.iter().filter(is_stated).count();
        match holds {
            0 => Answer::Differs,
            all if all == found.len() => Answer::Holds,
            _ => Answer::CannotBeJudged(format!(
                "a critical coupling is not known well enough to tell on which side of it epsilon = {} \
                 lies",
                plain(self.epsilon()[0])
            )),
        }
    }

    /// The clusters found at an ε, several where it is not known which; else why there are none.
    fn clusters_at(&self, epsilon: f64) -> std::result::Result<Vec<Found>, Option<String>> {
        let findings = self.findings;
        if self.spec.of == Quantity::CascadeClusters {
            let here = findings.predicted_at(epsilon).ok_or_else(|| not_predicted(epsilon))?;
            let near = findings.predicted_about(epsilon).into_iter();
            let found = std::iter::once(Some(here)).chain(near);
            return Ok(found.map(|found| found.map(Partition::nontrivial)).collect());
        }
        let simulated = findings.simulated.as_ref().ok_or(None)?;
        let position = simulated.position(epsilon).ok_or(None)?;
        let regions = || {
            let agreement = findings.agreement.get(position);
            let regions = agreement.and_then(|agreement| agreement.regions.as_ref());
            regions.ok_or_else(|| self.not_compared(position))
        };
        let found = match self.spec.of {
            Quantity::PredictedRegions => self.of_regions(&regions()?.predicted),
            Quantity::SimulatedRegions => self.of_regions(&regions()?.simulated),
            _ => {
                let clusters = simulated.clusters(position);
                clusters.ok_or_else(|| nothing_left(simulated, position))?.nontrivial()
            }
        };
        Ok(vec![Some(found)])
    }

    /// Clusters of regions as clusters of their nodes.
    fn of_regions(&self, clusters: &RegionClusters) -> Vec<Vec<usize>> {
        let groups = self.plan.study.network.groups();
        let nodes = |regions: Vec<usize>| {
            regions.iter().flat_map(|&region| groups[region].nodes.iter().copied()).collect()
        };
        clusters.clusters().into_iter().map(nodes).collect()
    }

    /// Positions of the clusters, from 1, in the order in which they are lost as ε falls.
    pub(super) fn order(&self) -> Result<Judged> {
        let paper: Vec<usize> = self.equals("a list of positions")?;
        let clusters = self.nodes(self.spec.at.clusters.as_deref().unwrap_or_default());
        let lost: std::result::Result<Vec<[f64; 2]>, Answer> = clusters
            .iter()
            .enumerate()
            .map(|(at, cluster)| self.lost_between(at, cluster))
            .collect();
        let lost = match lost {
            Ok(lost) => lost,
            Err(answer) => return Ok(Judged::new(json!(paper), Value::Null, "exact", answer)),
        };
        let predicted = self.spec.of == Quantity::CascadeOrder;
        let answer = follows(&paper, &lost, predicted);
        let shown = match answer {
            Answer::CannotBeJudged(_) => Value::Null,
            _ => json!(order_shown(&lost, predicted)),
        };
        Ok(Judged::new(json!(paper), shown, "exact", answer))
    }

    /// Between which ε a cluster is lost, or what is to be said where that is not known.
    fn lost_between(&self, at: usize, cluster: &[usize]) -> std::result::Result<[f64; 2], Answer> {
        let findings = self.findings;
        let which = format!("cluster {}", at + 1);
        if self.spec.of == Quantity::CascadeOrder {
            return match findings.predicted_loss(cluster) {
                Some(lost) => Ok([lost, lost]),
                None if findings.is_predicted_everywhere() => Err(Answer::Differs),
                None => Err(Answer::CannotBeJudged(format!(
                    "where {which} is lost is not predicted: the prediction does not reach so far"
                ))),
            };
        }
        let seen = findings.seen(&[cluster.to_vec()]).ok_or(Answer::Differs)?;
        let why = match (seen.onset.bound, seen.onset.interval) {
            // Where runs escape below it, it may be lost anywhere there.
            (Known::Measured, Some([_, kept])) if seen.onset.n_escaped > 0 => {
                return Ok([0.0, kept]);
            }
            (_, Some(interval)) => return Ok(interval),
            (Known::Escaped, None) => "runs escaped wherever it was looked for",
            (Known::NotSwept, None) => "the sweep has no point where it is predicted",
            _ => "it was not seen in every seed",
        };
        Err(Answer::CannotBeJudged(format!("where {which} is lost is not known: {why}")))
    }

    /// Node numbers of labels that the plan has checked.
    pub(super) fn nodes(&self, clusters: &[Vec<Name>]) -> Vec<Vec<usize>> {
        let network = &self.plan.study.network;
        let nodes = |cluster: &Vec<Name>| {
            cluster.iter().filter_map(|name| nodes_named(network, name)).flatten().collect()
        };
        clusters.iter().map(nodes).collect()
    }
}

fn as_sets(clusters: &[Vec<usize>]) -> Clusters {
    clusters.iter().map(|cluster| cluster.iter().copied().collect()).collect()
}

/// Whether clusters that are lost somewhere between two ε each are lost in this order as ε falls. Two
/// that are predicted to be lost together have no order; of two that overlap it is not known.
fn follows(order: &[usize], lost: &[[f64; 2]], predicted: bool) -> Answer {
    let one_after_other = |pair: &[usize]| {
        let ([low, high], [next_low, next_high]) = (lost[pair[0] - 1], lost[pair[1] - 1]);
        if low >= next_high && low > next_low {
            Answer::Holds
        } else if predicted || high <= next_low {
            Answer::Differs
        } else {
            Answer::CannotBeJudged(format!(
                "clusters {} and {} are lost too near each other to tell which is first",
                pair[0], pair[1]
            ))
        }
    };
    Answer::of_all(order.windows(2).map(one_after_other))
}

/// The order in which clusters are lost as ε falls, from 1; those without an order among them stand
/// together, in words.
fn order_shown(lost: &[[f64; 2]], predicted: bool) -> Vec<Value> {
    let middle = |position: &usize| 0.5 * (lost[position - 1][0] + lost[position - 1][1]);
    let mut order: Vec<usize> = (1..=lost.len()).collect();
    order.sort_by(|a, b| middle(b).total_cmp(&middle(a)));
    let is_ordered = |a: &usize, b: &usize| follows(&[*a, *b], lost, predicted) == Answer::Holds;
    let shown = |group: &[usize]| match group {
        [single] => json!(single),
        several => {
            let texts: Vec<String> = several.iter().map(usize::to_string).collect();
            let how = if predicted { "lost together" } else { "lost too near each other" };
            json!(format!("{} {how}", texts.join(" and ")))
        }
    };
    order.chunk_by(|a, b| !is_ordered(a, b)).map(shown).collect()
}

fn texts(clusters: &[Vec<Name>]) -> Vec<Vec<&str>> {
    clusters.iter().map(|cluster| cluster.iter().map(|name| name.0.as_str()).collect()).collect()
}

/// Clusters of nodes as people name them: whole groups by their names, other nodes by their labels.
fn named<'a>(clusters: &[Vec<usize>], network: &'a Network) -> Vec<Vec<&'a str>> {
    let of_cluster = |cluster: &Vec<usize>| {
        let mut left: BTreeSet<usize> = cluster.iter().copied().collect();
        let mut names = Vec::new();
        for group in network.groups() {
            if group.nodes.iter().all(|node| left.contains(node)) {
                group.nodes.iter().for_each(|node| _ = left.remove(node));
                names.push(group.name.as_str());
            }
        }
        names.extend(left.into_iter().map(|node| network.labels()[node].as_str()));
        names
    };
    clusters.iter().map(of_cluster).collect()
}

/// Clusters of nodes as clusters of labels.
pub fn labelled<'a>(clusters: &[Vec<usize>], network: &'a Network) -> Vec<Vec<&'a str>> {
    let label = |&node: &usize| network.labels()[node].as_str();
    clusters.iter().map(|cluster| cluster.iter().map(label).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clusters_lost_together_are_in_no_order() {
        let lost = [[2.0, 2.0], [2.0, 2.0], [1.0, 1.0]];
        assert_eq!(follows(&[1, 2, 3], &lost, true), Answer::Differs);
        assert_eq!(follows(&[1, 3], &lost, true), Answer::Holds);
        assert_eq!(follows(&[3, 1], &lost, true), Answer::Differs);
    }

    #[test]
    fn clusters_lost_together_are_shown_together_and_not_in_the_claimed_order() {
        let at = |epsilon: f64| [epsilon, epsilon];
        assert_eq!(order_shown(&[at(2.0), at(2.0)], true), [json!("1 and 2 lost together")]);
        let shown = order_shown(&[at(1.0), at(3.0), at(1.0)], true);
        assert_eq!(shown, [json!(2), json!("1 and 3 lost together")]);
        assert_eq!(order_shown(&[at(1.0), at(3.0), at(2.0)], true), [2, 3, 1].map(|k| json!(k)));
        // Of simulated ones that overlap none is known to be the first.
        let shown = order_shown(&[[1.0, 2.0], [3.0, 4.0], [1.0, 2.0]], false);
        assert_eq!(shown, [json!(2), json!("1 and 3 lost too near each other")]);
    }

    #[test]
    fn simulated_losses_that_overlap_or_lie_below_the_sweep_are_in_no_known_order() {
        let unknown = |lost: [[f64; 2]; 2]| {
            [[1, 2], [2, 1]]
                .map(|order| follows(&order, &lost, false))
                .iter()
                .all(|answer| matches!(answer, Answer::CannotBeJudged(_)))
        };
        assert!(unknown([[1.0, 2.0], [1.0, 2.0]]), "between the same points");
        assert!(unknown([[0.0, 1.0], [0.0, 1.0]]), "both below the sweep");
        assert!(unknown([[1.0, 2.0], [1.5, 2.5]]), "means of seeds that overlap");
        assert_eq!(follows(&[1, 2], &[[1.0, 2.0], [0.0, 1.0]], false), Answer::Holds);
        assert_eq!(follows(&[2, 1], &[[1.0, 2.0], [0.0, 1.0]], false), Answer::Differs);
    }
}
