//! Claims: what the source says, what was obtained, and the verdict.

mod clusters;

use std::fmt;

use clustering::RegionClusters;
pub use clusters::labelled;
use serde::Serialize;
use serde_json::{Value, json};

use crate::agreement::Agreement;
use crate::findings::Findings;
use crate::plan::Plan;
use crate::problem::{Problem, Result};
use crate::simulated::Simulated;
use crate::spec::{ClaimSpec, OneOrMany, Quantity, Trend};

/// A judged claim.
#[derive(Clone, Debug, Serialize)]
pub struct Claim {
    pub name: String,
    pub source: String,
    pub paper: Value,
    pub obtained: Value,
    /// Standard error of the obtained number; for an onset the standard deviation over seeds, or half
    /// a step of the sweep if that is larger.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<f64>,
    /// Whether the zeros of Λ behind a number are all known as well as was asked for; there only where
    /// they are not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub refined: Option<bool>,
    pub tolerance: String,
    pub verdict: Verdict,
    /// Why the tolerance is what it is, or why a difference is known.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub reason: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Verdict {
    #[serde(rename = "holds")]
    Holds,
    #[serde(rename = "differs")]
    Differs,
    /// The file says why this cannot agree.
    #[serde(rename = "differs as known")]
    DiffersAsKnown,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Holds => "holds",
            Self::Differs => "differs",
            Self::DiffersAsKnown => "differs as known",
        })
    }
}

/// Judges every claim of an experiment, in the order of its file.
pub fn judge(plan: &Plan, findings: &Findings) -> Result<Vec<Claim>> {
    let claims = plan.experiment.claims.iter();
    claims.map(|(name, spec)| Judge { name, spec, plan, findings }.judge()).collect()
}

struct Judge<'a> {
    name: &'a str,
    spec: &'a ClaimSpec,
    plan: &'a Plan,
    findings: &'a Findings,
}

