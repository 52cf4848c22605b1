//! Zeros of Λ(σ): found on the grid where its sign is certain, then refined by a straight line
//! through many independent exponents, with more of them where the sign is in doubt.

use std::ops::Range;

use crate::{MasterStability, MsfError};

/// Exponents measured in each round of a refinement.
const PER_ROUND: usize = 32;

/// A sign is certain when Λ is this many standard errors away from zero.
const CERTAIN: f64 = 4.0;

/// A zero of Λ, where the stability of a mode changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zero {
    /// Where Λ(σ) = 0.
    pub sigma: f64,
    /// Standard error of it, from the scatter of independent orbits about the line.
    pub standard_error: f64,
    /// Whether Λ falls through zero, so that larger σ is stable.
    pub falling: bool,
    /// Whether it is known as well as was asked for: [`Refinement::relative_error`].
    pub refined: bool,
}

impl Zero {
    /// A zero that is known exactly, as in closed forms.
    pub fn exact(sigma: f64, falling: bool) -> Self {
        Self { sigma, standard_error: 0.0, falling, refined: true }
    }

    /// Interval that holds the zero with a probability of 95 %.
    pub fn confidence_interval(&self) -> [f64; 2] {
        let half_width = 1.96 * self.standard_error;
        [self.sigma - half_width, self.sigma + half_width]
    }
}

/// How well a zero of Λ must be known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refinement {
    /// Standard error of σ at which a zero is good enough, relative to σ.
    pub relative_error: f64,
    /// Rounds of 32 exponents after which a zero is left as well known as it then is.
    pub max_rounds: usize,
}

impl Default for Refinement {
    fn default() -> Self {
        Self { relative_error: 1e-3, max_rounds: 24 }
    }
}

/// The zeros of a curve, ascending, and whether Λ is negative before the first of them. `measure`
/// gives Λ at each of the σ it is asked for, from orbits that are new every time.
pub(crate) fn find(
    curve: &MasterStability,
    refinement: &Refinement,
    mut measure: impl FnMut(&[f64]) -> Result<Vec<f64>, MsfError>,
) -> Result<(Vec<Zero>, bool), MsfError> {
    let signs = settle_signs(curve, &mut measure)?;
    let certain: Vec<(f64, bool)> = curve
        .sigma
        .iter()
        .zip(signs)
        .filter_map(|(&sigma, negative)| Some((sigma, negative?)))
        .collect();
    let zeros = certain
        .windows(2)
        .filter(|pair| pair[0].1 != pair[1].1)
        .map(|pair| refine([pair[0].0, pair[1].0], pair[1].1, refinement, &mut measure))
        .collect::<Result<_, _>>()?;
    Ok((zeros, certain.first().is_some_and(|&(_, negative)| negative)))
}

/// Of each grid point whether Λ < 0; none where that stays in doubt.
///
/// Doubtful points between certain ones of opposite sign need no more time: the zero between these is
/// refined anyway. All others are measured again, as a whole round each.
fn settle_signs(
    curve: &MasterStability,
    measure: &mut impl FnMut(&[f64]) -> Result<Vec<f64>, MsfError>,
) -> Result<Vec<Option<bool>>, MsfError> {
    let sign = |mean: f64, error: f64| (mean.abs() > CERTAIN * error).then_some(mean < 0.0);
    let mut signs: Vec<_> =
        curve.lambda.iter().map(|lambda| sign(lambda.mean, lambda.standard_error)).collect();
    for doubtful in runs_of_doubt(&signs) {
        let before = doubtful.start.checked_sub(1).and_then(|i| signs[i]);
        let after = signs.get(doubtful.end).copied().flatten();
        if before.is_some() && after.is_some() && before != after {
            continue;
        }
        for index in doubtful {
            let again = measure(&[curve.sigma[index]; PER_ROUND])?;
            let estimate = dynamics::Estimate::from_independent(&again);
            signs[index] = sign(estimate.mean, estimate.standard_error);
        }
    }
    Ok(signs)
}

