//! The cascade of predicted states: as ε falls from infinity to zero, modes become unstable (or stable)
//! at their transitions, and between two of these the unstable modes, and so the clusters, stay the
//! same. Which modes are unstable where is given.
//!
//! Source: Fan, Wang & Wang (2023), Sec. II.

use std::sync::Arc;

use spectra::{RealModes, Spectrum};

use crate::coincidences::Coincidences;
use crate::exact::ExactClusters;
use crate::linkage::clusters_of_each;
use crate::modes::{check_finite, check_shapes, check_synchronous_mode, chosen_eigenspaces};
use crate::progress::{Progress, go_on};
use crate::{ClusteringError, Partition};

/// What makes a cluster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClusterRule {
    /// δe_ij = 0 up to the solver's accuracy: [`crate::EigenvectorDistance::exact_clusters`].
    Exact,
    /// Single linkage of δe_ij at a threshold: [`crate::EigenvectorDistance::clusters_within`].
    Threshold(f64),
}

/// A range of ε in which the same modes are unstable.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch {
    /// Open range of the coupling strength, from below; no upper end where it is unbounded.
    pub epsilon: (f64, Option<f64>),
    /// Unstable transverse modes, from 0, ascending.
    pub unstable_modes: Vec<usize>,
    /// Whether the range ends only because no more is known below.
    pub truncated: bool,
}

/// One predicted state.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Open range of the coupling strength, from below; no upper end where it is unbounded.
    pub epsilon: (f64, Option<f64>),
    /// Unstable transverse modes, from 0, ascending; of a merged state all that are unstable anywhere
    /// in its range.
    pub unstable_modes: Vec<usize>,
    /// How many modes are unstable at one ε of the range: the least and the most.
    pub n_unstable: (usize, usize),
    /// The nodes that stay together.
    pub clusters: Arc<Partition>,
    /// Those of them that stay together exactly, as far as is known: here nodes of one cluster that no
    /// unstable mode tells apart, and after [`crate::hold_against_links`] the coarsest equitable
    /// refinement of that. From a spectrum too rough to tell every node is a cell of its own.
    pub cells: Arc<Partition>,
    /// Clusters that chance alone explains, which were taken apart.
    pub coincidences: Option<Coincidences>,
    /// Whether the range ends only because no more is known below.
    pub truncated: bool,
}

impl State {
    /// Whether a coupling strength lies in the range of this state, its upper end included.
    pub fn holds_at(&self, epsilon: f64) -> bool {
        epsilon > self.epsilon.0 && self.epsilon.1.is_none_or(|to| epsilon <= to)
    }

    /// Those of these states, from the largest ε down, that were merged into this one.
    pub fn stretches<'a>(&self, states: &'a [Self]) -> &'a [Self] {
        let (from, to) = self.epsilon;
        let start = to.map_or(0, |to| states.partition_point(|state| state.epsilon.0 >= to));
        &states[start..states.partition_point(|state| state.epsilon.0 >= from)]
    }
}

/// The predicted state of every stretch, from the largest couplings down.
///
/// Neighbours differ in their unstable modes, though not always in their clusters (see
/// [`merge_equal_clusters`]). Reports every state whose clusters it has found, and stops where it is told to.
///
/// # Errors
/// [`ClusteringError::NoSynchronousMode`], [`ClusteringError::NotFinite`] (of any mode),
/// [`ClusteringError::SpectrumTooRough`], [`ClusteringError::BadThreshold`], and those of unstable modes
/// that are not whole eigenspaces of the spectrum, as [`crate::EigenvectorDistance`] has them;
/// [`ClusteringError::Cancelled`].
///
/// # Panics
/// If the stretches do not follow one another from the largest ε down.
pub fn cascade(
    spectrum: &Spectrum,
    stretches: Vec<Stretch>,
    rule: ClusterRule,
    progress: Progress<'_>,
) -> Result<Vec<State>, ClusteringError> {
    let spectrum = &spectrum.real_modes();
    check_shapes(spectrum);
    check_synchronous_mode(spectrum)?;
    check_finite(spectrum, &(1..spectrum.eigenvalues.len()).collect::<Vec<_>>())?;
    check_stretches(spectrum, &stretches)?;
    let sets: Vec<&[usize]> = stretches.iter().map(|s| &s.unstable_modes[..]).collect();
    let clusters = match rule {
        ClusterRule::Exact => exact_clusters(spectrum, &sets, progress)?,
        ClusterRule::Threshold(threshold) => near_clusters(spectrum, &sets, threshold, progress)?,
    };
    let state = |(stretch, clusters): (Stretch, Clusters)| State {
        epsilon: stretch.epsilon,
        n_unstable: (stretch.unstable_modes.len(), stretch.unstable_modes.len()),
        unstable_modes: stretch.unstable_modes,
        clusters: clusters.together,
        cells: clusters.alike,
        coincidences: None,
        truncated: stretch.truncated,
    };
    Ok(stretches.into_iter().zip(clusters).map(state).collect())
}

