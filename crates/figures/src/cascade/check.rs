//! What can be wrong with the data of a cascade: its ranges of ε follow one another, and clusters
//! fit into what they came from.

use super::panel::{CascadePanel, CascadeState};
use crate::cascade_error::CascadeError;

impl CascadePanel {
    /// Checks that the data are possible.
    ///
    /// # Errors
    /// A [`CascadeError`] that names the first state at fault.
    pub fn check(&self, panel: &str) -> Result<(), CascadeError> {
        for (is_missing, what) in [(self.n_nodes == 0, "nodes"), (self.states.is_empty(), "states")]
        {
            if is_missing {
                return Err(CascadeError::Empty { panel: panel.into(), what });
            }
        }
        let before = std::iter::once(None).chain(self.states.iter().map(Some));
        for (number, (state, before)) in self.states.iter().zip(before).enumerate() {
            check_range((number, state), before, panel)?;
            self.check_clusters((number, state), before, panel)?;
        }
        Ok(())
    }

    fn check_clusters(
        &self,
        (state, this): (usize, &CascadeState),
        before: Option<&CascadeState>,
        panel: &str,
    ) -> Result<(), CascadeError> {
        let rooms: Vec<usize> =
            before.map_or_else(Vec::new, |b| b.clusters.iter().map(|c| c.n_nodes).collect());
        let n_before = rooms.len();
        let mut found = vec![0_usize; n_before];
        let mut total = 0_usize;
        for (cluster, c) in this.clusters.iter().enumerate() {
            let n_nodes = c.n_nodes;
            if n_nodes < 2 {
                return Err(CascadeError::TooFewNodes {
                    panel: panel.into(),
                    state,
                    cluster,
                    n_nodes,
                });
            }
            total = total.saturating_add(n_nodes);
            let Some(parent) = c.parent else { continue };
            let Some(sum) = found.get_mut(parent) else {
                let panel = panel.into();
                return Err(CascadeError::ParentOutOfRange {
                    panel,
                    state,
                    cluster,
                    parent,
                    n_before,
                });
            };
            *sum = sum.saturating_add(n_nodes);
        }
        let all = std::iter::once((total, self.n_nodes)).chain(found.into_iter().zip(rooms));
        match all.into_iter().find(|(found, n_nodes)| found > n_nodes) {
            Some((found, n_nodes)) => {
                Err(CascadeError::TooManyNodes { panel: panel.into(), state, found, n_nodes })
            }
            None => Ok(()),
        }
    }
}

/// Checks the range of a state on its own and against the one before.
fn check_range(
    (state, this): (usize, &CascadeState),
    before: Option<&CascadeState>,
    panel: &str,
) -> Result<(), CascadeError> {
    let (from, to) = (this.epsilon.0, this.epsilon.1.unwrap_or(f64::INFINITY));
    let is_finite = from.is_finite() && this.epsilon.1.is_none_or(f64::is_finite);
    if !is_finite || from < 0.0 || from >= to {
        return Err(CascadeError::BadRange { panel: panel.into(), state, from, to });
    }
    match before.map(|b| b.epsilon.0) {
        Some(before) if before != to => {
            Err(CascadeError::Gap { panel: panel.into(), state, from: to, before })
        }
        _ => Ok(()),
    }
}
