//! `eigensync msf`: Λ(σ) without a network.

use crate::support::Workplace;

const LORENZ: [&str; 9] = [
    "msf",
    "--oscillator",
    "lorenz",
    "--coupling",
    "x:y",
    "--average",
    "2000",
    "--sigma",
    "0:12:13",
];

#[test]
fn a_curve_without_a_network_tells_its_zeros_and_what_was_looked_at() {
    let place = Workplace::new();
    let answer = place.answer(&LORENZ).with_status(0);
    for expected in [
        "isolated     Λ(0) = 1.",
        ": chaotic",
        "stable for   sigma > 8.",
        "where Λ falls",
        "looked at    33 sigma from 0 to 12, where a window narrower than",
        "results in results/lorenz-x-y, in ",
    ] {
        assert!(answer.stdout.contains(expected), "{expected} in:\n{}", answer.stdout);
    }
    let names = ["figure.pdf", "figure.png", "figure.svg", "msf.csv", "summary.json"];
    assert_eq!(place.names("results/lorenz-x-y"), names);
    let summary = place.json("results/lorenz-x-y/summary.json");
    let zero = &summary["msf"]["zeros"][0];
    assert!((zero["sigma"].as_f64().unwrap() - 8.17).abs() < 0.1, "{zero}");
    assert!(summary["experiment"]["network"].is_null(), "{}", summary["experiment"]);
    assert_eq!(place.read("results/lorenz-x-y/msf.csv").lines().count(), 14);
    // The same again takes the place of the first, and of nothing else.
    place.answer(&LORENZ).with_status(0);
    assert_eq!(place.names("results"), ["lorenz-x-y"]);
}

#[test]
fn a_curve_has_a_place_for_each_of_its_parameters_and_components() {
    let place = Workplace::new();
    let with = |oscillator: &'static str, status: i32| {
        let mut options = LORENZ;
        options[2] = oscillator;
        place.answer(&options).with_status(status)
    };
    with("lorenz:r=40,b=2.5", 0);
    assert_eq!(place.names("results"), ["lorenz-r=40-b=2.5-x-y"]);
    assert!(with("lorens", 2).stderr.contains("did you mean `lorenz`?"));
    let bad = [&LORENZ[..7], &["--sigma", "0:12"]].concat();
    assert!(place.answer(&bad).with_status(2).stderr.contains("such as 0:16:65"));
    let down = [&LORENZ[..7], &["--sigma", "12:0:13"]].concat();
    let said = place.answer(&down).with_status(2).stderr;
    assert!(said.contains("`msf.sigma`") && !said.contains(".toml"), "{said}");
}
