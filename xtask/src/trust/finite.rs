//! Whether every number of a `summary.json` is one. JSON has no NaN: what is none is written as null,
//! and so is what `results/README.md` says to be unknown or not to exist. Only there it may stand. No
//! number is written as text: a text is a label, a name or a sentence, and a node may be called `NaN`.

use serde_json::Value;

/// Tables that repeat what the file says, where keys without effect are null.
const OF_THE_FILE: [&str; 2] = ["experiment.", "parameters."];

/// Keys at which there may be no number; `[]` is any position in a list.
const MAY_BE_NULL: [&str; 29] = [
    // A look that ends stable; a stable set that is not σ > σ_c.
    "msf.stable[][1]",
    "msf.sigma_c",
    "msf.standard_error",
    "msf.confidence_interval",
    // A mode that no coupling stabilises.
    "critical_couplings[].epsilon",
    "critical_couplings[].standard_error",
    // Without links or λ_N, or without an end that is a zero.
    "global_synchrony.eigenratio",
    "global_synchrony.window_ratios[]",
    "global_synchrony.epsilon[].from_standard_error",
    "global_synchrony.epsilon[].to",
    "global_synchrony.epsilon[].to_standard_error",
    // A range without an upper end, a cluster too large to be judged, an end that was not measured.
    "cascade[].epsilon[1]",
    "cascade[].labels[].exceeds_threshold",
    "cascade[].simulated_onset.mean",
    "cascade[].simulated_onset.spread",
    "cascade[].simulated_onset.of_seeds[]",
    "cascade[].simulated_end.mean",
    "cascade[].simulated_end.spread",
    "cascade[].simulated_end.of_seeds[]",
    // Runs that all escaped, a coupling of 0, too few of them for an error.
    "simulations[].clusters",
    "simulations[].error_to_reference[]",
    "simulations[].error_within_clusters[]",
    "simulations[].agreement.regions.adjusted_rand_index",
    "simulations_step_effect[].error",
    "simulations_step_effect[].log_ratio",
    "simulations_step_effect[].standard_error",
    // Nothing of which a claim could hold.
    "claims[].obtained",
    "claims[].obtained[]",
    // A system that does not say.
    "provenance.peak_memory_bytes",
];

/// Tables all of whose numbers may be missing: agreement of runs that all escaped, of pairs that are
/// all alike, or of a single seed; what is said of regions is a table of its own.
const AGREEMENT: &str = "simulations[].agreement.";

/// The first key that has no finite number where there should be one.
pub fn first_that_is_not(summary: &Value) -> Option<String> {
    first(summary, "")
}

fn first(value: &Value, key: &str) -> Option<String> {
    let is_none = match value {
        Value::Object(all) => {
            let dot = if key.is_empty() { "" } else { "." };
            return all.iter().find_map(|(name, value)| first(value, &format!("{key}{dot}{name}")));
        }
        Value::Array(all) => {
            let mut all = all.iter().enumerate();
            return all.find_map(|(k, value)| first(value, &format!("{key}[{k}]")));
        }
        Value::Null => !may_be_null(key),
        Value::Number(number) => number.as_f64().is_some_and(|number| !number.is_finite()),
        Value::Bool(_) | Value::String(_) => false,
    };
    is_none.then(|| key.to_owned())
}

fn may_be_null(key: &str) -> bool {
    OF_THE_FILE.iter().any(|table| key.starts_with(table))
        || MAY_BE_NULL.iter().any(|known| is_at(known, key))
        || key.rsplit_once('.').is_some_and(|(table, _)| is_at(AGREEMENT, &format!("{table}.")))
}

/// Whether a key is the known one, with any position where that leaves it open.
fn is_at(known: &str, key: &str) -> bool {
    let (known, key): (Vec<_>, Vec<_>) = (known.split('[').collect(), key.split('[').collect());
    let is_same = |(known, key): (&&str, &&str)| {
        let after = key.split_once(']').map(|(_, after)| after);
        known == key || known.strip_prefix(']').is_some_and(|rest| after == Some(rest))
    };
    known.len() == key.len() && known.iter().zip(&key).all(is_same)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_null_is_a_fault_where_a_number_belongs_and_none_where_there_may_be_none() {
        let first = |summary: Value| first_that_is_not(&summary);
        assert_eq!(first(json!({ "cascade": [{ "epsilon": [0.5, null] }] })), None);
        assert_eq!(
            first(json!({ "cascade": [{ "epsilon": [null, 1.0] }] })),
            Some("cascade[0].epsilon[0]".into())
        );
        assert_eq!(first(json!({ "eigenvalues": [0, null] })), Some("eigenvalues[1]".into()));
        assert_eq!(first(json!({ "experiment": { "sweep": { "tolerance": null } } })), None);
        assert_eq!(first(json!({ "simulations": [{ "agreement": { "pearson": null } }] })), None);
        assert_eq!(
            first(json!({ "simulations": [{ "error_to_reference": [{ "mean": null }] }] })),
            Some("simulations[0].error_to_reference[0].mean".into())
        );
        assert_eq!(
            first(json!({ "msf": { "lyapunov_isolated": null } })),
            Some("msf.lyapunov_isolated".into())
        );
    }

    #[test]
    fn a_node_may_have_the_name_of_what_is_no_number() {
        let first = |summary: Value| first_that_is_not(&summary);
        let labels = json!([["-inf", "a"], ["NaN", "inf"]]);
        assert_eq!(
            first(json!({ "cascade": [{ "epsilon": [0.5, 1.0], "clusters": labels }] })),
            None
        );
        assert_eq!(first(json!({ "experiment": { "sweep": { "error_to": "-inf" } } })), None);
        assert_eq!(
            first(json!({ "cascade": [{ "clusters": labels, "n_alone": null }] })),
            Some("cascade[0].n_alone".into())
        );
    }
}
