//! The results folder against the golden outputs: which quantity, expected, obtained, allowed.
//!
//! Deterministic quantities compare tightly, statistical ones within [`BANDS`] standard errors. The
//! kernel's arithmetic is the same everywhere, so any difference at all is worth a line; the band
//! decides whether it is a failure.
//!
//! The band is made of the golden standard error; the obtained one widens it only as far as it is no
//! more than [`GROWTH`] times as large. A number that moved and whose own error is beyond that, or is
//! more than [`HUGE`] of it, is no number to compare: it is a failure that says so, however wide its
//! band would be. Correlations have bands of their seeds, and a least width.

use std::collections::BTreeMap;

use std::path::Path;

use serde_json::{Map, Value};

use crate::files;
use crate::problem::{Problem, Result};

/// Width of a band in standard errors.
const BANDS: f64 = 5.0;
/// Relative accuracy of eigenvalues across solvers and machines.
const EIGENVALUES: f64 = 1e-9;
/// How much larger than the golden standard error one may be that is obtained over the same time.
const GROWTH: f64 = 3.0;
/// A number with a larger relative error is not known.
const HUGE: f64 = 0.25;
/// However much a relative error has grown, one below this is no doubt about a number.
const MINOR: f64 = 0.01;
/// Simulated errors below this are rounding, whatever their standard errors say.
const ROUNDING: f64 = 1e-9;
/// Least widths of the bands of correlations and of Rand indices, and the largest standard errors that
/// widen them where the golden output has none.
const CORRELATION: [f64; 2] = [0.02, 0.02];
const RAND_INDEX: [f64; 2] = [0.05, 0.2];
/// Most failures shown of one kind.
const SHOWN: usize = 6;
/// Up to this many differences of a kind that are no failures are named one by one.
const NAMED: usize = 2;

/// How a summary differs from its golden output.
#[derive(Default)]
pub struct Comparison {
    failures: BTreeMap<String, Vec<String>>,
    /// Differences that are no failures, by kind of quantity.
    notes: BTreeMap<String, Notes>,
}

/// Differences of one kind that are no failures.
#[derive(Default)]
struct Notes {
    count: usize,
    /// The largest share of its band; none where the kind is not judged.
    largest_share: Option<f64>,
    /// What the first few of them are.
    first: Vec<String>,
}

impl Notes {
    /// A line each where they are few, one for all otherwise.
    fn lines(&self, kind: &str) -> Vec<String> {
        let judged = match self.largest_share {
            None => "not judged".to_owned(),
            Some(share) => format!("within the band, by at most {share:.2} of it"),
        };
        if self.count <= self.first.len() {
            return self.first.iter().map(|line| format!("{line}: {judged}")).collect();
        }
        vec![format!("{kind}: {} values differ; {judged}", self.count)]
    }
}

impl Comparison {
    pub fn holds(&self) -> bool {
        self.failures.is_empty()
    }

    /// One line a finding, failures first.
    pub fn lines(&self) -> Vec<String> {
        let mut lines = Vec::new();
        for (kind, failures) in &self.failures {
            lines.extend(failures.iter().take(SHOWN).cloned());
            if failures.len() > SHOWN {
                lines.push(format!("… and {} more of {kind}", failures.len() - SHOWN));
            }
        }
        lines.extend(self.notes.iter().flat_map(|(kind, notes)| notes.lines(kind)));
        lines
    }
}

/// Compares the summary of a results folder with that of golden outputs; none without a golden one.
pub fn compare(results: &Path, golden: &Path) -> Result<Option<Comparison>> {
    let path = golden.join("summary.json");
    if !path.exists() {
        return Ok(None);
    }
    let expected = read(&path)?;
    let obtained = read(&results.join("summary.json"))?;
    Ok(Some(compare_summaries(&expected, &obtained)))
}

fn read(path: &Path) -> Result<Value> {
    let text = files::open(path).and_then(std::io::read_to_string).map_err(|error| {
        Problem::from_error("cannot be read", error).in_file(path).hint("`eigensync run` writes it")
    })?;
    serde_json::from_str(&text)
        .map_err(|error| Problem::from_error("is not JSON", error).in_file(path))
}

