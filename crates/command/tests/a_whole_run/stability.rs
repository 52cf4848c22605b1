//! What is said beside the stable set: its ends, zeros that could not be refined, oscillators at rest,
//! attractors of several kinds, bounded windows and what leading modes tell of them.

use serde_json::{Value, json};

use crate::run;
use crate::support::{Answer, SIX_NODES, Toml, Workplace, tiny};

/// The tiny experiment without a sweep and its claims.
fn prediction() -> Toml {
    tiny().without_table("sweep").without_table("claims.integers")
}

fn summary(experiment: &Toml, network: &str) -> (Value, Answer) {
    let (place, answer) = run(experiment, network, 0);
    (place.json("results/tiny/summary.json"), answer)
}

#[track_caller]
fn warned(summary: &Value, about: &str) -> String {
    let warnings = summary["warnings"].as_array().unwrap();
    let found = warnings.iter().find(|warning| warning["about"] == about);
    found.unwrap_or_else(|| panic!("{about} in {warnings:?}"))["message"].as_str().unwrap().into()
}

#[test]
fn a_grid_that_starts_inside_the_stable_range_has_the_zero_below_it() {
    let experiment = prediction().set("msf.sigma", "{ from = 20.0, to = 40.0, points = 5 }");
    let (summary, _) = summary(&experiment, "1 2\n");
    let sigma_c = summary["msf"]["sigma_c"].as_f64().unwrap();
    let error = summary["msf"]["standard_error"].as_f64().unwrap();
    assert!((sigma_c - 8.17).abs() < 0.05 + 4.0 * error, "{sigma_c} ± {error}");
    let ends = &summary["msf"]["stable_ends"][0];
    assert_eq!([&ends[0]["kind"], &ends[1]["kind"]], ["zero", "looked"]);
    assert_eq!(ends[1]["sigma"], 40.0);
}

#[test]
fn a_zero_that_is_not_as_good_as_asked_is_said_beside_every_number_that_follows() {
    let claim = "[claims.edge]\nof = \"msf.sigma_c\"\nequals = 8.17\nabs_tol = 5";
    let experiment = prediction()
        .set("msf.relative_error", "1e-6")
        .set("msf.transient", "5")
        .set("msf.average", "20")
        .and(claim);
    let (summary, answer) = summary(&experiment, "1 2\n");
    assert!(warned(&summary, "msf.zeros").contains("not as good as"), "{}", answer.stderr);
    assert!(answer.stderr.contains("not as good as `msf.relative_error`"), "{}", answer.stderr);
    assert!(answer.stdout.contains("not as good as"), "{}", answer.stdout);
    for number in ["/msf/zeros/0", "/msf/stable_ends/0/0", "/critical_couplings/0", "/claims/0"] {
        assert_eq!(summary.pointer(number).unwrap()["refined"], false, "{number}");
    }
}

#[test]
fn a_zero_that_the_step_moves_is_said_to_be_no_better_than_that() {
    // Rössler x into x has its lower zero at 0.187, and at 0.169 by steps of 0.1.
    let experiment = prediction()
        .without_table("oscillator.lorenz")
        .and("[oscillator.rossler]")
        .set("coupling.to", "\"x\"")
        .set("msf.sigma", "{ from = 0.0, to = 1.0, points = 6 }")
        .set("msf.relative_error", "1e-2")
        .set("msf.step", "0.1")
        .set("msf.renormalise", "1.0")
        .set("msf.transient", "200")
        .set("msf.average", "8e3");
    let (summary, answer) = summary(&experiment, "1 2\n");
    let zero = &summary["msf"]["zeros"][0];
    let of = |key: &str| zero.pointer(key).unwrap().as_f64().unwrap();
    let off = (of("/sigma") - 0.187).abs();
    assert!(off > 0.01 && off < 3.0 * of("/standard_error"), "{zero}");
    assert_eq!(zero["refined"], false);
    let shift = [of("/step_shift/mean"), of("/step_shift/standard_error")];
    assert!(shift[0] > 0.008 && shift[0] > 3.0 * shift[1], "{zero}");
    let said = warned(&summary, "msf.zeros");
    assert!(said.contains("half of `msf.step` = 0.1 moves it by 0.01"), "{said}");
    assert!(warned(&summary, "msf.lyapunov_isolated").contains("would be better"));
    assert!(answer.stderr.contains(", and would help"), "{}", answer.stderr);
}

