//! How each quantity of a summary is judged: exactly, within a band of standard errors, or not at all.

use serde_json::{Map, Value};

use crate::both::{Both, GROWTH, Pair, Siblings};

/// Width of a band in standard errors.
const BANDS: f64 = 5.0;
/// Relative accuracy of eigenvalues across solvers and machines.
const EIGENVALUES: f64 = 1e-9;
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

/// What the kinds of an atlas begin with; its curves are judged as those of experiments.
pub const ATLAS: &str = "atlas[].";

/// How a quantity is judged.
pub enum Rule {
    Exact,
    /// Within this absolute distance.
    Band(f64),
    /// A difference is mentioned, and no more.
    Note,
    Ignore,
}

impl Both<'_> {
    /// Why a number that moved is not known well enough to be compared.
    pub fn unknown(
        &self,
        kind: &str,
        [expected, obtained]: Pair,
        siblings: Siblings,
    ) -> Option<String> {
        let kind = kind.strip_prefix(ATLAS).unwrap_or(kind);
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

    /// The rule for a kind of quantity, with bands from the standard errors beside it.
    pub fn rule(&self, kind: &str, siblings: Siblings) -> Rule {
        let kind = kind.strip_prefix(ATLAS).unwrap_or(kind);
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
            "msf.stable[][]" => Rule::Band(BANDS * self.largest_zero_error(siblings)),
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
            // Few and short runs, for warnings only; and which step was chosen, which shows in its numbers.
            _ if kind.starts_with("simulations_step") => Rule::Note,
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
            _ if kind.starts_with("msf.rests")
                || kind == "msf.looked_between"
                || kind.starts_with("msf.doubtful")
                || kind.contains("step_shift") =>
            {
                Rule::Note
            }
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

pub fn is_onset(kind: &str) -> bool {
    kind == "cascade[].simulated_onset.mean"
}
