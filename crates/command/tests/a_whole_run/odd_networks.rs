//! Networks that are not what most are, through `eigensync predict`: each is answered with a result or
//! with what would be one.

use serde_json::{Value, json};

use crate::support::{Answer, Workplace};

/// The answer to a prediction for a network file with more options.
fn answer(place: &Workplace, file: &str, options: &[&str], status: i32) -> Answer {
    let lorenz = ["--oscillator", "lorenz", "--coupling", "x:y", "--quick"];
    place.answer(&[&["predict", file][..], &lorenz, options].concat()).with_status(status)
}

/// The same for the text of a network of its own.
fn of(file: &str, text: &str, options: &[&str], status: i32) -> (Workplace, Answer) {
    let place = Workplace::new();
    place.write(file, text);
    let answer = answer(&place, file, options, status);
    (place, answer)
}

#[track_caller]
fn check_says(said: &str, expected: &[&str]) {
    for expected in expected {
        assert!(said.contains(expected), "{expected} in:\n{said}");
    }
}

const DIRECTED: &str = "%%MatrixMarket matrix coordinate real general\n3 3 4\n\
                        1 2 1\n2 1 1\n2 3 0.5\n3 1 2\n";

#[test]
fn a_directed_network_is_refused_with_what_is_supported_and_how_to_get_there() {
    let (place, refused) = of("net.mtx", DIRECTED, &[], 2);
    let expected = [
        "is directed, but predictions are for undirected networks",
        "weights above zero, the same in both directions, and no self-loops",
        "net.mtx: ",
        "row `2`, column `3`",
        "--prepare symmetrise=mean",
    ];
    check_says(&refused.stderr, &expected);
    assert!(place.names("results").is_empty());
    let accepted = answer(&place, "net.mtx", &["--prepare", "symmetrise=mean"], 0);
    check_says(&accepted.stdout, &["3 nodes, 3 links, connected"]);
}

#[test]
fn a_matrix_that_could_be_directed_and_is_not_needs_no_preparation() {
    let both = "%%MatrixMarket matrix coordinate pattern general\n2 2 2\n1 2\n2 1\n";
    check_says(&of("net.mtx", both, &[], 0).1.stdout, &["2 nodes, 1 links, connected"]);
}

#[test]
fn self_loops_and_weights_below_zero_are_refused_with_the_step_that_helps() {
    let symmetric = "%%MatrixMarket matrix coordinate real symmetric\n3 3 3\n2 1 1\n3 1 1\n";
    let (place, loops) = of("net.mtx", &format!("{symmetric}2 2 1\n"), &[], 2);
    check_says(&loops.stderr, &["has self-loops", "node `2`", "drop_self_loops"]);
    answer(&place, "net.mtx", &["--prepare", "drop_self_loops"], 0);
    let (place, negative) = of("net.mtx", &format!("{symmetric}3 2 -1\n"), &[], 2);
    check_says(&negative.stderr, &["of weights above zero", "-1", "--prepare threshold=0"]);
    let without = answer(&place, "net.mtx", &["--prepare", "threshold=0"], 0);
    check_says(&without.stdout, &["3 nodes, 2 links, connected"]);
}

#[test]
fn one_node_is_no_network_to_synchronise() {
    let (_, refused) = of("net.edges", "alone\n", &[], 2);
    check_says(&refused.stderr, &["from net.edges has one node", "two or more"]);
    // Also where the file is another one than the experiment.
    let place = Workplace::new();
    place.write("networks/six-node.edges", "alone\n");
    let refused = place.answer(&["run", "tiny.toml"]).with_status(2).stderr;
    check_says(&refused, &["tiny.toml: `network` from networks/six-node.edges has one node"]);
}

#[test]
fn two_nodes_are_one_cluster_until_their_only_mode_is_unstable() {
    let (place, said) = of("net.edges", "a b\n", &["--matrix", "laplacian"], 0);
    check_says(&said.stdout, &["2 nodes, 1 links, connected", "-2\n"]);
    let states = place.json("results/net/summary.json")["cascade"].clone();
    let clusters: Vec<_> = states.as_array().unwrap().iter().map(|s| &s["clusters"]).collect();
    assert_eq!(clusters, [&json!([["a", "b"]]), &json!([])]);
}

#[test]
fn isolated_nodes_are_alone_at_every_coupling() {
    let (place, said) = of("net.edges", "1 2\n2 3\n3 1\n4\n5\n", &[], 0);
    check_says(&said.stderr, &["2 of 5 nodes have no links (4, 5)", "3 components"]);
    let states = place.json("results/net/summary.json")["cascade"].clone();
    assert_eq!(states[0]["clusters"], json!([["1", "2", "3"]]));
    assert!(states.as_array().unwrap().iter().all(|state| state["n_alone"].as_u64() >= Some(2)));
}

#[test]
fn modes_that_are_all_zero_are_refused_with_the_number_of_components() {
    let pairs: String = (0..8).map(|k| format!("{} {}\n", 2 * k, 2 * k + 1)).collect();
    let (place, refused) = of("net.edges", &pairs, &["--modes", "3"], 2);
    check_says(&refused.stderr, &["8 components", "largest_component"]);
    let accepted = answer(&place, "net.edges", &["--modes", "9"], 0);
    check_says(&accepted.stdout, &["16 nodes, 8 links, 8 components"]);
    answer(&place, "net.edges", &["--prepare", "largest_component"], 0);
}

