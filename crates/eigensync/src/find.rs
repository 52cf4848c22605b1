//! The stages of a study in their order: curve, modes, predicted states, sweep, agreement.

use clustering::{
    CascadeTree, ClusteringError, State, StateLabels, hold_against_links, merge_equal_clusters,
};
use dynamics::Progress;
use msf::{MasterStability, Stability, StableRegion};
use rayon::prelude::*;
use spectra::Spectrum;

use crate::compute::Plainly;
use crate::numbers::{four_digits, plain, two_digits};
use crate::synchrony::{Evidence, assumed_above};
use crate::{
    Compute, Error, Findings, Observer, Simulated, Study, Sweep, Synchrony, Warning, Warnings,
    agreement, doubts, prediction, stability,
};

/// Total weights of two nodes to a cluster that differ by no more, relative to what they are made of,
/// differ by rounding.
pub const EQUITABLE: f64 = 1e-9;

/// Clusters of fewer nodes are in no tree: a million single nodes tell nothing.
const LEAST_LISTED: usize = 2;

/// The largest residual, relative to the eigenvalue, that leaves this certain.
const CERTAIN: f64 = 0.1;

/// Answers a study: predicts, and simulates where it asks for that.
///
/// Runs on the current rayon pool; the result does not depend on the number of threads.
///
/// # Errors
/// What cannot be computed; [`Error::Cancelled`] when the observer wanted to stop.
pub fn find(study: &Study, observer: &dyn Observer) -> Result<Findings, Error> {
    find_by(study, &[], &Plainly(observer))
}

/// Runs a sweep of a study alone, without a prediction: for errors, or for the states of which
/// [`Observer::recorded`] is told.
///
/// # Errors
/// As [`find`].
pub fn simulate(study: &Study, sweep: &Sweep, observer: &dyn Observer) -> Result<Simulated, Error> {
    let runs = Plainly(observer).runs(study, sweep)?;
    Ok(Simulated::new(sweep, study.network.n_nodes(), runs))
}

/// The master stability function of a study alone, and what must be known beside it.
///
/// # Errors
/// Those of whoever computes.
pub fn curve_by<C: Compute>(
    study: &Study,
    before: &[Warning],
    compute: &C,
) -> Result<(MasterStability, Vec<Warning>), C::Error> {
    let tell = |warning: &Warning| compute.warn(warning);
    let mut warnings = Warnings::after(before, &tell);
    let msf = looked_at(study, compute, &mut warnings)?;
    Ok((msf, warnings.into_list()))
}

/// What [`find`] finds, by whoever computes, after warnings that are known already.
///
/// # Errors
/// Those of whoever computes.
pub fn find_by<C: Compute>(
    study: &Study,
    before: &[Warning],
    compute: &C,
) -> Result<Findings, C::Error> {
    let tell = |warning: &Warning| compute.warn(warning);
    let mut warnings = Warnings::after(before, &tell);
    let msf = looked_at(study, compute, &mut warnings)?;
    let stable = &msf.stable;
    let n_nodes = study.network.n_nodes();
    let request = study.modes.request(stable, n_nodes);
    let spectrum = compute.spectrum(study, &request)?;
    warn_of_weak_links(&spectrum, &mut warnings);
    let fastest = fastest(study, &spectrum, stable, &mut warnings);
    let assumed_above = assumed_above(stable, fastest.unwrap_or_else(|| strongest(study)));
    if let Some(above) = assumed_above {
        let looked = four_digits(msf.looked.to);
        let above = four_digits(above);
        let message = format!(
            "nothing was looked at beyond σ = {looked}: above epsilon = {above} some modes are there, \
             and are taken to be stable"
        );
        warnings.add("cascade", message);
    }
    let stability = prediction::stability(stable, msf.looked.from, &spectrum, fastest)?;
    if let Some(top) = stability.decided.to {
        warnings.add("cascade", beyond(study, spectrum.n_modes(), top));
    }
    let synchrony = Synchrony::of(&Evidence {
        stable,
        stability: &stability,
        slowest: spectrum.real_eigenvalues().into_iter().find(|&lambda| lambda < 0.0),
        fastest,
        n_components: study.n_components,
        n_rests: msf.rests.len(),
        looked: msf.looked,
        assumed_above,
    });
    let Stability { transitions, stretches, .. } = stability;
    let states = compute
        .stage("clusters", Some(stretches.len() as u64), |progress| {
            let mut states = prediction::states(&spectrum, stretches, study.rule, &progress)?;
            let matrix = study.matrix.matrix().view();
            hold_against_links(&mut states, &spectrum, matrix, study.rule, EQUITABLE)?;
            Ok(states)
        })
        .map_err(|error| not_clustered(error, Error::Cascade))?;
    let mut simulated = None;
    let (mut step_effects, mut agreement) = (Vec::new(), Vec::new());
    if let Some(sweep) = &study.sweep {
        let runs = compute.runs(study, sweep)?;
        doubts::warn_of_failures(&runs, &mut warnings);
        let mut sweeps = Simulated::new(sweep, n_nodes, runs);
        sweeps.apart = doubts::apart(&msf);
        doubts::warn_of_runs(&msf, &sweeps, &mut warnings);
        step_effects = compute.step_effects(study, sweep, &sweeps)?;
        step_effects.iter().for_each(|effect| effect.warn(&mut warnings));
        agreement = compute
            .stage("agreement", None, |_| agreement::at_all(study, &spectrum, &states, &sweeps))?;
        simulated = Some(sweeps);
    }
    let cascade = merge_equal_clusters(&states);
    let labels = compute
        .stage("labels", Some(cascade.len() as u64), |progress| {
            labels(study, &spectrum, &cascade, &states, progress)
        })
        .map_err(|error| not_clustered(error, Error::Labels))?;
    drop(states);
    let mut trees = CascadeTree::of_each_run(&cascade, LEAST_LISTED);
    trees.iter_mut().for_each(|tree| tree.label(&cascade, &labels));
    let mut findings = Findings {
        cascade,
        labels,
        trees,
        spectrum,
        msf,
        transitions,
        synchrony,
        simulated,
        step_effects,
        agreement,
        warnings: Vec::new(),
    };
    doubts::warn_of_groups(&findings, &mut warnings);
    findings.warnings = warnings.into_list();
    Ok(findings)
}

