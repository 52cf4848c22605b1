//! `eigensync predict`: a network file and a few options instead of an experiment file.

use crate::support::{SIX_NODES, Workplace};

const LORENZ: [&str; 6] = ["--oscillator", "lorenz", "--coupling", "x:y", "--matrix", "laplacian"];

/// Predicts for a file with more options.
fn predict(place: &Workplace, network: &str, options: &[&str], status: i32) -> (String, String) {
    let arguments = [&["predict", network], options].concat();
    let answer = place.answer(&arguments).with_status(status);
    (answer.stdout, answer.stderr)
}

fn with_network() -> Workplace {
    let place = Workplace::new();
    place.write("six.edges", SIX_NODES);
    place
}

#[test]
fn a_network_alone_is_predicted_in_words_and_in_a_results_folder() {
    let place = with_network();
    let (said, _) = predict(&place, "six.edges", &[&LORENZ[..], &["--quick"]].concat(), 0);
    for expected in ["6 nodes, 9 links, connected", "-2, -3, -4, -5, -6", "sigma > 8.", "3 + 3"] {
        assert!(said.contains(expected), "{expected} in:\n{said}");
    }
    let summary = place.json("results/six/summary.json");
    // ε_2 = σ_c / 2, with σ_c = 8.17.
    let first = summary["critical_couplings"][0]["epsilon"].as_f64().unwrap();
    assert!((first - 8.17 / 2.0).abs() < 0.1, "{first}");
    assert_eq!(summary["cascade"][1]["n_clusters"], 2);
}

#[test]
fn a_prediction_leaves_the_experiment_file_that_says_the_same() {
    let place = with_network();
    predict(&place, "six.edges", &[&LORENZ[..], &["--quick"]].concat(), 0);
    let repeated = ["run", "results/six/experiment.toml", "--quick", "--results", "again"];
    place.answer(&repeated).with_status(0);
    let of = |path: &str| place.json(path)["critical_couplings"].clone();
    assert_eq!(of("results/six/summary.json"), of("again/experiment/summary.json"));
}

#[test]
fn modes_unstable_at_a_coupling_carry_the_cascade_down_to_it() {
    let place = with_network();
    // λ = −2 and −3 lie above −8.17 / 2.5, λ = −4 does not.
    let options = [&LORENZ[..], &["--quick", "--unstable-at", "2.5"]].concat();
    let (said, _) = predict(&place, "six.edges", &options, 0);
    assert!(said.contains("The states end at epsilon = 2.5, down to which"), "{said}");
    let summary = place.json("results/six/summary.json");
    let eigenvalues = summary["eigenvalues"].as_array().unwrap();
    assert_eq!(eigenvalues.len(), 3);
    let last = summary["cascade"].as_array().unwrap().last().unwrap().clone();
    assert!((last["epsilon"][0].as_f64().unwrap() - 2.5).abs() < 1e-9, "{last}");
    assert_eq!(last["unstable_modes"], serde_json::json!([2, 3]));
}

#[test]
fn modes_unstable_at_a_coupling_tell_what_they_can_where_the_stable_set_ends() {
    let place = with_network();
    // λ = −2 and −3 lie above −0.187 / 0.05; λ_6 = −6 leaves the set above 4.61 / 6 = 0.77.
    let rossler = ["--oscillator", "rossler", "--coupling", "x:x", "--matrix", "laplacian"];
    let options = [&rossler[..], &["--quick", "--unstable-at", "0.05"]].concat();
    let (_, said) = predict(&place, "six.edges", &options, 0);
    assert!(said.contains("above epsilon = 0.76"), "{said}");
    let summary = place.json("results/six/summary.json");
    let first = &summary["cascade"][0];
    assert!((first["epsilon"][1].as_f64().unwrap() - 0.768).abs() < 0.01, "{first}");
    assert_eq!(first["n_clusters"], 1);
}

