//! What the step of the integrator does to the simulated errors: at a few couplings the same replicas are
//! run twice over the same time, at the step of the sweep and at half of it.
//!
//! RK4 errs in proportion to h⁴ and DOP853 to h⁸, so that halving h takes away 15/16 and more of what the
//! step does to a mean, and the ratio of the two means tells nearly all of it. Orbits of two steps part soon, and means over a
//! finite time differ by chance; how much is told by the scatter of the seeds, on a scale of logarithms,
//! since errors near synchrony differ by decades from seed to seed. The couplings are
//! the largest at which no run escaped, where the method is nearest to its limit of stability, the largest of
//! those at which nodes are not synchronised, where errors are small and bursts depend on everything, and
//! the smallest at which a run escaped, which the step alone may be the reason of.
//!
//! Source: E. Hairer, S. P. Nørsett & G. Wanner, Solving Ordinary Differential Equations I (1993),
//! Sec. II.4, on errors from two step sizes.

use std::fmt;

use dynamics::{Errors, Estimate, Method, Replica, Run, Schedule};
use serde::{Deserialize, Serialize};

use crate::numbers::{plain, two_digits};
use crate::simulated::{Simulated, completed, observed};
use crate::{Sweep, Warnings};

/// Seeds at each coupling: those of the sweep, and those that follow.
const SEEDS: u64 = 6;
/// Share of the steps of a sweep that go into this.
const SHARE: f64 = 0.03;
/// As many steps of nodes are taken in any case, half a second of one processor.
const LEAST_NODE_STEPS: f64 = 1e7;
/// Of a time shorter than that of the sweep, the share left for the transient: errors that are still
/// decaying hide what the step does to those that remain.
const FOR_TRANSIENT: f64 = 0.6;
/// An effect counts as real at this many of its standard errors (by chance in one of a hundred, with
/// six seeds), and as large at this share of the error.
const CERTAIN: f64 = 4.0;
const LARGE: f64 = 0.05;
/// Errors below this are rounding.
const ROUNDING: f64 = 1e-9;

/// What is run: twice the same replicas.
pub struct Probe {
    /// Some of those of the sweep, with further seeds.
    pub replicas: Vec<Replica>,
    /// At the step of the sweep and at half of it, over the same time.
    pub schedules: [Schedule; 2],
}

/// The effect of the step at one coupling.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct StepEffect {
    /// The coupling.
    pub epsilon: f64,
    /// Step of the sweep.
    pub step: f64,
    /// Times before the averages and of them, no longer than those of the sweep.
    pub transient: f64,
    /// Time of the average.
    pub average: f64,
    /// Runs that stayed bounded at both steps.
    pub n_seeds: usize,
    /// Runs that escaped at the step of the sweep and at half of it.
    pub escaped: [usize; 2],
    /// Runs in which all observed errors are below the bound of synchrony, at either step.
    pub synchronised: [usize; 2],
    /// Mean of the observed errors at either step, the geometric one over seeds; none where fewer than
    /// two seeds stayed bounded.
    pub error: Option<[f64; 2]>,
    /// Natural logarithm of the first of these over the second.
    pub log_ratio: Option<f64>,
    /// Of this logarithm.
    pub standard_error: Option<f64>,
}

impl Probe {
    /// What to run after a sweep; none for an integrator that chooses its own steps.
    pub fn of(sweep: &Sweep, simulated: &Simulated) -> Option<Self> {
        if !matches!(sweep.method, Method::Rk4 | Method::Dop853) {
            return None;
        }
        let epsilon = couplings(simulated);
        let first = *sweep.seeds.first()?;
        let of = |&epsilon: &f64| {
            (0..SEEDS).map(move |k| Replica { epsilon, seed: first.wrapping_add(k) })
        };
        let replicas: Vec<Replica> = epsilon.iter().flat_map(of).collect();
        if replicas.is_empty() {
            return None;
        }
        let all = sweep.steps() as f64;
        let budget = (SHARE * all).max(LEAST_NODE_STEPS / simulated.n_nodes() as f64);
        // A replica takes its steps once at the step of the sweep and twice as many at half of it.
        let share = budget / (3.0 * replicas.len() as f64 * sweep.schedule.steps() as f64);
        let schedule = shortened(sweep.schedule, share.min(1.0));
        let stride = schedule.stride.checked_mul(2)?;
        let halved = Schedule { step: 0.5 * schedule.step, stride, ..schedule };
        Some(Self { replicas, schedules: [schedule, halved] })
    }

