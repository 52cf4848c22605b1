//! What a run leaves: exit status, a whole folder, the same numbers every time.

use std::fs;

use serde_json::{Value, json};

use crate::run;
use crate::support::{SIX_NODES, Workplace, names, tiny};

/// A summary without the part that may differ between equal runs.
fn without_provenance(mut summary: Value) -> Value {
    summary.as_object_mut().and_then(|all| all.remove("provenance")).expect("there is provenance");
    summary
}

/// The columns and the number of rows of a table whose rows are all as long as its header.
fn table(place: &Workplace, name: &str) -> (Vec<String>, usize) {
    let mut table = csv::Reader::from_path(place.path(name)).expect("a table can be opened");
    let header = table.headers().expect("a table has a header").iter().map(str::to_owned).collect();
    (header, table.records().inspect(|row| assert!(row.is_ok(), "{row:?}")).count())
}

#[test]
fn a_run_whose_claims_hold_ends_with_status_0_and_leaves_a_whole_folder() {
    let (place, answer) = run(&tiny(), SIX_NODES, 0);
    assert!(
        answer.stdout.contains("1 claims hold, 0 differ as known, 0 differ"),
        "{}",
        answer.stdout
    );
    let files = [
        "cascade.csv",
        "cascade.nwk",
        "clusters.csv",
        "eigenvectors.csv",
        "figure.pdf",
        "figure.png",
        "figure.svg",
        "membership.csv",
        "msf.csv",
        "report.txt",
        "spectrum.csv",
        "summary.json",
        "sweep.csv",
    ];
    assert_eq!(place.names("results/tiny"), files);
    assert_eq!(place.names("results"), ["tiny"]);
}

#[test]
fn a_summary_has_the_keys_that_others_rely_on() {
    let (place, _) = run(&tiny(), SIX_NODES, 0);
    let summary = place.json("results/tiny/summary.json");
    for pointer in [
        "/id",
        "/title",
        "/eigenvalues/5",
        "/msf/lyapunov_isolated",
        "/msf/stable/0/0",
        "/msf/sigma_c",
        "/msf/standard_error",
        "/critical_couplings/4/mode",
        "/critical_couplings/4/lambda",
        "/critical_couplings/4/epsilon",
        "/cascade/0/epsilon/0",
        "/cascade/0/unstable_modes",
        "/cascade/0/clusters/0/0",
        "/simulations/4/epsilon",
        "/simulations/4/outcome",
        "/claims/0/name",
        "/claims/0/source",
        "/claims/0/paper",
        "/claims/0/obtained",
        "/claims/0/tolerance",
        "/claims/0/verdict",
        "/provenance/version",
        "/provenance/commit",
        "/provenance/seed",
        "/provenance/plan_hash",
        "/provenance/host_features",
        "/provenance/instruction_set",
        "/provenance/wall_time_s",
        "/provenance/stages_s/reading",
        "/provenance/stages_s/clusters",
        "/cascade/1/exact_tolerance",
        "/cascade/1/labels/1/kind",
        "/cascade/1/largest_deviation",
    ] {
        assert!(summary.pointer(pointer).is_some_and(|value| !value.is_null()), "{pointer}");
    }
    // Fan, Wang & Wang (2023), Sec. III A: one cluster, two, two pairs, none.
    let states = summary["cascade"].as_array().unwrap().iter();
    let clusters: Vec<_> = states.map(|state| state["clusters"].clone()).collect();
    let expected = [
        json!([["1", "2", "3", "4", "5", "6"]]),
        json!([["1", "2", "6"], ["3", "4", "5"]]),
        json!([["2", "6"], ["3", "5"]]),
        json!([]),
    ];
    assert_eq!(clusters, expected);
    assert_eq!(summary["claims"][0]["verdict"], "holds");
    assert_eq!(summary["provenance"]["plan_hash"].as_str().map(str::len), Some(64));
}

