//! Numbers that do not say more than is known: ends of ranges, runs that escaped, uncoupled nodes, short
//! averages, long steps, claims about nothing.

use serde_json::{Value, json};

use crate::run;
use crate::support::{Answer, SIX_NODES, Toml, Workplace, tiny};

/// Rössler oscillators coupled from x into x, whose stable window of σ is about 0.19 to 4.6.
fn rossler(epsilon: &str) -> Toml {
    tiny()
        .without_table("oscillator.lorenz")
        .and("[oscillator.rossler]")
        .set("coupling.to", "\"x\"")
        .set("msf.sigma", "{ from = 0.0, to = 8.0, points = 17 }")
        .set("msf.average", "1000")
        .set("sweep.epsilon", epsilon)
        .set("sweep.transient", "300")
        .set("sweep.average", "200")
        .without("sweep.error_to")
        .set("sweep.clusters", "[[1, 2, 3, 4, 5, 6]]")
}

fn summary(place: &Workplace) -> Value {
    place.json("results/tiny/summary.json")
}

/// The predicted state in which all six nodes are one cluster.
fn all_together(summary: &Value) -> Value {
    let all = json!([["1", "2", "3", "4", "5", "6"]]);
    let states = summary["cascade"].as_array().unwrap();
    states.iter().find(|state| state["clusters"] == all).expect("it is predicted").clone()
}

/// A warning about a key of the summary must hold these words, and stand on the terminal too.
#[track_caller]
fn check_warned(place: &Workplace, answer: &Answer, about: &str, words: &str) {
    let warnings = summary(place)["warnings"].as_array().unwrap().clone();
    let is_meant =
        |w: &&Value| w["about"] == about && w["message"].as_str().unwrap().contains(words);
    assert!(warnings.iter().any(|w| is_meant(&w)), "{about}, {words} in {warnings:#?}");
    assert!(answer.stderr.contains(words), "{words} in:\n{}", answer.stderr);
}

#[test]
fn a_state_that_is_bounded_above_is_seen_between_two_ends() {
    // λ from −2 to −6: together from ε = 0.094 to 0.77.
    let (place, answer) = run(&rossler("[0.05, 0.08, 0.3, 0.6, 1.2, 2.0]"), SIX_NODES, 0);
    let state = all_together(&summary(&place));
    let [onset, end] = ["simulated_onset", "simulated_end"].map(|key| state[key].clone());
    assert_eq!([&onset["bound"], &end["bound"]], ["measured"; 2], "{state}");
    let near = |value: &Value, expected: f64| (value.as_f64().unwrap() - expected).abs() < 1e-9;
    assert!(near(&onset["mean"], 0.19) && near(&onset["half_step"], 0.11), "{onset}");
    assert!(near(&end["mean"], 0.9) && near(&end["half_step"], 0.3), "{end}");
    assert!(answer.stdout.contains("0.19 ± 0.11"), "{}", answer.stdout);
    assert!(answer.stdout.contains("0.9 ± 0.3"), "{}", answer.stdout);
}

#[test]
fn an_onset_at_the_first_point_of_a_sweep_is_a_bound_everywhere() {
    let clusters = "where = { clusters = [[1, 2, 3, 4, 5, 6]] }";
    let claim = |name: &str, of: &str| {
        format!("[claims.{name}]\nof = \"simulated.onset\"\n{clusters}\n{of}")
    };
    let experiment = rossler("[0.3, 0.4]")
        .and(&claim("near", "equals = 0.2\nabs_tol = 0.2"))
        .and(&claim("most", "at_most = 0.3"))
        .and(&claim("less", "at_most = 0.2"))
        .and(&claim("more", "at_least = 0.35"))
        .and(
            "[claims.order]\nof = \"simulated.order_of_loss\"\nequals = [1, 2]\n\
             where = { clusters = [[1, 2, 6], [3, 4, 5]] }",
        );
    let (place, answer) = run(&experiment, SIX_NODES, 1);
    let summary = summary(&place);
    let onset = &all_together(&summary)["simulated_onset"];
    assert_eq!((&onset["bound"], &onset["limit"]), (&json!("at_most"), &json!(0.3)));
    assert!(onset["mean"].is_null(), "{onset}");
    let claims = summary["claims"].as_array().unwrap();
    let verdicts: Vec<&Value> = claims[1..].iter().map(|claim| &claim["verdict"]).collect();
    let undecided = "cannot be judged";
    assert_eq!(verdicts, [undecided, "holds", undecided, "differs", undecided], "{claims:#?}");
    assert_eq!(claims[1]["obtained"], "at most 0.3");
    for words in ["at most 0.3", "at least 0.4", "1 differ, 3 cannot be judged"] {
        assert!(answer.stdout.contains(words), "{words} in:\n{}", answer.stdout);
    }
}