#[test]
fn more_components_than_modes_by_default_are_predicted_all_the_same() {
    // 24 paths of three nodes: λ = 0, −1 and −3 in each.
    let path = |k: usize| format!("{k}a {k}b\n{k}b {k}c\n");
    let links: String = (0..24).map(path).collect();
    let (place, _) = of("net.edges", &links, &["--matrix", "laplacian"], 0);
    let summary = place.json("results/net/summary.json");
    let eigenvalues = summary["eigenvalues"].as_array().unwrap();
    let zeros = eigenvalues.iter().filter(|lambda| lambda.as_f64().unwrap().abs() < 1e-9);
    assert_eq!(zeros.count(), 24);
    // Strong coupling synchronises each path.
    assert_eq!(summary["cascade"][0]["n_clusters"], 24);
}

#[test]
fn weights_over_twelve_orders_of_magnitude_keep_their_clusters() {
    // Two pairs of strong links, as alike as they can be, and a weak link between them.
    let (place, said) = of("net.edges", "1 2 1e6\n2 3 1e-6\n3 4 1e6\n", &[], 0);
    check_says(&said.stdout, &["4 nodes, 3 links, connected"]);
    let summary = place.json("results/net/summary.json");
    // The pairs against each other: −1e-6 (1/2e6 + 1/2e6).
    let lambda_2 = summary["eigenvalues"][1].as_f64().unwrap();
    assert!((lambda_2 / -1e-12 - 1.0).abs() < 1e-6, "{lambda_2}");
    assert_eq!(summary["cascade"][0]["clusters"], json!([["1", "2", "3", "4"]]));
    assert_eq!(summary["cascade"][1]["clusters"], json!([["1", "2"], ["3", "4"]]));
    // The weak link parts each pair in the end.
    assert_eq!(summary["cascade"][1]["labels"][0]["kind"], "approximate");
    assert!(!said.stderr.contains("uncertain"), "{}", said.stderr);
}

#[test]
fn a_link_twelve_decades_weaker_than_another_still_connects() {
    // c against the pair: λ_2 = −3/2; global synchrony above σ_c / 1.5, with σ_c near 8.2.
    let (place, said) = of("net.edges", "a b 1.4e12\nb c 1\n", &["--matrix", "laplacian"], 0);
    check_says(&said.stdout, &["3 nodes, 2 links, connected"]);
    let summary = place.json("results/net/summary.json");
    assert!((summary["eigenvalues"][1].as_f64().unwrap() + 1.5).abs() < 1e-9, "{summary}");
    assert_eq!(summary["cascade"][0]["clusters"], json!([["a", "b", "c"]]));
    let from = summary["cascade"][0]["epsilon"][0].as_f64().unwrap();
    let sigma_c = summary["msf"]["sigma_c"].as_f64().unwrap();
    assert!((from * 1.5 / sigma_c - 1.0).abs() < 1e-9, "{from}");
    let critical = summary["critical_couplings"][0]["epsilon"].as_f64().unwrap();
    assert!((critical / from - 1.0).abs() < 1e-12, "{critical} and {from}");
}

/// A triangle and a fourth node on a weak link, of weight w: λ_2 = −4w/3.
fn weakly_tied(weight: f64) -> (Value, String) {
    let network = format!("a b 1\nb c 1\nc a 1\nc d {weight:e}\n");
    let (place, said) = of("net.edges", &network, &["--matrix", "laplacian"], 0);
    (place.json("results/net/summary.json"), said.stderr)
}

#[test]
fn a_coupling_is_as_uncertain_as_the_eigenvalue_behind_it() {
    let (summary, _) = weakly_tied(1e-30);
    let (sigma_c, critical) = (&summary["msf"], &summary["critical_couplings"][0]);
    let number = |value: &Value| value.as_f64().unwrap();
    let expected = number(&sigma_c["sigma_c"]) / (4e-30 / 3.0);
    let error = number(&critical["standard_error"]);
    let off = (number(&critical["epsilon"]) - expected).abs();
    assert!(off < 2.0 * error && error < 0.1 * expected, "{critical}, expected {expected:e}");
    // Rounding is more than the zero of Λ is uncertain by.
    let of_zero = number(&sigma_c["standard_error"]) / number(&sigma_c["sigma_c"]);
    assert!(error > 2.0 * of_zero * expected, "{critical}");
    // The verdict says the same.
    let from = &summary["global_synchrony"]["epsilon"][0];
    assert_eq!(from["from_standard_error"], critical["standard_error"]);
}

#[test]
fn an_eigenvalue_lost_in_rounding_is_said_to_be_uncertain() {
    let (summary, said) = weakly_tied(1e-34);
    check_says(&said, &["lambda_2 = -", "e-3", "is uncertain by", "rounding"]);
    let warnings = summary["warnings"].as_array().unwrap();
    assert!(warnings.iter().any(|w| w["about"] == "eigenvalues"), "{warnings:#?}");
    let critical = &summary["critical_couplings"][0];
    let [epsilon, error] = ["epsilon", "standard_error"].map(|key| critical[key].as_f64().unwrap());
    assert!(error > 0.1 * epsilon, "{critical}");
}

#[test]
fn weights_over_twelve_orders_of_magnitude_that_can_be_told_apart_are() {
    // A star: its weakest leaf is coupled as strongly as any other by the normalized matrix.
    let star: String = (0..13).map(|k| format!("hub leaf{k} 1e{}\n", k - 6)).collect();
    let (place, said) = of("net.edges", &star, &["--modes", "14"], 0);
    check_says(&said.stdout, &["14 nodes, 13 links, connected"]);
    let summary = place.json("results/net/summary.json");
    // λ = 0, −1 (N − 2 times) and −2.
    assert_eq!(summary["spectrum"]["multiple"], json!([[2, 13]]));
    let last = summary["eigenvalues"][13].as_f64().unwrap();
    assert!((last + 2.0).abs() < 1e-9, "{last}");
}
