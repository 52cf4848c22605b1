//! Modes of a spectrum as clusters see them: transverse ones, whole eigenspaces, components that are
//! numbers.

use std::ops::Range;

use spectra::RealModes;

use crate::ClusteringError;

/// Nodes whose components are copied at a time: few enough to stay in cache.
const COPIED_NODES: usize = 256;
/// How much less than 1 the constant vector's share in the first eigenspace may be.
const CONSTANT_SHARE: f64 = 1e-6;

/// The modes of an eigenspace without mode 0, the synchronous one.
pub(crate) fn transverse(eigenspace: &Range<usize>) -> Range<usize> {
    eigenspace.start.max(1)..eigenspace.end
}

/// A threshold is finite and not negative.
pub(crate) fn check_threshold(threshold: f64) -> Result<(), ClusteringError> {
    if threshold.is_finite() && threshold >= 0.0 {
        Ok(())
    } else {
        Err(ClusteringError::BadThreshold { threshold })
    }
}

pub(crate) fn check_shapes(spectrum: &RealModes<'_>) {
    let n_modes = spectrum.eigenvalues.len();
    let (n_vectors, n_residuals) = (spectrum.eigenvectors.len(), spectrum.residuals.len());
    assert!(
        n_modes > 0 && n_vectors == n_modes && n_residuals == n_modes,
        "{n_modes} eigenvalues, {n_vectors} eigenvectors, {n_residuals} residuals"
    );
    let n_nodes = spectrum.eigenvectors[0].len();
    assert!(
        spectrum.eigenvectors.iter().all(|v| v.len() == n_nodes),
        "eigenvectors of different lengths, the first {n_nodes}"
    );
    let covered = spectrum.eigenspaces.iter().fold(0, |end, space| {
        assert!(space.start == end && space.end > end, "eigenspace {space:?} after mode {end}");
        space.end
    });
    assert_eq!(covered, n_modes, "eigenspaces cover {covered} of {n_modes} modes");
}

/// The vector of equal components is an eigenvector of eigenvalue 0, the largest there is.
pub(crate) fn check_synchronous_mode(spectrum: &RealModes<'_>) -> Result<(), ClusteringError> {
    let n_nodes = spectrum.eigenvectors[0].len() as f64;
    let share = |v: &&[f64]| v.iter().sum::<f64>().powi(2) / n_nodes;
    let overlap = spectrum.eigenvectors[spectrum.eigenspaces[0].clone()].iter().map(share).sum();
    if (1.0 - CONSTANT_SHARE..=1.0 + CONSTANT_SHARE).contains(&overlap) {
        Ok(())
    } else {
        Err(ClusteringError::NoSynchronousMode { overlap })
    }
}

/// The eigenspaces, by number, whose transverse modes are those given.
pub(crate) fn chosen_eigenspaces(
    spectrum: &RealModes<'_>,
    modes: &[usize],
) -> Result<Vec<usize>, ClusteringError> {
    let n_modes = spectrum.eigenvalues.len();
    let mut is_given = vec![false; n_modes];
    for &mode in modes {
        if mode == 0 {
            return Err(ClusteringError::SynchronousMode);
        }
        *is_given.get_mut(mode).ok_or(ClusteringError::ModeOutOfRange { mode, n_modes })? = true;
    }
    let mut chosen = Vec::new();
    for (number, space) in spectrum.eigenspaces.iter().enumerate() {
        let Range { start: first, end } = transverse(space);
        if !is_given[first..end].contains(&true) {
            continue;
        }
        if let Some(missing) = (first..end).find(|&mode| !is_given[mode]) {
            return Err(ClusteringError::PartOfEigenspace { first, last: end - 1, missing });
        }
        chosen.push(number);
    }
    Ok(chosen)
}

/// The components of these modes are numbers.
pub(crate) fn check_finite(
    spectrum: &RealModes<'_>,
    modes: &[usize],
) -> Result<(), ClusteringError> {
    for &mode in modes {
        let components = &spectrum.eigenvectors[mode];
        if let Some(node) = components.iter().position(|component| !component.is_finite()) {
            return Err(ClusteringError::NotFinite { mode, node });
        }
    }
    Ok(())
}

/// The components of these nodes in the modes of these eigenspaces, node by node.
pub(crate) fn interleaved(
    spectrum: &RealModes<'_>,
    spaces: &[Range<usize>],
    nodes: &[usize],
) -> Vec<f64> {
    let vectors: Vec<&[f64]> =
        spaces.iter().flat_map(|space| &spectrum.eigenvectors[space.clone()]).copied().collect();
    let width = vectors.len();
    let mut rows = vec![0.0; nodes.len() * width];
    for (some, nodes) in nodes.chunks(COPIED_NODES).enumerate() {
        let rows = &mut rows[some * COPIED_NODES * width..];
        for (column, vector) in vectors.iter().enumerate() {
            for (place, &node) in nodes.iter().enumerate() {
                rows[place * width + column] = vector[node];
            }
        }
    }
    rows
}
