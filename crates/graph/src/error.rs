//! What can be wrong with a network, with a coupling matrix, with its preparation, and with the wishes for a random one.

use thiserror::Error;

/// Why a network could not be read or built.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum GraphError {
    /// No nodes.
    #[error("the network has no nodes")]
    Empty,
    /// More nodes than 32-bit indices can number.
    #[error("{n_nodes} nodes are more than the {} that can be numbered", u32::MAX)]
    TooManyNodes {
        /// Number of nodes found.
        n_nodes: usize,
    },
    /// Two nodes of the same name.
    #[error("two nodes are called `{label}`")]
    DuplicateLabel {
        /// Their label.
        label: String,
    },
    /// A link names a node that does not exist.
    #[error("a link names node {node}, but there are only {n_nodes} nodes")]
    NodeOutOfRange {
        /// Node number from 0.
        node: usize,
        /// Number of nodes.
        n_nodes: usize,
    },
    /// A link from a node to itself.
    #[error("node `{node}` is linked to itself")]
    SelfLoop {
        /// Its label.
        node: String,
    },
    /// A weight that is zero, negative or not finite.
    #[error("the link {from}–{to} has weight {weight}; expected a finite weight above zero")]
    BadWeight {
        /// Label of one end.
        from: String,
        /// Label of the other end.
        to: String,
        /// The weight found.
        weight: f64,
    },
    /// The same link twice.
    #[error("the link {from}–{to} is given twice")]
    DuplicateLink {
        /// Label of one end.
        from: String,
        /// Label of the other end.
        to: String,
    },
    /// A group without nodes.
    #[error("the group `{group}` has no nodes")]
    EmptyGroup {
        /// Its name.
        group: String,
    },
    /// Two groups of the same name.
    #[error("two groups are called `{group}`")]
    DuplicateGroup {
        /// Their name.
        group: String,
    },
    /// A group names a node that does not exist.
    #[error("the group `{group}` names node {node} (from 0), but there are only {n_nodes} nodes")]
    GroupOutOfRange {
        /// Its name.
        group: String,
        /// Node number from 0.
        node: usize,
        /// Number of nodes.
        n_nodes: usize,
    },
    /// A group names one node more than once.
    #[error("the group `{group}` names node `{node}` twice")]
    RepeatedInGroup {
        /// Label of the node.
        node: String,
        /// Name of the group.
        group: String,
    },
    /// Groups that overlap.
    #[error("node `{node}` is in the groups `{first}` and `{second}`; expected one group at most")]
    NodeInTwoGroups {
        /// Label of the node.
        node: String,
        /// Name of the earlier group.
        first: String,
        /// Name of the later group.
        second: String,
    },
    /// Not one position for every node.
    #[error("there are {n_positions} positions; expected one for each of the {n_nodes} nodes")]
    WrongPositionCount {
        /// Number of positions found.
        n_positions: usize,
        /// Number of nodes.
        n_nodes: usize,
    },
    /// A coordinate that is not finite.
    #[error("node `{node}` lies at {position:?}; expected finite coordinates")]
    BadPosition {
        /// Label of the node.
        node: String,
        /// The position found (x, y, z).
        position: [f64; 3],
    },
    /// A matrix entry that is not finite.
    #[error("the entry in row `{row}`, column `{column}` is {value}; expected a finite number")]
    BadEntry {
        /// Label of the row's node.
        row: String,
        /// Label of the column's node.
        column: String,
        /// The entry.
        value: f64,
    },
    /// The same matrix entry twice.
    #[error("the entry in row `{row}`, column `{column}` is given twice")]
    DuplicateEntry {
        /// Label of the row's node.
        row: String,
        /// Label of the column's node.
        column: String,
    },
    /// A matrix that differs from its transpose.
    #[error(
        "the matrix is not symmetric: row `{row}`, column `{column}` holds {value}, but row \
         `{column}`, column `{row}` holds {transposed}"
    )]
    NotSymmetric {
        /// Label of the row's node.
        row: String,
        /// Label of the column's node.
        column: String,
        /// The entry a_ij.
        value: f64,
        /// The entry a_ji.
        transposed: f64,
    },
}

/// Why a step of preparation could not be taken.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PrepareError {
    /// A selection without nodes.
    #[error("the selection names no nodes")]
    EmptySelection,
    /// A range that ends before or where it starts.
    #[error("nodes {} to {end} are selected; expected a range of at least one node", start + 1)]
    EmptyRange {
        /// First node, from 0.
        start: usize,
        /// End, excluded.
        end: usize,
    },
    /// A range beyond the last node.
    #[error("nodes {} to {end} are selected, but there are only {n_nodes} nodes", start + 1)]
    RangeOutOfRange {
        /// First node, from 0.
        start: usize,
        /// End, excluded.
        end: usize,
        /// Number of nodes.
        n_nodes: usize,
    },
    /// A selected label that no node bears.
    #[error("node `{label}` is selected, but no node is called that")]
    UnknownLabel {
        /// The label.
        label: String,
    },
    /// A node that the selection names more than once.
    #[error("node `{label}` is selected twice")]
    SelectedTwice {
        /// Its label.
        label: String,
    },
    /// A negative weight where a step would lose its sign.
    #[error("row `{row}`, column `{column}` holds {value}; expected no weight below zero")]
    NegativeWeight {
        /// Label of the row's node.
        row: String,
        /// Label of the column's node.
        column: String,
        /// The weight.
        value: f64,
    },
    /// A threshold that is not finite.
    #[error("the threshold is {threshold}; expected a finite number")]
    BadThreshold {
        /// The threshold.
        threshold: f64,
    },
    /// Dropping isolated nodes would leave none.
    #[error("all {n_nodes} nodes are isolated, so that dropping them leaves no network")]
    AllIsolated {
        /// Number of nodes.
        n_nodes: usize,
    },
}

