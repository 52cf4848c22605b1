//! The density of eigenvalues by a few Lanczos steps, for the ends of a filter.
//!
//! The Ritz values of k steps and the squared first components of their vectors are nodes and weights
//! of a Gauss quadrature of the density of eigenvalues (Lin, Saad & Yang, SIAM Review 58, 34 (2016)),
//! so weight · N counts eigenvalues. The smallest Ritz value less the norm of the last residual
//! bounds the spectrum from below (Zhou & Li, J. Comput. Appl. Math. 235, 4163 (2011)); so does
//! −2 max_i |w_ii|, by Gershgorin, and always.

use crate::error::SpectraError;
use crate::matrix::product::Links;
use crate::recurrences::lanczos::Lanczos;
use crate::vectors::random::Random;

/// How many.
const STEPS: usize = 24;

/// What a few Lanczos steps tell of the spectrum of S.
pub(crate) struct SpectralDensity {
    /// At most the smallest eigenvalue.
    pub low: f64,
    /// Ritz values descending, with the number of eigenvalues that each stands for.
    pub density: Vec<(f64, f64)>,
    /// Products spent.
    pub products: usize,
}

impl SpectralDensity {
    /// That seen from a random vector.
    ///
    /// - `scale`: max_i |w_ii|.
    pub fn new(links: &Links<'_>, scale: f64, random: &mut Random) -> Result<Self, SpectraError> {
        let n_nodes = links.scale().len();
        let mut lanczos = Lanczos::from(random.block(n_nodes, 1), links, scale);
        while lanczos.steps() < STEPS.min(n_nodes) && lanczos.step() {}
        let ritz = lanczos.ritz()?;
        let steps = lanczos.steps();
        let weights = (0..steps).map(|k| n_nodes as f64 * ritz.vectors[(0, k)].powi(2));
        let density: Vec<_> = ritz.values.iter().copied().zip(weights).collect();
        let low = (density[steps - 1].0 - lanczos.last_beta()).max(-2.0 * scale);
        // Twice the rounding of a product, so that the smallest eigenvalue is inside for certain.
        Ok(Self { low: low - 1e-12 * scale, density, products: steps })
    }

    /// A value that about `count` eigenvalues exceed.
    pub fn exceeded_by(&self, count: usize) -> f64 {
        let mut sum = 0.0;
        let last = self.density[self.density.len() - 1].0;
        let enough = |&&(_, weight): &&(f64, f64)| {
            sum += weight;
            sum >= count as f64
        };
        self.density.iter().find(enough).map_or(last, |&(value, _)| value)
    }
}
