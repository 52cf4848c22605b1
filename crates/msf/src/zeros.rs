//! Zeros of Λ(σ). Between two σ of certain and opposite signs more are measured until the change of
//! sign is as narrow as noise allows; then a straight line through many independent exponents gives
//! the zero, in a window so narrow that bending does not matter beside the accuracy asked for.

use dynamics::Estimate;

use crate::MsfError;
use crate::attractors::{self, Column};
use crate::fit::{Line, Sample, curvature};
use crate::refinement::{Advance, Refinement, rounds_ahead};
use crate::step::Step;
use crate::zero::Zero;

/// Exponents measured in each round.
pub(crate) const PER_ROUND: usize = 32;
/// A round that looks for signs has as many σ, and as many orbits at each.
const COLUMNS: usize = 8;
const ORBITS: usize = PER_ROUND / COLUMNS;

/// A sign is certain when Λ is this many standard errors away from zero.
const CERTAIN: f64 = 4.0;

/// Half the width of the last window, in standard errors asked for and in those obtained: wide enough
/// that noise does not hide the slope, and no wider.
const WINDOW: f64 = 8.0;

/// A σ whose sign is certain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Signed {
    pub sigma: f64,
    /// Whether Λ < 0.
    pub negative: bool,
}

/// The sign of Λ, if that is certain: whether it is negative. `floor` is what is not known of an
/// exponent in any case, 1/T.
pub(crate) fn sign(estimate: Estimate, floor: f64) -> Option<bool> {
    let error = estimate.standard_error.hypot(floor);
    (estimate.mean.abs() > CERTAIN * error).then_some(estimate.mean < 0.0)
}

/// The zeros between certain signs, ascending, and a σ at which orbits were seen to be on different
/// attractors: the zeros are then no property of any of these.
pub(crate) struct Found {
    pub zeros: Vec<Zero>,
    pub split: Option<f64>,
}

/// Finds zeros with exponents that `measure` gives at each of the σ it is asked for, at the step asked
/// for or at half of it, from orbits that are new every time.
pub(crate) struct Finder<'a, M> {
    pub refinement: &'a Refinement,
    /// Told how far each zero has come.
    pub advance: &'a dyn Fn(Advance),
    pub floor: f64,
    pub measure: M,
    /// Where orbits have settled on different attractors.
    pub split: Option<f64>,
    /// Whether there is a step to halve: none of a map.
    pub has_step: bool,
    /// By how much exponents of all orbits may be off alike.
    pub bias: f64,
}