    /// The effect at each coupling, from the runs at both steps.
    pub fn effects(&self, simulated: &Simulated, runs: [&[Run]; 2]) -> Vec<StepEffect> {
        let n_seeds = usize::try_from(SEEDS).expect("there are few seeds");
        let [at_step, at_half] = runs.map(|runs| runs.chunks(n_seeds));
        at_step.zip(at_half).map(|(a, b)| self.effect(simulated, [a, b])).collect()
    }

    fn effect(&self, simulated: &Simulated, runs: [&[Run]; 2]) -> StepEffect {
        let epsilon = runs[0][0].replica.epsilon;
        let bound = simulated.position(epsilon).map_or(0.0, |at| simulated.bound(at));
        let escaped = runs.map(|runs| runs.iter().filter(|run| completed(run).is_none()).count());
        let is_together = |run: &&Run| completed(run).is_some_and(|errors| largest(errors) < bound);
        let pairs: Vec<[&Errors; 2]> = runs[0]
            .iter()
            .zip(runs[1])
            .filter_map(|(a, b)| Some([completed(a)?, completed(b)?]))
            .collect();
        let compared = compare(&pairs);
        StepEffect {
            epsilon,
            step: self.schedules[0].step,
            transient: self.schedules[0].transient,
            average: self.schedules[0].average,
            n_seeds: pairs.len(),
            escaped,
            synchronised: runs.map(|runs| runs.iter().filter(is_together).count()),
            error: compared.map(|compared| compared.0),
            log_ratio: compared.map(|compared| compared.1),
            standard_error: compared.map(|compared| compared.2),
        }
    }
}

impl StepEffect {
    /// Says what the step does to the errors where that is more than chance and some per cent.
    pub fn warn(&self, warnings: &mut Warnings<'_>) {
        let Some(what) = self.doubt() else { return };
        let Self { epsilon, step, .. } = self;
        let message = format!(
            "at epsilon = {epsilon} the step of {step} changes what is simulated: {what} at half of it; \
             take a shorter `sweep.step`"
        );
        warnings.add("simulations_step_effect", message);
    }

    /// What differs between the steps beyond chance, up to the words "at half of it".
    fn doubt(&self) -> Option<String> {
        // All but one of six against none comes about by chance once in fifty times.
        let differ = |[a, b]: [usize; 2]| a.abs_diff(b) as u64 + 1 >= SEEDS;
        for (counts, did) in [(self.escaped, "escaped"), (self.synchronised, "synchronised")] {
            if differ(counts) {
                return Some(format!("{} of {SEEDS} runs {did}, but {}", counts[0], counts[1]));
            }
        }
        let ([a, b], ratio, error) = (self.error?, self.log_ratio?, self.standard_error?);
        let is_large = a.max(b) > ROUNDING
            && (libm::exp(ratio) - 1.0).abs() > LARGE
            && ratio.abs() > CERTAIN * error;
        is_large.then(|| {
            let [least, times, most] =
                [ratio - error, ratio, ratio + error].map(|ratio| two_digits(libm::exp(ratio)));
            let (a, b) = (two_digits(a), two_digits(b));
            format!("errors are {a}, {times} times ({least} to {most}) as large as {b}")
        })
    }
}

