//! Lyapunov exponents: the largest of the master equation, and the whole spectrum of one oscillator.
//!
//! The master equation `δẏ = [DF(s) − σ DH(s)] δy` (Fan, Wang & Wang 2023, Eq. (4)) is integrated with
//! its orbit `ṡ = F(s)`, or iterated with that of a map, as one system on dual numbers: s is the value, δy the tangent. At σ = 0 its
//! exponent is the largest Lyapunov exponent of the isolated oscillator.
//!
//! The integrator is RK4 with a fixed step, or Taylor series; see [`Integrator`].
//!
//! Method: G. Benettin et al., Meccanica 15, 9 (1980): tangents are renormalised at intervals and
//! the logarithms of their growth averaged.

mod growth;
pub(crate) mod master_equation;
mod taylor;
mod tiles;

use rayon::prelude::*;

pub use growth::{Integrator, Tangent, Tangents, Times};
use growth::{Plan, estimates};
use taylor::Followed;
use tiles::Tiles;

use crate::error::check_step;
use crate::tile::TILE;
use crate::{Coupling, DynamicsError, Estimate, InstructionSet, NodeDynamics, Progress, QUIET};

/// From this many tangents on an orbit is worth computing for them alone, as a plain number.
const SHARED_ORBIT: usize = 4;

/// Series take the place of RK4 where their mean step is this many of its steps: measured, and rounded up,
/// for tangents with orbits of their own.
const LONG: f64 = 8.0;

/// Largest Lyapunov exponents Λ(σ) of the master equation, one for each tangent, per unit of model
/// time, with standard errors over [`crate::BLOCKS`] blocks. Tangents with one seed have one orbit, and are
/// cheaper for it; their errors are then correlated.
///
/// Runs on the current rayon pool; results come in the order of `tangents` and do not depend on how
/// these are grouped into lanes or threads.
///
/// # Errors
/// [`DynamicsError::BadStep`], [`DynamicsError::StepOfMap`], [`DynamicsError::BadTime`],
/// [`DynamicsError::TooFewSamples`] for times that make no sense; [`DynamicsError::Escaped`] when an
/// orbit leaves the ball of [`NodeDynamics::escape_radius`]; [`DynamicsError::Overflow`] for tangents that
/// cannot be followed.
pub fn master_exponents(
    dynamics: &dyn NodeDynamics,
    coupling: &Coupling,
    times: &Times,
    tangents: &[Tangent],
    progress: Progress<'_>,
) -> Result<Vec<Estimate>, DynamicsError> {
    master_exponents_with(InstructionSet::best(), dynamics, coupling, times, tangents, progress)
}

/// [`master_exponents`] with given vector instructions, on which the results do not depend.
///
/// # Errors
/// As [`master_exponents`].
///
/// # Panics
/// When this processor does not have the instructions.
pub fn master_exponents_with(
    instruction_set: InstructionSet,
    dynamics: &dyn NodeDynamics,
    coupling: &Coupling,
    times: &Times,
    tangents: &[Tangent],
    progress: Progress<'_>,
) -> Result<Vec<Estimate>, DynamicsError> {
    check_step(dynamics.is_map(), times.step)?;
    let plan = Plan::new(times)?;
    let escape_radius = dynamics.escape_radius();
    if let Some(followed) = followed(dynamics, coupling, times) {
        return in_batches(tangents, &followed.batches(tangents), |tangents| {
            let tangents = Tangents { coupling, plan: &plan, tangents, escape_radius, progress };
            followed.exponents(instruction_set, &tangents)
        });
    }
    // Compiled equations take σ DH to be the same everywhere.
    let is_constant = coupling.constant_derivative().is_some();
    let mut order: Vec<usize> = (0..tangents.len()).collect();
    order.sort_by_key(|&index| tangents[index].seed);
    let (shared, alone): (Vec<_>, Vec<_>) = order
        .chunk_by(|&a, &b| tangents[a].seed == tangents[b].seed)
        .partition(|of_one_seed| of_one_seed.len() >= SHARED_ORBIT);
    let alone = alone.concat();
    let fused = || dynamics.fused().filter(|_| is_constant);
    // Equations that are not compiled want many numbers at once, but no more than keeps all threads busy.
    let share = tangents.len().div_ceil(rayon::current_num_threads()).next_multiple_of(TILE);
    let at_once = if fused().is_some() { TILE } else { share.clamp(TILE, tiles::MOST) };
    let chunks = shared
        .iter()
        .flat_map(|of_one_seed| of_one_seed.chunks(at_once))
        .chain(alone.chunks(at_once));
    let batches: Vec<Vec<usize>> = chunks.map(<[usize]>::to_vec).collect();
    in_batches(tangents, &batches, |tangents| {
        let tangents = Tangents { coupling, plan: &plan, tangents, escape_radius, progress };
        match fused() {
            Some(fused) => fused.exponents(instruction_set, &tangents),
            None => tiles::exponents(dynamics, instruction_set, &tangents),
        }
    })
}

