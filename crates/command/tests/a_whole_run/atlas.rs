//! An atlas: every coupling of one component into another of several oscillators.

use crate::support::Workplace;

/// Lorenz' convection and an oscillator of two components that comes to rest, in a hurry.
const ATLAS: &str = r#"title  = "Two systems"
source = "the paper"

[msf]
points         = 17
transient      = 20.0
average        = 100.0
relative_error = 0.1

[atlas.lorenz]
title             = "Lorenz"
oscillator.lorenz = { r = 28.0 }
[atlas.lorenz.published]
"x:x" = { windows = [[7.9, inf]], within = 0.5 }
"x:z" = { windows = [[1.0, 2.0]], within = 0.1, known_difference = "it was looked for in vain" }

[atlas.spiral]
oscillator.custom = { flow = { u = "-u - v", v = "u - v" }, start = { u = [-1, 1], v = [-1, 1] } }
"#;

#[test]
fn an_atlas_has_a_class_a_look_and_windows_with_errors_for_every_pair() {
    let place = Workplace::new();
    place.write("atlas.toml", ATLAS);
    let answer = place.answer(&["run", "atlas.toml"]).with_status(0);
    assert!(
        answer.stdout.contains("1 claims hold, 1 differ as known, 0 differ"),
        "{}",
        answer.stdout
    );
    let names = [
        "atlas.csv",
        "atlas_curves.csv",
        "figure.pdf",
        "figure.png",
        "figure.svg",
        "report.txt",
        "summary.json",
    ];
    assert_eq!(place.names("results/atlas"), names);
    let table = place.read("results/atlas/atlas.csv");
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 1 + 9 + 4);
    let column = |name: &str| rows[0].iter().position(|column| *column == name).unwrap();
    let row = |of: [&str; 3]| rows.iter().find(|row| row[..3] == of).unwrap();
    let number = |of: [&str; 3], name: &str| row(of)[column(name)].parse::<f64>().unwrap();
    let (x_y, z_z) = (["lorenz", "x", "y"], ["lorenz", "z", "z"]);
    assert_eq!([row(x_y)[3], row(z_z)[3], row(["lorenz", "x", "z"])[3]], ["Γ1", "Γ3", "Γ0"]);
    assert!((number(x_y, "window_1_from") - 7.14).abs() < 0.5, "{:?}", row(x_y));
    assert!(number(x_y, "window_1_from_standard_error") > 0.0);
    assert_eq!(row(x_y)[column("window_1_to_is")], "end of the look");
    assert_eq!(number(x_y, "window_1_to"), number(x_y, "looked_to"));
    assert!(number(x_y, "narrowest_spacing") < number(x_y, "widest_spacing") / 10.0);
    // Of the spiral Λ = -1 at every σ of u into u until the two exponents part, and Λ(0) = -1 < 0.
    let spiral = table.lines().find(|line| line.starts_with("spiral,u,u")).unwrap();
    assert!(spiral.contains("\"Γ0, stable from 0\",0,-1"), "{spiral}");
    let svg = place.read("results/atlas/figure.svg");
    for name in ["Lorenz", "spiral", "Γ"] {
        assert!(svg.contains(name), "{name}");
    }
    let summary = place.json("results/atlas/summary.json");
    assert_eq!(summary["atlas"].as_array().unwrap().len(), 13);
    assert_eq!(summary["parameters"]["atlas"]["lorenz"]["step"], 0.01);
    // Held against itself as a golden output, nothing differs.
    place.write("golden/atlas/summary.json", place.read("results/atlas/summary.json"));
    place.answer(&["compare", "--golden", "golden"]).with_status(0);
    assert!(place.answer(&["list", "."]).with_status(0).stdout.contains("[results] Two systems"));
}

#[test]
fn an_atlas_is_checked_before_it_is_made() {
    let place = Workplace::new();
    place.write("atlas.toml", ATLAS);
    let said = place.answer(&["check", "atlas.toml"]).with_status(0).stdout;
    for expected in
        ["atlas: Two systems", "lorenz: {\"lorenz\":", "9 pairs, step 0.01", "claims       2"]
    {
        assert!(said.contains(expected), "{expected} in:\n{said}");
    }
    let json = place.answer(&["check", "atlas.toml", "--json"]).with_status(0).stdout;
    let checked: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(checked["experiments"][0]["pairs"], 13);
    assert_eq!(place.names("results"), [""; 0]);
}
