//! Results against golden outputs: whatever moved is named, with what was expected, obtained, allowed.

use serde_json::{Value, json};

use crate::run;
use crate::support::{SIX_NODES, Workplace, tiny};

/// The tiny experiment with its results as golden outputs.
fn with_golden() -> Workplace {
    let (place, _) = run(&tiny(), SIX_NODES, 0);
    place.write("golden/tiny/summary.json", place.read("results/tiny/summary.json"));
    place
}

/// A command must end with status 1 and a line with these pieces.
#[track_caller]
fn check_moved(place: &Workplace, arguments: &[&str], expected: &[&str]) {
    let arguments = [arguments, &["--golden", "golden"]].concat();
    let answer = place.answer(&arguments).with_status(1);
    // A long line is continued on an indented one.
    let said = answer.stdout.replace("\n    ", " ");
    let has_all = |line: &str| expected.iter().all(|piece| line.contains(piece));
    assert!(said.lines().any(has_all), "{expected:?} in:\n{said}");
    assert!(said.contains("the golden output differs: tiny in "), "{said}");
}

#[test]
fn a_run_agrees_with_its_own_golden_output() {
    let place = with_golden();
    for arguments in [&["compare"][..], &["compare", "tiny"], &["run", "tiny.toml"]] {
        let answer = place.answer(&[arguments, &["--golden", "golden"]].concat()).with_status(0);
        assert!(answer.stdout.contains("the golden output holds\n"), "{}", answer.stdout);
        assert!(!answer.stdout.contains("tiny: "), "no value differs:\n{}", answer.stdout);
    }
}

#[test]
fn a_digit_changed_in_a_golden_eigenvalue_is_named() {
    let place = with_golden();
    let mut golden = place.json("golden/tiny/summary.json");
    golden["eigenvalues"][3] = json!(-4.000_001);
    place.write("golden/tiny/summary.json", golden.to_string());
    let line = ["eigenvalues[3]: expected -4.000001, obtained -4", ", allowed ± 6.00e-9"];
    check_moved(&place, &["compare"], &line);
}

#[test]
fn a_digit_changed_in_a_golden_error_or_a_golden_cluster_is_named() {
    let place = with_golden();
    let golden = place.json("golden/tiny/summary.json");
    let after = |pointer: &str, value: Value| {
        let mut changed = golden.clone();
        *changed.pointer_mut(pointer).unwrap_or_else(|| panic!("{pointer}")) = value;
        place.write("golden/tiny/summary.json", changed.to_string());
    };
    after("/simulations/0/error_to_reference/0/mean", json!(99.0));
    let line =
        ["simulations[0].error_to_reference[0].mean: expected 99.0, obtained ", "allowed ± "];
    check_moved(&place, &["compare"], &line);
    after("/cascade/1/clusters/0/1", json!("5"));
    let line = ["cascade[1].clusters[0][1]: expected \"5\", obtained \"2\", allowed none"];
    check_moved(&place, &["compare"], &line);
}

#[test]
fn a_digit_changed_in_the_experiment_is_named() {
    let place = with_golden();
    place.write("tiny.toml", tiny().set("sweep.step", "0.02").0);
    let line = ["experiment.sweep.step: expected 0.01, obtained 0.02, allowed none"];
    check_moved(&place, &["run", "tiny.toml"], &line);
    place.write("tiny.toml", tiny().set("oscillator.lorenz.r", "36.0").0);
    let line = ["experiment.oscillator.lorenz.r: expected 35.0, obtained 36.0, allowed none"];
    check_moved(&place, &["run", "tiny.toml"], &line);
}

#[test]
fn a_digit_changed_in_the_network_is_named() {
    let place = with_golden();
    place.write("networks/six-node.edges", SIX_NODES.replace("2 6 1.5", "2 6 1.6"));
    check_moved(&place, &["run", "tiny.toml"], &["eigenvalues[5]: expected -6", "allowed ± "]);
    place.write("networks/six-node.edges", SIX_NODES.replace("1 4\n", ""));
    check_moved(&place, &["run", "tiny.toml"], &["network.links: expected 9, obtained 8"]);
}