impl fmt::Display for StepEffect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "epsilon = {}", plain(self.epsilon))?;
        let is_rounding = |error: [f64; 2]| error[0].max(error[1]) <= ROUNDING;
        let [at_step, at_half] = self.escaped;
        if at_step + at_half > 0 {
            return write!(f, " ({at_step} of {SEEDS} runs escaped, {at_half} at half the step)");
        }
        match (self.error, self.log_ratio, self.standard_error) {
            (Some(error), ..) if is_rounding(error) => f.write_str(" (errors are rounding)"),
            (Some(_), Some(ratio), Some(error)) => write!(
                f,
                " (errors {} times as large, {} to {})",
                two_digits(libm::exp(ratio)),
                two_digits(libm::exp(ratio - error)),
                two_digits(libm::exp(ratio + error))
            ),
            _ => f.write_str(" (too few runs stayed bounded)"),
        }
    }
}

/// At which couplings it was looked, and that it was at no others; none without any.
pub fn looked_at(effects: &[StepEffect]) -> Option<String> {
    let step = effects.first()?.step;
    let each: Vec<String> = effects.iter().map(StepEffect::to_string).collect();
    Some(format!(
        "half the step of {} was tried at {}; at no other epsilon",
        plain(step),
        each.join(" and ")
    ))
}

/// The largest coupling at which no run escaped, the largest of these at which nodes are not synchronised
/// (the one in the middle where these are one), and the smallest at which a run escaped.
fn couplings(simulated: &Simulated) -> Vec<f64> {
    let (lost, bounded): (Vec<usize>, Vec<usize>) = (0..simulated.epsilon.len())
        .filter(|&at| simulated.epsilon[at] > 0.0)
        .partition(|&at| simulated.broken_off(at) > 0);
    let is_apart = |at: &usize| {
        let errors = simulated.at(*at).iter().filter_map(completed).map(largest);
        errors.fold(0.0, f64::max) >= simulated.bound(*at)
    };
    let mut positions: Vec<usize> = lost.first().copied().into_iter().collect();
    if let Some(&last) = bounded.last() {
        let apart = bounded.iter().copied().rev().find(is_apart).filter(|&at| at != last);
        positions.extend([apart.unwrap_or(bounded[bounded.len() / 2]), last]);
    }
    positions.sort_unstable();
    positions.dedup();
    positions.into_iter().map(|at| simulated.epsilon[at]).collect()
}

/// A schedule of a share of the time, with a sample for each block of its average at least.
fn shortened(schedule: Schedule, share: f64) -> Schedule {
    let Schedule { transient, average, .. } = schedule;
    if share >= 1.0 {
        return schedule;
    }
    let time = share * (transient + average);
    let shorter = transient.min(FOR_TRANSIENT * time);
    let least = dynamics::BLOCKS as f64 * schedule.sampling_interval();
    Schedule { transient: shorter, average: (time - shorter).max(least).min(average), ..schedule }
}

fn largest(errors: &Errors) -> f64 {
    observed(errors).map(|estimate| estimate.mean).fold(0.0, f64::max)
}

