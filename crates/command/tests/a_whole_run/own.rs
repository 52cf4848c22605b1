//! Oscillators and couplings of one's own: equations in an experiment file, maps, matrices and formulas of
//! H, and the library that is there.

use crate::support::{Toml, Workplace, tiny};

/// The tiny experiment of another oscillator, whose components are coupled x into x.
fn of(oscillator: &str) -> Toml {
    tiny().without_table("oscillator.lorenz").set("coupling.to", "\"x\"").and(oscillator)
}

/// Two nodes in place of the network of the tiny experiment.
fn pair(toml: Toml) -> Toml {
    toml.without_table("network.file")
        .without_table("claims.integers")
        .and("[network.communities]\nsizes = [2]\np_within = 1.0\np_between = 0.0")
        .without("sweep.clusters")
        .without("sweep.error_to")
}

const LORENZ: &str = r#"[oscillator.custom]
flow = { x = "(y - x)*alpha", y = "x*(r - z) - y", z = "x*y - z*b" }
parameters = { alpha = 10.0, r = 35.0, b = 2.6666666666666665 }
start = { x = [-1, 1], y = [-1, 1], z = [20, 30] }"#;

/// What follows from simulations and exponents in a summary.
fn numbers(place: &Workplace) -> [serde_json::Value; 3] {
    let summary = place.json("results/tiny/summary.json");
    ["msf", "cascade", "simulations"].map(|key| summary[key].clone())
}

#[test]
fn an_oscillator_written_as_text_has_the_results_of_the_built_in_one() {
    let place = Workplace::new();
    let shown = place.answer(&["oscillators", "lorenz", "--json"]).with_status(0).stdout;
    let lorenz: serde_json::Value = serde_json::from_str(&shown).unwrap();
    let start = |c: &str| {
        lorenz["equations"]["start"][c]
            .as_array()
            .unwrap()
            .iter()
            .map(ToString::to_string)
            .collect::<Vec<_>>()
            .join(", ")
    };
    let [x, y, z] = ["x", "y", "z"].map(start);
    let text = LORENZ.replace(
        "x = [-1, 1], y = [-1, 1], z = [20, 30]",
        &format!("x = [{x}], y = [{y}], z = [{z}]"),
    );
    place.answer(&["run", "tiny.toml"]).with_status(0);
    let built_in = numbers(&place);
    place.write("tiny.toml", tiny().without_table("oscillator.lorenz").and(&text).0);
    place.answer(&["run", "tiny.toml"]).with_status(0);
    assert_eq!(numbers(&place), built_in);
    // A matrix and a formula with one entry are the pair of components.
    let coupled = |function: &str| {
        let toml = tiny().without("coupling.from").without("coupling.to");
        place.write("tiny.toml", toml.set("coupling.function", function).0);
        place.answer(&["run", "tiny.toml"]).with_status(0);
        numbers(&place)
    };
    assert_eq!(coupled("[[0, 0, 0], [1, 0, 0], [0, 0, 0]]"), built_in);
    assert_eq!(coupled("{ y = \"x\" }"), built_in);
}

#[test]
fn maps_have_windows_in_closed_form_and_synchronise_in_them() {
    let place = Workplace::new();
    let logistic = "[oscillator.logistic]\nr = 4.0";
    let toml = pair(of(logistic))
        .without("coupling.from")
        .without("coupling.to")
        .set("coupling.function", "{ x = \"r*x*(1 - x)\" }")
        .without("msf.step")
        .without("sweep.step")
        .set("msf.sigma", "{ from = 0.0, to = 3.0, points = 25 }")
        .set("msf.average", "1e4")
        .set("sweep.epsilon", "[0.1, 0.2, 0.3, 0.5, 0.7, 0.8]")
        .set("sweep.transient", "1000")
        .set("sweep.average", "1000")
        .set("sweep.synchronised_below", "1e-6")
        .and("[claims.window]\nof = \"msf.zeros\"\nequals = [0.5, 1.5]\nabs_tol = 0.02")
        .and("[claims.inside]\nof = \"simulated.clusters\"\nwhere = { epsilon = 0.5 }\nequals = [[1, 2]]")
        .and("[claims.outside]\nof = \"simulated.clusters\"\nwhere = { epsilon = 0.8 }\nequals = []");
    place.write("tiny.toml", toml.0);
    let answer = place.answer(&["run", "tiny.toml"]).with_status(0);
    assert!(answer.stdout.contains("3 claims hold"), "{}", answer.stdout);
    let parameters = &place.json("results/tiny/summary.json")["parameters"];
    assert_eq!(parameters["sweep"]["method"], "iterate");
    assert_eq!([&parameters["msf"]["step"], &parameters["sweep"]["step"]], [1.0, 1.0]);
    assert_eq!(parameters["sweep"]["stride"], 1);
}

