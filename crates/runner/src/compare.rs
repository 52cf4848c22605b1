//! The results folder against the golden outputs: which quantity, expected, obtained, allowed.
//!
//! Deterministic quantities compare tightly, statistical ones within `rules::BANDS` standard errors. The
//! kernel's arithmetic is the same everywhere, so any difference at all is worth a line; the band
//! decides whether it is a failure.
//!
//! The band is made of the golden standard error; the obtained one widens it only as far as it is no
//! more than `rules::GROWTH` times as large. A number that moved and whose own error is beyond that, or is
//! more than `rules::HUGE` of it, is no number to compare: it is a failure that says so, however wide its
//! band would be. Correlations have bands of their seeds, and a least width.

mod comparison;
mod rules;

use std::path::Path;

use serde_json::{Map, Value};

use crate::files;
use crate::problem::{Problem, Result};

pub use comparison::Comparison;
use comparison::Meaning;
use rules::{Rule, is_onset};

/// Compares the summary of a results folder with that of golden outputs; none without a golden one.
pub fn compare(results: &Path, golden: &Path) -> Result<Option<Comparison>> {
    let Some(expected) = golden_summary(golden)? else { return Ok(None) };
    let obtained = read(&results.join("summary.json"))?;
    Ok(Some(compare_summaries(&expected, &obtained)))
}

/// The summary of golden outputs; none where there are none.
pub fn golden_summary(golden: &Path) -> Result<Option<Value>> {
    let path = golden.join("summary.json");
    path.exists().then(|| read(&path)).transpose()
}

fn read(path: &Path) -> Result<Value> {
    let text = files::open(path).and_then(std::io::read_to_string).map_err(|error| {
        Problem::from_error("cannot be read", error).in_file(path).hint("`eigensync run` writes it")
    })?;
    serde_json::from_str(&text)
        .map_err(|error| Problem::from_error("is not JSON", error).in_file(path))
}

/// Compares a summary with that of golden outputs.
pub fn compare_summaries(expected: &Value, obtained: &Value) -> Comparison {
    let mut walk = Walk { expected, obtained, comparison: Comparison::default() };
    let empty = Map::new();
    walk.value("", "", [expected, obtained], [&empty, &empty]);
    walk.comparison
}

struct Walk<'a> {
    expected: &'a Value,
    obtained: &'a Value,
    comparison: Comparison,
}

type Pair<'a> = [&'a Value; 2];
type Siblings<'a> = [&'a Map<String, Value>; 2];

impl Walk<'_> {
    /// Compares two values at a path; `kind` is the path with its indices left out, and `siblings`
    /// the objects around them.
    fn value(&mut self, path: &str, kind: &str, [expected, obtained]: Pair, siblings: Siblings) {
        match (expected, obtained) {
            (Value::Object(a), Value::Object(b)) => self.objects(path, kind, [a, b]),
            (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
                for (index, pair) in a.iter().zip(b).enumerate() {
                    let path = format!("{path}[{index}]");
                    self.value(&path, &format!("{kind}[]"), [pair.0, pair.1], siblings);
                }
            }
            _ if expected == obtained => {}
            _ => self.differ(path, kind, [expected, obtained], siblings),
        }
    }

    fn objects(&mut self, path: &str, kind: &str, [a, b]: Siblings) {
        let join = |name: &str, to: &str| {
            if to.is_empty() { name.to_owned() } else { format!("{to}.{name}") }
        };
        for key in a.keys().filter(|key| !b.contains_key(*key)) {
            let kind = join(key, kind);
            if matches!(self.rule(&kind, [a, b]), Rule::Exact | Rule::Band(_)) {
                self.fail(&kind, format!("{} is missing", join(key, path)));
            }
        }
        // A golden output of before says nothing of a key; of the experiment it says everything.
        for key in b.keys().filter(|key| !a.contains_key(*key)) {
            let (kind, line) = (join(key, kind), format!("{} is new", join(key, path)));
            if kind.starts_with("experiment.") {
                self.fail(&kind, line);
            } else if !matches!(self.rule(&kind, [a, b]), Rule::Ignore) {
                self.add(Meaning::NotJudged, line);
            }
        }
        for (key, expected) in a {
            if let Some(obtained) = b.get(key) {
                self.value(&join(key, path), &join(key, kind), [expected, obtained], [a, b]);
            }
        }
    }

    fn differ(&mut self, path: &str, kind: &str, [expected, obtained]: Pair, siblings: Siblings) {
        let rule = self.rule(kind, siblings);
        let distance = match (expected.as_f64(), obtained.as_f64()) {
            (Some(a), Some(b)) => (a - b).abs(),
            // An onset that was not found lies beyond the couplings that were swept.
            (Some(onset), None) | (None, Some(onset)) if is_onset(kind) => self.to_an_end(onset),
            _ => f64::INFINITY,
        };
        let moved =
            || format!("{path}: expected {}, obtained {}", short(expected), short(obtained));
        if let Some(why) = self.unknown(kind, [expected, obtained], siblings) {
            return self.fail(kind, format!("{}, cannot be judged: {why}", moved()));
        }
        match rule {
            Rule::Ignore => {}
            Rule::Note => self.add(Meaning::NotJudged, moved()),
            Rule::Band(allowed) if distance <= allowed => {
                let share = distance / allowed;
                let line = format!("{}: within ± {allowed:.2e}, {share:.2} of it", moved());
                self.add(Meaning::WithinBand, line);
            }
            Rule::Band(allowed) => self.fail(kind, format!("{}, allowed ± {allowed:.2e}", moved())),
            Rule::Exact => self.fail(kind, format!("{}, allowed none", moved())),
        }
    }

    /// A difference beyond what is allowed; of what a quick run simulated, a full one decides.
    fn fail(&mut self, kind: &str, line: String) {
        let is_short = shortening(self.obtained) > shortening(self.expected);
        let is_simulated = kind.starts_with("simulations") || kind.contains(".simulated_");
        let meaning = if is_short && is_simulated { Meaning::Open } else { Meaning::Failure };
        self.add(meaning, line);
    }

    fn add(&mut self, meaning: Meaning, line: String) {
        self.comparison.add(meaning, line);
    }
}

/// By how much the times of a run were shortened.
fn shortening(summary: &Value) -> f64 {
    summary["shortened"].as_f64().unwrap_or(1.0)
}

/// A value on one line of bearable length.
fn short(value: &Value) -> String {
    let text = value.to_string();
    match text.char_indices().nth(80) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}

#[cfg(test)]
mod tests;
