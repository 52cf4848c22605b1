//! How each quantity of a summary is judged: exactly, within a band of standard errors, or not at all.

use serde_json::{Map, Value};

use super::{Pair, Siblings, Walk, shortening};

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

/// How a quantity is judged.
pub(super) enum Rule {
    Exact,
    /// Within this absolute distance.
    Band(f64),
    /// A difference is mentioned, and no more.
    Note,
    Ignore,
}

impl Walk<'_> {
    /// Why a number that moved is not known well enough to be compared.
    pub(super) fn unknown(
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
    pub(super) fn rule(&self, kind: &str, siblings: Siblings) -> Rule {
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
        (shortening(self.obtained) / shortening(self.expected)).sqrt().max(1.0)
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
    pub(super) fn to_an_end(&self, epsilon: f64) -> f64 {
        let swept = self.swept();
        let ends = swept.first().into_iter().chain(swept.last());
        ends.map(|end| (epsilon - end).abs()).fold(f64::INFINITY, f64::min)
    }

    /// The couplings of the sweep, ascending.
    fn swept(&self) -> Vec<f64> {
        let simulations = self.expected["simulations"].as_array();
        simulations.into_iter().flatten().filter_map(|s| s["epsilon"].as_f64()).collect()
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

pub(super) fn is_onset(kind: &str) -> bool {
    kind == "cascade[].simulated_onset.mean"
}
