//! What follows from Λ(σ): Λ(0), σ_c, critical couplings.

use eigensync::msf::{Zero, coupling_at};
use eigensync::numbers::four_digits;

use super::spectrum;
use crate::Number;
use crate::found::Found;

/// Λ(0).
pub fn isolated(found: &Found<'_>) -> Vec<Number> {
    let isolated = found.findings.msf.isolated;
    vec![Number::Known { value: isolated.mean, error: isolated.standard_error }]
}

/// σ_c.
pub fn sigma_c(found: &Found<'_>) -> Vec<Number> {
    vec![match found.findings.msf.stable.sigma_c() {
        Some(zero) => Number::Known { value: zero.sigma, error: zero.standard_error },
        None => no_edge(found, -1.0),
    }]
}

/// Whether σ_c is not known as well as was asked for.
pub fn sigma_c_is_unrefined(found: &Found<'_>) -> bool {
    found.findings.msf.stable.sigma_c().is_some_and(|zero| !zero.refined)
}

/// The zeros that bound the stable set.
pub fn zeros(found: &Found<'_>) -> Vec<Number> {
    let known = |zero: Zero| Number::Known { value: zero.sigma, error: zero.standard_error };
    found.findings.msf.stable.zeros().map(known).collect()
}

/// Whether any of them is not known as well as was asked for.
pub fn zeros_are_unrefined(found: &Found<'_>) -> bool {
    found.findings.msf.stable.zeros().any(|zero| !zero.refined)
}

/// ε_k above which each of the claimed modes is stable.
pub fn critical_couplings(found: &Found<'_>) -> Vec<Number> {
    let findings = found.findings;
    let eigenvalues = findings.spectrum.real_eigenvalues();
    let number = |&mode: &usize| {
        if mode > eigenvalues.len() {
            return Number::Unknown(found.not_computed(mode));
        }
        match findings.transitions_of(mode - 1).find(|transition| transition.zero.falling) {
            // The zero of Λ is the same for all modes, and does not change their order.
            Some(t) if found.at.in_order && t.epsilon.is_finite() => Number::Known {
                value: t.epsilon,
                error: t.epsilon * spectrum::error(found, mode) / -t.lambda,
            },
            Some(t) if t.epsilon.is_finite() => {
                Number::Known { value: t.epsilon, error: t.standard_error }
            }
            Some(_) => Number::None,
            None => no_edge(found, eigenvalues[mode - 1]),
        }
    };
    found.at.modes.iter().flatten().map(number).collect()
}

/// Whether any of them follows from a zero that is not known as well as was asked for.
pub fn couplings_are_unrefined(found: &Found<'_>) -> bool {
    let modes = found.at.modes.as_deref().unwrap_or_default();
    let is_unrefined = |mode: &usize| {
        found.findings.transitions_of(mode - 1).any(|transition| !transition.zero.refined)
    };
    modes.iter().any(is_unrefined)
}

/// Where there is no σ from which on a mode of eigenvalue λ is stable: it may lie where nothing was looked
/// at. σ_c is the coupling of λ = −1.
fn no_edge(found: &Found<'_>, lambda: f64) -> Number {
    let msf = &found.findings.msf;
    let [first, last] = [msf.looked.from, msf.looked.to];
    let [from, to] = [first, last].map(four_digits);
    if msf.stable.intervals.is_empty() {
        let words = format!("nothing is stable from sigma = {from} to {to}");
        return match first {
            0.0 => Number::NoneUpTo { limit: coupling_at(last, lambda), words },
            _ => Number::Unknown(words),
        };
    }
    match msf.stable.unknown_below() {
        Some(_) => Number::Unknown(format!(
            "Λ < 0 at sigma = {from}, the smallest that was looked at: where that begins is not known"
        )),
        None => Number::None,
    }
}
