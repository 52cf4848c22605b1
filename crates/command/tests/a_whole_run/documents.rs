//! What programs read and shells need: `--json`, `--quiet`, networks from standard input, completions.

use serde_json::Value;

use crate::support::{SIX_NODES, Workplace, tiny};

const LORENZ: [&str; 7] =
    ["--oscillator", "lorenz", "--coupling", "x:y", "--matrix", "laplacian", "--quick"];

/// What the command prints, which must be one document.
#[track_caller]
fn document(place: &Workplace, arguments: &[&str]) -> Value {
    let answer = place.answer(arguments).with_status(0);
    serde_json::from_str(&answer.stdout)
        .unwrap_or_else(|error| panic!("{error}: {}", answer.stdout))
}

#[test]
fn every_json_is_one_document_with_the_names_of_the_summary() {
    let place = Workplace::new();
    place.write("six.edges", SIX_NODES);
    let predicted = document(&place, &[&["predict", "six.edges", "--json"], &LORENZ[..]].concat());
    assert_eq!(predicted, place.json("results/six/summary.json"));
    let curve = ["msf", "--json", "--oscillator", "lorenz", "--coupling", "x:y", "--quick"];
    let curve = document(&place, &[&curve[..], &["--sigma", "0:12:7"]].concat());
    assert_eq!(curve["msf"]["isolated_state"], "chaotic");
    assert_eq!(curve["id"], "lorenz-x-y");
    let checked = document(&place, &["check", "tiny.toml", "--json"]);
    let checked = &checked["experiments"][0];
    assert_eq!(checked["network"]["nodes"], 6);
    assert_eq!(checked["parameters"]["sweep"]["average"], 40.0);
    assert_eq!(checked["parameters"]["network"]["file"]["format"], "edge_list");
    assert!(checked["cost"]["seconds"].is_number() && checked["memory_bytes"].is_number());
    place.write("bad.toml", "title = 1");
    let listed = document(&place, &["list", ".", "--json"]);
    let [bad, good] = &listed["experiments"].as_array().unwrap()[..] else { panic!("{listed}") };
    assert!(bad["title"].is_null() && bad["problem"].is_string(), "{bad}");
    assert_eq!(good["id"], "tiny");
    assert!(good["results"].is_null() && good["running"] == false, "{good}");
    place.answer(&["run", "tiny.toml"]).with_status(0);
    assert_eq!(document(&place, &["list", ".", "--json"])["experiments"][1]["results"], "current");
    place.write("tiny.toml", tiny().set("sweep.step", "0.02").0);
    assert_eq!(document(&place, &["list", ".", "--json"])["experiments"][1]["results"], "stale");
}

#[test]
fn a_quiet_run_says_errors_and_results_alone() {
    let place = Workplace::new();
    place.write("tiny.toml", tiny().set("msf.transient", "1.0").0);
    let told = place.answer(&["run", "tiny.toml"]).with_status(0);
    assert!(told.stderr.contains("warning: tiny: "), "{}", told.stderr);
    for arguments in [["-q", "run", "tiny.toml"], ["run", "tiny.toml", "--quiet"]] {
        let quiet = place.answer(&arguments).with_status(0);
        assert_eq!(quiet.stderr, "");
        assert!(quiet.stdout.contains("1 claims hold"), "{}", quiet.stdout);
    }
    let summary = place.json("results/tiny/summary.json");
    assert!(!summary["warnings"].as_array().unwrap().is_empty(), "they stand in the results");
    let refused = place.answer(&["-q", "run", "none.toml"]).with_status(2);
    assert!(refused.stderr.starts_with("error: "), "{}", refused.stderr);
}

#[test]
fn a_network_from_standard_input_is_kept_with_the_results_and_can_be_run_again() {
    let place = Workplace::new();
    let arguments = [&["predict", "-", "--format", "edge_list"], &LORENZ[..]].concat();
    let predict = |network: &str| {
        let output = place.eigensync(&arguments).write_stdin(network).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    };
    predict(SIX_NODES);
    predict(SIX_NODES);
    let [id] = &place.names("results")[..] else { panic!("one network has one place") };
    assert!(id.starts_with("stdin-"), "{id}");
    let network = place.read(&format!("results/{id}/{id}.edges"));
    assert_eq!(network, SIX_NODES);
    let summary = place.json(&format!("results/{id}/summary.json"));
    assert_eq!(summary["provenance"]["origin"]["file"], "-");
    let experiment = format!("results/{id}/experiment.toml");
    place.answer(&["run", &experiment, "--quick", "--results", "again"]).with_status(0);
    let again = place.json("again/experiment/summary.json");
    assert_eq!(again["critical_couplings"], summary["critical_couplings"]);
    predict("1 2\n2 3\n");
    assert_eq!(place.names("results").len(), 2, "another network has another place");
    let without = place.answer(&[&["predict", "-"], &LORENZ[..]].concat()).with_status(2);
    assert!(without.stderr.contains("--format edge_list"), "{}", without.stderr);
}

#[test]
fn the_ending_of_a_network_tells_its_format_in_experiment_files_too() {
    let place = Workplace::new();
    place.write("net.mtx", "%%MatrixMarket matrix coordinate pattern symmetric\n3 3 2\n2 1\n3 2\n");
    let network = tiny().set("network.file.path", "\"net.mtx\"").without_table("sweep");
    place.write("a.toml", network.without_table("claims.integers").0);
    let checked = document(&place, &["check", "a.toml", "--json"]);
    assert_eq!(checked["experiments"][0]["network"]["links"], 2);
    let format = &checked["experiments"][0]["parameters"]["network"]["file"]["format"];
    assert_eq!(format, "matrix_market");
}

#[test]
fn shells_are_given_completions_and_manuals_a_page_for_each_command() {
    let place = Workplace::new();
    for shell in ["bash", "zsh", "fish"] {
        let script = place.answer(&["completions", shell]).with_status(0).stdout;
        assert!(script.contains("predict") && script.contains("unstable-at"), "{shell}");
    }
    place.write("man/x", "");
    place.answer(&["man", "man"]).with_status(0);
    let names = place.names("man");
    for page in ["eigensync.1", "eigensync-run.1", "eigensync-msf.1"] {
        assert!(names.iter().any(|name| name == page), "{page} among {names:?}");
    }
    assert!(place.read("man/eigensync.1").contains("Exit status"));
}