#[test]
fn tables_have_a_column_for_each_quantity_and_a_row_for_each_point() {
    let (place, _) = run(&tiny(), SIX_NODES, 0);
    let check = |name: &str, columns: &str, rows: usize| {
        let (header, count) = table(&place, &format!("results/tiny/{name}.csv"));
        assert_eq!((header.join(" "), count), (columns.to_owned(), rows), "{name}");
    };
    check("spectrum", "mode lambda residual", 6);
    check("eigenvectors", "node v1 v2 v3 v4 v5 v6", 6);
    check("msf", "sigma Lambda standard_error", 7);
    check(
        "cascade",
        "cluster parent tree nodes first_node modes epsilon_from epsilon_to critical_coupling kind \
         spread deviation modes_to exceeds_threshold holds_exact",
        5,
    );
    check("clusters", "tree node cluster alone_below exact_with", 6);
    check(
        "sweep",
        "epsilon seed outcome error_1_to_2 error_2_to_2 error_3_to_2 error_4_to_2 error_5_to_2 \
         error_6_to_2 error_within_cluster_1 error_within_cluster_2",
        10,
    );
}

#[test]
fn the_figure_is_a_picture_in_both_formats() {
    let (place, _) = run(&tiny(), SIX_NODES, 0);
    let svg = place.read("results/tiny/figure.svg");
    assert!(svg.contains("<svg") && svg.trim_end().ends_with("</svg>"));
    let file = fs::File::open(place.path("results/tiny/figure.png")).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut pixels).unwrap();
    assert!(frame.width > 1000 && frame.height > 500, "{} × {}", frame.width, frame.height);
    assert!(pixels.iter().any(|&byte| byte != pixels[0]), "the picture is blank");
}

#[test]
fn a_claim_that_differs_gives_status_1_and_one_known_to_differ_does_not() {
    let differing = || tiny().set("claims.integers.equals", "[0, -2, -3, -4, -5, -6.5]");
    let (place, answer) = run(&differing(), SIX_NODES, 1);
    assert!(
        answer.stdout.contains("0 claims hold, 0 differ as known, 1 differ"),
        "{}",
        answer.stdout
    );
    let verdict =
        |place: &Workplace| place.json("results/tiny/summary.json")["claims"][0]["verdict"].clone();
    assert_eq!(verdict(&place), "differs");
    let known = differing().set("claims.integers.known_difference", "\"a misprint\"");
    let (place, answer) = run(&known, SIX_NODES, 0);
    assert!(answer.stdout.contains("1 differ as known"), "{}", answer.stdout);
    assert!(answer.stdout.contains("a misprint"), "{}", answer.stdout);
    assert_eq!(verdict(&place), "differs as known");
}

#[test]
fn results_are_the_same_to_the_last_bit_for_any_number_of_threads() {
    let place = Workplace::new();
    for threads in ["1", "2", "3"] {
        place
            .answer(&["run", "tiny.toml", "--threads", threads, "--results", threads])
            .with_status(0);
    }
    for name in names(&place.path("1/tiny")) {
        for threads in ["2", "3"] {
            let [one, more] = ["1", threads].map(|folder| format!("{folder}/tiny/{name}"));
            if name == "summary.json" {
                let [one, more] = [one, more].map(|file| without_provenance(place.json(&file)));
                assert_eq!(one, more, "{threads} threads");
            } else {
                let [one, more] = [one, more].map(|file| fs::read(place.path(&file)).unwrap());
                assert!(one == more, "{name} with {threads} threads");
            }
        }
    }
}

#[test]
fn running_again_replaces_the_whole_folder() {
    let (place, _) = run(&tiny(), SIX_NODES, 0);
    let before = without_provenance(place.json("results/tiny/summary.json"));
    place.answer(&["run", "tiny.toml"]).with_status(0);
    assert_eq!(place.names("results"), ["tiny"]);
    assert_eq!(without_provenance(place.json("results/tiny/summary.json")), before);
}

#[test]
fn quick_shortens_the_times_and_says_so_in_the_summary() {
    let place = Workplace::new();
    let long = tiny().set("sweep.average", "100").set("msf.average", "200");
    place.write("tiny.toml", long.0);
    place.answer(&["run", "tiny.toml", "--quick"]).with_status(0);
    assert_eq!(place.json("results/tiny/summary.json")["shortened"], 10.0);
}