#[test]
fn oscillators_at_rest_synchronise_in_pieces_and_without_coupling() {
    let experiment = prediction()
        .without_table("oscillator.lorenz")
        .and("[oscillator.rossler]\na = -0.1\nb = 0.2\nc = 5.0")
        .set("coupling.to", "\"x\"")
        .set("msf.sigma", "{ from = 0.0, to = 2.0, points = 5 }")
        .set("msf.transient", "100")
        .set("msf.average", "400");
    let (summary, answer) = summary(&experiment, "1 2\n3 4\n");
    assert!(!answer.stderr.contains("no coupling synchronises"), "{}", answer.stderr);
    assert_eq!(summary["msf"]["isolated_state"], "at rest");
    assert!(warned(&summary, "msf.isolated_state").contains("even without coupling"));
    assert_eq!(summary["cascade"][0]["clusters"], json!([["1", "2", "3", "4"]]));
    let verdict = summary["global_synchrony"]["verdict"].as_str().unwrap();
    assert!(verdict.starts_with("all nodes synchronise for every ε"), "{verdict}");
}

#[test]
fn oscillators_at_rest_in_two_states_are_not_said_to_become_equal_by_themselves() {
    let experiment = prediction()
        .set("oscillator.lorenz.r", "10.0")
        .set("coupling.to", "\"x\"")
        .set("msf.sigma", "{ from = 0.0, to = 2.0, points = 3 }")
        .set("msf.transient", "100")
        .set("msf.average", "400");
    let (pieces, answer) = summary(&experiment, "1 2\n3 4\n");
    let rests = pieces["msf"]["rests"].as_array().unwrap();
    assert!(pieces["msf"]["isolated_state"] == "at rest" && rests.len() == 2, "{rests:?}");
    let message = warned(&pieces, "msf.isolated_state");
    assert!(message.contains("in 2 different states") && message.contains("same one only"));
    assert!(!answer.stdout.contains("at rest, nodes become equal"), "{}", answer.stdout);
    assert_eq!(pieces["msf"]["stable_ends"][0][0]["included"], false);
    assert_eq!(pieces["cascade"][0]["clusters"], json!([["1", "2"], ["3", "4"]]));
    let verdict = &pieces["global_synchrony"]["verdict"];
    assert_eq!(*verdict, "no ε synchronises all nodes: the network has 2 components");
    let (connected, _) = summary(&experiment, "1 2\n2 3\n");
    let verdict = connected["global_synchrony"]["verdict"].as_str().unwrap();
    let expected = "the same one of the 2 states in which isolated oscillators rest";
    assert!(verdict.contains(expected), "{verdict}");
}

#[test]
fn orbits_on_two_fixed_points_are_told_with_a_zero_for_each() {
    let experiment = prediction()
        .set("oscillator.lorenz.r", "10.0")
        .set("coupling.from", "\"z\"")
        .set("msf.sigma", "{ from = 0.0, to = 15.0, points = 4 }")
        .set("msf.transient", "100")
        .set("msf.average", "500");
    let (summary, _) = summary(&experiment, "1 2\n");
    let message = warned(&summary, "msf.attractors");
    assert!(message.contains("2 different attractors"), "{message}");
    let mut ends: Vec<f64> = summary["msf"]["attractors"]
        .as_array()
        .unwrap()
        .iter()
        .map(|attractor| attractor["stable_ends"][0][1]["sigma"].as_f64().unwrap())
        .collect();
    ends.sort_by(f64::total_cmp);
    assert!((ends[0] - 4.899).abs() < 0.2 && (ends[1] - 8.022).abs() < 0.4, "{ends:?}");
}

