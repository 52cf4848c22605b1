//! A figure never costs results: what does not fit is summarised, and said.

use crate::support::{Answer, Toml, Workplace, tiny};

/// The tiny experiment on a ring, without what names nodes of its own network.
fn on_a_ring(place: &Workplace, n_nodes: usize) -> Toml {
    let links: String = (0..n_nodes).map(|i| format!("{i} {}\n", (i + 1) % n_nodes)).collect();
    place.write("ring.edges", links);
    tiny()
        .set("network.file.path", "\"ring.edges\"")
        .set("sweep.epsilon", "[1.0, 2.0]")
        .set("sweep.transient", "1.0")
        .set("sweep.average", "2.0")
        .without("sweep.error_to")
        .without("sweep.clusters")
        .without_table("claims.integers")
}

/// Runs an experiment whose numbers and figure must be there, and gives the messages of its summary.
fn results_of(place: &Workplace, experiment: &Toml) -> (Answer, Vec<String>) {
    place.write("tiny.toml", &experiment.0);
    let answer = place.answer(&["run", "tiny.toml"]).with_status(0);
    let names = place.names("results/tiny");
    for file in ["summary.json", "sweep.csv", "figure.svg", "figure.png"] {
        assert!(names.iter().any(|name| name == file), "{file} among {names:?}");
    }
    let summary = place.json("results/tiny/summary.json");
    let warnings = summary["warnings"].as_array().expect("a list").iter();
    let messages = warnings.filter(|warning| warning["about"] == "figure");
    (answer, messages.map(|warning| warning["message"].as_str().unwrap().to_owned()).collect())
}

#[test]
fn more_clusters_than_colours_are_drawn_and_foreseen() {
    let place = Workplace::new();
    let clusters: Vec<[usize; 2]> = (0..36).map(|m| [2 * m, 2 * m + 1]).collect();
    let experiment = on_a_ring(&place, 72).set("sweep.clusters", &format!("{clusters:?}"));
    let (answer, messages) = results_of(&place, &experiment);
    let expected = "the curves of 36 clusters cannot be told apart: the 16 largest are named";
    assert!(messages[0].starts_with(expected), "{messages:?}");
    assert!(answer.stderr.contains(expected), "{}", answer.stderr);
    let svg = place.read("results/tiny/figure.svg");
    assert!(svg.contains(">20 more<") && svg.contains(">and 26 more<"));
    let checked = place.answer(&["check", "tiny.toml"]).with_status(0);
    assert!(checked.stdout.contains(expected), "{}", checked.stdout);
}

#[test]
fn errors_of_a_hundred_nodes_are_drawn() {
    let place = Workplace::new();
    let experiment = on_a_ring(&place, 100).set("sweep.error_to", "0");
    let (_, messages) = results_of(&place, &experiment);
    assert!(messages[0].contains("99 nodes cannot be told apart: the first 16 are named"));
}

#[test]
fn six_couplings_of_matrices_show_four() {
    let place = Workplace::new();
    let experiment = tiny()
        .set("sweep.epsilon", "{ from = 1.0, to = 5.0, points = 6 }")
        .and("[figure]\nkind = \"matrices\"");
    let (_, messages) = results_of(&place, &experiment);
    let expected = "6 values of epsilon have no room: 4 of them are shown (1, 2.6, 3.4, 5)";
    assert_eq!(messages, [expected]);
    let names = place.names("results/tiny");
    assert_eq!(names.iter().filter(|name| name.starts_with("error_epsilon_")).count(), 6);
}

#[test]
fn matrices_of_more_nodes_than_are_kept_are_left_out_and_foreseen() {
    let place = Workplace::new();
    let experiment = on_a_ring(&place, 2001)
        .set("sweep.error_to", "0")
        .set("sweep.seeds", "1")
        .set("sweep.epsilon", "[2.0]")
        .and("[spectrum]\nmodes = 3\n[figure]\nkind = \"matrices\"");
    let (answer, messages) = results_of(&place, &experiment);
    let expected = "there are no matrices: the errors of all pairs are kept for networks of up to \
                    2000 nodes; the sweep is shown instead";
    assert_eq!(messages[0], expected);
    assert!(answer.stderr.contains(expected), "{}", answer.stderr);
    assert!(!place.names("results/tiny").iter().any(|name| name.ends_with(".npy")));
    let checked = place.answer(&["check", "tiny.toml"]).with_status(0);
    assert!(checked.stdout.contains(expected), "{}", checked.stdout);
}

#[test]
fn matrices_are_called_by_couplings_of_any_size() {
    let place = Workplace::new();
    let experiment = tiny()
        .set("sweep.epsilon", "[1e-300, 2.5e-300, 0.5, 1]")
        .and("[figure]\nkind = \"matrices\"");
    let (_, messages) = results_of(&place, &experiment);
    assert!(messages.is_empty(), "{messages:?}");
    let names = place.names("results/tiny");
    for epsilon in ["1e-300", "2.5e-300", "0.5", "1"] {
        assert!(names.contains(&format!("error_epsilon_{epsilon}.npy")), "{names:?}");
    }
}

#[test]
fn matrices_of_runs_that_all_escaped_say_so() {
    let place = Workplace::new();
    let experiment = tiny()
        .without_table("oscillator.lorenz")
        .set("coupling.to", "\"x\"")
        .set("sweep.epsilon", "[0.3, 3.0]")
        .set("sweep.transient", "300.0")
        .and("[figure]\nkind = \"matrices\"\n[oscillator.rossler]");
    results_of(&place, &experiment);
    assert!(place.read("results/tiny/figure.svg").contains(">all runs escaped<"));
}

#[test]
fn numbers_that_no_axis_holds_cost_their_panel_alone() {
    let place = Workplace::new();
    place.write("networks/six-node.edges", "1 2\n2 3 1e-300\n3 4\n4 5 1e-300\n5 6");
    let experiment = tiny().without("sweep.error_to").without_table("claims.integers");
    results_of(&place, &experiment.replace("[[1, 2, 6], [3, 4, 5]]", "[[1, 2]]"));
}

#[test]
fn no_figure_is_made_where_none_is_wanted() {
    let place = Workplace::new();
    place.write("tiny.toml", tiny().and("[figure]\nkind = \"none\"").0);
    place.answer(&["run", "tiny.toml"]).with_status(0);
    let names = place.names("results/tiny");
    assert!(names.contains(&"summary.json".to_owned()) && names.contains(&"sweep.csv".to_owned()));
    assert!(!names.iter().any(|name| name.starts_with("figure")), "{names:?}");
}

#[test]
fn names_of_any_length_and_kind_leave_the_figure_whole() {
    let place = Workplace::new();
    let long = "n".repeat(5000);
    place.write("networks/six-node.edges", format!("{long} b\nb <c>&\n<c>& d\nd e\ne {long}"));
    let experiment = tiny()
        .set("title", "\"\\u001b[31m<b>& \\u0000 \\u202e\"")
        .set("sweep.error_to", "\"b\"")
        .without("sweep.clusters")
        .without_table("claims.integers");
    let (_, messages) = results_of(&place, &experiment);
    assert!(messages.is_empty(), "{messages:?}");
    let svg = place.read("results/tiny/figure.svg");
    assert!(!svg.contains(&long) && !svg.contains('\u{1b}') && !svg.contains('\u{202e}'));
}
