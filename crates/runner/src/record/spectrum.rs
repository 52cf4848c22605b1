//! The spectrum in a summary, and how it is known to be whole.

use serde::Serialize;
use spectra::{Spectrum, Verification};

/// How the modes are known.
#[derive(Serialize)]
pub struct SpectrumRecord {
    /// Which solver found them: its name in experiment files, with hyphens.
    pub solver: String,
    /// First and last mode of each run of equal eigenvalues of two modes or more.
    pub multiple: Vec<[usize; 2]>,
    /// Eigenvalues closer than this are one eigenspace.
    pub tolerance: f64,
    /// Largest ‖W v − λ v‖.
    pub largest_residual: f64,
    /// Where all modes with larger eigenvalues were asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cutoff: Option<f64>,
    /// How it is known that none is missing.
    pub verified: VerifiedRecord,
}

/// How it is known that no mode is missing above the last one, or above the cutoff.
#[derive(Serialize)]
pub struct VerifiedRecord {
    /// `dense`: all were computed; `inertia`: counted by a factorisation; `probed`: random vectors
    /// showed no further one.
    pub by: &'static str,
    /// 1 less the largest probability that one is missing nevertheless.
    pub confidence: f64,
}

/// A spectrum without its numbers.
pub fn record(spectrum: &Spectrum) -> SpectrumRecord {
    SpectrumRecord {
        solver: spectrum.solver.name().replace('_', "-"),
        multiple: spectrum
            .real_modes()
            .eigenspaces
            .iter()
            .filter(|modes| modes.len() > 1)
            .map(|modes| [modes.start + 1, modes.end])
            .collect(),
        tolerance: spectrum.tolerance,
        largest_residual: spectrum.largest_residual(),
        cutoff: spectrum.cutoff,
        verified: verified(spectrum.verification),
    }
}

fn verified(verification: Verification) -> VerifiedRecord {
    match verification {
        Verification::Dense => VerifiedRecord { by: "dense", confidence: 1.0 },
        Verification::Inertia { .. } => VerifiedRecord { by: "inertia", confidence: 1.0 },
        Verification::Probed { confidence, .. } => VerifiedRecord { by: "probed", confidence },
    }
}
