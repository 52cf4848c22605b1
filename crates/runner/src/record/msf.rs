//! The master stability function in a summary: its zeros, its stable set, and the critical couplings.

use dynamics::{Closes, Estimate};
use eigensync::{Findings, word};
use msf::{Attractor, End, MasterStability, StableRegion, Zero};
use serde::Serialize;

/// Λ(σ) in numbers.
#[derive(Serialize)]
pub struct MsfRecord {
    /// Λ(0).
    pub lyapunov_isolated: f64,
    /// Its standard error.
    pub lyapunov_isolated_standard_error: f64,
    /// By how much half the step changes it.
    pub lyapunov_isolated_step_shift: ShiftRecord,
    /// What that says: `chaotic`, `periodic` or `at rest`.
    pub isolated_state: &'static str,
    /// How the orbit closes, where it does: Λ is then that of multipliers, and no average.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub closes: Option<ClosesRecord>,
    /// How many isolated oscillators ended in each of the states in which they come to rest; only
    /// where they do.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub rests: Vec<usize>,
    /// The σ between which was looked; Λ(0) is known besides.
    pub looked: [f64; 2],
    /// At how many.
    pub looked_at: usize,
    /// How many σ were looked at between those of the grid, where a window might have been missed.
    pub looked_between: usize,
    /// The widest gap between neighbours, as a share of its σ: a narrower window may have been missed.
    pub widest_gap: f64,
    /// Gaps in which Λ comes so near zero that a window may still be hidden.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub doubtful: Vec<[f64; 2]>,
    /// Stable intervals of σ, [from, to]; no upper end where the look ends stable.
    pub stable: Vec<(f64, Option<f64>)>,
    /// What the ends of these intervals are.
    pub stable_ends: Vec<[EndRecord; 2]>,
    /// σ_c, the edge of the stable set where that is σ > σ_c as far as was looked.
    pub sigma_c: Option<f64>,
    /// Its standard error.
    pub standard_error: Option<f64>,
    /// Interval that holds it with a probability of 95 %.
    pub confidence_interval: Option<[f64; 2]>,
    /// Every zero of Λ, with its standard error.
    pub zeros: Vec<ZeroRecord>,
    /// Each attractor, where orbits settle on several.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub attractors: Vec<AttractorRecord>,
}

/// By how much half of `msf.step` changes a number.
#[derive(Serialize)]
pub struct ShiftRecord {
    /// The mean change.
    pub mean: f64,
    /// Its standard error.
    pub standard_error: f64,
}

impl From<Estimate> for ShiftRecord {
    fn from(Estimate { mean, standard_error }: Estimate) -> Self {
        Self { mean, standard_error }
    }
}

/// How an orbit closes.
#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum ClosesRecord {
    /// It is at rest.
    Equilibrium,
    /// It is a limit cycle.
    LimitCycle {
        /// Its period, in model time units.
        period: f64,
    },
    /// It is a cycle of a map.
    MapCycle {
        /// Its length.
        iterations: usize,
    },
}

impl From<Closes> for ClosesRecord {
    fn from(closes: Closes) -> Self {
        match closes {
            Closes::AtOnce => Self::Equilibrium,
            Closes::AfterPeriod { period } => Self::LimitCycle { period },
            Closes::AfterIterations { n } => Self::MapCycle { iterations: n },
        }
    }
}

/// An attractor of several.
#[derive(Serialize)]
pub struct AttractorRecord {
    /// Orbits that settled on it, of how many.
    pub orbits: [usize; 2],
    /// σ at which it was told from the others, and Λ there.
    pub told_at: f64,
    /// Λ there.
    pub lambda: f64,
    /// Its standard error.
    pub lambda_standard_error: f64,
    /// What Λ(0) says on it.
    pub isolated_state: &'static str,
    /// The ends of its stable intervals.
    pub stable_ends: Vec<[EndRecord; 2]>,
}

/// An end of a stable interval.
#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum EndRecord {
    /// A zero of Λ.
    Zero {
        /// Where it is.
        sigma: f64,
        /// Its standard error.
        standard_error: f64,
        /// Whether it is known as well as was asked for.
        refined: bool,
    },
    /// σ = 0, where nodes become equal themselves, or only the limit.
    Origin {
        /// Whether nodes become equal without coupling.
        included: bool,
    },
    /// No end is known: the last σ that was looked at.
    Looked {
        /// Where it is.
        sigma: f64,
    },
}

