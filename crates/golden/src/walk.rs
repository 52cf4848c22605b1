//! One summary against another, value by value.

use serde_json::{Map, Value};

use crate::Comparison;
use crate::both::{Both, Pair, Siblings};
use crate::comparison::Meaning;
use crate::rules::{ATLAS, Rule, is_onset};

/// Compares a summary with that of golden outputs.
pub fn compare_summaries(expected: &Value, obtained: &Value) -> Comparison {
    let mut walk = Walk { both: Both { expected, obtained }, comparison: Comparison::default() };
    let empty = Map::new();
    walk.value("", "", [expected, obtained], [&empty, &empty]);
    walk.comparison
}

/// Goes through both sides at once.
struct Walk<'a> {
    both: Both<'a>,
    comparison: Comparison,
}

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
            if matches!(self.both.rule(&kind, [a, b]), Rule::Exact | Rule::Band(_)) {
                self.fail(&kind, format!("{} is missing", join(key, path)));
            }
        }
        // A golden output of before says nothing of a key; of the experiment it says everything.
        for key in b.keys().filter(|key| !a.contains_key(*key)) {
            let (kind, line) = (join(key, kind), format!("{} is new", join(key, path)));
            if kind.starts_with("experiment.") {
                self.fail(&kind, line);
            } else if !matches!(self.both.rule(&kind, [a, b]), Rule::Ignore) {
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
        let rule = self.both.rule(kind, siblings);
        let distance = match (expected.as_f64(), obtained.as_f64()) {
            (Some(a), Some(b)) => (a - b).abs(),
            // An onset that was not found lies beyond the couplings that were swept.
            (Some(onset), None) | (None, Some(onset)) if is_onset(kind) => {
                self.both.to_an_end(onset)
            }
            _ => f64::INFINITY,
        };
        let moved =
            || format!("{path}: expected {}, obtained {}", short(expected), short(obtained));
        if let Some(why) = self.both.unknown(kind, [expected, obtained], siblings) {
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

    /// A difference beyond what is allowed; of what a quick run simulated, and of the pairs of
    /// an atlas, a full one decides.
    fn fail(&mut self, kind: &str, line: String) {
        let is_short = self.both.widening() > 1.0;
        let is_simulated = kind.starts_with("simulations") || kind.contains(".simulated_");
        // Its averages may be too short to see a narrow window.
        let is_of_atlas = kind.starts_with(ATLAS);
        let meaning = if is_short && (is_simulated || is_of_atlas) {
            Meaning::Open
        } else {
            Meaning::Failure
        };
        self.add(meaning, line);
    }

    fn add(&mut self, meaning: Meaning, line: String) {
        self.comparison.add(meaning, line);
    }
}

/// A value on one line of bearable length.
fn short(value: &Value) -> String {
    let text = value.to_string();
    match text.char_indices().nth(80) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}
