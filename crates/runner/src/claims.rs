//! Claims: what the source says, what was obtained, and the verdict.

mod clusters;
mod number;
mod numbers;
mod obtained;

use eigensync::Findings;
use std::fmt;

pub use clusters::labelled;
use number::Number;
use serde::Serialize;
use serde_json::{Value, json};

use crate::output::one_line;
use crate::plan::Plan;
use crate::problem::{Problem, Result};
use crate::spec::{ClaimSpec, OneOrMany, Quantity};

/// A judged claim.
#[derive(Clone, Debug, Serialize)]
pub struct Claim {
    pub name: String,
    pub source: String,
    pub paper: Value,
    pub obtained: Value,
    /// Standard error of the obtained number; for an onset the standard deviation over seeds, or half
    /// a step of the sweep if that is larger.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<f64>,
    /// How many runs a simulated claim stands on; there only where these are not all of the seeds, or
    /// where one is all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub runs: Option<Runs>,
    /// Whether the zeros of Λ behind a number are all known as well as was asked for; there only where
    /// they are not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub refined: Option<bool>,
    pub tolerance: String,
    pub verdict: Verdict,
    /// Why the tolerance is what it is, why a difference is known, or why there is no verdict.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub reason: String,
}

impl Claim {
    /// The name as a sentence: `_` is a blank, and a decimal point between two digits, since a key in
    /// TOML has no other.
    pub fn sentence(&self) -> String {
        let chars: Vec<char> = one_line(&self.name).chars().collect();
        let is_digit = |at: usize| chars.get(at).is_some_and(char::is_ascii_digit);
        let shown = |(at, &c): (usize, &char)| match c {
            '_' if at > 0 && is_digit(at - 1) && is_digit(at + 1) => '.',
            '_' => ' ',
            c => c,
        };
        chars.iter().enumerate().map(shown).collect()
    }
}

/// Runs that came to their end, at the ε of a claim at which they are fewest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Runs {
    pub bounded: usize,
    pub of: usize,
}

impl fmt::Display for Runs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self { bounded: 1, of: 1 } => f.write_str("of one run"),
            Self { bounded, of } => write!(f, "over {bounded} of {of} runs"),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Verdict {
    #[serde(rename = "holds")]
    Holds,
    #[serde(rename = "differs")]
    Differs,
    /// The file says why this cannot agree.
    #[serde(rename = "differs as known")]
    DiffersAsKnown,
    /// What was obtained is not known well enough to tell.
    #[serde(rename = "cannot be judged")]
    CannotBeJudged,
    /// The averages of a quick run are too short to tell.
    #[serde(rename = "needs a full run")]
    NeedsFullRun,
}

/// Whether what was obtained is what is claimed.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Answer {
    Holds,
    Differs,
    /// There is nothing of which the claim could hold.
    NothingToJudge,
    /// For this reason.
    CannotBeJudged(String),
}

impl Answer {
    /// Of a claim that must hold of each of several things: one that differs decides, and then one
    /// that cannot be judged. Of nothing, nothing holds.
    fn of_all(answers: impl Iterator<Item = Self>) -> Self {
        let mut all = Self::NothingToJudge;
        for answer in answers {
            match answer {
                Self::Differs | Self::NothingToJudge => return Self::Differs,
                Self::CannotBeJudged(_) => all = answer,
                Self::Holds if all == Self::NothingToJudge => all = Self::Holds,
                Self::Holds => {}
            }
        }
        all
    }
}

impl From<bool> for Answer {
    fn from(holds: bool) -> Self {
        if holds { Self::Holds } else { Self::Differs }
    }
}

/// Both sides of a claim and the answer.
struct Judged {
    paper: Value,
    obtained: Value,
    tolerance: String,
    answer: Answer,
}

impl Judged {
    fn new(
        paper: Value,
        obtained: Value,
        tolerance: impl Into<String>,
        answer: impl Into<Answer>,
    ) -> Self {
        Self { paper, obtained, tolerance: tolerance.into(), answer: answer.into() }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Holds => "holds",
            Self::Differs => "differs",
            Self::DiffersAsKnown => "differs as known",
            Self::CannotBeJudged => "cannot be judged",
            Self::NeedsFullRun => "needs a full run",
        })
    }
}

/// Judges every claim of an experiment, in the order of its file.
pub fn judge(plan: &Plan, findings: &Findings) -> Result<Vec<Claim>> {
    let claims = plan.experiment.claims.iter();
    claims.map(|(name, spec)| Judge { name, spec, plan, findings }.judge()).collect()
}

struct Judge<'a> {
    name: &'a str,
    spec: &'a ClaimSpec,
    plan: &'a Plan,
    findings: &'a Findings,
}

