//! Networks in pieces, networks of two nodes, and orbits that escape: answered with results.

use serde_json::{Value, json};

use crate::run;
use crate::support::{SIX_NODES, Toml, tiny};

/// Where in a summary there is no number though a number is expected.
fn nulls(path: &str, value: &Value, found: &mut Vec<String>) {
    match value {
        Value::Null => found.push(path.to_owned()),
        Value::Array(list) => {
            list.iter().for_each(|value| nulls(&format!("{path}[]"), value, found));
        }
        Value::Object(keys) => {
            keys.iter().for_each(|(key, value)| nulls(&format!("{path}.{key}"), value, found));
        }
        _ => {}
    }
}

#[test]
fn a_disconnected_network_is_warned_of_and_never_predicted_to_synchronise() {
    let experiment = tiny().without("sweep.clusters").without_table("claims.integers");
    let (place, answer) = run(&experiment, "1 2\n3 4\n5\n6\n", 0);
    assert!(answer.stderr.contains("warning: tiny: 2 of 6 nodes have no links (5, 6)"));
    assert!(
        answer.stderr.contains("4 components, so 4 modes have eigenvalue 0"),
        "{}",
        answer.stderr
    );
    let summary = place.json("results/tiny/summary.json");
    let cascade = summary["cascade"].as_array().unwrap();
    assert_eq!(cascade[0]["clusters"], json!([["1", "2"], ["3", "4"]]));
    // The coupling at which a mode of eigenvalue zero is damped does not exist.
    for critical in summary["critical_couplings"].as_array().unwrap() {
        let is_zero = critical["lambda"].as_f64().unwrap().abs() < 1e-9;
        assert_eq!(critical["epsilon"].is_null(), is_zero, "{critical}");
    }
}

#[test]
fn nodes_without_links_at_all_are_simulated_as_they_are() {
    let experiment = tiny().without("sweep.clusters").without_table("claims.integers");
    let (place, _) = run(&experiment, "1\n2\n", 0);
    let summary = place.json("results/tiny/summary.json");
    assert_eq!(summary["eigenvalues"], json!([0.0, 0.0]));
    assert!(
        summary["cascade"].as_array().unwrap().iter().all(|state| state["clusters"] == json!([]))
    );
    for simulation in summary["simulations"].as_array().unwrap() {
        assert_eq!(simulation["clusters"], json!([]), "{simulation}");
    }
}

#[test]
fn two_nodes_synchronise_where_one_mode_of_eigenvalue_minus_2_is_damped() {
    let experiment = tiny()
        .set("sweep.clusters", "[[1, 2]]")
        .set("sweep.epsilon", "[1.0, 6.0]")
        .set("claims.integers.equals", "[0, -2]");
    let (place, _) = run(&experiment, "1 2\n", 0);
    let summary = place.json("results/tiny/summary.json");
    let sigma_c = summary["msf"]["sigma_c"].as_f64().unwrap();
    let epsilon = summary["critical_couplings"][0]["epsilon"].as_f64().unwrap();
    assert!((epsilon - sigma_c / 2.0).abs() < 1e-9, "{epsilon} against {sigma_c} / 2");
    let clusters = |at: usize| summary["simulations"][at]["clusters"].clone();
    assert_eq!([clusters(0), clusters(1)], [json!([]), json!([["1", "2"]])]);
}

/// Rössler oscillators coupled from x into x, which escape when coupled so strongly that the fastest
/// mode leaves the bounded stable set at its upper end.
fn rossler(epsilon: &str) -> Toml {
    tiny()
        .without_table("oscillator.lorenz")
        .and("[oscillator.rossler]")
        .set("coupling.to", "\"x\"")
        .set("msf.sigma", "{ from = 0.0, to = 8.0, points = 9 }")
        .set("sweep.epsilon", epsilon)
        .set("sweep.transient", "200")
}

#[test]
fn runs_that_escape_are_an_outcome_and_not_a_failure() {
    let (place, answer) = run(&rossler("[0.4, 20.0]"), SIX_NODES, 0);
    assert!(answer.stdout.contains("1 claims hold"), "{}", answer.stdout);
    let summary = place.json("results/tiny/summary.json");
    let outcome = |at: usize| summary["simulations"][at]["outcome"].as_str().unwrap().to_owned();
    assert_eq!([outcome(0), outcome(1)], ["completed", "escaped"]);
    let mut found = Vec::new();
    nulls("", &summary["simulations"][0], &mut found);
    assert_eq!(found, Vec::<String>::new(), "a completed run has all its numbers");
    let sweep = place.read("results/tiny/sweep.csv");
    assert_eq!(sweep.lines().filter(|line| line.contains("escaped at ")).count(), 2, "{sweep}");
    assert!(!sweep.contains("NaN") && !sweep.contains("inf"), "{sweep}");
}

#[test]
fn a_sweep_that_escapes_throughout_still_has_results_and_a_figure() {
    for scale in ["linear", "log"] {
        let figure = format!("[figure]\nerror_scale = \"{scale}\"");
        let (place, _) = run(&rossler("[20.0]").and(&figure), SIX_NODES, 0);
        let summary = place.json("results/tiny/summary.json");
        assert_eq!(summary["simulations"][0]["outcome"], "escaped");
        assert!(summary["simulations"][0]["clusters"].is_null());
        assert!(place.path("results/tiny/figure.png").exists());
    }
}

#[test]
fn a_claim_about_what_escaped_cannot_be_judged() {
    let claim = "[claims.clusters]\nof = \"simulated.clusters\"\nwhere.epsilon = 20.0\nequals = []";
    let (place, _) = run(&rossler("[20.0]").and(claim), SIX_NODES, 1);
    let claims = place.json("results/tiny/summary.json")["claims"].clone();
    assert_eq!([&claims[0]["verdict"], &claims[1]["verdict"]], ["holds", "cannot be judged"]);
    assert_eq!(claims[1]["reason"], "at epsilon = 20 2 of 2 runs escaped");
    assert!(claims[1]["obtained"].is_null());
}
