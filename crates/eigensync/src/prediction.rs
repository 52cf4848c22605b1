//! The cascade as far as the computed modes decide it. All modes, or leading ones where the stable set
//! has no upper end, decide every ε down to where the next mode would count. With an upper end σ₂ the
//! fastest modes leave the set as ε grows: from leading modes and λ_N alone it is known that none has
//! done so while ε < σ₂ / |λ_N|, and up to there the leading modes decide as ever.

use clustering::{ClusterRule, ClusteringError, State, cascade_reported};
use msf::{End, Interval, StableRegion};
use spectra::Spectrum;

/// What the computed modes are known to be of: all, or the leading ones and the last.
pub struct Known<'a> {
    pub spectrum: &'a Spectrum,
    /// λ_N, where it is known.
    pub fastest: Option<f64>,
}

impl Known<'_> {
    /// ε from which on modes that were not computed may be unstable; none if none ever is.
    pub fn top(&self, stable: &StableRegion) -> Option<f64> {
        if self.is_whole() || stable.is_unbounded() {
            return None;
        }
        let end = stable.intervals.first().and_then(Interval::upper).unwrap_or(0.0);
        // Without λ_N nothing is known at any ε.
        Some(self.fastest.filter(|&lambda| lambda < 0.0).map_or(0.0, |lambda| end / -lambda))
    }

    /// Takes back what was said of ε at which the slowest mode has a σ below this one, the smallest
    /// that was looked at: where nothing was found stable, something may be so there.
    pub fn end_where_the_look_began(&self, states: &mut [State], sigma: f64) {
        let slowest = self.slowest();
        if let (Some(last), Some(lambda)) = (states.last_mut(), slowest)
            && sigma > 0.0
        {
            last.epsilon.0 = last.epsilon.0.max(sigma / -lambda);
            last.truncated = true;
        }
    }

    /// The largest λ below 0: zero modes are zero exactly.
    pub fn slowest(&self) -> Option<f64> {
        self.spectrum.real_eigenvalues().into_iter().find(|&lambda| lambda < 0.0)
    }

    fn is_whole(&self) -> bool {
        self.spectrum.is_whole()
    }

    /// The states below that ε; none where nothing can be said.
    pub fn states(
        &self,
        stable: &StableRegion,
        rule: ClusterRule,
        progress: &dyn Fn(u64),
    ) -> Result<Vec<State>, ClusteringError> {
        let Some(top) = self.top(stable) else {
            return cascade_reported(self.spectrum, stable, rule, progress);
        };
        let Some(first) = stable.intervals.first().filter(|_| top > 0.0) else {
            return Ok(Vec::new());
        };
        let to = End::Looked { sigma: f64::INFINITY };
        let without_end = StableRegion { intervals: vec![Interval { to, ..*first }] };
        let mut states = cascade_reported(self.spectrum, &without_end, rule, progress)?;
        states.retain(|state| state.epsilon.0 < top);
        if let Some(highest) = states.first_mut() {
            highest.epsilon.1 = Some(highest.epsilon.1.map_or(top, |to| to.min(top)));
        }
        Ok(states)
    }
}
