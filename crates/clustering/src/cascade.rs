//! The cascade of predicted states: as ε falls from infinity to zero, eigenspaces of σ = −ελ leave
//! (and enter) the stable set at the couplings ε = σ_edge / |λ|, and between two of these the
//! unstable modes, and so the clusters, stay the same.
//!
//! Eigenvalue 0 has σ = 0 at every ε: the zero modes of a network of several components are unstable
//! throughout, unless σ = 0 is stable itself, where oscillators are at rest.
//!
//! Source: Fan, Wang & Wang (2023), Sec. II, for a stable set σ > σ_c; bounded windows and
//! unions of intervals follow from the same relation.

use std::ops::Range;
use std::sync::Arc;

use msf::StableRegion;
use spectra::{RealModes, Spectrum};

use crate::coincidences::Coincidences;
use crate::exact::ExactClusters;
use crate::linkage::clusters_of_each;
use crate::modes::{check_finite, check_shapes, check_synchronous_mode, transverse};
use crate::{ClusteringError, Partition};

/// Couplings closer than this, relatively, are one: they differ by rounding.
const SAME_COUPLING: f64 = 1e-12;

/// What makes a cluster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClusterRule {
    /// δe_ij = 0 up to the solver's accuracy: [`crate::EigenvectorDistance::exact_clusters`].
    Exact,
    /// Single linkage of δe_ij at a threshold: [`crate::EigenvectorDistance::clusters_within`].
    Threshold(f64),
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
    /// Whether the range ends only because no more is known: at its lower end the last computed
    /// eigenspace becomes unstable, and others may with it, or the next ones may; or a mode comes to
    /// a σ below all that were looked at.
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

/// Every predicted state, from the largest couplings down.
///
/// The ranges follow one another without gaps from infinity to ε = 0; neighbours differ in their
/// unstable modes, though not always in their clusters (see [`merge_equal_clusters`]). An interval
/// of the stable set without an upper end counts as unbounded.
///
/// From a partial spectrum (leading modes only) the states reach down to where the last computed
/// eigenspace becomes unstable, as modes that were not computed may follow at once, or to where an
/// eigenvalue at the spectrum's cutoff would; the last state then is `truncated`.
///
/// # Errors
/// - [`ClusteringError::PartialSpectrum`] for a partial spectrum where the stable set is bounded
///   above or empty, and [`ClusteringError::NoTransverseMode`] for one of nothing but zeros.
/// - [`ClusteringError::NoSynchronousMode`], [`ClusteringError::NotFinite`] (of any mode),
///   [`ClusteringError::SpectrumTooRough`] and [`ClusteringError::BadThreshold`] as
///   [`crate::EigenvectorDistance`] has them.
pub fn cascade(
    spectrum: &Spectrum,
    stable: &StableRegion,
    rule: ClusterRule,
) -> Result<Vec<State>, ClusteringError> {
    cascade_reported(spectrum, stable, rule, &|_| {})
}

