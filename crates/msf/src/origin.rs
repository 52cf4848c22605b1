//! What Λ is right above σ = 0, where a grid need not reach.
//!
//! Where Λ(0) is certain, so is its sign there. A periodic orbit has Λ(0) = 0 and Λ(σ) = cσ for small σ:
//! a simple characteristic multiplier depends analytically on σ (T. Kato, Perturbation Theory for
//! Linear Operators (1966), Ch. II). So σ is halved until noise hides the sign, and if Λ/σ has then
//! become constant, the sign is the same down to 0; if not, nothing is known below the last σ.

use dynamics::Estimate;

use crate::step::Step;
use crate::zeros::{Finder, Signed, sign};
use crate::{End, Isolated, MsfError};

/// How often σ is halved.
const HALVINGS: i32 = 10;

/// Λ/σ at neighbouring σ counts as constant when it differs by no more, relatively, or by four of its
/// standard errors.
const CONSTANT: f64 = 0.1;

/// The certain signs with those at and near σ = 0, and what the lower end of a stable interval is that
/// begins there.
pub(crate) fn with<M: FnMut(&[f64], Step) -> Result<Vec<Estimate>, MsfError>>(
    state: Isolated,
    mut certain: Vec<Signed>,
    finder: &mut Finder<'_, M>,
) -> Result<(Vec<Signed>, Option<End>), MsfError> {
    let at_zero = |negative| Signed { sigma: 0.0, negative };
    match state {
        Isolated::Chaotic => {
            certain.insert(0, at_zero(false));
            Ok((certain, None))
        }
        Isolated::AtRest => {
            certain.insert(0, at_zero(true));
            Ok((certain, Some(End::Origin { included: true })))
        }
        Isolated::Periodic => {
            let Some(&first) = certain.first() else { return Ok((certain, None)) };
            let (nearer, is_linear) = nearer(first, finder)?;
            certain.splice(0..0, nearer);
            let lowest = certain[0];
            let end = if is_linear {
                End::Origin { included: false }
            } else {
                End::Looked { sigma: lowest.sigma }
            };
            Ok((certain, lowest.negative.then_some(end)))
        }
    }
}

/// Certain signs below the first, ascending, and whether Λ is proportional to σ at the lowest two.
fn nearer<M: FnMut(&[f64], Step) -> Result<Vec<Estimate>, MsfError>>(
    first: Signed,
    finder: &mut Finder<'_, M>,
) -> Result<(Vec<Signed>, bool), MsfError> {
    let sigmas: Vec<f64> = (0..=HALVINGS).map(|k| first.sigma * 0.5f64.powi(k)).collect();
    let measured = (finder.measure)(&sigmas, Step::Asked)?;
    let slopes: Vec<(Signed, Estimate)> = sigmas
        .iter()
        .zip(measured)
        .map_while(|(&sigma, lambda)| {
            let negative = sign(lambda, finder.floor)?;
            let error = lambda.standard_error.hypot(finder.floor) / sigma;
            let slope = Estimate { mean: lambda.mean / sigma, standard_error: error };
            Some((Signed { sigma, negative }, slope))
        })
        .collect();
    let is_linear = match slopes[..] {
        [.., (_, above), (_, below)] => {
            let error = above.standard_error.hypot(below.standard_error);
            (above.mean - below.mean).abs() <= (CONSTANT * below.mean.abs()).max(4.0 * error)
        }
        _ => false,
    };
    let signs = slopes.into_iter().skip(1).rev().map(|(signed, _)| signed);
    Ok((signs.collect(), is_linear))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Advance, Refinement};

    fn of(state: Isolated, truth: fn(f64) -> f64) -> (f64, Option<End>) {
        let refinement = Refinement::default();
        let exponent = |&sigma: &f64| Estimate { mean: truth(sigma), standard_error: 1e-5 };
        let measure = |sigmas: &[f64], _| Ok(sigmas.iter().map(exponent).collect());
        let advance: &dyn Fn(Advance) = &|_| ();
        let mut finder = Finder {
            refinement: &refinement,
            advance,
            floor: 1e-5,
            measure,
            split: None,
            has_step: true,
            bias: 0.0,
        };
        let first = Signed { sigma: 1.0, negative: truth(1.0) < 0.0 };
        let (certain, end) = with(state, vec![first], &mut finder).unwrap();
        (certain[0].sigma, end)
    }

    #[test]
    fn rest_reaches_the_origin_and_includes_it() {
        assert_eq!(
            of(Isolated::AtRest, |sigma| -1.0 - sigma),
            (0.0, Some(End::Origin { included: true }))
        );
        assert_eq!(of(Isolated::Chaotic, |sigma| 1.0 - 2.0 * sigma), (0.0, None));
    }

    #[test]
    fn a_periodic_orbit_is_stable_down_to_zero_where_lambda_is_proportional_to_sigma() {
        let (lowest, end) = of(Isolated::Periodic, |sigma| -0.1 * sigma);
        assert!(lowest < 2e-3, "{lowest}");
        assert_eq!(end, Some(End::Origin { included: false }));
    }

    #[test]
    fn a_window_below_the_grid_is_found() {
        // Negative up to 0.1 only, as z into x of a periodic Rössler oscillator.
        let (lowest, end) = of(Isolated::Periodic, |sigma| sigma * (sigma - 0.1));
        assert!(lowest < 0.01, "{lowest}");
        assert_eq!(end, Some(End::Origin { included: false }));
    }

    #[test]
    fn where_noise_hides_the_sign_nothing_is_known_below() {
        // Λ = −σ⁴ is too small to be seen before it could be proportional to σ.
        let (lowest, end) = of(Isolated::Periodic, |sigma| -sigma.powi(4));
        assert_eq!(end, Some(End::Looked { sigma: lowest }));
    }
}
