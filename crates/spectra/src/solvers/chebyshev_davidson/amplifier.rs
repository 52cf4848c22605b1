//! How the block method amplifies what is wanted: by a Chebyshev filter of a degree that fits.

use crate::error::SpectraError;
use crate::matrix::product::Links;
use crate::progress::Asked;
use crate::recurrences::chebyshev::{Interval, filter};
use crate::vectors::block::Block;

/// The highest degree of a filter.
const HIGHEST_DEGREE: usize = 24;
/// A filter may amplify the largest eigenvalue by this much more than those searched for: what
/// rounding leaves of modes found then stays small.
const LARGEST_GAIN: f64 = 1e10;
/// A sequence may amplify known eigenvectors by this much before they are projected out again.
const STRETCH_GAIN: f64 = 1e9;

/// T_d(t(S)), whose largest eigenvalues belong to the wanted eigenvectors.
pub(crate) struct Amplifier<'a> {
    pub links: &'a Links<'a>,
    /// At most the smallest eigenvalue of S.
    pub low: f64,
    /// Upper end of the unwanted part while little is known.
    pub first_guess: f64,
}

/// What is known of the spectrum when vectors are amplified.
pub(crate) struct Situation {
    /// The largest eigenvalue.
    pub top: f64,
    /// A Ritz value below all that are wanted, hence a lower bound of an eigenvalue.
    pub guard: Option<f64>,
    /// Below which eigenvalues are unwanted by request.
    pub cutoff: Option<f64>,
}

impl Amplifier<'_> {
    /// Products that each vector costs.
    pub fn products(&self, situation: &Situation) -> usize {
        degree(situation, self.interval(situation))
    }

    /// Amplifies the vectors of a block.
    pub fn apply(
        &self,
        block: Block,
        situation: &Situation,
        asked: Asked<'_>,
    ) -> Result<Block, SpectraError> {
        let unwanted = self.interval(situation);
        filter(self.links, block, degree(situation, unwanted), unwanted, asked)
    }

    /// Steps after which what rounding leaves of the largest eigenvalue has to be projected out again,
    /// when eigenvalues up to `high` are not amplified.
    pub fn stretch(&self, top: f64, high: Option<&f64>) -> usize {
        let high = high.copied().unwrap_or(self.first_guess);
        Interval { low: self.low, high }.stretch(top, STRETCH_GAIN)
    }

    fn interval(&self, situation: &Situation) -> Interval {
        let high = situation.guard.unwrap_or(self.first_guess);
        let high = situation.cutoff.map_or(high, |cutoff| high.min(cutoff));
        // Where all that is left lies at the lower end, an interval of no width would amplify nothing
        // but rounding.
        let narrowest = 0.01 * (situation.top - self.low);
        Interval { low: self.low.min(high - narrowest), high }
    }
}

fn degree(situation: &Situation, unwanted: Interval) -> usize {
    let growth = unwanted.growth(situation.top);
    let highest = LARGEST_GAIN.ln() / growth;
    (highest.min(HIGHEST_DEGREE as f64) as usize).max(1)
}
