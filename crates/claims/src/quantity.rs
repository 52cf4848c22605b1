//! What there is to a quantity that claims speak of.

use crate::Number;
use crate::answer::Answer;
use crate::found::Found;

/// A quantity: every field must be said of a new one.
#[derive(Debug)]
pub struct Quantity {
    /// What files call it.
    pub name: &'static str,
    /// What it is, in the words of the documentation.
    pub meaning: &'static str,
    /// Which keys of `where` single out one instance.
    pub uses: Uses,
    /// What it follows from.
    pub from: From,
    /// Whether it is about the two-threshold analysis of regions.
    pub of_regions: bool,
    /// How it is obtained; that decides what a claim may state, and how it is judged.
    pub obtained: Obtained,
    /// Runs that did not escape, of those on which it stands; none where it stands on none.
    pub bounded_runs: fn(&Found<'_>) -> Option<usize>,
    /// Whether it follows from a zero of Λ that could not be refined as asked.
    pub is_unrefined: fn(&Found<'_>) -> bool,
}

/// What a quantity follows from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum From {
    /// The network as it was prepared.
    Links,
    /// The spectrum.
    Modes,
    /// Λ(σ), and what is predicted by it.
    Curve,
    /// The sweep.
    Simulations,
}

/// Whether a quantity is singled out by a key of `where`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// It must be there.
    Needed,
    /// It may be there.
    Allowed,
    /// It must not.
    Meaningless,
}

/// How a quantity uses the keys of `where`.
#[derive(Clone, Copy, Debug)]
pub struct Uses {
    /// Coupling strengths.
    pub epsilon: Use,
    /// Modes.
    pub modes: Use,
    /// Clusters of nodes.
    pub clusters: Use,
    /// The beginning of names of groups.
    pub group_prefix: Use,
}

/// Clusters of nodes that were found, or none where nothing is predicted.
pub type Clusters = Option<Vec<Vec<usize>>>;

/// Clusters at one ε: several of them where it is not known which, first the likeliest; else why there are
/// none, where anything can be said of that.
pub type ClustersAt = Result<Vec<Clusters>, Option<String>>;

/// Between which two ε a cluster is lost as ε falls, or what is to be answered where that is not known.
pub type LostBetween = Result<[f64; 2], Answer>;

/// Takes vectors as they are printed, and gives the distances of their span from each computed eigenspace.
type OfVectors = fn(&Found<'_>, &[Vec<f64>]) -> Result<Vec<f64>, String>;

/// Takes the number of a cluster, from 0, and its nodes.
type OfLoss = fn(&Found<'_>, usize, &[usize]) -> LostBetween;

/// How a quantity is obtained.
#[derive(Clone, Copy, Debug)]
pub enum Obtained {
    /// Numbers: one for each mode or ε of the claim.
    Numbers(fn(&Found<'_>) -> Vec<Number>),
    /// Numbers, however many there are.
    List(fn(&Found<'_>) -> Vec<Number>),
    /// Distances of the span of given vectors from each computed eigenspace, or why there are none.
    Vectors(OfVectors),
    /// Clusters at the one ε of the claim.
    Clusters(fn(&Found<'_>, f64) -> ClustersAt),
    /// Where each cluster of the claim is lost, whose order is claimed.
    Losses {
        /// Of one cluster.
        between: OfLoss,
        /// Whether these are known exactly, so that equal ones are equal.
        exactly: bool,
    },
}

impl Uses {
    /// None of the keys.
    pub const NONE: Self = Self {
        epsilon: Use::Meaningless,
        modes: Use::Meaningless,
        clusters: Use::Meaningless,
        group_prefix: Use::Meaningless,
    };
    /// ε alone.
    pub const EPSILON: Self = Self { epsilon: Use::Needed, ..Self::NONE };
    /// Modes alone.
    pub const MODES: Self = Self { modes: Use::Needed, ..Self::NONE };
    /// Clusters alone.
    pub const CLUSTERS: Self = Self { clusters: Use::Needed, ..Self::NONE };
}

impl Quantity {
    /// Whether it is made from simulations.
    pub fn is_simulated(&self) -> bool {
        self.from == From::Simulations
    }

    /// Whether it needs a sweep: regions are held against the simulated ones, whichever of both a claim is
    /// about.
    pub fn needs_sweep(&self) -> bool {
        self.is_simulated() || self.of_regions
    }

    /// Whether it follows from averages over a time, which a quick run shortens.
    pub fn is_averaged(&self) -> bool {
        matches!(self.from, From::Curve | From::Simulations)
    }
}