#[test]
fn options_that_make_no_sense_are_answered_with_what_there_is() {
    let place = with_network();
    let refused = |network: &str, options: &[&str], expected: &[&str]| {
        let (_, said) = predict(&place, network, options, 2);
        for expected in expected {
            assert!(said.contains(expected), "{expected} in:\n{said}");
        }
    };
    refused("six.edges", &["--oscillator", "lorens", "--coupling", "x:y"], &["`lorenz`?"]);
    refused("six.edges", &["--oscillator", "lorenz:q=1", "--coupling", "x:y"], &["`q`", "`alpha`"]);
    refused("six.edges", &["--oscillator", "lorenz:r", "--coupling", "x:y"], &["such as r=35"]);
    refused("six.edges", &["--oscillator", "lorenz", "--coupling", "x"], &["such as x:y"]);
    refused("six.edges", &["--oscillator", "lorenz", "--coupling", "x:w"], &["\"w\"", "x, y, z"]);
    refused("none.edges", &LORENZ, &["none.edges", "cannot be opened"]);
    place.write("six.links", SIX_NODES);
    refused("six.links", &LORENZ, &["\".links\"", "--format edge_list"]);
    place.write("directed.csv", "0,1\n0,0\n");
    refused("directed.csv", &LORENZ, &["directed", "prepare"]);
}

#[test]
fn steps_of_preparation_and_a_format_can_be_named() {
    let place = Workplace::new();
    place.write("matrix", "0 1 0\n1 0 0\n0 0 0\n");
    let options = [&LORENZ[..], &["--quick", "--format", "dense"]].concat();
    let prepared = [&options[..], &["--prepare", "largest_component,symmetrise=mean"]].concat();
    let (said, _) = predict(&place, "matrix", &prepared, 0);
    assert!(said.contains("2 nodes, 1 links, connected"), "{said}");
}

/// Two logistic maps, of which Λ(σ) = ln|1 − σ| + ln 2 vanishes at 1/2 and 3/2.
const LOGISTIC: [&str; 6] =
    ["--oscillator", "logistic", "--coupling", "x:x", "--matrix", "laplacian"];

#[test]
fn a_first_answer_comes_before_the_whole_one() {
    let place = with_network();
    let (said, told) = predict(&place, "six.edges", &LOGISTIC, 0);
    let (first, rest) = told.split_once("first answer").unwrap_or_else(|| panic!("{told}"));
    assert!(!first.contains("sigma"), "{told}");
    assert!(rest.contains("stable for") && rest.contains("now to 0.001"), "{told}");
    assert!(said.contains("stable for") && !said.contains("first answer"), "{said}");
    let zeros = place.json("results/six/summary.json")["msf"]["zeros"].clone();
    for (zero, exact) in zeros.as_array().unwrap().iter().zip([0.5, 1.5]) {
        let [sigma, error] = ["sigma", "standard_error"].map(|key| zero[key].as_f64().unwrap());
        assert!(error <= 1e-3 * exact && (sigma - exact).abs() < 4.0 * error, "{zero}");
    }
}

#[test]
fn curves_are_taken_from_the_cache_and_computed_again_where_it_is_damaged() {
    let place = with_network();
    let cache = place.path("cache");
    let predicted = |options: &[&str]| {
        let arguments = [&["predict", "six.edges"], &LOGISTIC[..], options].concat();
        let mut command = place.eigensync(&arguments);
        let output = command.env("EIGENSYNC_CACHE", &cache).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        place.json("results/six/summary.json")["msf"].clone()
    };
    let first = predicted(&["--no-cache"]);
    assert!(place.names("cache").is_empty(), "nothing is left where none is wanted");
    assert_eq!(predicted(&[]), first);
    let names = place.names("cache");
    assert_eq!(names.len(), 2, "a curve of each answer: {names:?}");
    let written = |name: &str| cache.join(name).metadata().unwrap().modified().unwrap();
    let before: Vec<_> = names.iter().map(|name| written(name)).collect();
    assert_eq!(predicted(&[]), first);
    let after: Vec<_> = names.iter().map(|name| written(name)).collect();
    assert_eq!(before, after, "they were taken");
    for name in &names {
        place.write(&format!("cache/{name}"), b"damaged");
    }
    assert_eq!(predicted(&[]), first);
    assert!(names.iter().all(|name| place.read_lossy(&format!("cache/{name}")) != "damaged"));
    assert_eq!(predicted(&["--fresh"]), first);
}
