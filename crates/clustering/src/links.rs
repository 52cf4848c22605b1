//! What the links say of predicted states: which nodes of a cluster the network keeps equal, and which
//! clusters are there by chance.
//!
//! Nodes of a cluster that start equal stay so if the partition is equitable. A state's partition
//! need not be: equal total weights to clusters that are not equitable themselves prove nothing. Its
//! coarsest equitable refinement is, and so its cells are what stays together exactly.

use std::sync::Arc;

use spectra::Spectrum;
use sprs::CsMatViewI;

use crate::coincidences::taken_apart;
use crate::exact::are_among;
use crate::refinement::Refiner;
use crate::{ClusterRule, ClusteringError, State};

/// Refines the cells of every state to an equitable partition, and takes apart what clusters chance
/// alone explains where the rule is [`ClusterRule::Exact`].
///
/// - `matrix`: the coupling matrix.
/// - `tolerance`: as in [`Refiner::new`].
///
/// What was taken apart in one state stays so in the next ones as long as modes only become unstable.
/// O((N + links) log N) for all states in which clusters only split.
///
/// # Errors
/// Those of [`Refiner::new`] and [`crate::EigenvectorDistance::new`].
///
/// # Panics
/// If the states, the spectrum and the matrix are not of the same nodes.
pub fn hold_against_links(
    states: &mut [State],
    spectrum: &Spectrum,
    matrix: CsMatViewI<'_, f64, u32, usize>,
    rule: ClusterRule,
    tolerance: f64,
) -> Result<(), ClusteringError> {
    let spectrum = &spectrum.real_modes();
    let mut refiner = Refiner::new(matrix, tolerance)?;
    // The last state as it was, and as it is.
    let mut last: Option<(State, State)> = None;
    for state in states {
        let found = state.clone();
        if let Some((last_found, last)) = &last {
            let only_splits = are_among(&last.unstable_modes, &state.unstable_modes);
            let is_same = |a: &Arc<_>, b: &Arc<_>| Arc::ptr_eq(a, b) || a == b;
            let are_same = is_same(&found.clusters, &last_found.clusters)
                && is_same(&found.cells, &last_found.cells);
            if are_same && (only_splits || last.clusters == last_found.clusters) {
                state.clusters = Arc::clone(&last.clusters);
                state.cells = Arc::clone(&last.cells);
                continue;
            }
            if only_splits && last.clusters != last_found.clusters {
                state.clusters = state.clusters.intersection(&last.clusters).into();
                state.cells = state.cells.intersection(&last.clusters).into();
            }
        }
        let cells = refiner.coarsest(&state.cells);
        if rule == ClusterRule::Exact
            && let Some((clusters, coincidences)) =
                taken_apart(&state.clusters, &cells, spectrum, &state.unstable_modes)?
        {
            state.clusters = clusters.into();
            state.coincidences = Some(coincidences);
        }
        state.cells =
            if cells == *state.clusters { Arc::clone(&state.clusters) } else { cells.into() };
        last = Some((found, state.clone()));
    }
    Ok(())
}