/// The states with neighbours of equal clusters merged, as an observer of clusters sees them.
///
/// Equal are those that are also exact alike: where more modes become unstable under a threshold, all
/// clusters may stay as they are although exact synchrony is lost in some, and that is another state.
/// A merged state spans both ranges; its unstable modes are all those unstable somewhere in it.
pub fn merge_equal_clusters(states: &[State]) -> Vec<State> {
    let mut merged: Vec<State> = Vec::new();
    for state in states {
        match merged.last_mut() {
            Some(last) if last.clusters == state.clusters && last.cells == state.cells => {
                last.epsilon.0 = state.epsilon.0;
                last.unstable_modes.extend(&state.unstable_modes);
                last.unstable_modes.sort_unstable();
                last.unstable_modes.dedup();
                let ((least, most), (fewer, more)) = (last.n_unstable, state.n_unstable);
                last.n_unstable = (least.min(fewer), most.max(more));
                last.coincidences = last.coincidences.or(state.coincidences);
                last.truncated = state.truncated;
            }
            _ => merged.push(state.clone()),
        }
    }
    merged
}

/// Ranges of ε that follow one another, and whole eigenspaces in each.
fn check_stretches(spectrum: &RealModes<'_>, stretches: &[Stretch]) -> Result<(), ClusteringError> {
    for pair in stretches.windows(2) {
        let (above, below) = (pair[0].epsilon, pair[1].epsilon);
        assert!(below.1 == Some(above.0), "a stretch of ε over {below:?} below one over {above:?}");
    }
    for stretch in stretches {
        chosen_eigenspaces(spectrum, &stretch.unstable_modes)?;
    }
    Ok(())
}

/// The clusters of one stretch, and those of their nodes that no unstable mode tells apart.
struct Clusters {
    together: Arc<Partition>,
    alike: Arc<Partition>,
}

/// [`crate::EigenvectorDistance::exact_clusters`] of every set of unstable modes.
fn exact_clusters(
    spectrum: &RealModes<'_>,
    sets: &[&[usize]],
    progress: Progress<'_>,
) -> Result<Vec<Clusters>, ClusteringError> {
    let mut exact = ExactClusters::new(spectrum);
    let of = |modes: &&[usize]| {
        let together = exact.of(modes)?;
        go_on(progress(1))?;
        Ok(Clusters { alike: Arc::clone(&together), together })
    };
    sets.iter().map(of).collect()
}

/// [`crate::EigenvectorDistance::clusters_within`] of every set of unstable modes.
fn near_clusters(
    spectrum: &RealModes<'_>,
    sets: &[&[usize]],
    threshold: f64,
    progress: Progress<'_>,
) -> Result<Vec<Clusters>, ClusteringError> {
    let n_nodes = spectrum.eigenvectors[0].len();
    let near = clusters_of_each(spectrum, sets, threshold, progress)?;
    let mut exact = ExactClusters::new(spectrum);
    let mut last: Option<Arc<Partition>> = None;
    let mut of = |(together, modes): (Partition, &&[usize])| {
        let alike = match exact.of(modes) {
            Err(ClusteringError::SpectrumTooRough { .. }) => Partition::singletons(n_nodes).into(),
            alike => alike?,
        };
        let alike = match alike.is_refinement_of(&together) {
            true => alike,
            false => alike.intersection(&together).into(),
        };
        // Most neighbours have equal clusters: one copy is enough.
        let shared = last.take().filter(|last| **last == together);
        let together = shared.unwrap_or_else(|| Arc::new(together));
        last = Some(Arc::clone(&together));
        Ok(Clusters { together, alike })
    };
    near.into_iter().zip(sets).map(&mut of).collect()
}