fn runs_of_doubt(signs: &[Option<bool>]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for index in (0..signs.len()).filter(|&index| signs[index].is_none()) {
        match runs.last_mut() {
            Some(run) if run.end == index => run.end += 1,
            _ => runs.push(index..index + 1),
        }
    }
    runs
}

/// Refines the zero in a bracket whose ends have opposite, certain signs.
///
/// Each round spreads its exponents over a window about the best estimate. The window shrinks until
/// the curvature of Λ within it no longer matters, but never below what the noise of the estimate
/// allows; the line is fitted to all exponents within the window.
fn refine(
    bracket: [f64; 2],
    falling: bool,
    refinement: &Refinement,
    measure: &mut impl FnMut(&[f64]) -> Result<Vec<f64>, MsfError>,
) -> Result<Zero, MsfError> {
    let [from, to] = bracket;
    let whole = 0.5 * (to - from);
    let mut best =
        Zero { sigma: 0.5 * (from + to), standard_error: whole, falling, refined: false };
    let mut window = whole;
    let mut samples: Vec<(f64, f64)> = Vec::new();
    for _ in 0..refinement.max_rounds {
        let (low, high) = ((best.sigma - window).max(from), (best.sigma + window).min(to));
        let sigmas: Vec<f64> = (0..PER_ROUND)
            .map(|k| low + (high - low) * (k as f64 + 0.5) / PER_ROUND as f64)
            .collect();
        let measured = measure(&sigmas)?;
        samples.retain(|(sigma, _)| (low..=high).contains(sigma));
        samples.extend(sigmas.into_iter().zip(measured));
        match Line::through(&samples).zero(falling).filter(|zero| (from..=to).contains(&zero.sigma))
        {
            Some(zero) => best = zero,
            // Noise hides the slope: look over a wider window.
            None => {
                window = (2.0 * window).min(whole);
                continue;
            }
        }
        let target = refinement.relative_error * best.sigma;
        let narrow = (20.0 * target).max(8.0 * best.standard_error);
        best.refined = best.standard_error <= target && window <= narrow;
        if best.refined {
            break;
        }
        window = window.min((0.25 * window).max(narrow));
    }
    Ok(best)
}

/// A straight line y = mean + slope (x − centre), with the variances of mean and slope.
struct Line {
    centre: f64,
    mean: f64,
    slope: f64,
    variance_of_mean: f64,
    variance_of_slope: f64,
}

impl Line {
    /// Least squares with equal weights; variances from the scatter about the line.
    fn through(samples: &[(f64, f64)]) -> Self {
        let n = samples.len() as f64;
        let centre = samples.iter().map(|(x, _)| x).sum::<f64>() / n;
        let mean = samples.iter().map(|(_, y)| y).sum::<f64>() / n;
        let spread: f64 = samples.iter().map(|(x, _)| (x - centre).powi(2)).sum();
        let slope = samples.iter().map(|(x, y)| (x - centre) * (y - mean)).sum::<f64>() / spread;
        let residual: f64 =
            samples.iter().map(|(x, y)| (y - mean - slope * (x - centre)).powi(2)).sum();
        let variance = residual / (n - 2.0);
        Self {
            centre,
            mean,
            slope,
            variance_of_mean: variance / n,
            variance_of_slope: variance / spread,
        }
    }