#[test]
fn a_state_outside_the_sweep_has_no_ends() {
    let (place, answer) = run(&rossler("[0.02, 0.03]"), SIX_NODES, 0);
    let state = all_together(&summary(&place));
    for key in ["simulated_onset", "simulated_end"] {
        assert_eq!(state[key]["bound"], "not_swept", "{state}");
        assert!(state[key]["mean"].is_null() && state[key]["limit"].is_null(), "{state}");
    }
    assert!(answer.stdout.contains("not swept"), "{}", answer.stdout);
}

#[test]
fn runs_that_escaped_are_told_beside_the_state_and_in_the_figure() {
    let (place, answer) = run(&rossler("[0.3, 0.6, 4.0, 20.0]"), SIX_NODES, 0);
    check_warned(&place, &answer, "simulations", "at epsilon = 4 to 20 all 2 runs escaped");
    let summary = summary(&place);
    assert_eq!(summary["simulations"][0]["n_seeds"], 2);
    assert_eq!(summary["simulations"][0]["error_within_clusters"][0]["n_seeds"], 2);
    assert_eq!(summary["simulations"][3]["n_seeds"], 0);
    let state = all_together(&summary);
    assert_eq!(state["simulated_runs"], json!({ "runs": 4, "escaped": 0 }));
    assert_eq!(state["simulated_end"]["n_escaped"], 2, "it ends because runs escape: {state}");
    let escaped = summary["cascade"]
        .as_array()
        .unwrap()
        .iter()
        .map(|state| state["simulated_runs"]["escaped"].as_u64().unwrap());
    assert_eq!(escaped.sum::<u64>(), 4);
    assert!(place.read("results/tiny/figure.svg").contains("2 of 2 runs escaped"));
}

#[test]
fn matrices_that_were_not_computed_say_so_and_are_not_zeros() {
    // Two modes of Lorenz' network tell the states above ε = 2.7 only; x into y loses all at once below.
    let experiment = tiny()
        .and("[spectrum]\nmodes = 2")
        .and("[figure]\nkind = \"matrices\"\neigenvectors = [1, 2]")
        .set("sweep.epsilon", "[0.0, 1.0, 5.0]")
        .without_table("claims.integers");
    let (place, _) = run(&experiment, SIX_NODES, 0);
    let svg = place.read("results/tiny/figure.svg");
    assert!(svg.contains("not predicted") && svg.contains("uncoupled"), "words in the figure");
    let escaped = rossler("[0.4, 20.0]").and("[figure]\nkind = \"matrices\"");
    let (place, _) = run(&escaped, SIX_NODES, 0);
    assert!(place.read("results/tiny/figure.svg").contains("all runs escaped"));
}

#[test]
fn nodes_at_rest_or_without_coupling_are_not_called_synchronised() {
    let experiment = rossler("[0.0, 0.5]")
        .without_table("oscillator.rossler")
        .and("[oscillator.rossler]\na = -0.1\nb = 0.2\nc = 5.0");
    let (place, answer) = run(&experiment, SIX_NODES, 0);
    check_warned(&place, &answer, "simulations", "comes to rest in the same");
    check_warned(&place, &answer, "simulations", "15 of 15 pairs have errors below");
    let summary = summary(&place);
    assert_eq!(summary["simulations"][0]["clusters"], json!([]));
    let onset = &all_together(&summary)["simulated_onset"];
    assert_eq!((&onset["bound"], &onset["limit"]), (&json!("at_most"), &json!(0.5)));
}

