//! What is said of a claim that the results do not decide: runs that escaped, states that are not
//! predicted, errors larger than a tolerance or as small as rounding, seeds on different attractors.

use serde_json::{Value, json};

use crate::run;
use crate::support::{SIX_NODES, Toml, Workplace, tiny};

const UNDECIDED: &str = "cannot be judged";

/// One claim of this name, about a quantity, with more keys.
fn claim(name: &str, of: &str, keys: &str) -> String {
    format!("[claims.{name}]\nof = \"{of}\"\n{keys}")
}

fn with(experiment: Toml, claims: &[String]) -> Toml {
    claims.iter().fold(experiment, |experiment, claim| experiment.and(claim))
}

/// The claims of a run by their names.
fn judged(place: &Workplace) -> Value {
    let summary = place.json("results/tiny/summary.json");
    let named = |claim: &Value| (claim["name"].as_str().unwrap().to_owned(), claim.clone());
    summary["claims"].as_array().unwrap().iter().map(named).collect()
}

#[track_caller]
fn check_verdict(claims: &Value, name: &str, verdict: &str, reason: &str) {
    let claim = &claims[name];
    assert_eq!(claim["verdict"], verdict, "{claim}");
    let said = claim["reason"].as_str().unwrap_or_default();
    assert!(said.contains(reason), "{reason} in {claim}");
}

/// Rössler oscillators coupled from x into x: all runs escape at strong coupling, and some between.
fn rossler() -> Toml {
    tiny()
        .without_table("oscillator.lorenz")
        .and("[oscillator.rossler]")
        .set("coupling.to", "\"x\"")
        .set("msf.sigma", "{ from = 0.0, to = 8.0, points = 17 }")
        .set("msf.average", "1000")
        .set("sweep.transient", "300")
        .set("sweep.average", "200")
        .without("sweep.error_to")
        .set("sweep.clusters", "[[1, 2, 3, 4, 5, 6]]")
}

#[test]
fn a_claim_where_runs_escaped_says_how_many_it_stands_on() {
    let at = |epsilon: &str| format!("where.epsilon = {epsilon}\n");
    let all = "where.clusters = [[1, 2, 3, 4, 5, 6]]\n";
    let claims = [
        claim("error", "simulated.error", &format!("{}{all}at_most = 1", at("4.0"))),
        claim("errors", "simulated.error", &format!("{}{all}trend = \"rises\"", at("[0.5, 4.0]"))),
        claim("clusters", "simulated.clusters", &format!("{}equals = []", at("4.0"))),
        claim("pearson", "agreement.pearson", &format!("{}at_least = 0", at("4.0"))),
        claim("some", "simulated.clusters", &format!("{}equals = []", at("0.82"))),
        claim("of_some", "simulated.error", &format!("{}{all}at_least = 0", at("0.82"))),
        claim("onset", "simulated.onset", &format!("{all}at_most = 0.5")),
    ];
    let experiment =
        with(rossler(), &claims).set("sweep.epsilon", "[0.5, 0.82, 4.0]").set("sweep.seeds", "4");
    let (place, answer) = run(&experiment, SIX_NODES, 1);
    let summary = place.json("results/tiny/summary.json");
    let bounded = &summary["simulations"][1]["n_seeds"];
    let few = bounded.as_u64().unwrap();
    assert!(0 < few && few < 4, "some of four runs escape at 0.82: {bounded} stayed");
    let claims = judged(&place);
    for name in ["error", "errors", "clusters", "pearson"] {
        check_verdict(&claims, name, UNDECIDED, "at epsilon = 4 4 of 4 runs escaped");
        assert_eq!(claims[name]["runs"], json!({ "bounded": 0, "of": 4 }));
    }
    let lost = format!("at epsilon = 0.82 {} of 4 runs escaped", 4 - few);
    check_verdict(&claims, "of_some", UNDECIDED, &lost);
    assert_eq!(claims["some"]["runs"], json!({ "bounded": few, "of": 4 }));
    assert!(claims["onset"]["runs"].is_null(), "{}", claims["onset"]);
    assert!(answer.stdout.contains(&format!("over {few} of 4 runs")), "{}", answer.stdout);
}

