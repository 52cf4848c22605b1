//! The cascade as far as the computed modes decide it: what `msf` makes of their eigenvalues goes to
//! `clustering` as stretches of ε.

use clustering::{ClusterRule, ClusteringError, State, Stretch, cascade};
use msf::{Eigenspace, KnownModes, Others, Stability, StableRegion};
use spectra::Spectrum;

use crate::Error;

/// Where the modes of a spectrum change their stability, after a look at σ from some value on; λ_N may be
/// known beside the modes.
///
/// # Errors
/// [`Error::OnlyZeroModes`], where something is stable.
pub fn stability(
    stable: &StableRegion,
    looked_from: f64,
    spectrum: &Spectrum,
    smallest: Option<f64>,
) -> Result<Stability, Error> {
    let eigenspaces = transverse(spectrum);
    let (computed, n_nodes) = (spectrum.n_modes(), spectrum.n_nodes());
    let last = spectrum.eigenspaces.last().map_or(0.0, |space| space.eigenvalue().re);
    let at_most = spectrum.cutoff.map_or(last, |cutoff| last.min(cutoff));
    if !spectrum.is_whole() && at_most == 0.0 && !stable.intervals.is_empty() {
        return Err(Error::OnlyZeroModes { computed, n_nodes });
    }
    let others = (!spectrum.is_whole()).then_some(Others { at_most, smallest });
    let known = KnownModes { eigenspaces, others, looked_from };
    Ok(Stability::new(stable, &known))
}

/// The states of these stretches.
pub fn states(
    spectrum: &Spectrum,
    stretches: Vec<msf::Stretch>,
    rule: ClusterRule,
    progress: clustering::Progress<'_>,
) -> Result<Vec<State>, ClusteringError> {
    let handed_over = |stretch: msf::Stretch| {
        let msf::Stretch { epsilon, unstable_modes, truncated } = stretch;
        Stretch { epsilon, unstable_modes, truncated }
    };
    cascade(spectrum, stretches.into_iter().map(handed_over).collect(), rule, progress)
}

/// The eigenspaces without mode 0. Zero modes are zero exactly, and no others are.
fn transverse(spectrum: &Spectrum) -> Vec<Eigenspace> {
    let modes = spectrum.real_modes();
    let ranges = modes.eigenspaces.iter().zip(&spectrum.eigenspaces);
    let of = |(range, space): (&std::ops::Range<usize>, &spectra::Eigenspace)| Eigenspace {
        modes: range.start.max(1)..range.end,
        lambda: space.eigenvalue().re,
        error: range.clone().map(|mode| modes.error(mode)).fold(0.0, f64::max),
    };
    ranges.map(of).filter(|space| !space.modes.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use graph::formats::edge_list;
    use graph::{CouplingMatrix, Normalization};
    use msf::Interval;
    use spectra::{Modes, Request, leading_modes};

    use super::*;

    fn spectrum_of(links: &str, modes: Modes) -> Spectrum {
        let network = edge_list::read(links.as_bytes()).unwrap();
        let w = CouplingMatrix::new(&network, Normalization::Laplacian);
        leading_modes(&w, &Request { modes, ..Request::default() }).unwrap()
    }

    fn above_one() -> StableRegion {
        StableRegion { intervals: vec![Interval::known(1.0, None)] }
    }

    #[test]
    fn eigenspaces_are_handed_over_without_the_synchronous_mode() {
        // A triangle and a pair: λ = 0, 0, −2, −3, −3.
        let spectrum = spectrum_of("1 2\n2 3\n3 1\n4 5", Modes::All);
        let found = stability(&above_one(), 0.0, &spectrum, None).unwrap();
        let modes: Vec<_> = found.transitions.iter().map(|t| t.modes.clone()).collect();
        assert_eq!(modes, [1..2, 2..3, 3..5]);
        let lambda: Vec<_> = found.transitions.iter().map(|t| t.lambda.round()).collect();
        assert_eq!(lambda, [0.0, -2.0, -3.0]);
        let unstable: Vec<_> = found.stretches.iter().map(|s| s.unstable_modes.clone()).collect();
        assert_eq!(unstable, [vec![1], vec![1, 2], vec![1, 2, 3, 4]]);
    }

    #[test]
    fn modes_above_a_cutoff_decide_down_to_where_one_at_the_cutoff_would_count() {
        // A path of three: λ = 0, −1, −3.
        let spectrum = spectrum_of("1 2\n2 3", Modes::Above(-2.0));
        let found = stability(&above_one(), 0.0, &spectrum, None).unwrap();
        assert_eq!((found.decided.from, found.stretches.len()), (0.5, 2));
        assert!(found.stretches[1].truncated);
    }

    #[test]
    fn zero_modes_alone_are_refused_where_something_is_stable() {
        let spectrum = spectrum_of("1 2\n2 3\n3 1\n4 5\n6", Modes::Leading(2));
        let error = stability(&above_one(), 0.0, &spectrum, None).unwrap_err();
        assert!(matches!(error, Error::OnlyZeroModes { computed: 3, n_nodes: 6 }), "{error}");
        let nowhere = stability(&StableRegion::default(), 0.0, &spectrum, Some(-3.0)).unwrap();
        assert_eq!(nowhere.stretches, []);
    }
}
