//! Which nodes synchronise, and when: the eigenvector distance δe_ij, the clusters it predicts, the
//! cascade of predicted states over the coupling strength ε and its tree, which clusters the links keep
//! exact, regions under two thresholds, and how far two partitions or two distances agree.
//!
//! Integrates nothing and reads no files: it takes a [`spectra::Spectrum`], and which of its modes are
//! unstable on each [`Stretch`] of ε. Modes and nodes count from 0 here; mode 0, of eigenvalue λ_1 = 0,
//! is the synchronous motion itself and never transverse.

mod agreement;
mod assignment;
mod cascade;
mod cascade_tree;
mod cell_list;
mod cells;
mod coincidences;
mod coordinates;
mod correlation;
mod disjoint_sets;
mod distance;
mod equitability;
mod error;
mod exact;
mod label;
mod linkage;
mod links;
mod metric;
mod modes;
mod near_pairs;
mod partition;
mod progress;
mod refinement;
mod regions;
mod spread;
mod tolerance;

pub use agreement::{MaximumOverlap, adjusted_rand_index, maximum_overlap};
pub use cascade::{ClusterRule, State, Stretch, cascade, merge_equal_clusters};
pub use cascade_tree::{CascadeTree, TreeCluster, TreeEnd, TreeRow};
pub use coincidences::Coincidences;
pub use correlation::{Correlation, correlation_of_pairs, pearson, spearman};
pub use distance::{EigenvectorDistance, mean_over_bases};
pub use equitability::{Equitability, equitable};
pub use error::ClusteringError;
pub use label::{ClusterKind, ClusterLabel, StateLabels};
pub use links::hold_against_links;
pub use partition::Partition;
pub use progress::{Progress, QUIET};
pub use refinement::{Refiner, equitable_refinement};
pub use regions::{RegionAgreement, RegionClusters, RegionDistances, RegionThresholds};