    /// Where the line crosses zero, if its slope has the sign expected beyond doubt.
    fn zero(&self, falling: bool) -> Option<Zero> {
        let certain = self.slope * self.slope > CERTAIN * self.variance_of_slope;
        (certain && (self.slope < 0.0) == falling).then(|| {
            let offset = -self.mean / self.slope;
            let variance = self.variance_of_mean + offset * offset * self.variance_of_slope;
            Zero {
                sigma: self.centre + offset,
                standard_error: variance.sqrt() / self.slope.abs(),
                falling,
                refined: false,
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use dynamics::Estimate;
    use rand_core::Rng;
    use rand_pcg::Pcg64;

    use super::*;

    /// A noisy measurement of a known curve: uniform noise of the given half-width.
    struct Noisy<F> {
        truth: F,
        noise: f64,
        generator: Pcg64,
        calls: usize,
    }

    impl<F: Fn(f64) -> f64> Noisy<F> {
        fn new(truth: F, noise: f64) -> Self {
            Self { truth, noise, generator: Pcg64::new(1, 1), calls: 0 }
        }

        fn measure(&mut self, sigmas: &[f64]) -> Vec<f64> {
            self.calls += sigmas.len();
            let mut noise =
                || self.noise * (self.generator.next_u64() as f64 / 2f64.powi(63) - 1.0);
            sigmas.iter().map(|&sigma| (self.truth)(sigma) + noise()).collect()
        }

        fn curve(&mut self, sigma: Vec<f64>) -> MasterStability {
            let error = self.noise / 3f64.sqrt();
            let lambda = self.measure(&sigma).into_iter();
            let lambda = lambda.map(|mean| Estimate { mean, standard_error: error }).collect();
            MasterStability { sigma, lambda, ..MasterStability::default() }
        }

        fn zeros(&mut self, sigma: Vec<f64>) -> (Vec<Zero>, bool) {
            let curve = self.curve(sigma);
            find(&curve, &Refinement::default(), |sigmas| Ok(self.measure(sigmas))).unwrap()
        }
    }

    fn grid(to: f64, points: u32) -> Vec<f64> {
        (0..points).map(|k| to * f64::from(k) / f64::from(points - 1)).collect()
    }

    #[test]
    fn the_zero_of_a_noisy_curve_lies_within_its_standard_errors() {
        // Λ(σ) = exp(−σ/2) − 1/4 vanishes at 2 ln 4.
        let mut noisy = Noisy::new(|sigma: f64| (-sigma / 2.0).exp() - 0.25, 0.005);
        let (zeros, initially_stable) = noisy.zeros(grid(6.0, 13));
        assert!(!initially_stable);
        let [zero] = zeros[..] else { panic!("{zeros:?}") };
        assert!(zero.falling);
        assert!(zero.standard_error <= 1e-3 * zero.sigma, "{zero:?}");
        assert!((zero.sigma - 2.0 * 4f64.ln()).abs() < 4.0 * zero.standard_error, "{zero:?}");
    }

    #[test]
    fn both_ends_of_a_bounded_window_are_found() {
        let mut noisy = Noisy::new(|sigma: f64| (sigma - 1.0) * (sigma - 4.0) / 4.0, 0.005);
        let (zeros, initially_stable) = noisy.zeros(grid(6.0, 25));
        assert!(!initially_stable);
        let [low, high] = zeros[..] else { panic!("{zeros:?}") };
        assert!(low.falling && !high.falling);
        assert!((low.sigma - 1.0).abs() < 4.0 * low.standard_error);
        assert!((high.sigma - 4.0).abs() < 4.0 * high.standard_error);
    }

    #[test]
    fn a_curve_that_comes_near_zero_without_crossing_it_has_no_zero() {
        let mut noisy = Noisy::new(|sigma: f64| 0.003 + (sigma - 1.5).powi(2), 0.005);
        assert_eq!(noisy.zeros(grid(3.0, 31)), (vec![], false));
    }

    #[test]
    fn a_curve_that_starts_at_zero_takes_its_sign_from_where_it_is_certain() {
        // A limit cycle: Λ(0) = 0, and any coupling damps.
        let mut noisy = Noisy::new(|sigma: f64| -sigma, 0.001);
        assert_eq!(noisy.zeros(grid(3.0, 31)), (vec![], true));
    }

    #[test]
    fn more_time_is_spent_where_noise_is_larger() {
        let cost = |noise| {
            let mut noisy = Noisy::new(|sigma: f64| 1.0 - sigma, noise);
            noisy.zeros(grid(3.0, 31));
            noisy.calls
        };
        assert!(cost(0.1) > 2 * cost(0.01), "{} against {}", cost(0.1), cost(0.01));
    }
}
