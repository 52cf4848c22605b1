//! A claim that was checked.

use crate::at::At;
use crate::quantity::Quantity;
use crate::trend::Trend;

/// What a source says of a quantity, checked against the study that it is about.
#[derive(Clone, Debug)]
pub struct Claim {
    /// Its key in the file.
    pub name: String,
    /// Which quantity.
    pub of: &'static Quantity,
    /// Which instance of it.
    pub at: At,
    /// What is said of it.
    pub stated: Stated,
    /// Where the source says it.
    pub source: String,
    /// Why the tolerance is what it is.
    pub reason: String,
    /// Why a difference is expected, where it is.
    pub known_difference: Option<String>,
}

/// What a claim says.
#[derive(Clone, Debug)]
pub enum Stated {
    /// Numbers, and how near what is obtained must come.
    Numbers {
        /// One for each mode or ε.
        values: Vec<f64>,
        /// Absolute tolerance.
        abs_tol: f64,
        /// Tolerance as a part of each value.
        rel_tol: f64,
    },
    /// A number is at most this.
    AtMost(f64),
    /// A number is at least this.
    AtLeast(f64),
    /// Each number against the one before it.
    Trend(Trend),
    /// A vector over the nodes for each mode.
    Vectors {
        /// As they are printed.
        vectors: Vec<Vec<f64>>,
        /// Largest distance of their span from the computed eigenspace.
        abs_tol: f64,
    },
    /// Clusters of nodes.
    Clusters {
        /// As the file names them.
        named: Vec<Vec<String>>,
        /// Their nodes.
        nodes: Vec<Vec<usize>>,
    },
    /// Positions of the clusters in the order in which they are lost, from 1.
    Order(Vec<usize>),
}