#[test]
fn errors_of_the_size_of_rounding_are_in_no_order_and_below_no_bound() {
    let where_ = "where.epsilon = [12.0, 13.0, 14.0]\nwhere.clusters = [[1, 2, 6]]\n";
    let of = |name: &str, keys: &str| claim(name, "simulated.error", &format!("{where_}{keys}"));
    let claims = [
        of("fall", "trend = \"falls\""),
        of("rise", "trend = \"rises\""),
        of("tiny", "at_most = 1e-12"),
        of("small", "at_most = 1e-3"),
        claim("copies", "eigenvalues", "where.modes = [2, 3]\ntrend = \"falls\""),
    ];
    let experiment = with(tiny(), &claims)
        .set("sweep.epsilon", "[12.0, 13.0, 14.0]")
        .set("sweep.seeds", "1")
        .without_table("claims.integers");
    // A ring of six: λ = 0, −1, −1, −3, −3, −4, all together above σ_c = 8.2.
    let links = "1 2\n2 3\n3 4\n4 5\n5 6\n6 1\n";
    let (place, answer) =
        run(&experiment.replace("[[1, 2, 6], [3, 4, 5]]", "[[1, 2, 6]]"), links, 1);
    let claims = judged(&place);
    for name in ["copies", "fall", "rise"] {
        check_verdict(&claims, name, UNDECIDED, "neither is known to be the larger");
    }
    check_verdict(&claims, "tiny", UNDECIDED, "only known to be");
    check_verdict(&claims, "small", "holds", "");
    for name in ["fall", "rise", "tiny", "small"] {
        assert_eq!(claims[name]["runs"], json!({ "bounded": 1, "of": 1 }));
    }
    assert!(answer.stdout.contains("of one run"), "{}", answer.stdout);
}

#[test]
fn what_is_not_predicted_or_not_known_well_enough_cannot_be_judged() {
    let at = |epsilon: f64| format!("where.epsilon = {epsilon}\n");
    let all = "equals = [[1, 2, 3, 4, 5, 6]]";
    let claims = [
        claim("far", "cascade.clusters", &format!("{}{all}", at(8.0))),
        claim("near", "cascade.clusters", &format!("{}{all}", at(4.06))),
        claim("below", "cascade.clusters", &format!("{}equals = []", at(1.0))),
        claim("edge", "msf.sigma_c", "equals = 8.17\nabs_tol = 1e-4"),
        claim("other_edge", "msf.sigma_c", "equals = 20\nabs_tol = 1e-4"),
        claim(
            "order",
            "cascade.order_of_loss",
            "where.clusters = [[1, 2, 6], [3, 5]]\nequals = [1, 2]",
        ),
    ];
    let experiment = with(tiny(), &claims)
        .and("[spectrum]\nmodes = 2")
        .without_table("sweep")
        .without_table("claims.integers");
    let (place, _) = run(&experiment, SIX_NODES, 1);
    let claims = judged(&place);
    check_verdict(&claims, "far", "holds", "");
    check_verdict(&claims, "near", UNDECIDED, "on which side of it epsilon = 4.06 lies");
    check_verdict(&claims, "below", UNDECIDED, "nothing is predicted at epsilon = 1");
    check_verdict(&claims, "edge", UNDECIDED, "8.088 ± 0.056");
    check_verdict(&claims, "other_edge", "differs", "");
    check_verdict(&claims, "order", UNDECIDED, "where cluster 1 is lost is not predicted");
}