#[test]
fn a_grid_above_the_window_finds_it_and_one_that_finds_nothing_says_where_it_looked() {
    let above = rossler("\"auto\"").set("msf.sigma", "{ from = 10.0, to = 12.0, points = 3 }");
    let (found, answer) = summary(&above, "1 2\n2 3\n");
    let window = &found["msf"]["stable"][0];
    let [from, to] = [0, 1].map(|end| window[end].as_f64().unwrap());
    assert!((from - 0.187).abs() < 0.04 && (to - 4.61).abs() < 0.5, "{window} {}", answer.stderr);
    let verdict = found["global_synchrony"]["verdict"].as_str().unwrap();
    assert!(verdict.starts_with("all nodes synchronise for 0."), "{verdict}");
    // The smallest σ looked at is 2000 / 256 = 7.8, above the window; λ_2 = −1.
    let far = rossler("\"auto\"").set("msf.sigma", "{ from = 2000.0, to = 2400.0, points = 3 }");
    let far = far.set("msf.step", "0.0005").set("msf.transient", "20").set("msf.average", "40");
    let (nothing, _) = summary(&far, "1 2\n2 3\n");
    let verdict = nothing["global_synchrony"]["verdict"].as_str().unwrap();
    assert!(verdict.contains("sigma from 7.8") && verdict.contains("to 2400"), "{verdict}");
    let lowest = nothing["cascade"][0]["epsilon"][0].as_f64().unwrap();
    assert!((lowest - 7.8125).abs() < 1e-9, "{lowest}");
}

/// Rössler, x into x: the window is 0.187 to 4.61, a ratio of 24.7; some modes of a network.
fn rossler(modes: &str) -> Toml {
    prediction()
        .without_table("oscillator.lorenz")
        .and(&format!("[oscillator.rossler]\n\n[spectrum]\nmodes = {modes}"))
        .set("coupling.to", "\"x\"")
        .set("msf.sigma", "{ from = 0.0, to = 6.0, points = 13 }")
        .set("msf.transient", "100")
        .set("msf.average", "400")
        .set("msf.relative_error", "0.03")
}

fn ring(n_nodes: usize) -> String {
    (0..n_nodes).map(|node| format!("{node} {}\n", (node + 1) % n_nodes)).collect()
}

#[test]
fn a_bounded_window_takes_all_modes_and_has_a_verdict() {
    // A star of 40: λ_N / λ_2 = 40.
    let star: String = (1..40).map(|leaf| format!("0 {leaf}\n")).collect();
    let (narrow, _) = summary(&rossler("\"auto\""), &star);
    assert_eq!(narrow["eigenvalues"].as_array().unwrap().len(), 40);
    let verdict = narrow["global_synchrony"]["verdict"].as_str().unwrap();
    assert!(verdict.starts_with("λ_N/λ_2 = 40 exceeds the window's 2"), "{verdict}");
    assert!(verdict.ends_with(": no ε synchronises all nodes"), "{verdict}");
    // A ring of ten: λ_2 = −0.382, λ_N = −4.
    let (wide, _) = summary(&rossler("\"auto\""), &ring(10));
    let range = &wide["global_synchrony"]["epsilon"][0];
    let [from, to] = ["from", "to"].map(|end| range[end].as_f64().unwrap());
    assert!((from - 0.489).abs() < 0.1 && (to - 1.153).abs() < 0.1, "{range}");
    assert!(range["from_standard_error"].as_f64().unwrap() > 0.0);
}

#[test]
fn leading_modes_and_the_fastest_tell_what_they_can_of_a_bounded_window() {
    let (summary, _) = summary(&rossler("3"), &ring(12));
    // 4.61 / |λ_N| = 4.61 / 4: above that the fastest mode is unstable, and its cluster not known.
    let top = summary["cascade"][0]["epsilon"][1].as_f64().unwrap();
    assert!((top - 1.153).abs() < 0.1, "{top}");
    assert!(warned(&summary, "cascade").contains("nothing is predicted there"));
    let verdict = summary["global_synchrony"]["verdict"].as_str().unwrap();
    assert!(verdict.starts_with("all nodes synchronise for 0."), "{verdict}");
}

#[test]
fn an_unbounded_set_says_how_far_was_looked() {
    let (place, answer) = {
        let place = Workplace::new();
        place.write("net.edges", SIX_NODES);
        let options = ["--oscillator", "lorenz", "--coupling", "x:y", "--matrix", "laplacian"];
        let answer = place.answer(&[&["predict", "net.edges", "--quick"][..], &options].concat());
        (place, answer.with_status(0))
    };
    for expected in [
        "sigma from 0 to 4096, where a window narrower than",
        "taken to be stable beyond",
        "chaotic",
        "for ε > 4.",
    ] {
        assert!(answer.stdout.contains(expected), "{expected} in {}", answer.stdout);
    }
    let summary = place.json("results/net/summary.json");
    assert_eq!(summary["msf"]["looked"][0], 0.0);
    assert_eq!(summary["msf"]["isolated_state"], "chaotic");
}
