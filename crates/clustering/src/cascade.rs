//! The cascade of predicted states: as ε falls from infinity to zero, eigenspaces of σ = −ελ leave
//! (and enter) the stable set at the couplings ε = σ_edge / |λ|, and between two of these the
//! unstable modes, and so the clusters, stay the same.
//!
//! Eigenvalue 0 has σ = 0 at every ε, which is never inside the open stable set: the zero modes of a
//! network of several components are not damped by any coupling and count as unstable throughout.
//!
//! Source: Fan, Wang & Wang (2023), Sec. II, for a stable set σ > σ_c; bounded windows and
//! unions of intervals follow from the same relation.

use std::ops::Range;

use msf::StableRegion;
use spectra::Spectrum;

use crate::distance::{check_synchronous_mode, transverse};
use crate::{ClusteringError, EigenvectorDistance, Partition};

/// Couplings closer than this, relatively, are one: they differ by rounding.
const SAME_COUPLING: f64 = 1e-12;

/// What makes a cluster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClusterRule {
    /// δe_ij = 0 up to the solver's accuracy: [`EigenvectorDistance::exact_clusters`].
    Exact,
    /// Single linkage of δe_ij at a threshold: [`EigenvectorDistance::clusters_within`].
    Threshold(f64),
}

/// One predicted state.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Open range of the coupling strength, from below; no upper end where it is unbounded.
    pub epsilon: (f64, Option<f64>),
    /// Unstable transverse modes, from 0, ascending.
    pub unstable_modes: Vec<usize>,
    /// The nodes that stay together.
    pub clusters: Partition,
    /// Whether the range ends only because the next modes were not computed: at its lower end the
    /// last computed eigenspace becomes unstable, and others may with it.
    pub truncated: bool,
}

/// Every predicted state, from the largest couplings down.
///
/// The ranges follow one another without gaps from infinity to ε = 0; neighbours differ in their
/// unstable modes, though not always in their clusters (see [`merge_equal_clusters`]). An interval
/// of the stable set without an upper end counts as unbounded.
///
/// From a partial spectrum (leading modes only) the states reach down to where the last computed
/// eigenspace becomes unstable, as modes that were not computed may follow at once; the last state
/// then is `truncated`.
///
/// # Errors
/// - [`ClusteringError::PartialSpectrum`] for a partial spectrum where the stable set is bounded
///   above or empty, and [`ClusteringError::NoTransverseMode`] for one of nothing but zeros.
/// - [`ClusteringError::NoSynchronousMode`], [`ClusteringError::SpectrumTooRough`] and
///   [`ClusteringError::BadThreshold`] as [`EigenvectorDistance`] has them.
pub fn cascade(
    spectrum: &Spectrum,
    stable: &StableRegion,
    rule: ClusterRule,
) -> Result<Vec<State>, ClusteringError> {
    check_synchronous_mode(spectrum)?;
    let eigenspaces = Eigenspace::of(spectrum);
    let lowest = lowest_coupling(spectrum, &eigenspaces, stable)?;
    let mut states: Vec<State> = Vec::new();
    for (from, to) in ranges(&eigenspaces, stable, lowest) {
        let unstable_modes = unstable_modes(&eigenspaces, stable, inside(from, to));
        match states.last_mut() {
            Some(last) if last.unstable_modes == unstable_modes => last.epsilon.0 = from,
            last => {
                let clusters = clusters(spectrum, &unstable_modes, rule, last.as_deref())?;
                states.push(State {
                    epsilon: (from, to),
                    unstable_modes,
                    clusters,
                    truncated: false,
                });
            }
        }
    }
    states.last_mut().expect("there is at least one range").truncated = lowest > 0.0;
    Ok(states)
}

/// The states with neighbours of equal clusters merged, as an observer of clusters sees them.
///
/// A merged state spans both ranges; its unstable modes are all those unstable somewhere in it.
pub fn merge_equal_clusters(states: &[State]) -> Vec<State> {
    let mut merged: Vec<State> = Vec::new();
    for state in states {
        match merged.last_mut() {
            Some(last) if last.clusters == state.clusters => {
                last.epsilon.0 = state.epsilon.0;
                last.unstable_modes.extend(&state.unstable_modes);
                last.unstable_modes.sort_unstable();
                last.unstable_modes.dedup();
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
    fn of(spectrum: &Spectrum) -> Vec<Self> {
        let of = |space: &Range<usize>| {
            let sum: f64 = spectrum.eigenvalues[space.clone()].iter().sum();
            let magnitude = if space.start == 0 { 0.0 } else { -sum / space.len() as f64 };
            Self { modes: transverse(space), magnitude }
        };
        spectrum.eigenspaces.iter().map(of).collect()
    }
}

/// Down to which ε the computed modes decide: 0 if they are all there are.
fn lowest_coupling(
    spectrum: &Spectrum,
    eigenspaces: &[Eigenspace],
    stable: &StableRegion,
) -> Result<f64, ClusteringError> {
    let (computed, n_nodes) = (spectrum.eigenvalues.len(), spectrum.eigenvectors[0].len());
    if computed == n_nodes {
        return Ok(0.0);
    }
    let largest = eigenspaces.last().map_or(0.0, |space| space.magnitude);
    if largest == 0.0 {
        return Err(ClusteringError::NoTransverseMode { computed, n_nodes });
    }
    match stable.intervals.last() {
        Some(interval) if interval.to.is_none() => Ok(interval.from / largest),
        _ => Err(ClusteringError::PartialSpectrum { computed, n_nodes }),
    }
}

/// The ranges of ε between neighbouring transitions, from the largest down to `lowest`.
fn ranges(
    eigenspaces: &[Eigenspace],
    stable: &StableRegion,
    lowest: f64,
) -> Vec<(f64, Option<f64>)> {
    let edges = stable.intervals.iter().flat_map(|interval| [Some(interval.from), interval.to]);
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

fn clusters(
    spectrum: &Spectrum,
    unstable_modes: &[usize],
    rule: ClusterRule,
    above: Option<&State>,
) -> Result<Partition, ClusteringError> {
    // Further unstable modes only split exact clusters: where none is left, none comes back.
    let is_settled = |above: &&State| {
        let n_nodes = above.clusters.n_nodes();
        rule == ClusterRule::Exact
            && above.clusters.n_clusters() == n_nodes
            && above.unstable_modes.iter().all(|mode| unstable_modes.binary_search(mode).is_ok())
    };
    if let Some(above) = above.filter(is_settled) {
        return Ok(above.clusters.clone());
    }
    let distance = EigenvectorDistance::new(spectrum, unstable_modes)?;
    match rule {
        ClusterRule::Exact => distance.exact_clusters(),
        ClusterRule::Threshold(threshold) => distance.clusters_within(threshold),
    }
}
