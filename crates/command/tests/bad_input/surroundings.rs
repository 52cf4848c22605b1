//! Files that are not there, files that clash, and slips on the command line.

use crate::check_answer;
use crate::support::{Workplace, tiny};

#[test]
fn a_missing_experiment_is_answered_with_where_to_look() {
    let place = Workplace::new();
    let answer = place.answer(&["run", "fig7.toml"]);
    check_answer(&place, answer, "fig7.toml: there is no such file", &["`eigensync list`"]);
}

#[test]
fn a_folder_in_place_of_an_experiment_is_called_one() {
    let place = Workplace::new();
    let answer = place.answer(&["run", "networks"]);
    check_answer(&place, answer, "networks: is a folder", &["`eigensync list networks`"]);
}

#[test]
fn a_name_with_line_breaks_is_shown_in_one_line() {
    let place = Workplace::new();
    let check = |text: &str| {
        let lines: Vec<&str> = text.lines().collect();
        assert!(!lines.iter().any(|line| line.starts_with("hint: rm -rf")), "{text}");
        assert!(text.contains("a\\nhint: rm -rf"), "{text}");
    };
    let name = "a\nhint: rm -rf *.toml";
    check(&place.answer(&["run", name]).with_status(2).stderr);
    place.write(name, tiny().0);
    check(&place.answer(&["run", name]).with_status(2).stderr);
    check(&place.answer(&["list", "."]).with_status(0).stdout);
    std::fs::remove_file(place.path(name)).unwrap();
    // So are names of other things: a network, a node, a title, a key.
    let label = "\"a\\nhint: rm -rf\"";
    for (key, value) in [
        ("network.file.path", label),
        ("sweep.error_to", label),
        ("sweep.\"a\\nhint: rm -rf\"", "1"),
    ] {
        place.write("tiny.toml", tiny().set(key, value).0);
        check(&place.answer(&["check", "tiny.toml"]).with_status(2).stderr);
    }
    place.write("tiny.toml", tiny().set("title", label).0);
    check(&place.answer(&["list", "."]).with_status(0).stdout);
    check(&place.answer(&["check", "tiny.toml"]).with_status(0).stdout);
}

#[test]
fn nothing_is_run_when_a_later_file_is_bad() {
    let place = Workplace::new();
    place.write("bad.toml", &tiny().set("sweep.step", "-0.01").0);
    let answer = place.answer(&["run", "tiny.toml", "bad.toml"]);
    check_answer(&place, answer, "bad.toml", &["`sweep.step` is -0.01"]);
    assert!(!place.path("results").exists());
}

#[test]
fn two_experiments_of_one_name_are_refused() {
    let place = Workplace::new();
    place.write("copies/tiny.toml", &tiny().replace("networks/", "../networks/").0);
    let answer = place.answer(&["run", "tiny.toml", "copies/tiny.toml"]);
    let expected = ["has the same name as tiny.toml", "results folder tiny", "one by one"];
    check_answer(&place, answer, "copies/tiny.toml", &expected);
}

#[test]
fn results_that_could_not_be_kept_are_refused_before_the_run() {
    let place = Workplace::new();
    place.write("taken", "a file, not a folder");
    let answer = place.answer(&["run", "tiny.toml", "--results", "taken"]);
    check_answer(&place, answer, "taken: cannot be written to", &[]);
}

#[test]
fn a_comparison_without_its_outputs_says_which_is_missing() {
    let place = Workplace::new();
    let answer = place.answer(&["compare", "--golden", "golden"]);
    check_answer(
        &place,
        answer,
        "golden: cannot be read",
        &["`cargo xtask reproduce --bless` makes"],
    );
    place.write("golden/tiny/summary.json", "{}");
    let answer = place.answer(&["compare", "tiny", "--golden", "golden"]);
    check_answer(&place, answer, "results/tiny/summary.json", &["`eigensync run` writes it"]);
    let answer = place.answer(&["compare", "tinny", "--golden", "golden"]);
    check_answer(
        &place,
        answer,
        "golden",
        &["no golden output called `tinny`", "known here: tiny"],
    );
    place.write("results/.keep", "");
    place.write("golden/tiny/summary.json", "{");
    place.write("results/tiny/summary.json", "{}");
    let answer = place.answer(&["compare", "--golden", "golden"]).with_status(2);
    assert!(answer.stderr.contains("golden/tiny/summary.json: is not JSON"), "{}", answer.stderr);
}

#[test]
fn a_slip_on_the_command_line_is_answered_with_the_usage() {
    let place = Workplace::new();
    for arguments in [&["run"][..], &["rum", "tiny.toml"], &["run", "tiny.toml", "--threads", "0"]]
    {
        let answer = place.answer(arguments).with_status(2);
        assert_eq!(answer.stdout, "");
        assert!(answer.stderr.contains("--help"), "{}", answer.stderr);
    }
}