/// [`cascade`], which reports every state whose clusters it has found; there are about as many as
/// eigenspaces for each end of a stable interval.
///
/// # Errors
/// Those of [`cascade`].
pub fn cascade_reported(
    spectrum: &Spectrum,
    stable: &StableRegion,
    rule: ClusterRule,
    progress: &dyn Fn(u64),
) -> Result<Vec<State>, ClusteringError> {
    let spectrum = &spectrum.real_modes();
    check_shapes(spectrum);
    check_synchronous_mode(spectrum)?;
    check_finite(spectrum, &(1..spectrum.eigenvalues.len()).collect::<Vec<_>>())?;
    let eigenspaces = Eigenspace::of(spectrum);
    let lowest = lowest_coupling(spectrum, &eigenspaces, stable)?;
    let stretches = stretches(&eigenspaces, stable, lowest);
    let sets: Vec<&[usize]> = stretches.iter().map(|s| &s.unstable_modes[..]).collect();
    let clusters = match rule {
        ClusterRule::Exact => exact_clusters(spectrum, &sets, progress)?,
        ClusterRule::Threshold(threshold) => near_clusters(spectrum, &sets, threshold, progress)?,
    };
    let last = stretches.len() - 1;
    let state = |(number, (stretch, clusters)): (usize, (Stretch, Clusters))| State {
        epsilon: stretch.epsilon,
        n_unstable: (stretch.unstable_modes.len(), stretch.unstable_modes.len()),
        unstable_modes: stretch.unstable_modes,
        clusters: clusters.together,
        cells: clusters.alike,
        coincidences: None,
        truncated: number == last && lowest > 0.0,
    };
    Ok(stretches.into_iter().zip(clusters).enumerate().map(state).collect())
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

/// The transverse modes of one eigenvalue.
struct Eigenspace {
    modes: Range<usize>,
    /// |λ|, and exactly 0 for the eigenspace of the synchronous mode.
    magnitude: f64,
}

impl Eigenspace {
    fn of(spectrum: &RealModes<'_>) -> Vec<Self> {
        let of = |space: &Range<usize>| {
            let sum: f64 = spectrum.eigenvalues[space.clone()].iter().sum();
            let magnitude = if space.start == 0 { 0.0 } else { -sum / space.len() as f64 };
            Self { modes: transverse(space), magnitude }
        };
        spectrum.eigenspaces.iter().map(of).collect()
    }
}

/// Down to which ε the computed modes decide: 0 if they are all there are, and all σ are known.
fn lowest_coupling(
    spectrum: &RealModes<'_>,
    eigenspaces: &[Eigenspace],
    stable: &StableRegion,
) -> Result<f64, ClusteringError> {
    let (computed, n_nodes) = (spectrum.eigenvalues.len(), spectrum.eigenvectors[0].len());
    let unknown_below = lowest_looked_at(eigenspaces, stable);
    if computed == n_nodes {
        return Ok(unknown_below);
    }
    let of_cutoff = spectrum.cutoff.map_or(0.0, |cutoff| -cutoff);
    let largest = eigenspaces.last().map_or(0.0, |space| space.magnitude).max(of_cutoff);
    if largest == 0.0 {
        return Err(ClusteringError::NoTransverseMode { computed, n_nodes });
    }
    match stable.intervals.last() {
        Some(interval) if interval.upper().is_none() => {
            Ok(unknown_below.max(interval.lower() / largest))
        }
        _ => Err(ClusteringError::PartialSpectrum { computed, n_nodes }),
    }
}

/// ε at which the slowest mode comes to the lowest σ that was looked at, if the stable set begins
/// only there; else 0.
fn lowest_looked_at(eigenspaces: &[Eigenspace], stable: &StableRegion) -> f64 {
    let slowest = eigenspaces.iter().map(|space| space.magnitude).find(|&lambda| lambda > 0.0);
    stable.unknown_below().zip(slowest).map_or(0.0, |(sigma, lambda)| sigma / lambda)
}

/// The ranges of ε between neighbouring transitions, from the largest down to `lowest`.
fn ranges(
    eigenspaces: &[Eigenspace],
    stable: &StableRegion,
    lowest: f64,
) -> Vec<(f64, Option<f64>)> {
    let edges = stable.intervals.iter().flat_map(|i| [Some(i.lower()), i.upper()]);
    let mut couplings: Vec<f64> = edges
        .flatten()
        .flat_map(|edge| eigenspaces.iter().map(move |space| edge / space.magnitude))
        .filter(|&epsilon| epsilon.is_finite() && epsilon > lowest * (1.0 + SAME_COUPLING))
        .collect();
    couplings.sort_unstable_by(|a, b| b.total_cmp(a));
    couplings.dedup_by(|lower, upper| *lower >= *upper * (1.0 - SAME_COUPLING));
    let upper_ends = std::iter::once(None).chain(couplings.iter().copied().map(Some));
    let lower_ends = couplings.iter().copied().chain([lowest]);
    lower_ends.zip(upper_ends).collect()
}

/// Some coupling inside a range.
fn inside(from: f64, to: Option<f64>) -> f64 {
    match to {
        Some(to) => 0.5 * (from + to),
        None => 2.0 * from + 1.0,
    }
}

fn unstable_modes(eigenspaces: &[Eigenspace], stable: &StableRegion, epsilon: f64) -> Vec<usize> {
    eigenspaces
        .iter()
        .filter(|space| !stable.contains(epsilon * space.magnitude))
        .flat_map(|space| space.modes.clone())
        .collect()
}

/// A range of ε in which the same modes are unstable.
struct Stretch {
    epsilon: (f64, Option<f64>),
    unstable_modes: Vec<usize>,
}

/// The stretches from the largest ε down, at least one; neighbours differ in their modes.
fn stretches(eigenspaces: &[Eigenspace], stable: &StableRegion, lowest: f64) -> Vec<Stretch> {
    let mut stretches: Vec<Stretch> = Vec::new();
    for (from, to) in ranges(eigenspaces, stable, lowest) {
        let unstable_modes = unstable_modes(eigenspaces, stable, inside(from, to));
        match stretches.last_mut() {
            Some(last) if last.unstable_modes == unstable_modes => last.epsilon.0 = from,
            _ => stretches.push(Stretch { epsilon: (from, to), unstable_modes }),
        }
    }
    stretches
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
    progress: &dyn Fn(u64),
) -> Result<Vec<Clusters>, ClusteringError> {
    let mut exact = ExactClusters::new(spectrum);
    let of = |modes: &&[usize]| {
        let together = exact.of(modes)?;
        progress(1);
        Ok(Clusters { alike: Arc::clone(&together), together })
    };
    sets.iter().map(of).collect()
}

/// [`crate::EigenvectorDistance::clusters_within`] of every set of unstable modes.
fn near_clusters(
    spectrum: &RealModes<'_>,
    sets: &[&[usize]],
    threshold: f64,
    progress: &dyn Fn(u64),
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