/// The series by which a master equation is followed, where it is.
fn followed<'a>(
    dynamics: &'a dyn NodeDynamics,
    coupling: &Coupling,
    times: &Times,
) -> Option<Followed<'a>> {
    match times.integrator {
        Integrator::Rk4 => None,
        Integrator::Taylor { tolerance } => Followed::new(dynamics, coupling, tolerance),
        Integrator::Auto { tolerance } => Followed::new(dynamics, coupling, tolerance)
            .filter(|followed| followed.mean_step() >= LONG * times.step),
    }
}

/// Whether exponents of these equations come from series at these times, rather than from RK4.
pub fn takes_series(dynamics: &dyn NodeDynamics, coupling: &Coupling, times: &Times) -> bool {
    followed(dynamics, coupling, times).is_some()
}

/// Exponents batch by batch on the pool of threads, in the order of tangents.
fn in_batches(
    tangents: &[Tangent],
    batches: &[Vec<usize>],
    run: impl Fn(&[Tangent]) -> Result<Vec<Estimate>, DynamicsError> + Sync,
) -> Result<Vec<Estimate>, DynamicsError> {
    let run = |batch: &Vec<usize>| {
        run(&batch.iter().map(|&index| tangents[index]).collect::<Vec<Tangent>>())
    };
    let exponents: Vec<_> =
        batches.par_iter().with_max_len(1).map(run).collect::<Result<_, _>>()?;
    let mut in_order = vec![Estimate::default(); tangents.len()];
    for (&index, exponent) in batches.iter().flatten().zip(exponents.concat()) {
        in_order[index] = exponent;
    }
    let overflown = in_order.iter().position(|exponent| !exponent.mean.is_finite());
    if let Some(index) = overflown {
        return Err(DynamicsError::Overflow { sigma: tangents[index].sigma });
    }
    Ok(in_order)
}