impl<M: FnMut(&[f64], Step) -> Result<Vec<Estimate>, MsfError>> Finder<'_, M> {
    /// Of each grid point, with the exponent there, whether Λ < 0; none where that stays in doubt.
    ///
    /// Doubtful points between certain ones of opposite sign need no more time: the zero between
    /// these is refined anyway. All others are measured again, as a whole round each.
    pub fn settle(&mut self, grid: &[(f64, Estimate)]) -> Result<Vec<Signed>, MsfError> {
        let mut signs: Vec<_> = grid.iter().map(|&(_, lambda)| sign(lambda, self.floor)).collect();
        let mut start = 0;
        while let Some(first) = (start..signs.len()).find(|&index| signs[index].is_none()) {
            let end = (first..signs.len()).find(|&i| signs[i].is_some()).unwrap_or(signs.len());
            let before = first.checked_sub(1).and_then(|i| signs[i]);
            let after = signs.get(end).copied().flatten();
            if before.is_none() || after.is_none() || before == after {
                for index in first..end {
                    let again = (self.measure)(&[grid[index].0; PER_ROUND], Step::Asked)?;
                    signs[index] = sign(mean_of(&again), self.floor);
                }
            }
            start = end;
        }
        let signed = grid.iter().zip(signs);
        Ok(signed
            .filter_map(|(&(sigma, _), negative)| Some(Signed { sigma, negative: negative? }))
            .collect())
    }

    /// The zeros between neighbours of opposite sign.
    pub fn zeros(mut self, certain: &[Signed]) -> Result<Found, MsfError> {
        let mut zeros = Vec::new();
        for pair in certain.windows(2).filter(|pair| pair[0].negative != pair[1].negative) {
            self.zeros_between([pair[0], pair[1]], &mut zeros)?;
        }
        Ok(Found { zeros, split: self.split })
    }

    /// Narrows a bracket down, or the several that it turns out to hold, and refines each zero.
    fn zeros_between(
        &mut self,
        bracket: [Signed; 2],
        zeros: &mut Vec<Zero>,
    ) -> Result<(), MsfError> {
        let mut samples = Vec::new();
        // Narrowed last first, so that zeros come in ascending order.
        let mut waiting = vec![(bracket, 0)];
        while let Some((bracket, rounds)) = waiting.pop() {
            let [from, to] = bracket;
            let width = to.sigma - from.sigma;
            let enough = WINDOW * self.refinement.relative_error * 0.5 * (from.sigma + to.sigma);
            if width <= 2.0 * enough || rounds >= self.refinement.max_rounds {
                zeros.push(self.refine(bracket, rounds, &mut samples)?);
                continue;
            }
            let signs = self.look(bracket, &mut samples)?;
            let narrower: Vec<[Signed; 2]> = signs
                .windows(2)
                .filter(|pair| pair[0].negative != pair[1].negative)
                .map(|pair| [pair[0], pair[1]])
                .collect();
            match narrower[..] {
                // Noise is as wide as the bracket.
                [[a, b]] if b.sigma - a.sigma > 0.4 * width => {
                    zeros.push(self.refine([a, b], rounds + 1, &mut samples)?);
                }
                _ => waiting.extend(narrower.into_iter().rev().map(|pair| (pair, rounds + 1))),
            }
        }
        Ok(())
    }

    /// The certain signs within a bracket, its ends among them, from one round.
    fn look(
        &mut self,
        [from, to]: [Signed; 2],
        samples: &mut Vec<Sample>,
    ) -> Result<Vec<Signed>, MsfError> {
        let step = (to.sigma - from.sigma) / (COLUMNS + 1) as f64;
        let sigma = |column: usize| from.sigma + step * (column + 1) as f64;
        let sigmas: Vec<f64> = (0..PER_ROUND).map(|k| sigma(k / ORBITS)).collect();
        let measured = (self.measure)(&sigmas, Step::Asked)?;
        samples.extend(sigmas.iter().zip(&measured).map(|(&sigma, lambda)| (sigma, lambda.mean)));
        let exponents = measured.chunks(ORBITS).enumerate();
        let columns: Vec<Column<'_>> =
            exponents.map(|(k, exponents)| Column { sigma: sigma(k), exponents }).collect();
        self.split = self.split.or_else(|| attractors::split(&columns, self.floor));
        let variance = columns.iter().map(|c| variance(c.exponents)).sum::<f64>() / COLUMNS as f64;
        let error = (variance / ORBITS as f64).sqrt();
        let inside = columns.iter().filter_map(|column| {
            let estimate = Estimate { standard_error: error, ..mean_of(column.exponents) };
            let negative = sign(estimate, self.floor)?;
            Some(Signed { sigma: column.sigma, negative })
        });
        Ok([from].into_iter().chain(inside).chain([to]).collect())
    }

    /// Refines the zero in a bracket, after some rounds that were spent on finding it.
    ///
    /// Each round spreads its exponents over a window about the best estimate. The window shrinks to
    /// what the noise of the estimate allows; what bending may add within it comes from a parabola
    /// through the samples of a window four times as wide.
    fn refine(
        &mut self,
        [from, to]: [Signed; 2],
        rounds: usize,
        samples: &mut Vec<Sample>,
    ) -> Result<Zero, MsfError> {
        let falling = to.negative;
        let whole = 0.5 * (to.sigma - from.sigma);
        let middle = 0.5 * (from.sigma + to.sigma);
        let (sigma, standard_error) = (middle, whole);
        let mut best = Zero { sigma, standard_error, falling, refined: false, step_shift: None };
        let mut slope = None;
        let mut window = whole;
        let most = self.refinement.max_rounds.max(rounds + 4);
        for round in rounds..most {
            let low = (best.sigma - window).max(from.sigma);
            let high = (best.sigma + window).min(to.sigma);
            let sigmas: Vec<f64> = (0..PER_ROUND)
                .map(|k| low + (high - low) * (k as f64 + 0.5) / PER_ROUND as f64)
                .collect();
            let measured = (self.measure)(&sigmas, Step::Asked)?;
            samples.extend(sigmas.into_iter().zip(measured.iter().map(|lambda| lambda.mean)));
            let within = |half: f64| {
                let near = samples.iter().filter(|s| (s.0 - best.sigma).abs() <= half);
                near.copied().collect::<Vec<Sample>>()
            };
            let line = Line::through(&within(window * (1.0 + 1e-9)));
            let zero = line.as_ref().and_then(|line| line.zero(falling));
            let bracketed = |zero: &Zero| (from.sigma..=to.sigma).contains(&zero.sigma);
            let Some((line, zero)) = line.zip(zero.filter(bracketed)) else {
                // Noise hides the slope: look over a wider window.
                window = (2.0 * window).min(whole);
                continue;
            };
            let bend = curvature(&within(4.0 * window)).map_or(0.0, |q| line.bend(q));
            let noise = zero.standard_error;
            best = Zero { standard_error: noise.hypot(bend), ..zero };
            slope = Some(line.slope());
            let target = self.refinement.relative_error * best.sigma;
            let narrow = WINDOW * target.max(noise);
            best.refined = best.standard_error <= target && window <= narrow;
            if best.refined {
                break;
            }
            let [spent, left] = [round + 1 - rounds, most - round - 1];
            (self.advance)(Advance {
                sigma: best.sigma,
                standard_error: best.standard_error,
                wanted: target,
                exponents_ahead: rounds_ahead(best.standard_error / target, spent, left)
                    * PER_ROUND,
            });
            // Where bending is what is left, the window may shrink to where noise sets the slope.
            let least = if bend > 0.5 * target { 0.5 * WINDOW * noise } else { narrow };
            window = window.min((0.25 * window).max(least));
        }
        slope.map_or(Ok(best), |slope| self.held_against(best, slope))
    }
}