/// Warns of eigenvalues that rounding beside the largest weight leaves uncertain.
fn warn_of_weak_links(spectrum: &Spectrum, warnings: &mut Warnings<'_>) {
    let spectrum = spectrum.real_modes();
    let n_zero = spectrum.eigenspaces.first().map_or(0, ExactSizeIterator::len);
    let modes = spectrum.eigenvalues.iter().enumerate().skip(n_zero);
    let mut lost = modes.filter(|(mode, lambda)| spectrum.error(*mode) > CERTAIN * lambda.abs());
    let Some((mode, lambda)) = lost.next() else { return };
    let message = format!(
        "lambda_{} = {} is uncertain by {}, and so are {} more eigenvalues: links much weaker than \
         the strongest are lost in rounding",
        mode + 1,
        four_digits(*lambda),
        two_digits(spectrum.error(mode)),
        lost.count()
    );
    warnings.add("eigenvalues", message);
}

/// The curve, after which its doubts are told.
fn looked_at<C: Compute>(
    study: &Study,
    compute: &C,
    warnings: &mut Warnings<'_>,
) -> Result<MasterStability, C::Error> {
    let msf = compute.curve(study)?;
    doubts::warn_of_short_times(study, &msf, warnings);
    stability::warn(study, &msf, warnings);
    Ok(msf)
}

/// λ_N: the last eigenvalue, or computed by itself where it decides and is not among the leading ones.
fn fastest(
    study: &Study,
    spectrum: &Spectrum,
    stable: &StableRegion,
    warnings: &mut Warnings<'_>,
) -> Option<f64> {
    if spectrum.is_whole() {
        return spectrum.real_eigenvalues().last().copied();
    }
    if stable.is_unbounded() {
        return None;
    }
    match spectra::smallest_eigenvalue(&study.matrix) {
        Ok(lambda) => Some(lambda),
        Err(error) => {
            warnings.add("global_synchrony", format!("λ_N is not known: {error}"));
            None
        }
    }
}

/// The largest |w_ii|, which |λ_N| is at least.
fn strongest(study: &Study) -> f64 {
    let diagonal = study.matrix.matrix().diag_iter();
    diagonal.flatten().fold(0.0, |largest, w| largest.max(w.abs()))
}

/// What is not predicted from a part of the modes, and what would be needed for it.
fn beyond(study: &Study, computed: usize, top: f64) -> String {
    format!(
        "the stable set has an upper end, and {computed} of {} modes were computed: above epsilon = {} \
         the fastest modes may be unstable, and nothing is predicted there. `spectrum.modes = \"all\"` \
         decides it",
        study.network.n_nodes(),
        plain(top)
    )
}

/// What kept clusters from being found.
fn not_clustered(error: ClusteringError, of: fn(ClusteringError) -> Error) -> Error {
    match error {
        ClusteringError::Cancelled => Error::Cancelled,
        other => of(other),
    }
}

/// Which clusters are exact and which approximate, state by state.
fn labels(
    study: &Study,
    spectrum: &Spectrum,
    cascade: &[State],
    stretches: &[State],
    progress: Progress<'_>,
) -> Result<Vec<StateLabels>, ClusteringError> {
    let (matrix, rule) = (study.matrix.matrix().view(), study.rule);
    let of = |state: &State| {
        let stretches = state.stretches(stretches);
        let labels = StateLabels::of(state, stretches, spectrum, matrix, rule, EQUITABLE);
        if progress(1).is_break() { Err(ClusteringError::Cancelled) } else { labels }
    };
    cascade.par_iter().map(of).collect()
}