#[test]
fn what_nothing_uses_and_orbits_that_escape_are_told_by_check() {
    let place = Workplace::new();
    let unused = LORENZ.replace("b = 2.6666666666666665", "b = 2.6666666666666665, gamma = 1.0");
    place.write("tiny.toml", tiny().without_table("oscillator.lorenz").and(&unused).0);
    let said = place.answer(&["check", "tiny.toml"]).with_status(0).stdout;
    assert!(said.contains("nothing uses `oscillator.custom.parameters.gamma`"), "{said}");
    assert!(said.contains("all 64 stay bounded") && said.contains("Λ(0) takes about"), "{said}");
    let (_, warned) = {
        let answer = place.answer(&["run", "tiny.toml"]).with_status(0);
        (answer.stdout, answer.stderr)
    };
    assert!(warned.contains("nothing uses `oscillator.custom.parameters.gamma`"), "{warned}");
    // ẋ = x² has no bounded orbits from above 0.
    let runaway = of("[oscillator.custom]\nflow = { x = \"x^2\" }\nstart = { x = [-1, 1] }");
    place.write("tiny.toml", runaway.0);
    let said = place.answer(&["check", "tiny.toml"]).with_status(0).stdout;
    assert!(said.contains("of 64 escape, the first after"), "{said}");
}

#[test]
fn a_flow_that_jumps_is_warned_of_and_one_with_kinks_is_not() {
    let place = Workplace::new();
    let flow = |z: &str| {
        of(&format!(
            "[oscillator.custom]\nflow = {{ x = \"y - x\", y = \"z - y\", z = \"-z - {z}\" }}\n\
             start = {{ x = [-1, 1], y = [-1, 1], z = [-1, 1] }}"
        ))
    };
    for (z, jumps) in [("sign(x)", true), ("if(x > 0, 1, -1)", true), ("abs(x) + 2*x", false)] {
        place.write("tiny.toml", flow(z).0);
        let said = place.answer(&["check", "tiny.toml"]).with_status(0).stdout;
        assert_eq!(
            said.contains("the flow jumps on the way of an isolated orbit"),
            jumps,
            "{said}"
        );
    }
}

#[test]
fn a_radius_of_escape_of_ones_own_ends_orbits_there() {
    let place = Workplace::new();
    place.write("tiny.toml", format!("escape_radius = 20.0\n{}", tiny().0));
    let answer = place.answer(&["run", "tiny.toml"]).with_status(2);
    assert!(answer.stderr.contains("escapes at time"), "{}", answer.stderr);
}

#[test]
fn forced_equations_run_and_time_is_no_component_to_couple() {
    let place = Workplace::new();
    let forced =
        of("[oscillator.duffing]").set("msf.sigma", "{ from = 0.0, to = 4.0, points = 5 }");
    place.write("tiny.toml", forced.0);
    let answer = place.answer(&["run", "tiny.toml"]);
    assert!(answer.status != Some(2), "{}", answer.stderr);
    let coupled = of("[oscillator.duffing]").set("coupling.from", "\"t\"");
    place.write("tiny.toml", coupled.0);
    let answer = place.answer(&["run", "tiny.toml"]).with_status(2);
    assert!(answer.stderr.contains("`coupling.from` is \"t\""), "{}", answer.stderr);
}

#[test]
fn the_library_is_listed_and_each_of_it_is_shown_with_its_equations() {
    let place = Workplace::new();
    let list = place.answer(&["oscillators"]).with_status(0).stdout;
    for name in ["lorenz", "rossler", "hindmarsh_rose", "chua", "ikeda", "henon_heiles"] {
        assert!(list.contains(name), "{name} in:\n{list}");
        let shown = place.answer(&["oscillators", name]).with_status(0).stdout;
        for expected in [name, "    with ", "[oscillator."] {
            assert!(shown.contains(expected) || name == "henon_heiles", "{expected} in:\n{shown}");
        }
    }
    let unknown = place.answer(&["oscillators", "lorentz"]).with_status(2).stderr;
    assert!(unknown.contains("did you mean `lorenz`?"), "{unknown}");
}

#[test]
fn options_take_an_oscillator_from_a_file_and_formulas_of_the_coupling() {
    let place = Workplace::new();
    let own = LORENZ.replace("[oscillator.custom]\n", "");
    place.write("mine.toml", &own);
    let options = |coupling: &'static str| {
        [
            "msf",
            "--oscillator",
            "mine.toml",
            "--coupling",
            coupling,
            "--average",
            "1000",
            "--sigma",
            "0:12:7",
        ]
    };
    let said = place.answer(&options("y=x")).with_status(0).stdout;
    assert!(said.contains("Master stability function of mine.toml, x into y"), "{said}");
    assert!(said.contains("sigma > 8."), "{said}");
    let wrong = place.answer(&options("y=tahn(x)")).with_status(2).stderr;
    assert!(wrong.contains("`coupling.function.y`: there is no function `tahn`"), "{wrong}");
    place.write("mine.toml", own.replace("x*y", "x*w"));
    let wrong = place.answer(&options("x:y")).with_status(2).stderr;
    assert!(wrong.contains("`w` is unknown") && wrong.contains("mine.toml:1:59: "), "{wrong}");
    let twice = place.answer(&options("y=x,y=-x")).with_status(2).stderr;
    assert!(twice.contains("`y` is given twice"), "{twice}");
    place.write("mine.toml", "title = 1");
    let wrong = place.answer(&options("x:y")).with_status(2).stderr;
    assert!(wrong.contains("mine.toml"), "{wrong}");
}