pub(crate) fn mean_of(exponents: &[Estimate]) -> Estimate {
    Estimate::from_independent(&exponents.iter().map(|e| e.mean).collect::<Vec<_>>())
}

fn variance(exponents: &[Estimate]) -> f64 {
    mean_of(exponents).standard_error.powi(2) * exponents.len() as f64
}

#[cfg(test)]
mod tests {
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

        fn exponents(&mut self, sigmas: &[f64]) -> Vec<Estimate> {
            let standard_error = self.noise / 3f64.sqrt();
            let means = self.measure(sigmas).into_iter();
            means.map(|mean| Estimate { mean, standard_error }).collect()
        }

        fn zeros(&mut self, sigma: Vec<f64>) -> (Vec<Zero>, bool) {
            let refinement = Refinement::default();
            let grid = self.exponents(&sigma);
            let grid: Vec<_> = sigma.into_iter().zip(grid).collect();
            let measure = |sigmas: &[f64], _| Ok(self.exponents(sigmas));
            let advance: &dyn Fn(Advance) = &|_| ();
            let mut finder = Finder {
                refinement: &refinement,
                advance,
                floor: 0.0,
                measure,
                split: None,
                has_step: true,
                bias: 0.0,
            };
            let signs = finder.settle(&grid).unwrap();
            let found = finder.zeros(&signs).unwrap();
            assert_eq!(found.split, None);
            (found.zeros, signs.first().is_some_and(|signed| signed.negative))
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

    #[test]
    fn a_grid_of_one_wide_cell_is_bisected_down_to_the_zero() {
        // As Lorenz, x into y, seen at 0 and 250: steep near the zero at 8.17, flat far beyond.
        let truth = |sigma: f64| 1.0 - (sigma / 8.17).powf(1.5).min(4.0);
        let (zeros, _) = Noisy::new(truth, 0.02).zeros(vec![0.0, 250.0, 500.0]);
        let [zero] = zeros[..] else { panic!("{zeros:?}") };
        assert!(zero.refined && zero.standard_error < 0.0082, "{zero:?}");
        assert!((zero.sigma - 8.17).abs() < 4.0 * zero.standard_error, "{zero:?}");
    }

    #[test]
    fn three_zeros_in_one_cell_are_three() {
        let truth = |sigma: f64| (1.0 - sigma) * (sigma - 3.0) * (sigma - 8.0) / 24.0;
        let (zeros, _) = Noisy::new(truth, 0.002).zeros(vec![0.0, 10.0]);
        let at: Vec<f64> = zeros.iter().map(|zero| zero.sigma).collect();
        assert_eq!(zeros.len(), 3, "{zeros:?}");
        for (zero, expected) in at.iter().zip([1.0, 3.0, 8.0]) {
            assert!((zero - expected).abs() < 0.02 * expected, "{zeros:?}");
        }
    }

    #[test]
    fn a_curve_without_noise_that_bends_has_its_zero_within_the_error_it_states() {
        for power in [0.3, 3.0, 8.0] {
            let truth = |sigma: f64| 1.0 - (sigma / 2.42616).powf(power);
            let (zeros, _) = Noisy::new(truth, 1e-7).zeros(vec![0.0, 2.0, 4.0]);
            let off = (zeros[0].sigma - 2.42616).abs();
            assert!(zeros[0].refined && off <= 2.0 * zeros[0].standard_error, "{off} {zeros:?}");
        }
    }

    #[test]
    fn a_zero_that_noise_hides_says_that_it_is_not_as_good_as_asked() {
        let (zeros, _) = Noisy::new(|sigma: f64| 1.0 - sigma, 1.0).zeros(vec![0.0, 3.0, 6.0]);
        for zero in zeros {
            assert!(!zero.refined && zero.standard_error > 1e-3 * zero.sigma, "{zero:?}");
            assert!((zero.sigma - 1.0).abs() < 4.0 * zero.standard_error, "{zero:?}");
        }
    }
}
