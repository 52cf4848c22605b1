//! Claims about numbers: what was obtained, how far it is known, and whether that decides the claim.
//!
//! A number may be known only from one side, as an onset below the sweep is. A claim then holds if it
//! does for every value that the number may have, differs if it does for none, and cannot be judged
//! otherwise. A claim about no number at all never holds.

use clustering::RegionClusters;
use serde_json::{Value, json};

use super::{Answer, Judge, Judged};
use crate::agreement::Agreement;
use crate::problem::Result;
use crate::simulated::{Known, Simulated};
use crate::spec::{OneOrMany, Quantity, Trend};

/// A number as far as it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Number {
    Exactly(f64),
    AtMost(f64),
    AtLeast(f64),
}

impl Number {
    /// Whether it lies between two numbers, these included.
    fn is_within(self, low: f64, high: f64) -> Answer {
        let [least, most] = match self {
            Self::Exactly(x) => [x, x],
            Self::AtMost(x) => [f64::NEG_INFINITY, x],
            Self::AtLeast(x) => [x, f64::INFINITY],
        };
        if low <= least && most <= high {
            Answer::Holds
        } else if most < low || high < least || low.is_nan() || high.is_nan() || least.is_nan() {
            Answer::Differs
        } else {
            Answer::CannotBeJudged(format!("the number is only known to be {self}"))
        }
    }
}

impl std::fmt::Display for Number {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Exactly(x) => write!(f, "{x}"),
            Self::AtMost(x) => write!(f, "at most {x}"),
            Self::AtLeast(x) => write!(f, "at least {x}"),
        }
    }
}

