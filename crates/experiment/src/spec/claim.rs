//! `[claims.NAME]`: what the source says, and how near ours must come.

use serde::Deserialize;

use super::Name;

/// One entry of `[claims]`: a value the source states, and how near ours must come.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClaimSpec {
    /// Which quantity.
    pub of: Quantity,
    /// Which instance of it.
    #[serde(default, rename = "where")]
    pub at: Where,
    /// The source's value; exactly one of `equals`, `at_most`, `at_least` and `trend` is given.
    pub equals: Option<toml::Value>,
    /// The most that the number may be.
    pub at_most: Option<f64>,
    /// The least that it may be.
    pub at_least: Option<f64>,
    /// How the quantity changes along the list `where.epsilon`.
    pub trend: Option<Trend>,
    /// How far it may lie off.
    pub abs_tol: Option<f64>,
    /// The same as a part of what is claimed.
    pub rel_tol: Option<f64>,
    /// Where the source says it; the experiment's own source by default.
    #[serde(default)]
    pub source: String,
    /// Why the tolerance is what it is.
    #[serde(default)]
    pub reason: String,
    /// Why a difference is expected: the verdict is then `differs as known`.
    pub known_difference: Option<String>,
}

/// Quantities that claims speak of.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub enum Quantity {
    /// All λ_k, descending.
    #[serde(rename = "eigenvalues")]
    Eigenvalues,
    /// Distance of given vectors from the eigenspace of `where.modes`.
    #[serde(rename = "eigenvectors")]
    Eigenvectors,
    /// Λ(0).
    #[serde(rename = "msf.lyapunov_isolated")]
    LyapunovIsolated,
    /// σ_c.
    #[serde(rename = "msf.sigma_c")]
    SigmaC,
    /// ε_k of `where.modes`.
    #[serde(rename = "critical_couplings")]
    CriticalCouplings,
    /// Predicted clusters at `where.epsilon`.
    #[serde(rename = "cascade.clusters")]
    CascadeClusters,
    /// Positions of `where.clusters` in the order in which they are predicted to be lost.
    #[serde(rename = "cascade.order_of_loss")]
    CascadeOrder,
    /// Simulated clusters at `where.epsilon`.
    #[serde(rename = "simulated.clusters")]
    SimulatedClusters,
    /// ε from which on all of `where.clusters` stay synchronised.
    #[serde(rename = "simulated.onset")]
    SimulatedOnset,
    /// Positions of `where.clusters` in the order in which they are lost as ε falls.
    #[serde(rename = "simulated.order_of_loss")]
    SimulatedOrder,
    /// Largest δx^c_m of `where.clusters` at `where.epsilon`.
    #[serde(rename = "simulated.error")]
    SimulatedError,
    /// Number of nodes of the network, or of its groups that begin with `where.group_prefix`.
    #[serde(rename = "network.nodes")]
    Nodes,
    /// Number of links of the network.
    #[serde(rename = "network.links")]
    Links,
    /// Number of groups of the network.
    #[serde(rename = "network.groups")]
    Groups,
    /// Pearson's correlation of δx_ij with δe_ij over all pairs at `where.epsilon`.
    #[serde(rename = "agreement.pearson")]
    Pearson,
    /// Spearman's rank correlation of δx_ij with δe_ij over all pairs at `where.epsilon`.
    #[serde(rename = "agreement.spearman")]
    Spearman,
    /// Adjusted Rand index of predicted and simulated clusters at `where.epsilon`.
    #[serde(rename = "agreement.rand_index")]
    RandIndex,
    /// Fraction of regions of the same verdict in prediction and simulation at `where.epsilon`.
    #[serde(rename = "agreement.regions")]
    RegionVerdicts,
    /// Clusters of regions by the two thresholds on δe_ij, at `where.epsilon`.
    #[serde(rename = "regions.predicted")]
    PredictedRegions,
    /// Clusters of regions by the two thresholds on δx_ij, at `where.epsilon`.
    #[serde(rename = "regions.simulated")]
    SimulatedRegions,
    /// Number of nodes in regions that δe_ij does not let synchronise, at `where.epsilon`.
    #[serde(rename = "regions.predicted.grey_nodes")]
    PredictedGrey,
    /// Number of nodes in regions that do not synchronise in simulation, at `where.epsilon`.
    #[serde(rename = "regions.simulated.grey_nodes")]
    SimulatedGrey,
    /// Mean number of nodes of the predicted clusters of regions at `where.epsilon`.
    #[serde(rename = "regions.predicted.cluster_size")]
    PredictedSize,
    /// Mean number of nodes of the simulated clusters of regions at `where.epsilon`.
    #[serde(rename = "regions.simulated.cluster_size")]
    SimulatedSize,
}

impl Quantity {
    /// Whether it is about the two-threshold analysis of regions.
    pub fn is_of_regions(self) -> bool {
        matches!(
            self,
            Self::RegionVerdicts
                | Self::PredictedRegions
                | Self::SimulatedRegions
                | Self::PredictedGrey
                | Self::SimulatedGrey
                | Self::PredictedSize
                | Self::SimulatedSize
        )
    }

    /// Whether it is made from simulations.
    pub fn is_simulated(self) -> bool {
        matches!(
            self,
            Self::SimulatedClusters
                | Self::SimulatedOnset
                | Self::SimulatedOrder
                | Self::SimulatedError
                | Self::Pearson
                | Self::Spearman
                | Self::RandIndex
                | Self::RegionVerdicts
                | Self::SimulatedRegions
                | Self::SimulatedGrey
                | Self::SimulatedSize
        )
    }
}

/// Each value against the one before it.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Trend {
    /// Larger than the one before.
    Rises,
    /// Smaller than the one before.
    Falls,
}

/// Which instance of a quantity a claim is about.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Where {
    /// A coupling strength or, for a quantity that is a number, a list of them.
    pub epsilon: Option<OneOrMany>,
    /// Modes k, counted from 1 as in λ_k.
    pub modes: Option<Vec<usize>>,
    /// Clusters of node labels.
    pub clusters: Option<Vec<Vec<Name>>>,
    /// What the names of groups begin with whose nodes are counted.
    pub group_prefix: Option<String>,
}

/// One number, or a list.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub enum OneOrMany {
    /// One.
    One(f64),
    /// Several.
    Many(Vec<f64>),
}

impl OneOrMany {
    /// The numbers as a list.
    pub fn list(&self) -> &[f64] {
        match self {
            Self::One(number) => std::slice::from_ref(number),
            Self::Many(numbers) => numbers,
        }
    }
}
