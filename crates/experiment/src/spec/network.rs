//! `[network.…]`, `prepare`, `[groups.…]` and `[regions]`: where the network comes from, what is made
//! of it before it is used, and how its nodes belong together.

use std::path::PathBuf;
use std::sync::Arc;

use eigensync::{Bound, RegionBounds};
use graph::formats::edge_list;
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use claims::Name;

use super::format::Format;

/// Where the network comes from.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum NetworkSpec {
    /// A file.
    File(FileSpec),
    /// Random communities.
    Communities(CommunitiesSpec),
    /// Random communities in place of the nodes of a small network.
    Hierarchical(HierarchicalSpec),
}

/// `[network.file]`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct FileSpec {
    /// Relative to the experiment file.
    pub path: PathBuf,
    /// Told by the ending of the path where it is left out.
    pub format: Option<Format>,
    /// What the file holds, where it is none but came from standard input.
    #[serde(skip)]
    pub given: Option<Arc<[u8]>>,
    /// Which matrix of a file that holds several.
    pub variable: Option<String>,
    /// Which attributes of nodes and links are what.
    #[serde(default)]
    pub attributes: AttributesSpec,
    /// First and last row (and column) to take of a matrix, counted from 1.
    pub block: Option<[usize; 2]>,
    /// Which nodes the rows of a matrix are.
    #[serde(default)]
    pub rows: RowsSpec,
    /// The command that brings the file where it may not be shipped: without the file the experiment
    /// is left out, with a notice, instead of refused.
    pub fetched_by: Option<String>,
}

impl FileSpec {
    /// The format that is named or that the ending tells; an edge list where it tells none.
    pub fn format(&self) -> Format {
        let told = self.format.or_else(|| Format::of_ending(&self.path));
        told.unwrap_or(Format(&edge_list::FORMAT))
    }
}

/// Names of attributes of nodes and links; those left out are not read.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct AttributesSpec {
    /// Number of an edge that is its weight; every edge has weight 1 without it.
    pub weight: Option<String>,
    /// Attribute of a node that is its label; its `id` without it.
    pub label: Option<String>,
    /// Attribute of a node that names its group.
    pub group: Option<String>,
    /// Two or three numbers of a node that are its position.
    pub position: Vec<String>,
}

/// Which nodes the rows of a matrix are.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RowsSpec {
    /// Row i, column j: the strength with which j drives i.
    #[default]
    Driven,
    /// Row i, column j: the strength with which i drives j.
    Driving,
}

/// `[network.communities]`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct CommunitiesSpec {
    /// Number of nodes in each community; the groups are called C1, C2, …
    pub sizes: Vec<usize>,
    /// Probability of a link within a community, and between two.
    pub p_within: Option<f64>,
    /// Probability of a link between two communities.
    pub p_between: Option<f64>,
    /// In place of both: the probability for each pair of communities, a symmetric matrix.
    pub probability: Option<Vec<Vec<f64>>>,
    /// Seed of the links; the experiment's by default.
    pub seed: Option<u64>,
}

/// `[network.hierarchical]`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct HierarchicalSpec {
    /// Edge list of the small network, relative to the experiment file.
    pub path: PathBuf,
    /// Number of nodes in each community.
    pub size: usize,
    /// Probability of a link within a community.
    pub p_within: f64,
    /// Probability of a link between two communities, for each unit of weight of the link between
    /// the nodes in whose place they stand.
    pub p_between_per_weight: f64,
    /// Seed of the links; the experiment's by default.
    pub seed: Option<u64>,
}

/// One step of `prepare`, applied in the order written.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum StepSpec {
    /// Keeps ranges of nodes, first and last counted from 1.
    Nodes(Vec<[usize; 2]>),
    /// Keeps nodes by their labels.
    Labels(Vec<Name>),
    /// Drops links of nodes to themselves.
    DropSelfLoops,
    /// Makes both directions equal.
    Symmetrise(SymmetriseSpec),
    /// Drops links of less weight.
    Threshold(f64),
    /// Gives every link the weight 1.
    Binarise,
    /// Drops nodes without links.
    DropIsolated,
    /// Keeps the largest component.
    LargestComponent,
}

/// What two directions become.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SymmetriseSpec {
    /// A link of weight 1 where there is one in either direction.
    Union,
    /// Their mean.
    Mean,
    /// The larger one.
    Max,
}

/// `[groups.…]`: groups of nodes, in place of those that the network brings with it.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum GroupsSpec {
    /// Name = [first, last], nodes counted from 1 after preparation.
    Ranges(IndexMap<String, [usize; 2]>),
    /// A text file with the name of each node's group, a line a node.
    File {
        /// Relative to the experiment file.
        path: PathBuf,
    },
}

/// `[regions]`: the groups as regions under two thresholds each for prediction and simulation.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct RegionsSpec {
    /// A region is predicted to synchronise where its mean δe is below this.
    pub distance_within: Bound,
    /// Two such regions are predicted to be one cluster where the mean δe between them is below this.
    pub distance_between: Bound,
    /// The same for δx in the simulation, in the units of the component.
    pub error_within: Bound,
    /// The largest δx between regions of one cluster.
    pub error_between: Bound,
}

impl RegionsSpec {
    /// The same as the library knows it.
    pub fn bounds(&self) -> RegionBounds {
        let Self { distance_within, distance_between, error_within, error_between } = *self;
        RegionBounds { distance_within, distance_between, error_within, error_between }
    }
}