impl Judge<'_> {
    /// One number or a list of numbers.
    pub(super) fn numbers(&self) -> Result<Judged> {
        let obtained = self.obtained_numbers();
        let value = |number: &Option<Number>| match number {
            None => Value::Null,
            Some(Number::Exactly(x)) => json!(x),
            Some(bound) => json!(bound.to_string()),
        };
        let shown = match &obtained[..] {
            [single] => value(single),
            many => many.iter().map(value).collect(),
        };
        let spec = self.spec;
        if let Some(limit) = spec.at_most {
            let answer = all(&obtained, |_, x| x.is_within(f64::NEG_INFINITY, limit));
            return Ok(Judged::new(json!(format!("at most {limit}")), shown, "exact", answer));
        }
        if let Some(limit) = spec.at_least {
            let answer = all(&obtained, |_, x| x.is_within(limit, f64::INFINITY));
            return Ok(Judged::new(json!(format!("at least {limit}")), shown, "exact", answer));
        }
        if let Some(trend) = spec.trend {
            let word = if trend == Trend::Rises { "rising" } else { "falling" };
            return Ok(Judged::new(json!(word), shown, "exact", follows(&obtained, trend)));
        }
        let paper = self.equals::<OneOrMany>("a number or a list of numbers")?;
        let paper = paper.list();
        let (abs, rel) = (spec.abs_tol.unwrap_or(0.0), spec.rel_tol.unwrap_or(0.0));
        // A hair of slack: 4.2 ± 0.1 holds 4.1, whose difference is 0.10000000000000053.
        let allowed = |expected: f64| (abs + rel * expected.abs()) * (1.0 + 1e-9);
        let near = |at: usize, x: Number| {
            let expected = paper[at];
            x.is_within(expected - allowed(expected), expected + allowed(expected))
        };
        let answer =
            if obtained.len() == paper.len() { all(&obtained, near) } else { Answer::Differs };
        let tolerance = match (abs > 0.0, rel > 0.0) {
            (true, true) => format!("± {abs} ± {} %", 100.0 * rel),
            (true, false) => format!("± {abs}"),
            (false, true) => format!("± {} %", 100.0 * rel),
            (false, false) => "exact".into(),
        };
        let paper = if let [single] = paper { json!(single) } else { json!(paper) };
        Ok(Judged::new(paper, shown, tolerance, answer))
    }

    fn obtained_numbers(&self) -> Vec<Option<Number>> {
        if self.spec.of == Quantity::SimulatedOnset {
            return vec![self.onset()];
        }
        self.plain_numbers().into_iter().map(|number| number.map(Number::Exactly)).collect()
    }

    fn onset(&self) -> Option<Number> {
        let onset = self.findings.seen(&self.claimed_clusters())?.onset;
        match onset.bound {
            Known::Measured => onset.mean.map(Number::Exactly),
            Known::AtMost => onset.limit.map(Number::AtMost),
            Known::AtLeast => onset.limit.map(Number::AtLeast),
            Known::Unseen | Known::NotSwept => None,
        }
    }

    /// The clusters that the claim is about.
    fn claimed_clusters(&self) -> Vec<Vec<usize>> {
        self.nodes(self.spec.at.clusters.as_deref().unwrap_or_default())
    }

    fn plain_numbers(&self) -> Vec<Option<f64>> {
        let (findings, at) = (self.findings, &self.spec.at);
        match self.spec.of {
            Quantity::Eigenvalues => {
                let eigenvalues = findings.spectrum.real_eigenvalues();
                match &at.modes {
                    None => eigenvalues.into_iter().map(Some).collect(),
                    Some(modes) => modes.iter().map(|k| eigenvalues.get(k - 1).copied()).collect(),
                }
            }
            Quantity::LyapunovIsolated => vec![Some(findings.msf.isolated.mean)],
            Quantity::SigmaC => vec![findings.msf.stable.sigma_c().map(|zero| zero.sigma)],
            Quantity::CriticalCouplings => {
                let of_mode = |mode: &usize| {
                    let found =
                        findings.critical.iter().find(|c| c.mode == *mode && c.stable_above);
                    found.map(|critical| critical.epsilon)
                };
                at.modes.iter().flatten().map(of_mode).collect()
            }
            Quantity::SimulatedError => {
                let clusters = self.claimed_clusters();
                self.at_each_epsilon(|simulated, position| {
                    simulated.largest_cluster_error(position, &clusters)
                })
            }
            Quantity::Nodes => vec![Some(self.counted_nodes() as f64)],
            Quantity::Links => vec![Some(self.plan.network.n_links() as f64)],
            Quantity::Groups => vec![Some(self.plan.network.groups().len() as f64)],
            Quantity::Pearson => self.agreements(|a| Some(a.correlation?.pearson)),
            Quantity::Spearman => self.agreements(|a| Some(a.correlation?.spearman)),
            Quantity::RandIndex => self.agreements(|a| a.rand_index),
            Quantity::RegionVerdicts => self.agreements(|a| {
                let agreement = a.regions.as_ref()?.agreement;
                // Regions that are not there agree about nothing.
                (agreement.n_regions > 0).then(|| agreement.verdict_fraction())
            }),
            Quantity::PredictedGrey => {
                self.agreements(|a| Some(grey_nodes(&a.regions.as_ref()?.predicted)))
            }
            Quantity::SimulatedGrey => {
                self.agreements(|a| Some(grey_nodes(&a.regions.as_ref()?.simulated)))
            }
            Quantity::PredictedSize => {
                self.agreements(|a| mean_cluster_size(&a.regions.as_ref()?.predicted))
            }
            Quantity::SimulatedSize => {
                self.agreements(|a| mean_cluster_size(&a.regions.as_ref()?.simulated))
            }
            // Judged by their own functions.
            Quantity::SimulatedOnset
            | Quantity::Eigenvectors
            | Quantity::CascadeClusters
            | Quantity::SimulatedClusters
            | Quantity::PredictedRegions
            | Quantity::SimulatedRegions
            | Quantity::CascadeOrder
            | Quantity::SimulatedOrder => vec![],
        }
    }

    /// The nodes of the network, or of the groups that the claim is about.
    fn counted_nodes(&self) -> usize {
        let network = &self.plan.network;
        let Some(prefix) = &self.spec.at.group_prefix else { return network.n_nodes() };
        let groups = network.groups().iter().filter(|group| group.name.starts_with(prefix));
        groups.map(|group| group.nodes.len()).sum()
    }

    /// A number of the simulations at each ε of the claim.
    fn at_each_epsilon(&self, of: impl Fn(&Simulated, usize) -> Option<f64>) -> Vec<Option<f64>> {
        let number = |&epsilon: &f64| {
            let simulated = self.findings.simulated.as_ref()?;
            of(simulated, simulated.position(epsilon)?)
        };
        self.epsilon().iter().map(number).collect()
    }

    /// A number of the agreement at each ε of the claim.
    fn agreements(&self, of: impl Fn(&Agreement) -> Option<f64>) -> Vec<Option<f64>> {
        self.at_each_epsilon(|_, position| of(self.findings.agreement.get(position)?))
    }

    /// How well the obtained number is known, where that is known itself.
    pub(super) fn uncertainty(&self) -> Option<f64> {
        let findings = self.findings;
        match self.spec.of {
            Quantity::LyapunovIsolated => Some(findings.msf.isolated.standard_error),
            Quantity::SigmaC => findings.msf.stable.sigma_c().map(|zero| zero.standard_error),
            Quantity::SimulatedOnset => {
                findings.seen(&self.claimed_clusters())?.onset.uncertainty()
            }
            _ => None,
        }
    }
}

