//! Eigenvalues and eigenvectors.

use std::ops::Range;

use crate::Number;
use crate::found::Found;

/// λ_k of the claimed modes, or of all.
pub fn eigenvalues(found: &Found<'_>) -> Vec<Number> {
    let eigenvalues = found.findings.spectrum.real_eigenvalues();
    let computed = eigenvalues.len();
    let number = |mode: usize| match eigenvalues.get(mode - 1) {
        Some(&value) => Number::Known { value, error: error(found, mode) },
        None => Number::Unknown(found.not_computed(mode)),
    };
    match &found.at.modes {
        Some(modes) => modes.iter().map(|&mode| number(mode)).collect(),
        // All, of which a part says nothing of the rest.
        None if computed < found.study.network.n_nodes() => {
            (1..=computed + 1).map(number).collect()
        }
        None => (1..=computed).map(number).collect(),
    }
}

/// How far an eigenvalue is known. Those of one eigenspace are equal as far as anyone can tell, so that
/// they are in no order.
pub fn error(found: &Found<'_>, mode: usize) -> f64 {
    let spectrum = found.findings.spectrum.real_modes();
    let error = spectrum.error(mode - 1);
    let is_multiple = |space: &Range<usize>| space.len() > 1 && space.contains(&(mode - 1));
    match found.at.in_order && spectrum.eigenspaces.iter().any(is_multiple) {
        true => error.max(spectrum.tolerance),
        false => error,
    }
}

/// How far the span of the printed vectors of each eigenspace lies from that eigenspace.
pub fn eigenvectors(found: &Found<'_>, printed: &[Vec<f64>]) -> Result<Vec<f64>, String> {
    let modes = found.at.modes.as_deref().unwrap_or_default();
    let spectrum = found.findings.spectrum.real_modes();
    // Fewer modes may have been computed than were asked for.
    if let Some(&mode) = modes.iter().find(|&&mode| mode > spectrum.eigenvalues.len()) {
        return Err(found.not_computed(mode));
    }
    let of_eigenspace = |eigenspace: &Range<usize>| {
        let inside =
            modes.iter().zip(printed).filter(|(mode, _)| eigenspace.contains(&(*mode - 1)));
        let vectors: Vec<Vec<f64>> = inside.map(|(_, vector)| vector.clone()).collect();
        let computed = &spectrum.eigenvectors[eigenspace.clone()];
        (!vectors.is_empty()).then(|| spectra::subspace_distance(&vectors, computed))
    };
    Ok(spectrum.eigenspaces.iter().filter_map(of_eigenspace).collect())
}