impl From<End> for EndRecord {
    fn from(end: End) -> Self {
        match end {
            End::Zero(Zero { sigma, standard_error, refined, .. }) => {
                Self::Zero { sigma, standard_error, refined }
            }
            End::Origin { included } => Self::Origin { included },
            End::Looked { sigma } => Self::Looked { sigma },
        }
    }
}

/// A zero of Λ.
#[derive(Serialize)]
pub struct ZeroRecord {
    /// Where it is.
    pub sigma: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// Whether Λ falls there as σ grows.
    pub falling: bool,
    /// Whether it is known as well as was asked for.
    pub refined: bool,
    /// None where no line could be drawn through exponents near it.
    pub step_shift: Option<ShiftRecord>,
}

/// An ε at which a mode changes stability.
#[derive(Serialize)]
pub struct CriticalRecord {
    /// Which mode.
    pub mode: usize,
    /// λ_k.
    pub lambda: f64,
    /// None where no coupling stabilises the mode.
    pub epsilon: Option<f64>,
    /// Its standard error.
    pub standard_error: Option<f64>,
    /// Whether the mode is stable above it.
    pub stable_above: bool,
    /// Whether the zero of Λ behind it is known as well as was asked for.
    pub refined: bool,
}

/// A curve in numbers.
pub fn msf_record(msf: &MasterStability) -> MsfRecord {
    let sigma_c = msf.stable.sigma_c();
    MsfRecord {
        lyapunov_isolated: msf.isolated.mean,
        lyapunov_isolated_standard_error: msf.isolated.standard_error,
        lyapunov_isolated_step_shift: msf.isolated_step_shift.into(),
        isolated_state: word(msf.state),
        closes: msf.closes.map(Into::into),
        rests: msf.rests.clone(),
        looked: [msf.looked.from, msf.looked.to],
        looked_at: msf.looked.points,
        looked_between: msf.looked.between,
        widest_gap: msf.looked.widest_gap,
        doubtful: msf.doubtful.clone(),
        stable: msf.stable.intervals.iter().map(|i| (i.lower(), i.upper())).collect(),
        stable_ends: ends(&msf.stable),
        attractors: msf.attractors.iter().map(attractor_record).collect(),
        sigma_c: sigma_c.map(|zero| zero.sigma),
        standard_error: sigma_c.map(|zero| zero.standard_error),
        confidence_interval: sigma_c.map(|zero| zero.confidence_interval()),
        zeros: msf.stable.zeros().map(zero_record).collect(),
    }
}

fn ends(stable: &StableRegion) -> Vec<[EndRecord; 2]> {
    stable.intervals.iter().map(|i| [i.from, i.to].map(Into::into)).collect()
}

fn attractor_record(attractor: &Attractor) -> AttractorRecord {
    AttractorRecord {
        orbits: [attractor.orbits, attractor.of],
        told_at: attractor.told_at,
        lambda: attractor.lambda.mean,
        lambda_standard_error: attractor.lambda.standard_error,
        isolated_state: word(attractor.state),
        stable_ends: ends(&attractor.stable),
    }
}

fn zero_record(zero: Zero) -> ZeroRecord {
    let Zero { sigma, standard_error, falling, refined, step_shift } = zero;
    ZeroRecord { sigma, standard_error, falling, refined, step_shift: step_shift.map(Into::into) }
}

/// The critical couplings, mode by mode.
pub fn critical_records(findings: &Findings) -> Vec<CriticalRecord> {
    let finite = |value: f64| value.is_finite().then_some(value);
    let record = |(mode, lambda): (usize, f64)| {
        findings.transitions_of(mode).map(move |transition| CriticalRecord {
            mode: mode + 1,
            lambda,
            epsilon: finite(transition.epsilon),
            standard_error: finite(transition.standard_error),
            stable_above: transition.zero.falling,
            refined: transition.zero.refined,
        })
    };
    findings.spectrum.real_eigenvalues().into_iter().enumerate().flat_map(record).collect()
}