/// Why a network could not be generated. Communities are numbered from 1.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum GeneratorError {
    /// No communities.
    #[error("there are no communities")]
    NoCommunities,
    /// A community of size zero.
    #[error("community {community} has 0 nodes; expected at least one")]
    EmptyCommunity {
        /// Its number.
        community: usize,
    },
    /// More nodes than 32-bit indices can number.
    #[error("{n_nodes} nodes are more than the {} that can be numbered", u32::MAX)]
    TooManyNodes {
        /// Number of nodes asked for.
        n_nodes: usize,
    },
    /// More links than a computer is likely to hold.
    #[error("these probabilities give {expected:.0} links or more; expected at most {limit:.0}")]
    TooManyLinks {
        /// Mean number of links, of those parts of the network that were counted.
        expected: f64,
        /// The largest mean number allowed.
        limit: f64,
    },
    /// A probability within communities outside [0, 1].
    #[error("the probability of a link within a community is {value}; expected 0 to 1")]
    BadWithin {
        /// The probability.
        value: f64,
    },
    /// A probability between communities outside [0, 1].
    #[error("the probability of a link between communities is {value}; expected 0 to 1")]
    BadBetween {
        /// The probability.
        value: f64,
    },
    /// Not one row of probabilities for every community.
    #[error(
        "the probability matrix has {n_rows} rows; expected one for each of the {n_communities} \
         communities"
    )]
    WrongRowCount {
        /// Number of rows.
        n_rows: usize,
        /// Number of communities.
        n_communities: usize,
    },
    /// A row of probabilities that is too short or too long.
    #[error(
        "row {row} of the probability matrix has {length} entries; expected one for each of the \
         {n_communities} communities"
    )]
    WrongRowLength {
        /// Number of the row, from 1.
        row: usize,
        /// Number of its entries.
        length: usize,
        /// Number of communities.
        n_communities: usize,
    },
    /// An entry of the probability matrix outside [0, 1].
    #[error("row {row}, column {column} of the probability matrix is {value}; expected 0 to 1")]
    BadEntry {
        /// Number of the row, from 1.
        row: usize,
        /// Number of the column, from 1.
        column: usize,
        /// The entry.
        value: f64,
    },
    /// A probability matrix that differs from its transpose.
    #[error(
        "the probability matrix is not symmetric: row {row}, column {column} is {value}, but row \
         {column}, column {row} is {transposed}"
    )]
    NotSymmetric {
        /// Number of the row, from 1.
        row: usize,
        /// Number of the column, from 1.
        column: usize,
        /// The entry in that row and column.
        value: f64,
        /// The entry opposite.
        transposed: f64,
    },
    /// A factor that is negative or not finite.
    #[error("the factor is {factor}; expected a finite number of at least zero")]
    BadFactor {
        /// The factor.
        factor: f64,
    },
    /// A link weight that the factor takes above probability 1.
    #[error(
        "the link {from}–{to} of weight {weight} times the factor {factor} gives the probability \
         {probability}; expected at most 1"
    )]
    AboveOne {
        /// Label of one end in the backbone.
        from: String,
        /// Label of the other end.
        to: String,
        /// Weight of the link.
        weight: f64,
        /// The factor.
        factor: f64,
        /// Their product.
        probability: f64,
    },
}

/// Why a matrix cannot couple anything. Rows and columns count from 0.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum CouplingError {
    /// No rows.
    #[error("the coupling matrix has no rows")]
    Empty,
    /// Rows and columns differ in number.
    #[error("the coupling matrix has {rows} rows and {columns} columns, and is to be square")]
    NotSquare {
        /// Number of rows.
        rows: usize,
        /// Number of columns.
        columns: usize,
    },
    /// An entry that is not a finite number.
    #[error("the coupling matrix has {value} in row {row}, column {column} (from 0)")]
    NotFinite {
        /// Its row.
        row: usize,
        /// Its column.
        column: usize,
        /// The entry.
        value: f64,
    },
    /// A row that does not sum to zero: equal states of all nodes would not stay equal.
    #[error(
        "row {row} (from 0) of the coupling matrix sums to {sum}, where its entries sum to {size} in \
         magnitude; every row is to sum to zero"
    )]
    RowSum {
        /// The row.
        row: usize,
        /// Σ_j w_ij.
        sum: f64,
        /// Σ_j |w_ij|.
        size: f64,
    },
}

/// Why names are not those of nodes, or no clusters.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum NameError {
    /// No node and no group is called so.
    #[error("names node \"{name}\", which the network does not have")]
    Unknown {
        /// The name.
        name: String,
        /// The first labels that there are.
        known: Vec<String>,
    },
    /// A cluster of fewer than two nodes.
    #[error("has the cluster [{}]; a cluster has two nodes or more", names.join(", "))]
    TooFew {
        /// The names in it.
        names: Vec<String>,
    },
    /// A node in two clusters, or twice in one.
    #[error("has node \"{label}\" twice; clusters share no nodes")]
    Twice {
        /// Its label.
        label: String,
    },
}

impl NameError {
    /// The way out, where there is an obvious one.
    pub fn hint(&self) -> Option<String> {
        match self {
            Self::Unknown { known, .. } => Some(format!("its nodes are {}", known.join(", "))),
            Self::TooFew { .. } | Self::Twice { .. } => None,
        }
    }
}