fn compare_summaries(expected: &Value, obtained: &Value) -> Comparison {
    let mut walk = Walk { expected, obtained, comparison: Comparison::default() };
    let empty = Map::new();
    walk.value("", "", [expected, obtained], [&empty, &empty]);
    walk.comparison
}

/// How a quantity is judged.
enum Rule {
    Exact,
    /// Within this absolute distance.
    Band(f64),
    /// A difference is mentioned, and no more.
    Note,
    Ignore,
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
                self.note(&kind, None, line);
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
            Rule::Note => self.note(kind, None, moved()),
            Rule::Band(allowed) if distance <= allowed => {
                self.note(kind, Some(distance / allowed), moved());
            }
            Rule::Band(allowed) => self.fail(kind, format!("{}, allowed ± {allowed:.2e}", moved())),
            Rule::Exact => self.fail(kind, format!("{}, allowed none", moved())),
        }
    }

    /// Why a number that moved is not known well enough to be compared.
    fn unknown(
        &self,
        kind: &str,
        [expected, obtained]: Pair,
        siblings: Siblings,
    ) -> Option<String> {
        let key = error_key(kind)?;
        let is_unrefined =
            |side: &Map<String, Value>| side.get("refined") == Some(&Value::Bool(false));
        if siblings.into_iter().any(is_unrefined) {
            return Some("the zero of Λ that it follows from could not be refined".into());
        }
        let [golden, own] =
            siblings.map(|side| side.get(key).and_then(Value::as_f64).unwrap_or(0.0));
        // Numbers near zero, as errors near synchrony are, are known by the scale of their kind.
        let of_kind = self.scale(kind);
        let [golden_size, own_size] =
            [expected, obtained].map(|x| of_kind.unwrap_or(x.as_f64().unwrap_or(0.0).abs()));
        let has_grown = own > GROWTH * golden * self.widening() && own > MINOR * own_size;
        // Λ(0) is zero within its error for a periodic oscillator: only growth tells.
        let is_huge = kind != "msf.lyapunov_isolated" && own > HUGE * own_size;
        if golden > HUGE * golden_size && kind != "msf.lyapunov_isolated" {
            return Some(format!("the golden standard error is {golden:.2e}"));
        }
        (has_grown || is_huge)
            .then(|| format!("its standard error is {own:.2e}, the golden one {golden:.2e}"))
    }

    /// What an error of a kind of quantity is large against, where it is not the quantity itself.
    fn scale(&self, kind: &str) -> Option<f64> {
        let list = kind.strip_prefix("simulations[].")?.strip_suffix("[].mean")?;
        let simulations = self.expected["simulations"].as_array()?.iter();
        let errors = simulations.filter_map(|s| s[list].as_array()).flatten();
        Some(errors.filter_map(|error| error["mean"].as_f64()).fold(0.0, f64::max))
    }

    /// The rule for a kind of quantity, with bands from the standard errors beside it.
    fn rule(&self, kind: &str, siblings: Siblings) -> Rule {
        let band = |error: &str| Rule::Band(BANDS * self.joint_error(siblings, error));
        let of_seeds = |error: &str, [least, most]: [f64; 2]| {
            let error = self.seeds_error(siblings, error, most);
            Rule::Band(least.max(BANDS * error) * self.widening())
        };
        match kind {
            "eigenvalues[]" => Rule::Band(EIGENVALUES * self.largest_eigenvalue()),
            "critical_couplings[].lambda" => Rule::Band(EIGENVALUES * self.largest_eigenvalue()),
            "msf.lyapunov_isolated" => band("lyapunov_isolated_standard_error"),
            "msf.sigma_c" | "msf.zeros[].sigma" | "critical_couplings[].epsilon" => {
                band("standard_error")
            }
            "msf.stable[][]" => Rule::Band(BANDS * self.largest_zero_error()),
            "cascade[].epsilon[]" => Rule::Band(BANDS * self.largest_coupling_error()),
            _ if is_onset(kind) => {
                let step = self.widest_step();
                Rule::Band(BANDS * self.joint_spread(siblings, step) + 2.0 * step)
            }
            "simulations[].error_to_reference[].mean"
            | "simulations[].error_within_clusters[].mean" => {
                Rule::Band(ROUNDING.max(BANDS * self.joint_error(siblings, "standard_error")))
            }
            "simulations[].agreement.pearson" => of_seeds("pearson_standard_error", CORRELATION),
            "simulations[].agreement.spearman" => of_seeds("spearman_standard_error", CORRELATION),
            "simulations[].agreement.adjusted_rand_index" => {
                of_seeds("adjusted_rand_index_standard_error", RAND_INDEX)
            }
            // Few and short runs, for warnings only.
            _ if kind.starts_with("simulations_step_effect") => Rule::Note,
            // Of an onset its mean is judged.
            _ if kind.starts_with("cascade[].simulated_onset.") => Rule::Note,
            _ if kind.starts_with("cascade[].simulated_end") => Rule::Note,
            _ if kind.starts_with("provenance") || kind.starts_with("spectrum.largest") => {
                Rule::Ignore
            }
            // Goldens blessed before it was recorded do not have it.
            _ if kind.starts_with("spectrum.verified") => Rule::Note,
            // What was asked for is judged as `experiment` says it.
            _ if kind == "layout" || kind.starts_with("parameters") => Rule::Note,
            // Written in the program's own words by 0.1.0.
            "network.preparation[].step" => Rule::Note,
            // Words; the numbers that they concern are judged themselves.
            _ if kind.starts_with("warnings") => Rule::Note,
            // What the ends of the stable set are; their numbers are judged under `stable`.
            _ if kind.starts_with("msf.stable_ends") || kind.ends_with(".refined") => Rule::Note,
            _ if kind.starts_with("msf.attractors") || kind == "msf.isolated_state" => Rule::Note,
            _ if kind.starts_with("msf.rests") || kind.contains("step_shift") => Rule::Note,
            _ if kind.starts_with("msf.looked") || kind.starts_with("global_synchrony") => {
                Rule::Note
            }
            "spectrum.tolerance" | "cascade[].exact_tolerance" => Rule::Ignore,
            "cascade[].labels[].spread" | "cascade[].labels[].deviation" => Rule::Ignore,
            "cascade[].largest_deviation" => Rule::Ignore,
            // The tolerances behind them follow the residuals, which no two solvers share.
            "cascade[].n_exact" | "cascade[].n_approximate" | "cascade[].equitable" => Rule::Note,
            _ if kind.starts_with("cascade[].labels") => Rule::Note,
            // Goldens blessed before they were recorded do not have them; the modes are judged.
            _ if kind.starts_with("cascade[].n_unstable") => Rule::Note,
            _ if kind.starts_with("cascade[].coincidences") => Rule::Note,
            "shortened" => Rule::Note,
            _ if kind.starts_with("claims") || kind.ends_with("standard_error") => Rule::Note,
            _ if kind.ends_with("spread") || kind.contains("of_seeds") => Rule::Note,
            _ if kind.starts_with("simulations[].clusters") => Rule::Note,
            _ if kind.starts_with("simulations[].agreement") => Rule::Note,
            "msf.confidence_interval[]" => Rule::Note,
            _ => Rule::Exact,
        }
    }

    /// Standard errors of both sides added in squares, the expected one widened when the obtained run
    /// was shortened: its averages are over less time than the golden ones. The obtained one counts as
    /// far as the golden one lets it.
    fn joint_error(&self, [expected, obtained]: Siblings, key: &str) -> f64 {
        let of = |side: &Map<String, Value>| side.get(key).and_then(Value::as_f64).unwrap_or(0.0);
        let golden = of(expected) * self.widening();
        golden.hypot(of(obtained).min(GROWTH * golden))
    }

    /// Spreads of an onset over seeds on both sides; none is known better than to a step.
    fn joint_spread(&self, [expected, obtained]: Siblings, step: f64) -> f64 {
        let of =
            |side: &Map<String, Value>| side.get("spread").and_then(Value::as_f64).unwrap_or(0.0);
        let golden = of(expected) * self.widening();
        golden.hypot(of(obtained).min(GROWTH * golden.max(step)))
    }

    /// How far a number depends on the seeds: as the golden output says or, where it does not, as the
    /// obtained one does, up to a size.
    fn seeds_error(&self, [expected, obtained]: Siblings, key: &str, most: f64) -> f64 {
        let of = |side: &Map<String, Value>| side.get(key).and_then(Value::as_f64);
        of(expected).unwrap_or_else(|| of(obtained).unwrap_or(0.0).min(most))
    }

    fn widening(&self) -> f64 {
        let shortened = |side: &Value| side["shortened"].as_f64().unwrap_or(1.0);
        (shortened(self.obtained) / shortened(self.expected)).sqrt().max(1.0)
    }

    /// The largest joint standard error of one key in a list of objects.
    fn largest_joint_error(&self, list: &str) -> f64 {
        let entries = |side: &Value| side.pointer(list).and_then(Value::as_array).cloned();
        let (a, b) = (entries(self.expected), entries(self.obtained));
        let pairs = a.unwrap_or_default().into_iter().zip(b.unwrap_or_default());
        pairs
            .filter_map(|(a, b)| {
                Some(self.joint_error([a.as_object()?, b.as_object()?], "standard_error"))
            })
            .fold(0.0, f64::max)
    }

    fn largest_zero_error(&self) -> f64 {
        self.largest_joint_error("/msf/zeros")
    }

    fn largest_coupling_error(&self) -> f64 {
        self.largest_joint_error("/critical_couplings")
    }

    fn largest_eigenvalue(&self) -> f64 {
        let values = self.expected["eigenvalues"].as_array();
        values.into_iter().flatten().filter_map(Value::as_f64).fold(1.0, |m, x| m.max(x.abs()))
    }

    fn widest_step(&self) -> f64 {
        self.swept().windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max)
    }

    /// How far a coupling is from the nearer end of the sweep.
    fn to_an_end(&self, epsilon: f64) -> f64 {
        let swept = self.swept();
        let ends = swept.first().into_iter().chain(swept.last());
        ends.map(|end| (epsilon - end).abs()).fold(f64::INFINITY, f64::min)
    }

    /// The couplings of the sweep, ascending.
    fn swept(&self) -> Vec<f64> {
        let simulations = self.expected["simulations"].as_array();
        simulations.into_iter().flatten().filter_map(|s| s["epsilon"].as_f64()).collect()
    }

    fn fail(&mut self, kind: &str, line: String) {
        self.comparison.failures.entry(kind.to_owned()).or_default().push(line);
    }

    fn note(&mut self, kind: &str, share: Option<f64>, line: String) {
        let notes = self.comparison.notes.entry(kind.to_owned()).or_default();
        notes.count += 1;
        if let Some(share) = share {
            notes.largest_share = Some(notes.largest_share.unwrap_or(0.0).max(share));
        }
        if notes.first.len() < NAMED {
            notes.first.push(line);
        }
    }
}