/// Geometric means over seeds of the error at both steps, the logarithm of the first over the second,
/// and its standard error: the larger of what the scatter of the seeds and the blocks within the runs
/// tell. None for fewer than two seeds, or where an error is zero.
fn compare(pairs: &[[&Errors; 2]]) -> Option<([f64; 2], f64, f64)> {
    let of = |errors: &Errors| {
        let (mut sum, mut error, mut count) = (0.0, 0.0, 0.0);
        for estimate in observed(errors) {
            sum += estimate.mean;
            // Errors of one run rise and fall together: their standard errors add up as they are.
            error += estimate.standard_error;
            count += 1.0;
        }
        Estimate { mean: libm::log(sum / count), standard_error: error / sum }
    };
    let logs: Vec<[Estimate; 2]> = pairs.iter().map(|pair| pair.map(of)).collect();
    if logs.len() < 2 || logs.iter().flatten().any(|log| !log.mean.is_finite()) {
        return None;
    }
    let n = logs.len() as f64;
    let means = [0, 1].map(|step| logs.iter().map(|pair| pair[step].mean).sum::<f64>() / n);
    let ratios: Vec<f64> = logs.iter().map(|[a, b]| a.mean - b.mean).collect();
    let scatter = Estimate::from_independent(&ratios).standard_error;
    let squares = |pair: &[Estimate; 2]| pair.iter().map(|e| e.standard_error.powi(2)).sum::<f64>();
    let blocks = logs.iter().map(squares).sum::<f64>().sqrt() / n;
    Some((means.map(libm::exp), means[0] - means[1], scatter.max(blocks)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulated::tests::from;

    fn errors(mean: f64) -> Errors {
        Errors { pairs: vec![Estimate { mean, standard_error: 0.0 }; 3], ..Errors::default() }
    }

    #[test]
    fn the_effect_is_the_ratio_of_the_errors_with_the_scatter_of_the_seeds() {
        let of = |runs: [[f64; 2]; 3]| {
            let runs = runs.map(|pair| pair.map(errors));
            compare(&runs.iter().map(<[Errors; 2]>::each_ref).collect::<Vec<_>>())
        };
        // Errors nine times as large in every seed: the ratio does not scatter.
        let ([a, b], ratio, error) = of([[9.0, 1.0], [18.0, 2.0], [36.0, 4.0]]).unwrap();
        assert!((a - 18.0).abs() < 1e-12 && (b - 2.0).abs() < 1e-12, "{a}, {b}");
        assert!((ratio - 9f64.ln()).abs() < 1e-12 && error < 1e-12, "{ratio} ± {error}");
        // 1, 2 and 4 times as large: twice, with the scatter of 0, 1 and 2 times ln 2.
        let (_, ratio, error) = of([[1.0, 1.0], [2.0, 1.0], [4.0, 1.0]]).unwrap();
        let expected = 2f64.ln() / 3f64.sqrt();
        assert!((ratio - 2f64.ln()).abs() < 1e-12 && (error - expected).abs() < 1e-12);
        assert!(of([[1.0, 0.0], [2.0, 1.0], [4.0, 1.0]]).is_none(), "no ratio to nothing");
        let one = [errors(1.0), errors(2.0)];
        assert!(compare(&[one.each_ref()]).is_none(), "of one seed nothing is known");
    }

    #[test]
    fn couplings_are_the_strongest_bounded_and_unsynchronised_and_the_first_that_escapes() {
        let escapes = [f64::INFINITY; 2];
        let of = |errors: &[[f64; 2]]| couplings(&from(1.0, errors));
        let (apart, together) = ([5.0; 2], [0.0; 2]);
        assert_eq!(of(&[apart, apart, together, together]), [2.0, 4.0]);
        assert_eq!(of(&[apart, together, [5.0, f64::INFINITY], escapes]), [1.0, 2.0, 3.0]);
        assert_eq!(of(&[together, together, together]), [2.0, 3.0]);
        assert_eq!(of(&[escapes, escapes]), [1.0], "the step may be why");
    }

    #[test]
    fn chance_and_rounding_are_no_effect() {
        let effect = |ratio: f64, standard_error: f64| StepEffect {
            epsilon: 1.0,
            step: 0.1,
            transient: 10.0,
            average: 10.0,
            n_seeds: 6,
            escaped: [0, 0],
            synchronised: [0, 0],
            error: Some([libm::exp(ratio), 1.0]),
            log_ratio: Some(ratio),
            standard_error: Some(standard_error),
        };
        let doubt = effect(2.2, 0.5).doubt().unwrap();
        assert!(doubt.contains("9 times (5.5 to 15) as large as 1"), "{doubt}");
        assert!(effect(0.3, 0.1).doubt().is_none(), "three standard errors");
        assert!(effect(0.01, 0.0001).doubt().is_none(), "one per cent");
        let rounding = StepEffect { error: Some([3e-13, 1e-13]), ..effect(1.1, 0.1) };
        assert!(rounding.doubt().is_none());
        let apart = StepEffect { synchronised: [1, 6], ..effect(0.0, 1.0) };
        assert_eq!(apart.doubt().unwrap(), "1 of 6 runs synchronised, but 6");
    }
}