impl Judge<'_> {
    fn judge(&self) -> Result<Claim> {
        let spec = self.spec;
        let (paper, obtained, tolerance, holds) = match spec.of {
            Quantity::Eigenvectors => self.eigenvectors()?,
            Quantity::CascadeClusters
            | Quantity::SimulatedClusters
            | Quantity::PredictedRegions
            | Quantity::SimulatedRegions => self.clusters()?,
            Quantity::CascadeOrder | Quantity::SimulatedOrder => self.order()?,
            _ => self.numbers()?,
        };
        let verdict = match (holds, &spec.known_difference) {
            (true, _) => Verdict::Holds,
            (false, Some(_)) => Verdict::DiffersAsKnown,
            (false, None) => Verdict::Differs,
        };
        let known = spec.known_difference.clone().filter(|_| verdict == Verdict::DiffersAsKnown);
        let own = &self.plan.experiment.source;
        Ok(Claim {
            name: self.name.to_owned(),
            source: if spec.source.is_empty() { own.clone() } else { spec.source.clone() },
            paper,
            obtained,
            uncertainty: self.uncertainty(),
            refined: self.is_unrefined().then_some(false),
            tolerance,
            verdict,
            reason: known.unwrap_or_else(|| spec.reason.clone()),
        })
    }

    /// One number or a list of numbers.
    fn numbers(&self) -> Result<(Value, Value, String, bool)> {
        let obtained = self.obtained_numbers();
        let shown = match &obtained[..] {
            [Some(single)] => json!(single),
            [None] => Value::Null,
            many => json!(many),
        };
        let all = |holds: &dyn Fn(f64) -> bool| obtained.iter().all(|x| x.is_some_and(holds));
        if let Some(limit) = self.spec.at_most {
            return Ok((
                json!(format!("at most {limit}")),
                shown,
                "exact".into(),
                all(&|x| x <= limit),
            ));
        }
        if let Some(limit) = self.spec.at_least {
            return Ok((
                json!(format!("at least {limit}")),
                shown,
                "exact".into(),
                all(&|x| x >= limit),
            ));
        }
        if let Some(trend) = self.spec.trend {
            let (word, ordered): (_, fn(f64, f64) -> bool) = match trend {
                Trend::Rises => ("rising", |a, b| a < b),
                Trend::Falls => ("falling", |a, b| a > b),
            };
            let follows =
                |pair: &[Option<f64>]| pair[0].zip(pair[1]).is_some_and(|(a, b)| ordered(a, b));
            return Ok((json!(word), shown, "exact".into(), obtained.windows(2).all(follows)));
        }
        let paper = self.equals::<OneOrMany>("a number or a list of numbers")?;
        let paper = paper.list();
        let (abs, rel) = (self.spec.abs_tol.unwrap_or(0.0), self.spec.rel_tol.unwrap_or(0.0));
        // A hair of slack: 4.2 ± 0.1 holds 4.1, whose difference is 0.10000000000000053.
        let near = |x: f64, expected: f64| {
            (x - expected).abs() <= (abs + rel * expected.abs()) * (1.0 + 1e-9)
        };
        let holds = obtained.len() == paper.len()
            && obtained
                .iter()
                .zip(paper)
                .all(|(x, &expected)| x.is_some_and(|x| near(x, expected)));
        let tolerance = match (abs > 0.0, rel > 0.0) {
            (true, true) => format!("± {abs} ± {} %", 100.0 * rel),
            (true, false) => format!("± {abs}"),
            (false, true) => format!("± {} %", 100.0 * rel),
            (false, false) => "exact".into(),
        };
        let paper = if let [single] = paper { json!(single) } else { json!(paper) };
        Ok((paper, shown, tolerance, holds))
    }

    /// Whether a number follows from a zero of Λ that could not be refined.
    fn is_unrefined(&self) -> bool {
        let findings = self.findings;
        match self.spec.of {
            Quantity::SigmaC => findings.msf.stable.sigma_c().is_some_and(|zero| !zero.refined),
            Quantity::CriticalCouplings => {
                let modes = self.spec.at.modes.as_deref().unwrap_or_default();
                findings.critical.iter().any(|c| modes.contains(&c.mode) && !c.refined)
            }
            Quantity::CascadeClusters | Quantity::CascadeOrder => {
                findings.msf.stable.zeros().any(|zero| !zero.refined)
            }
            _ => false,
        }
    }

    fn obtained_numbers(&self) -> Vec<Option<f64>> {
        let (findings, at) = (self.findings, &self.spec.at);
        let clusters = || self.nodes(at.clusters.as_deref().unwrap_or_default());
        match self.spec.of {
            Quantity::Eigenvalues => {
                let eigenvalues = &findings.spectrum.eigenvalues;
                match &at.modes {
                    None => eigenvalues.iter().copied().map(Some).collect(),
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
            Quantity::SimulatedOnset => {
                vec![findings.simulated.as_ref().and_then(|s| s.onset(&clusters()).mean)]
            }
            Quantity::SimulatedError => {
                let clusters = clusters();
                self.at_each_epsilon(|simulated, position| {
                    let error = simulated.largest_cluster_error(position, &clusters);
                    error.is_finite().then_some(error)
                })
            }
            Quantity::Nodes => vec![Some(self.counted_nodes() as f64)],
            Quantity::Links => vec![Some(self.plan.network.n_links() as f64)],
            Quantity::Groups => vec![Some(self.plan.network.groups().len() as f64)],
            Quantity::Pearson => self.agreements(|a| Some(a.correlation?.pearson)),
            Quantity::Spearman => self.agreements(|a| Some(a.correlation?.spearman)),
            Quantity::RandIndex => self.agreements(|a| a.rand_index),
            Quantity::RegionVerdicts => {
                self.agreements(|a| Some(a.regions.as_ref()?.agreement.verdict_fraction()))
            }
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
            Quantity::Eigenvectors
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

    fn epsilon(&self) -> &[f64] {
        self.spec.at.epsilon.as_ref().map_or(&[], OneOrMany::list)
    }

    /// How well the obtained number is known, where that is known itself.
    fn uncertainty(&self) -> Option<f64> {
        let findings = self.findings;
        match self.spec.of {
            Quantity::LyapunovIsolated => Some(findings.msf.isolated.standard_error),
            Quantity::SigmaC => findings.msf.stable.sigma_c().map(|zero| zero.standard_error),
            Quantity::SimulatedOnset => {
                let clusters = self.nodes(self.spec.at.clusters.as_deref().unwrap_or_default());
                let simulated = findings.simulated.as_ref()?;
                Some(simulated.onset(&clusters).spread?.max(0.5 * simulated.widest_step()))
            }
            _ => None,
        }
    }

    /// How far the span of the printed vectors of each eigenspace lies from that eigenspace.
    fn eigenvectors(&self) -> Result<(Value, Value, String, bool)> {
        let printed: Vec<Vec<f64>> = self.equals("a list of vectors")?;
        let modes = self.spec.at.modes.clone().unwrap_or_default();
        let spectrum = &self.findings.spectrum;
        let of_eigenspace = |eigenspace: &std::ops::Range<usize>| {
            let inside =
                modes.iter().zip(&printed).filter(|(mode, _)| eigenspace.contains(&(*mode - 1)));
            let vectors: Vec<Vec<f64>> = inside.map(|(_, vector)| vector.clone()).collect();
            let computed = &spectrum.eigenvectors[eigenspace.clone()];
            if vectors.is_empty() { 0.0 } else { spectra::subspace_distance(&vectors, computed) }
        };
        let distance = spectrum.eigenspaces.iter().map(of_eigenspace).fold(0.0, f64::max);
        let allowed = self.spec.abs_tol.unwrap_or(0.0);
        let shown = json!(format!("{distance:.4} away"));
        let paper = json!(format!(
            "modes {} to {}",
            modes.iter().min().unwrap_or(&0),
            modes.iter().max().unwrap_or(&0)
        ));
        Ok((paper, shown, format!("≤ {allowed}"), distance <= allowed))
    }

    fn equals<T: serde::de::DeserializeOwned>(&self, expected: &str) -> Result<T> {
        let problem = || self.problem(&format!("needs `equals` to be {expected}"));
        self.spec.equals.clone().ok_or_else(problem)?.try_into().map_err(|_| problem())
    }

    fn problem(&self, message: &str) -> Problem {
        Problem::with_key(&self.plan.file, &format!("claims.{}", self.name), message)
    }
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