/// Where the standard error of a statistical quantity stands beside it.
fn error_key(kind: &str) -> Option<&'static str> {
    match kind {
        "msf.lyapunov_isolated" => Some("lyapunov_isolated_standard_error"),
        "msf.sigma_c"
        | "msf.zeros[].sigma"
        | "critical_couplings[].epsilon"
        | "simulations[].error_to_reference[].mean"
        | "simulations[].error_within_clusters[].mean" => Some("standard_error"),
        _ => None,
    }
}

fn is_onset(kind: &str) -> bool {
    kind == "cascade[].simulated_onset.mean"
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
mod tests {
    use serde_json::json;

    use super::*;

    fn summary() -> Value {
        json!({
            "shortened": 1.0,
            "experiment": { "sweep": { "step": 0.01 } },
            "eigenvalues": [0.0, -2.0, -3.0],
            "msf": { "sigma_c": 8.17, "standard_error": 0.004, "zeros": [{ "sigma": 8.17, "standard_error": 0.004 }] },
            "cascade": [{ "epsilon": [2.7, 4.1], "clusters": [["1", "2"]] }],
            "simulations": [{ "epsilon": 1.0, "error_within_clusters": [{ "mean": 9.0, "standard_error": 0.1 }] }],
            "provenance": { "wall_time_s": 1.0 },
        })
    }

    fn after(change: impl FnOnce(&mut Value)) -> Comparison {
        let mut changed = summary();
        change(&mut changed);
        compare_summaries(&summary(), &changed)
    }

    #[test]
    fn equal_summaries_need_no_line() {
        assert!(after(|_| ()).lines().is_empty());
        assert!(after(|s| s["provenance"]["wall_time_s"] = json!(2.0)).lines().is_empty());
    }

    #[test]
    fn a_changed_parameter_is_named() {
        let comparison = after(|s| s["experiment"]["sweep"]["step"] = json!(0.02));
        assert!(!comparison.holds());
        let line = "experiment.sweep.step: expected 0.01, obtained 0.02, allowed none";
        assert_eq!(comparison.lines(), [line]);
    }

    #[test]
    fn eigenvalues_are_judged_to_nine_digits() {
        assert!(after(|s| s["eigenvalues"][1] = json!(-2.000_000_001)).holds());
        assert!(!after(|s| s["eigenvalues"][1] = json!(-2.000_001)).holds());
    }

    #[test]
    fn statistical_values_are_judged_by_five_joint_standard_errors() {
        let shift = |by: f64| after(|s| s["msf"]["sigma_c"] = json!(8.17 + by));
        let band = 5.0 * 0.004 * 2f64.sqrt();
        assert!(shift(0.9 * band).holds());
        assert!(!shift(1.1 * band).holds());
        let lines = shift(0.5 * band).lines();
        let [line] = &lines[..] else { panic!("{lines:?}") };
        assert!(line.starts_with("msf.sigma_c: expected 8.17, obtained 8.18"), "{line}");
        assert!(line.ends_with("within the band, by at most 0.50 of it"), "{line}");
    }

    #[test]
    fn a_moved_cluster_or_a_missing_quantity_is_a_failure() {
        assert!(!after(|s| s["cascade"][0]["clusters"][0][1] = json!("3")).holds());
        assert!(!after(|s| _ = s.as_object_mut().unwrap().remove("eigenvalues")).holds());
        assert!(!after(|s| s["eigenvalues"] = json!([0.0, -2.0])).holds());
        assert!(!after(|s| s["msf"]["sigma_c"] = Value::Null).holds());
    }

    #[test]
    fn an_onset_that_was_not_found_lies_beyond_the_sweep() {
        // Steps of 1 allow two of them, from an onset at 5.5 to the end of the sweep at 6, not to one at 8.
        let onset = |last: u32| {
            let mut expected = summary();
            expected["simulations"] =
                (3..=last).map(|epsilon| json!({ "epsilon": f64::from(epsilon) })).collect();
            let mut obtained = expected.clone();
            expected["cascade"][0]["simulated_onset"] = json!({ "mean": 5.5, "spread": 0.0 });
            obtained["cascade"][0]["simulated_onset"] = json!({ "mean": null, "spread": null });
            compare_summaries(&expected, &obtained).holds()
        };
        assert!(onset(6));
        assert!(!onset(8));
    }

    #[test]
    fn a_shortened_run_has_wider_bands() {
        let error = |by: f64, shortened: f64| {
            after(|s| {
                s["shortened"] = json!(shortened);
                s["simulations"][0]["error_within_clusters"][0]["mean"] = json!(9.0 + by);
            })
            .holds()
        };
        assert!(!error(1.5, 1.0));
        assert!(error(1.5, 10.0));
    }

    #[test]
    fn a_number_whose_own_error_is_huge_is_not_equal_to_anything() {
        let zero = |sigma: f64, error: f64| {
            after(|s| {
                s["msf"]["sigma_c"] = json!(sigma);
                s["msf"]["standard_error"] = json!(error);
            })
        };
        assert!(zero(8.171, 0.006).holds());
        // 125 ± 125 is within one of its standard errors of everything.
        for (sigma, error) in [(125.0, 125.0), (8.18, 125.0), (8.18, 1.0)] {
            let comparison = zero(sigma, error);
            assert!(!comparison.holds(), "{sigma} ± {error}");
            let cannot = comparison.lines().iter().any(|line| line.contains("cannot be judged"));
            assert!(cannot, "{:?}", comparison.lines());
        }
    }

    #[test]
    fn a_zero_that_could_not_be_refined_equals_no_other() {
        let comparison = after(|s| {
            s["msf"]["zeros"][0] =
                json!({ "sigma": 8.171, "standard_error": 0.004, "refined": false });
        });
        assert!(!comparison.holds());
        let said = comparison.lines().iter().any(|line| line.contains("could not be refined"));
        assert!(said, "{:?}", comparison.lines());
    }

    #[test]
    fn a_golden_number_that_is_not_known_judges_nothing() {
        let mut golden = summary();
        golden["msf"]["sigma_c"] = json!(125.0);
        golden["msf"]["standard_error"] = json!(125.0);
        assert!(!compare_summaries(&golden, &summary()).holds());
    }

    #[test]
    fn an_error_near_synchrony_is_judged_by_the_golden_band_alone() {
        let expected = |mean: f64, error: f64| {
            let mut summary = summary();
            let weaker = json!({ "epsilon": 2.0, "error_within_clusters": [{ "mean": mean, "standard_error": error }] });
            summary["simulations"].as_array_mut().unwrap().push(weaker);
            summary
        };
        let holds = |golden: (f64, f64), own: (f64, f64)| {
            compare_summaries(&expected(golden.0, golden.1), &expected(own.0, own.1)).holds()
        };
        assert!(holds((0.01, 0.01), (0.03, 0.02)), "bursts");
        assert!(!holds((0.01, 0.01), (5.0, 5.0)), "an error of its own that takes in everything");
        assert!(holds((1e-13, 1e-15), (3e-13, 1e-13)), "rounding");
    }

    #[test]
    fn correlations_are_judged_within_the_band_of_their_seeds() {
        let with = |pearson: f64, rand_index: f64, error: Option<f64>| {
            let mut summary = summary();
            summary["simulations"][0]["agreement"] =
                json!({ "pearson": pearson, "adjusted_rand_index": rand_index });
            if let Some(error) = error {
                summary["simulations"][0]["agreement"]["pearson_standard_error"] = json!(error);
            }
            summary
        };
        let golden = with(0.8, 1.0, None);
        assert!(compare_summaries(&golden, &with(0.81, 0.98, None)).holds());
        assert!(!compare_summaries(&golden, &with(0.7, 1.0, None)).holds());
        assert!(!compare_summaries(&golden, &with(0.8, 0.0, None)).holds());
        // Without an error in the golden output the obtained one widens the band a little only.
        assert!(compare_summaries(&golden, &with(0.75, 1.0, Some(0.5))).holds());
        assert!(!compare_summaries(&golden, &with(0.2, 1.0, Some(0.5))).holds());
        let golden = with(0.8, 1.0, Some(0.04));
        assert!(compare_summaries(&golden, &with(0.65, 1.0, Some(0.04))).holds());
    }

    #[test]
    fn a_new_key_is_mentioned_and_a_new_parameter_is_a_failure() {
        let comparison = after(|s| s["simulations"][0]["n_seeds"] = json!(4));
        assert!(comparison.holds());
        assert_eq!(comparison.lines(), ["simulations[0].n_seeds is new: not judged"]);
        assert!(!after(|s| s["experiment"]["sweep"]["kick"] = json!(0.0)).holds());
    }
}