#[test]
fn averages_shorter_than_the_slow_time_are_warned_of() {
    let neurons = |average: &str| {
        tiny()
            .without_table("oscillator.lorenz")
            .and("[oscillator.hindmarsh_rose]")
            .set("coupling.to", "\"x\"")
            .set("msf.average", "1000")
            .set("msf.transient", "300")
            .set("sweep.epsilon", "[0.1]")
            .set("sweep.transient", "300")
            .set("sweep.average", average)
    };
    let (place, answer) = run(&neurons("5.0"), SIX_NODES, 0);
    check_warned(
        &place,
        &answer,
        "experiment.sweep.average",
        "`sweep.average` is 5, but an isolated",
    );
    let (_, answer) = run(&neurons("2000.0"), SIX_NODES, 0);
    assert!(!answer.stderr.contains("`sweep.average` is"), "{}", answer.stderr);
}

#[test]
fn what_the_step_does_to_errors_is_estimated_at_two_couplings() {
    let experiment = tiny().set("sweep.average", "200").set("sweep.epsilon", "[1.0, 2.0, 5.0]");
    let (place, answer) = run(&experiment, SIX_NODES, 0);
    let effects = summary(&place)["simulations_step_effect"].clone();
    let epsilon = |at: usize| effects[at]["epsilon"].as_f64();
    assert_eq!([epsilon(0), epsilon(1)], [Some(2.0), Some(5.0)], "{effects}");
    for effect in effects.as_array().unwrap() {
        assert_eq!(effect["n_seeds"], 6, "{effect}");
        let [ratio, error] =
            ["log_ratio", "standard_error"].map(|key| effect[key].as_f64().unwrap().abs());
        assert!(ratio < 5.0 * error, "a step of 0.01 is short for Lorenz: {effect}");
    }
    assert!(!answer.stderr.contains("changes what is simulated"), "{}", answer.stderr);
}

/// Ten neurons in a row, y into x: bounded at steps of 0.05 and 0.025, and lost by one of 0.1.
#[test]
fn runs_that_escape_by_the_step_alone_are_told() {
    let experiment = tiny()
        .without_table("oscillator.lorenz")
        .and("[oscillator.hindmarsh_rose]")
        .set("coupling.from", "\"y\"")
        .set("coupling.to", "\"x\"")
        .set("msf.sigma", "{ from = 0.0, to = 2.0, points = 5 }")
        .set("msf.average", "400")
        .set("msf.relative_error", "0.5")
        .set("sweep.epsilon", "[0.5, 1.0]")
        .set("sweep.step", "0.1")
        .set("sweep.transient", "300")
        .set("sweep.average", "300")
        .without("sweep.error_to")
        .without("sweep.clusters")
        .without_table("claims.integers");
    let path: String = (1..10).map(|k| format!("{k} {}\n", k + 1)).collect();
    let (place, answer) = run(&experiment, &path, 0);
    check_warned(
        &place,
        &answer,
        "simulations_step_effect",
        "at epsilon = 1 the step of 0.1 changes what is simulated: 6 of 6 runs escaped, but 0 at half",
    );
    assert_eq!(summary(&place)["simulations"][1]["outcome"], "escaped");
    let looked = "half the step of 0.1 was tried at epsilon = 0.5 (errors ";
    assert!(answer.stderr.contains(looked), "{}", answer.stderr);
    assert!(answer.stderr.contains("; at no other epsilon"), "{}", answer.stderr);
}

#[test]
fn claims_about_nothing_are_refused() {
    let refused = |claim: &str, words: &str| {
        let place = Workplace::new();
        place.write("tiny.toml", tiny().and(claim).0);
        let answer = place.answer(&["check", "tiny.toml"]).with_status(2);
        assert!(answer.stderr.contains(words), "{words} in:\n{}", answer.stderr);
    };
    refused("[claims.none]\nof = \"eigenvalues\"\nequals = []", "is an empty list");
    refused(
        "[claims.one]\nof = \"cascade.order_of_loss\"\nwhere.clusters = [[1, 2]]\nequals = [1]",
        "an order needs two or more",
    );
    refused(
        "[claims.prefix]\nof = \"network.nodes\"\nwhere.group_prefix = \"Z\"\nat_most = 5",
        "with which no group begins",
    );
    refused(
        "[claims.zero]\nof = \"eigenvectors\"\nwhere.modes = [2]\nequals = [[0, 0, 0, 0, 0, 0]]\nabs_tol = 1",
        "has no direction",
    );
}