#[test]
fn check_tells_network_and_cost_and_writes_nothing() {
    let place = Workplace::new();
    let before = place.names(".");
    let answer = place.answer(&["check", "tiny.toml"]).with_status(0);
    for piece in ["6 nodes, 9 links", "lorenz", "laplacian; x into y", "cost", "tangent steps"] {
        assert!(answer.stdout.contains(piece), "{piece} in:\n{}", answer.stdout);
    }
    assert_eq!(place.names("."), before);
    place.write("tiny.toml", tiny().set("sweep.step", "-1").0);
    let answer = place.answer(&["check", "tiny.toml"]).with_status(2);
    assert_eq!(answer.stdout, "");
}

#[test]
fn list_shows_titles_results_and_what_is_wrong() {
    let (place, _) = run(&tiny(), SIX_NODES, 0);
    place.write("bad.toml", "title = 1");
    place.write("changed.toml", tiny().set("seed", "2").0);
    place.write("fresh.toml", tiny().0);
    place.write("rewired.toml", tiny().replace("networks/six-node", "networks/other").0);
    place.write("networks/other.edges", SIX_NODES);
    for name in ["changed", "rewired"] {
        place.answer(&["run", &format!("{name}.toml"), "--quick"]).with_status(0);
    }
    place.write("changed.toml", tiny().0);
    place.write("networks/other.edges", format!("{SIX_NODES}1 3\n"));
    place.write("results/.fresh.unfinished/lock", "");
    place.write("results/.fresh.unfinished/journal", "hours of work");
    place.write("notes.txt", "");
    let answer = place.answer(&["list", "."]).with_status(0);
    let line = |name: &str| {
        answer.stdout.lines().find(|line| line.contains(name)).unwrap_or_else(|| panic!("{name}"))
    };
    assert!(line("tiny.toml").contains("[results] Six Lorenz oscillators, in a hurry"));
    let stale = "[results of a quick run, stale: the experiment or its network has changed since]";
    assert!(line("changed.toml").contains(stale), "{}", answer.stdout);
    assert!(line("rewired.toml").contains(stale), "{}", answer.stdout);
    assert!(line("fresh.toml").contains("[unfinished: run it again"), "{}", answer.stdout);
    assert!(line("bad.toml").contains("cannot be read: "), "{}", answer.stdout);
    assert!(!answer.stdout.contains("notes.txt"));
}

#[test]
fn an_experiment_without_a_sweep_predicts_only() {
    let (place, _) = run(&tiny().without_table("sweep"), SIX_NODES, 0);
    let summary = place.json("results/tiny/summary.json");
    assert_eq!(summary["simulations"], json!([]));
    assert_eq!(summary["cascade"].as_array().map(Vec::len), Some(4));
    assert!(!place.names("results/tiny").contains(&"sweep.csv".to_owned()));
}

#[test]
fn several_experiments_are_run_in_one_go() {
    let place = Workplace::new();
    let differing =
        tiny().without_table("sweep").set("claims.integers.equals", "[0, 0, 0, 0, 0, 0]");
    place.write("second.toml", differing.0);
    let answer = place.answer(&["run", "tiny.toml", "second.toml"]).with_status(1);
    assert!(
        answer.stdout.contains("1 claims hold, 0 differ as known, 1 differ"),
        "{}",
        answer.stdout
    );
    assert_eq!(place.names("results"), ["second", "tiny"]);
}

