//! Lyapunov exponents: the largest of the master equation, and the whole spectrum of one oscillator.
//!
//! The master equation `δẏ = [DF(s) − σ DH(s)] δy` (Fan, Wang & Wang 2023, Eq. (4)) is integrated with
//! its orbit `ṡ = F(s)`, or iterated with that of a map, as one system on dual numbers: s is the value, δy the tangent. At σ = 0 its
//! exponent is the largest Lyapunov exponent of the isolated oscillator.
//!
//! Method: G. Benettin et al., Meccanica 15, 9 (1980): tangents are renormalised at intervals and
//! the logarithms of their growth averaged.

mod growth;
pub(crate) mod master_equation;
mod tiles;

use rayon::prelude::*;

use growth::{Plan, estimates};
pub use growth::{Tangent, Tangents, Times};
use tiles::Tiles;

use crate::error::check_step;
use crate::tile::TILE;
use crate::{Coupling, DynamicsError, Estimate, InstructionSet, NodeDynamics, Progress, QUIET};

/// From this many tangents on an orbit is worth computing for them alone, as a plain number.
const SHARED_ORBIT: usize = 4;

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
    // Compiled equations take σ DH to be the same everywhere.
    let is_constant = coupling.constant_derivative().is_some();
    let escape_radius = dynamics.escape_radius();
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
    let batches: Vec<&[usize]> = shared
        .iter()
        .flat_map(|of_one_seed| of_one_seed.chunks(at_once))
        .chain(alone.chunks(at_once))
        .collect();
    let run = |&batch: &&[usize]| {
        let tangents: Vec<Tangent> = batch.iter().map(|&index| tangents[index]).collect();
        let tangents =
            Tangents { coupling, plan: &plan, tangents: &tangents, escape_radius, progress };
        match fused() {
            Some(fused) => fused.exponents(instruction_set, &tangents),
            None => tiles::exponents(dynamics, instruction_set, &tangents),
        }
    };
    let exponents: Vec<_> =
        batches.par_iter().with_max_len(1).map(run).collect::<Result<_, _>>()?;
    let mut in_order = vec![Estimate::default(); tangents.len()];
    for (&index, exponent) in batches.iter().copied().flatten().zip(exponents.concat()) {
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
    use crate::{Lorenz, Model, Rossler};

    const TIMES: Times = Times { step: 0.01, transient: 100.0, average: 5000.0, renormalise: 0.5 };

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
        let exponents = master_exponents(&model, &z, &TIMES, &tangents, QUIET).unwrap();
        // At r = 0, α = 1 the x–y block has the double rate −1; the slowest rate wins.
        for (exponent, expected) in exponents.iter().zip([-0.5, -0.75, -1.0]) {
            assert!((exponent.mean - expected).abs() < 2e-3, "{exponent:?} against {expected}");
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
        let times = Times { average: 100.0, ..TIMES };
        let tangents: Vec<_> =
            (0..11u32).map(|k| Tangent { sigma: f64::from(k), seed: u64::from(k % 3) }).collect();
        let together = master_exponents(&model, &coupling, &times, &tangents, QUIET).unwrap();
        let alone: Vec<_> = tangents
            .iter()
            .map(|&t| master_exponents(&model, &coupling, &times, &[t], QUIET).unwrap()[0])
            .collect();
        assert_eq!(together, alone);
    }

    #[test]
    fn exponents_have_the_same_bits_for_every_instruction_set() {
        let model = Model::Rossler(Rossler::default());
        let (coupling, times) = (Coupling::pair(0, 0), Times { average: 100.0, ..TIMES });
        let tangents: Vec<_> = (0..20u32)
            .map(|k| Tangent { sigma: f64::from(k) / 4.0, seed: u64::from(k.saturating_sub(15)) })
            .collect();
        let exponents =
            |set| master_exponents_with(set, &model, &coupling, &times, &tangents, QUIET).unwrap();
        let baseline = exponents(InstructionSet::Baseline);
        for set in InstructionSet::available() {
            assert_eq!(exponents(set), baseline, "{}", set.name());
        }
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
        assert_eq!(refused(Times { step: -0.01, ..TIMES }), DynamicsError::BadStep { step: -0.01 });
        assert_eq!(
            refused(Times { average: 0.0, ..TIMES }),
            DynamicsError::TooFewSamples { samples: 0, needed: 20 }
        );
    }
}
