//! The block method with Chebyshev filters and long Lanczos sequences.

mod amplifier;
mod long_sequence;
mod search;
mod search_space;
mod stagnation;

use crate::error::SpectraError;
use crate::found::Found;
use crate::recurrences::spectral_density::SpectralDensity;
use crate::solvers::chebyshev_davidson::amplifier::Amplifier;
use crate::solvers::chebyshev_davidson::search::Search;
use crate::solvers::method::{Method, Solve, Task};
use crate::verification::Verification;

/// Filters and sequences.
pub(crate) const METHOD: Method = Method {
    name: "chebyshev",
    finds_all: true,
    rounding: 0.0,
    factorises: false,
    solve: Some(Solve::Iterative(leading)),
};

fn leading(task: Task<'_>) -> Result<(Found, Verification), SpectraError> {
    let Task { w, plan, links, mut verifier, mut random, progress, .. } = task;
    // Within the pool a thread finds in its cache what it wrote the time before: a third faster.
    rayon::scope(|_| {
        let density = SpectralDensity::new(links, plan.scale, &mut random)?;
        verifier.low = density.low;
        let first_guess = density.exceeded_by(4 * (plan.wanted.at_least() + 4));
        let amplifier = Amplifier { links, low: density.low, first_guess };
        Search::new((w, links), plan, random, density.products, progress)?
            .run(&amplifier, &verifier)
    })
}