impl Judge<'_> {
    fn judge(&self) -> Result<Claim> {
        let spec = self.spec;
        let Judged { paper, obtained, tolerance, answer } = match spec.of {
            Quantity::Eigenvectors => self.eigenvectors()?,
            Quantity::CascadeClusters
            | Quantity::SimulatedClusters
            | Quantity::PredictedRegions
            | Quantity::SimulatedRegions => self.clusters()?,
            Quantity::CascadeOrder | Quantity::SimulatedOrder => self.order()?,
            _ => self.numbers()?,
        };
        let is_quick = self.plan.shortened > 1.0;
        let verdict = match (&answer, &spec.known_difference) {
            (Answer::Holds, _) => Verdict::Holds,
            (Answer::CannotBeJudged(_), _) if is_quick && self.is_averaged() => {
                Verdict::NeedsFullRun
            }
            (Answer::CannotBeJudged(_), _) => Verdict::CannotBeJudged,
            (Answer::Differs, Some(_)) => Verdict::DiffersAsKnown,
            (Answer::Differs, _) if is_quick && self.spec.of.is_simulated() => {
                Verdict::NeedsFullRun
            }
            (Answer::Differs | Answer::NothingToJudge, _) => Verdict::Differs,
        };
        let reason = match answer {
            Answer::CannotBeJudged(why) => why,
            Answer::NothingToJudge => "there is nothing to judge".into(),
            Answer::Holds | Answer::Differs => {
                let known = spec.known_difference.clone();
                let known = known.filter(|_| verdict == Verdict::DiffersAsKnown);
                known.unwrap_or_else(|| spec.reason.clone())
            }
        };
        let own = &self.plan.experiment.source;
        Ok(Claim {
            name: self.name.to_owned(),
            source: if spec.source.is_empty() { own.clone() } else { spec.source.clone() },
            paper,
            obtained,
            uncertainty: self.uncertainty(),
            runs: self.runs().filter(|runs| runs.bounded < runs.of || runs.of == 1),
            refined: self.is_unrefined().then_some(false),
            tolerance,
            verdict,
            reason,
        })
    }

    /// Whether a quantity follows from averages over a time, which `--quick` shortens.
    fn is_averaged(&self) -> bool {
        use Quantity as Q;
        !matches!(self.spec.of, Q::Eigenvalues | Q::Eigenvectors | Q::Nodes | Q::Links | Q::Groups)
    }

    /// Whether a number follows from a zero of Λ that could not be refined.
    fn is_unrefined(&self) -> bool {
        let findings = self.findings;
        match self.spec.of {
            Quantity::SigmaC => findings.msf.stable.sigma_c().is_some_and(|zero| !zero.refined),
            Quantity::CriticalCouplings => {
                let modes = self.spec.at.modes.as_deref().unwrap_or_default();
                let is_unrefined = |mode: &usize| {
                    findings.transitions_of(mode - 1).any(|transition| !transition.zero.refined)
                };
                modes.iter().any(is_unrefined)
            }
            Quantity::CascadeClusters | Quantity::CascadeOrder => {
                findings.msf.stable.zeros().any(|zero| !zero.refined)
            }
            _ => false,
        }
    }

    /// The runs on which a simulated claim stands; of an onset or an order those that do not escape at
    /// its end.
    fn runs(&self) -> Option<Runs> {
        let simulated = self.findings.simulated.as_ref().filter(|_| self.spec.of.is_simulated())?;
        let of = simulated.seeds.len();
        let bounded = |&epsilon: &f64| Some(simulated.bounded(simulated.position(epsilon)?));
        let not_escaped = |clusters: &[Vec<usize>]| {
            let seen = self.findings.seen(clusters)?;
            Some(of.saturating_sub(seen.onset.n_escaped))
        };
        let clusters = self.claimed_clusters();
        let fewest = match self.spec.of {
            Quantity::SimulatedOnset => not_escaped(&clusters),
            Quantity::SimulatedOrder => clusters.chunks(1).filter_map(not_escaped).min(),
            _ => self.epsilon().iter().filter_map(bounded).min(),
        };
        Some(Runs { bounded: fewest?, of })
    }

    fn epsilon(&self) -> &[f64] {
        self.spec.at.epsilon.as_ref().map_or(&[], OneOrMany::list)
    }

    /// How far the span of the printed vectors of each eigenspace lies from that eigenspace.
    fn eigenvectors(&self) -> Result<Judged> {
        let printed: Vec<Vec<f64>> = self.equals("a list of vectors")?;
        let modes = self.spec.at.modes.clone().unwrap_or_default();
        let spectrum = self.findings.spectrum.real_modes();
        let of_eigenspace = |eigenspace: &std::ops::Range<usize>| {
            let inside =
                modes.iter().zip(&printed).filter(|(mode, _)| eigenspace.contains(&(*mode - 1)));
            let vectors: Vec<Vec<f64>> = inside.map(|(_, vector)| vector.clone()).collect();
            let computed = &spectrum.eigenvectors[eigenspace.clone()];
            (!vectors.is_empty()).then(|| spectra::subspace_distance(&vectors, computed))
        };
        let distances: Vec<f64> = spectrum.eigenspaces.iter().filter_map(of_eigenspace).collect();
        let allowed = self.spec.abs_tol.unwrap_or(0.0);
        let paper = json!(format!(
            "modes {} to {}",
            modes.iter().min().unwrap_or(&0),
            modes.iter().max().unwrap_or(&0)
        ));
        let tolerance = format!("≤ {allowed}");
        // Fewer modes may have been computed than were asked for.
        if let Some(&mode) = modes.iter().find(|&&mode| mode > spectrum.eigenvalues.len()) {
            let why = Answer::CannotBeJudged(self.not_computed(mode).to_string());
            return Ok(Judged::new(paper, Value::Null, tolerance, why));
        }
        let farthest = distances.iter().copied().fold(0.0, f64::max);
        let shown = json!(format!("{farthest:.4} away"));
        let near = distances.iter().map(|&distance| (distance <= allowed).into());
        Ok(Judged::new(paper, shown, tolerance, Answer::of_all(near)))
    }

    fn equals<T: serde::de::DeserializeOwned>(&self, expected: &str) -> Result<T> {
        let problem = || self.problem(&format!("needs `equals` to be {expected}"));
        self.spec.equals.clone().ok_or_else(problem)?.try_into().map_err(|_| problem())
    }

    fn problem(&self, message: &str) -> Problem {
        Problem::with_key(&self.plan.file, &format!("claims.{}", self.name), message)
    }
}