/// Whether a claim holds of every one of some numbers, of which there must be some.
fn all(numbers: &[Option<Number>], holds: impl Fn(usize, Number) -> Answer) -> Answer {
    let answers = numbers.iter().enumerate().map(|(at, number)| match number {
        Some(number) => holds(at, *number),
        None => Answer::Differs,
    });
    Answer::of_all(answers)
}

/// Whether each number is above, or below, the one before it.
fn follows(numbers: &[Option<Number>], trend: Trend) -> Answer {
    let ordered = |a: f64, b: f64| match trend {
        Trend::Rises => a < b,
        Trend::Falls => a > b,
    };
    Answer::of_all(numbers.windows(2).map(|pair| match pair {
        [Some(Number::Exactly(a)), Some(Number::Exactly(b))] => ordered(*a, *b).into(),
        [Some(a), Some(b)] => {
            Answer::CannotBeJudged(format!("of {a} and {b} neither is known to be the larger"))
        }
        _ => Answer::Differs,
    }))
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

#[cfg(test)]
mod tests {
    use super::*;

    fn exactly(numbers: &[f64]) -> Vec<Option<Number>> {
        numbers.iter().map(|&x| Some(Number::Exactly(x))).collect()
    }

    #[test]
    fn a_claim_about_no_number_never_holds() {
        assert!(matches!(all(&[], |_, _| Answer::Holds), Answer::NothingToJudge));
        assert!(matches!(follows(&[], Trend::Rises), Answer::NothingToJudge));
        assert!(matches!(follows(&exactly(&[1.0]), Trend::Falls), Answer::NothingToJudge));
        assert_eq!(all(&[None], |_, _| Answer::Holds), Answer::Differs);
        assert_eq!(follows(&[None, None], Trend::Rises), Answer::Differs);
    }

    #[test]
    fn a_number_known_from_one_side_decides_a_claim_only_where_all_its_values_do() {
        let at_most = Number::AtMost(4.0);
        assert_eq!(at_most.is_within(f64::NEG_INFINITY, 4.0), Answer::Holds);
        assert_eq!(at_most.is_within(4.1, 4.3), Answer::Differs);
        assert!(matches!(at_most.is_within(3.9, 4.1), Answer::CannotBeJudged(_)));
        assert!(matches!(at_most.is_within(f64::NEG_INFINITY, 3.0), Answer::CannotBeJudged(_)));
        let at_least = Number::AtLeast(4.0);
        assert_eq!(at_least.is_within(4.0, f64::INFINITY), Answer::Holds);
        assert_eq!(at_least.is_within(f64::NEG_INFINITY, 3.0), Answer::Differs);
        assert!(matches!(at_least.is_within(3.9, 4.1), Answer::CannotBeJudged(_)));
    }

    #[test]
    fn what_is_no_number_holds_no_claim() {
        let nan = Number::Exactly(f64::NAN);
        assert_eq!(nan.is_within(f64::NEG_INFINITY, f64::INFINITY), Answer::Differs);
        assert_eq!(follows(&exactly(&[1.0, f64::NAN]), Trend::Rises), Answer::Differs);
    }

    #[test]
    fn numbers_follow_a_trend_one_by_one() {
        assert_eq!(follows(&exactly(&[1.0, 2.0, 3.0]), Trend::Rises), Answer::Holds);
        assert_eq!(follows(&exactly(&[1.0, 2.0, 2.0]), Trend::Rises), Answer::Differs);
        assert_eq!(follows(&exactly(&[3.0, 2.0]), Trend::Falls), Answer::Holds);
    }
}
