//! A first look at the spectrum: a few Lanczos steps, for the filter's ends.
//!
//! The Ritz values of k steps and the squared first components of their vectors are nodes and weights
//! of a Gauss quadrature of the density of eigenvalues (Lin, Saad & Yang, SIAM Review 58, 34 (2016)),
//! so weight · N counts eigenvalues. The smallest Ritz value less the norm of the last residual
//! bounds the spectrum from below (Zhou & Li, J. Comput. Appl. Math. 235, 4163 (2011)); so does
//! −2 max_i |w_ii|, by Gershgorin, and always.

use graph::CouplingMatrix;

use crate::SpectraError;
use crate::block::Basis;
use crate::dense::symmetric_eigen;
use crate::product::multiply_block;
use crate::random::Random;

/// Steps of the look.
const STEPS: usize = 24;

/// What a few Lanczos steps tell of the spectrum of S.
pub(crate) struct Look {
    /// At most the smallest eigenvalue.
    pub low: f64,
    /// Ritz values descending, with the number of eigenvalues that each stands for.
    pub density: Vec<(f64, f64)>,
    /// Products spent.
    pub products: usize,
}

impl Look {
    /// Looks from a random vector.
    ///
    /// - `scale`: max_i |w_ii|.
    pub fn new(w: &CouplingMatrix, scale: f64, random: &mut Random) -> Result<Self, SpectraError> {
        let n_nodes = w.n_nodes();
        let mut basis = Basis::empty(n_nodes);
        let (mut diagonal, mut beside) = (Vec::new(), Vec::new());
        let mut next = basis.orthonormalise(random.block(n_nodes, 1))?;
        while let Some(q) = next.filter(|_| diagonal.len() < STEPS.min(n_nodes)) {
            basis.append(&q);
            let image = multiply_block(w.symmetric(), &q);
            let overlaps = basis.overlaps(&image);
            diagonal.push(overlaps[(basis.len() - 1, 0)]);
            let mut rest = image.clone();
            basis.project_out(&mut rest);
            beside.push(rest.norms()[0]);
            next = basis.orthonormalise(image)?;
        }
        let steps = diagonal.len();
        let ritz = symmetric_eigen(steps, |i, j| match i - j {
            0 => diagonal[i],
            1 => beside[j],
            _ => 0.0,
        })?;
        let weights = ritz.vectors.iter().map(|y| n_nodes as f64 * y[0] * y[0]);
        let density: Vec<_> = ritz.values.iter().copied().zip(weights).collect();
        let low = (density[steps - 1].0 - beside[steps - 1]).max(-2.0 * scale);
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