/// All Lyapunov exponents of the isolated oscillator, descending, per unit of model time.
///
/// As many tangents as components are carried along one orbit and re-orthogonalised at every interval
/// (QR by modified Gram–Schmidt).
///
/// # Errors
/// As [`master_exponents`].
pub fn spectrum(
    dynamics: &dyn NodeDynamics,
    times: &Times,
    seed: u64,
) -> Result<Vec<Estimate>, DynamicsError> {
    check_step(dynamics.is_map(), times.step)?;
    let plan = Plan::new(times)?;
    let mut tiles = Tiles::axes(dynamics, InstructionSet::best(), seed);
    Ok(estimates(&plan.block_means(&mut tiles, QUIET)?, dynamics.start().len()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{HindmarshRose, Lorenz, Model, Rossler};

    const TIMES: Times = Times {
        integrator: Integrator::Rk4,
        step: 0.01,
        transient: 100.0,
        average: 5000.0,
        renormalise: 0.5,
    };

    const SERIES: Integrator = Integrator::Taylor { tolerance: 1e-6 };

    fn within(estimate: Estimate, expected: f64, slack: f64) {
        let allowed = 4.0 * estimate.standard_error + slack;
        assert!(
            (estimate.mean - expected).abs() < allowed,
            "{estimate:?} against {expected} ± {allowed}"
        );
    }

    #[test]
    fn a_component_that_decays_by_itself_decays_faster_by_sigma() {
        // z into z of Lorenz at a stable fixed point: r < 1 makes the origin attract, where the
        // Jacobian is triangular and the z direction decays at b + σ, apart from x and y.
        let model = Model::Lorenz(Lorenz { alpha: 1.0, r: 0.0, b: 0.5 });
        let z = Coupling::pair(2, 2);
        let tangents = [0.0, 0.25, 2.0].map(|sigma| Tangent { sigma, seed: 1 });
        for integrator in [Integrator::Rk4, SERIES] {
            let times = Times { integrator, ..TIMES };
            let exponents = master_exponents(&model, &z, &times, &tangents, QUIET).unwrap();
            // At r = 0, α = 1 the x–y block has the double rate −1; the slowest rate wins.
            for (exponent, expected) in exponents.iter().zip([-0.5, -0.75, -1.0]) {
                assert!((exponent.mean - expected).abs() < 2e-3, "{exponent:?} against {expected}");
            }
        }
    }

    #[test]
    fn lyapunov_exponents_of_lorenz_sum_to_its_divergence() {
        let lorenz = Lorenz::default();
        let exponents = spectrum(&Model::Lorenz(lorenz), &TIMES, 1).unwrap();
        let sum: f64 = exponents.iter().map(|e| e.mean).sum();
        let divergence = -(lorenz.alpha + 1.0 + lorenz.b);
        assert!((sum - divergence).abs() < 1e-3, "{sum} against {divergence}");
        within(exponents[1], 0.0, 1e-3);
    }

    #[test]
    fn the_largest_exponent_agrees_between_one_tangent_and_qr() {
        for model in [Model::Lorenz(Lorenz::default()), Model::Rossler(Rossler::default())] {
            let coupling = Coupling::pair(0, 0);
            let tangent = [Tangent { sigma: 0.0, seed: 7 }];
            let one = master_exponents(&model, &coupling, &TIMES, &tangent, QUIET).unwrap()[0];
            let qr = spectrum(&model, &TIMES, 8).unwrap()[0];
            within(one, qr.mean, 4.0 * qr.standard_error);
        }
    }

    #[test]
    fn exponents_have_the_same_bits_in_any_lane() {
        let model = Model::Lorenz(Lorenz::default());
        let coupling = Coupling::pair(0, 1);
        for integrator in [Integrator::Rk4, SERIES] {
            let times = Times { integrator, average: 100.0, ..TIMES };
            // Many about the first orbit, of several levels of σ, and few about each of two others.
            let tangents: Vec<_> = (0..90u32)
                .map(|k| Tangent { sigma: f64::from(k), seed: u64::from(k.saturating_sub(75) % 3) })
                .collect();
            let together = master_exponents(&model, &coupling, &times, &tangents, QUIET).unwrap();
            let alone: Vec<_> = tangents
                .iter()
                .map(|&t| master_exponents(&model, &coupling, &times, &[t], QUIET).unwrap()[0])
                .collect();
            assert_eq!(together, alone, "{integrator:?}");
        }
    }

    #[test]
    fn exponents_have_the_same_bits_for_every_instruction_set() {
        let model = Model::Rossler(Rossler::default());
        let (coupling, times) = (Coupling::pair(0, 0), Times { average: 100.0, ..TIMES });
        let tangents: Vec<_> = (0..20u32)
            .map(|k| Tangent { sigma: f64::from(k) / 4.0, seed: u64::from(k.saturating_sub(15)) })
            .collect();
        for integrator in [Integrator::Rk4, SERIES] {
            let times = Times { integrator, ..times };
            let exponents = |set| {
                master_exponents_with(set, &model, &coupling, &times, &tangents, QUIET).unwrap()
            };
            let baseline = exponents(InstructionSet::Baseline);
            for set in InstructionSet::available() {
                assert_eq!(exponents(set), baseline, "{} {integrator:?}", set.name());
            }
        }
    }

    #[test]
    fn series_and_rk4_agree_within_their_errors() {
        let cases = [
            (Model::Lorenz(Lorenz::default()), Coupling::pair(0, 1), 12.0),
            (Model::Rossler(Rossler::default()), Coupling::pair(0, 0), 5.0),
            (Model::HindmarshRose(HindmarshRose::default()), Coupling::pair(0, 0), 1.5),
        ];
        for (model, coupling, most) in cases {
            let tangents: Vec<_> = (0..16u64)
                .map(|k| Tangent { sigma: most * f64::from((k % 4) as u32) / 3.0, seed: k / 4 })
                .collect();
            let by = |integrator| {
                let times = Times { integrator, average: 4000.0, ..TIMES };
                master_exponents(&model, &coupling, &times, &tangents, QUIET).unwrap()
            };
            for (a, b) in by(Integrator::Rk4).into_iter().zip(by(SERIES)) {
                within(a, b.mean, 4.0 * b.standard_error + 1e-3);
            }
        }
    }

    #[test]
    fn series_are_taken_where_their_steps_are_long() {
        let takes = |model: &dyn NodeDynamics, coupling: Coupling| {
            let times = Times { integrator: Integrator::Auto { tolerance: 1e-6 }, ..TIMES };
            takes_series(model, &coupling, &times)
        };
        let x = || Coupling::pair(0, 0);
        assert!(takes(&Model::HindmarshRose(HindmarshRose::default()), x()));
        assert!(takes(&Model::Rossler(Rossler::default()), x()));
        assert!(!takes(&Model::Lorenz(Lorenz::default()), x()), "it is too fast");
    }

    #[test]
    fn an_orbit_that_escapes_is_an_error_with_its_time() {
        // With c < 0 the Rössler oscillator has no bounded attractor.
        let model = Model::Rossler(Rossler { a: 0.5, b: 0.2, c: -9.0 });
        let error = spectrum(&model, &TIMES, 1).unwrap_err();
        assert!(matches!(error, DynamicsError::Escaped { time } if time > 0.0), "{error:?}");
    }

    #[test]
    fn times_that_make_no_sense_are_refused() {
        let refused = |times| spectrum(&Model::Lorenz(Lorenz::default()), &times, 1).unwrap_err();
        assert_eq!(
            refused(Times { integrator: Integrator::Rk4, step: -0.01, ..TIMES }),
            DynamicsError::BadStep { step: -0.01 }
        );
        assert_eq!(
            refused(Times { average: 0.0, ..TIMES }),
            DynamicsError::TooFewSamples { samples: 0, needed: 20 }
        );
    }
}
