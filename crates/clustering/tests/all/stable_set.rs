//! Predicted states from a stable set: which modes are unstable where is what `msf` says.

use clustering::{ClusterRule, ClusteringError, State, Stretch};
use msf::{Eigenspace, KnownModes, Others, Stability, StableRegion};
use spectra::Spectrum;

/// The cascade as far as the modes of a spectrum decide it.
pub fn cascade(
    spectrum: &Spectrum,
    stable: &StableRegion,
    rule: ClusterRule,
) -> Result<Vec<State>, ClusteringError> {
    clustering::cascade(spectrum, stretches(spectrum, stable), rule, clustering::QUIET)
}

fn stretches(spectrum: &Spectrum, stable: &StableRegion) -> Vec<Stretch> {
    let stretch = |stretch: msf::Stretch| Stretch {
        epsilon: stretch.epsilon,
        unstable_modes: stretch.unstable_modes,
        truncated: stretch.truncated,
    };
    Stability::new(stable, &known(spectrum)).stretches.into_iter().map(stretch).collect()
}

fn known(spectrum: &Spectrum) -> KnownModes {
    let mut start = 0;
    let mut eigenspaces = Vec::new();
    for space in &spectrum.eigenspaces {
        let end = start + space.basis.len();
        // Zeros are so up to rounding here.
        let lambda = if start == 0 { 0.0 } else { space.eigenvalue().re };
        eigenspaces.push(Eigenspace { modes: start.max(1)..end, lambda, error: 0.0 });
        start = end;
    }
    let last = eigenspaces.last().map_or(0.0, |space| space.lambda);
    let at_most = spectrum.cutoff.map_or(last, |cutoff| last.min(cutoff));
    let others = (!spectrum.is_whole()).then_some(Others { at_most, smallest: None });
    eigenspaces.retain(|space| !space.modes.is_empty());
    KnownModes { eigenspaces, others, looked_from: 0.0 }
}
