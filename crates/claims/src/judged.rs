//! A claim with what was obtained and the verdict, as it stands in results.

use std::fmt;

use serde::Serialize;
use serde_json::Value;
use user::text::one_line;

/// A judged claim.
#[derive(Clone, Debug, Serialize)]
pub struct Judged {
    /// Its key in the file.
    pub name: String,
    /// Where the source says it.
    pub source: String,
    /// What the source says.
    pub paper: Value,
    /// What was obtained.
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
    /// How near it must come, in words.
    pub tolerance: String,
    /// Whether it does.
    pub verdict: Verdict,
    /// Why the tolerance is what it is, why a difference is known, or why there is no verdict.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub reason: String,
}

impl Judged {
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
    /// Those that did.
    pub bounded: usize,
    /// All of them.
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

/// What becomes of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Verdict {
    /// What was obtained is what is claimed.
    #[serde(rename = "holds")]
    Holds,
    /// It is not.
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