#[test]
fn halves_of_the_six_nodes_are_regions_that_synchronise_until_they_part() {
    // At ε = 3 only the mode that tells the halves apart is unstable; at 2 two more are.
    let experiment = tiny()
        .and("[groups.file]\npath = \"halves\"")
        .and(
            "[regions]\ndistance_within = 1e-6\ndistance_between = { of_largest = 0.1 }\n\
             error_within = { of_largest = 0.1 }\nerror_between = 0.1",
        )
        .and("[claims.p]\nof = \"regions.predicted\"\nwhere.epsilon = 3\nequals = [[\"A\"], [\"B\"]]")
        .and("[claims.s]\nof = \"regions.simulated\"\nwhere.epsilon = 3\nequals = [[\"A\"], [\"B\"]]")
        .and("[claims.pg]\nof = \"regions.predicted.grey_nodes\"\nwhere.epsilon = [3, 2]\ntrend = \"rises\"")
        .and("[claims.sg]\nof = \"regions.simulated.grey_nodes\"\nwhere.epsilon = [3, 2]\nequals = [0, 6]")
        .and("[claims.size]\nof = \"regions.predicted.cluster_size\"\nwhere.epsilon = 3\nequals = 3")
        .and("[claims.a]\nof = \"network.nodes\"\nwhere.group_prefix = \"A\"\nequals = 3");
    let place = Workplace::new();
    place.write("tiny.toml", &experiment.0);
    place.write("halves", "A\nA\nB\nB\nB\nA\n");
    place.write("networks/six-node.edges", SIX_NODES);
    let answer = place.answer(&["run", "tiny.toml"]).with_status(0);
    assert!(answer.stdout.contains("7 claims hold"), "{}", answer.stdout);
    let claims = place.json("results/tiny/summary.json")["claims"].clone();
    assert_eq!(claims[1]["obtained"], serde_json::json!([["A"], ["B"]]));
    let falling = experiment.replace("rises", "falls");
    place.write("tiny.toml", &falling.0);
    place.answer(&["run", "tiny.toml"]).with_status(1);
}

#[test]
fn a_summary_holds_every_parameter_that_was_used_and_the_version_of_its_layout() {
    let place = Workplace::new();
    let experiment = tiny().set("prepare", "[\"largest_component\", { symmetrise = \"mean\" }]");
    place.write(
        "tiny.toml",
        experiment.set("msf.average", "1000.0").set("sweep.average", "400.0").0,
    );
    place.answer(&["run", "tiny.toml", "--quick"]).with_status(0);
    let summary = place.json("results/tiny/summary.json");
    assert_eq!(summary["layout"], 1);
    let parameters = &summary["parameters"];
    for (pointer, expected) in [
        ("/oscillator/lorenz/r", json!(35.0)),
        ("/network/file/format", json!("edge_list")),
        ("/network/file/rows", json!("driven")),
        ("/spectrum/modes", json!("all")),
        ("/spectrum/tolerance", json!(1e-12)),
        // A tenth of what the file says.
        ("/msf/average", json!(100.0)),
        ("/sweep/average", json!(40.0)),
        ("/msf/renormalise", json!(0.5)),
        ("/sweep/kick", json!(1e-14)),
        ("/sweep/stride", json!(10)),
        ("/sweep/method", json!("rk4")),
        ("/sweep/tolerance", json!(null)),
        ("/sweep/component", json!("x")),
        ("/prediction/threshold", json!("exact")),
        ("/figure/kind", json!("sweep")),
    ] {
        assert_eq!(parameters.pointer(pointer), Some(&expected), "{pointer}");
    }
    let steps = summary["network"]["preparation"].as_array().unwrap();
    let steps: Vec<_> = steps.iter().map(|step| step["step"].clone()).collect();
    assert_eq!(steps, [json!("largest_component"), json!({ "symmetrise": "mean" })]);
}

#[test]
fn a_sweep_without_method_and_step_has_both_chosen_and_says_which_and_what_the_step_errs_by() {
    let place = Workplace::new();
    place.write("tiny.toml", tiny().without("sweep.step").0);
    let checked = place.answer(&["check", "tiny.toml"]).with_status(0).stdout;
    assert!(checked.contains("rk8 (chosen: a step errs by"), "{checked}");
    place.answer(&["run", "tiny.toml"]).with_status(0);
    let summary = place.json("results/tiny/summary.json");
    let step = summary["simulations_step"]["step"].as_f64().unwrap();
    let error = summary["simulations_step"]["error"].as_f64().unwrap();
    assert_eq!(summary["simulations_step"]["method"], "rk8");
    assert!(step > 0.01 && error <= 1e-8 && error > 0.0, "{step}: {error}");
    assert_eq!(summary["parameters"]["sweep"]["method"], "rk8");
    assert_eq!(summary["parameters"]["sweep"]["step"], json!(step));
    assert_eq!(summary["parameters"]["sweep"]["tolerance"], json!(1e-8));
    let text = std::fs::read_to_string(place.path("results/tiny/report.txt")).unwrap();
    assert!(text.contains("a step errs by"), "{text}");
}