#[test]
fn an_edge_beyond_the_look_is_not_known_and_one_inside_would_have_been_seen() {
    let claims = [
        claim("inside", "msf.sigma_c", "equals = 3\nabs_tol = 0.5"),
        claim("beyond", "msf.sigma_c", "equals = 8.3\nabs_tol = 0.5"),
        claim("coupling", "critical_couplings", "where.modes = [2]\nequals = [4.2]\nabs_tol = 0.2"),
    ];
    let experiment = with(tiny(), &claims)
        .set("msf.sigma", "{ from = 0.0, to = 6.0, points = 7 }")
        .without_table("sweep")
        .without_table("claims.integers");
    let (place, _) = run(&experiment, SIX_NODES, 1);
    let claims = judged(&place);
    check_verdict(&claims, "inside", "differs", "");
    check_verdict(&claims, "beyond", UNDECIDED, "nothing is stable from sigma = 0 to 6");
    check_verdict(&claims, "coupling", UNDECIDED, "nothing is stable from sigma = 0 to 6");
}

/// Lorenz oscillators at r = 24.3, where chaos and rest coexist: 24.06 < r < 24.74 (J. L. Kaplan &
/// J. A. Yorke, Commun. Math. Phys. 67, 93 (1979)).
#[test]
fn seeds_on_different_attractors_have_no_mean_onset_and_groups_are_named_everywhere() {
    let clusters = "where.clusters = [[1, 2, 3, 4, 5, 6]]\n";
    let claims = [
        claim("onset", "simulated.onset", &format!("{clusters}equals = 2.5\nabs_tol = 0.5")),
        claim("below", "simulated.onset", &format!("{clusters}at_most = 6")),
    ];
    let experiment = with(tiny(), &claims)
        .set("oscillator.lorenz.r", "24.3")
        .set("coupling.to", "\"x\"")
        .set("msf.sigma", "{ from = 0.0, to = 12.0, points = 13 }")
        .set("msf.average", "4000")
        .set("msf.transient", "1000")
        .set("msf.relative_error", "0.02")
        .set("sweep.epsilon", "{ from = 0.2, to = 4.0, points = 20 }")
        .set("sweep.seeds", "6")
        .set("sweep.transient", "300")
        .set("sweep.average", "100")
        .without("sweep.error_to");
    let (place, answer) = run(&experiment, SIX_NODES, 1);
    let summary = place.json("results/tiny/summary.json");
    let onset = &summary["cascade"][0]["simulated_onset"];
    assert_eq!(onset["bound"], "groups", "{onset}");
    assert!(onset["mean"].is_null() && onset["spread"].is_null(), "{onset}");
    let groups = onset["groups"].as_array().unwrap();
    let seeds: u64 = groups.iter().map(|group| group["n_seeds"].as_u64().unwrap()).sum();
    assert!(groups.len() == 2 && seeds == 6, "{onset}");
    assert!(
        groups[0]["from"].is_null() && groups[0]["to"] == 0.2,
        "at rest from the first: {onset}"
    );
    let claims = judged(&place);
    check_verdict(&claims, "onset", UNDECIDED, "seeds at most 0.2, ");
    check_verdict(&claims, "below", "holds", "");
    let told = claims["onset"]["obtained"].as_str().unwrap();
    let report = place.read("results/tiny/report.txt");
    assert!(answer.stdout.contains(told), "{told} beside the states:\n{}", answer.stdout);
    assert!(report.matches(told).count() >= 3, "{told} in claims and states:\n{report}");
    for words in [
        "settles on one of 2 attractors (chaotic, at rest)",
        "runs fall into two groups, and means are of neither",
        "no mean is given",
    ] {
        assert!(answer.stderr.contains(words), "{words} in:\n{}", answer.stderr);
    }
    assert!(place.read("results/tiny/figure.svg").contains("runs in two groups"));
    let told = |w: &&Value| w["about"] == "cascade";
    assert!(summary["warnings"].as_array().unwrap().iter().any(|w| told(&w)), "{summary}");
}
