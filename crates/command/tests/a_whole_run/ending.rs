//! What a run ends with: the prediction beside simulation, a screen that says what matters, and the rest
//! in a file that is named.

use serde_json::json;

use crate::run;
use crate::support::{SIX_NODES, Workplace, tiny};

/// The lines after the prediction.
fn closing(stdout: &str) -> Vec<&str> {
    let lines: Vec<&str> = stdout.lines().collect();
    let start = lines.iter().rposition(|line| line.is_empty()).map_or(0, |empty| empty + 1);
    lines[start..].to_vec()
}

#[test]
fn a_run_ends_with_its_prediction_and_a_row_for_each_cluster_beside_simulation() {
    let experiment = tiny().set("sweep.epsilon", "{ from = 1.0, to = 5.0, points = 9 }");
    let (place, answer) = run(&experiment, SIX_NODES, 0);
    for expected in
        ["6 nodes, 9 links, connected", "verdict      all nodes synchronise", "seen from"]
    {
        assert!(answer.stdout.contains(expected), "{expected} in:\n{}", answer.stdout);
    }
    // σ_c = 8.17 and λ = −2, −3, −4: lost at 4.1, 2.7 and 2.0.
    let clusters = ["{1, 2, 3, 4, 5, 6}", "{1, 2, 6}", "{3, 4, 5}", "{2, 6}", "{3, 5}"];
    for (cluster, lost) in clusters.into_iter().zip(["4.", "2.", "2.", "2.", "2."]) {
        let row = |line: &&str| line.trim_start().starts_with(&format!("{cluster} "));
        let rows: Vec<&str> = answer.stdout.lines().filter(row).collect();
        let [row] = rows[..] else { panic!("one row of {cluster} in:\n{}", answer.stdout) };
        assert!(row.contains(&format!("above {lost}")) && row.contains(" ± "), "{row}");
        assert!(row.contains("at least 5"), "{row}");
    }
    let report = place.read("results/tiny/report.txt");
    assert!(answer.stdout.contains(report.lines().nth(20).unwrap()), "{report}");
}

#[test]
fn claims_and_golden_outputs_are_mentioned_only_where_there_are_some() {
    let (_, answer) = run(&tiny().without_table("claims.integers"), SIX_NODES, 0);
    assert!(!answer.stdout.contains("claim") && !answer.stdout.contains("golden"));
    let lines = closing(&answer.stdout);
    assert_eq!(lines.len(), 1, "{lines:?}");
    assert!(lines[0].starts_with("in full: results/tiny/report.txt; "), "{lines:?}");
}

#[test]
fn a_suite_ends_in_a_screen_and_everything_else_stands_in_the_reports() {
    let place = Workplace::new();
    let claim = |number: usize| {
        format!(
            "[claims.eigenvalue_{number}_at_4_10]\nof = \"eigenvalues\"\nequals = [{number}, 2]\n\
             abs_tol = 0.1\nknown_difference = \"the number {number} was misprinted, and what is \
             said of it holds for another network\"\n"
        )
    };
    let claims: String = (0..30).map(claim).collect();
    place.write("a.toml", tiny().and(&claims).0);
    place.write("b.toml", tiny().0);
    place.answer(&["run", "b.toml"]).with_status(0);
    let mut golden = place.json("results/b/summary.json");
    golden["simulations"].as_array_mut().unwrap()[0]["agreement"] = json!({ "other": 1 });
    place.write("golden/b/summary.json", golden.to_string());
    let answer = place.answer(&["run", "a.toml", "b.toml", "--golden", "golden"]).with_status(0);
    let lines: Vec<&str> = answer.stdout.lines().collect();
    assert!(lines.len() < 24, "{}", answer.stdout);
    assert_eq!(lines[0], "2 claims hold, 30 differ as known, 0 differ");
    let first = "a: eigenvalue 0 at 4.10: as known: the number 0 was misprinted,";
    assert!(lines[1].starts_with(first), "{}", answer.stdout);
    assert!(answer.stdout.contains(" more that differ\nthe golden output holds"));
    assert!(answer.stdout.contains("in full: results/a/report.txt, and so for 1 more beside it"));
    assert!(answer.stderr.contains("; 1 of 2 done, about "), "{}", answer.stderr);
    let report = place.read("results/a/report.txt");
    assert_eq!(report.matches("was misprinted").count(), 30, "every claim and its reason");
    assert!(place.read("results/b/report.txt").contains("the golden output holds"));
}

#[test]
fn a_quick_run_leaves_to_a_full_one_what_it_cannot_decide() {
    let claims = "[claims.error]\nof = \"simulated.error\"\nwhere.epsilon = 3.0\n\
        where.clusters = [[1, 2, 6]]\nat_least = 100.0\n";
    let place = Workplace::new();
    place.write("tiny.toml", tiny().and(claims).0);
    place.answer(&["run", "tiny.toml"]).with_status(1);
    let quick = ["run", "tiny.toml", "--quick", "--results", "quick"];
    let answer = place.answer(&quick).with_status(0);
    assert!(
        answer.stdout.contains("1 claims hold, 0 differ as known, 0 differ, 1 need a full run")
    );
    assert!(answer.stdout.contains("tiny: error: needs a full run"), "{}", answer.stdout);
    // The network is the same whatever the averages.
    place.write("tiny.toml", tiny().set("claims.integers.equals", "[0, -2, -3, -4, -5, -7]").0);
    let answer = place.answer(&quick).with_status(1);
    assert!(answer.stdout.contains("tiny: integers: differs: expected"), "{}", answer.stdout);
}

#[test]
fn every_node_in_every_state_stands_in_one_table() {
    let (place, _) = run(&tiny(), SIX_NODES, 0);
    let states = place.json("results/tiny/summary.json")["cascade"].as_array().unwrap().clone();
    let mut table = csv::Reader::from_path(place.path("results/tiny/membership.csv")).unwrap();
    let rows: Vec<Vec<String>> =
        table.records().map(|row| row.unwrap().iter().map(str::to_owned).collect()).collect();
    assert_eq!(rows.len(), 6 * states.len());
    for (place, state) in states.iter().enumerate() {
        let rows = &rows[6 * place..6 * (place + 1)];
        assert!(rows.iter().all(|row| row[0] == (place + 1).to_string()));
        let from: f64 = rows[0][1].parse().unwrap();
        assert_eq!(from, state["epsilon"][0].as_f64().unwrap());
        assert_eq!(rows[0][2].is_empty(), state["epsilon"][1].is_null());
        let mut numbers: Vec<&String> = rows.iter().map(|row| &row[4]).collect();
        numbers.retain(|number| !number.is_empty());
        let clusters = state["clusters"].as_array().unwrap();
        let sizes: usize = clusters.iter().map(|cluster| cluster.as_array().unwrap().len()).sum();
        assert_eq!(numbers.len(), sizes, "nodes alone are in no cluster");
        for cluster in clusters {
            let number = |node: &serde_json::Value| {
                let row = rows.iter().find(|row| row[3] == node.as_str().unwrap());
                row.expect("every node has a row")[4].clone()
            };
            let mut of: Vec<String> = cluster.as_array().unwrap().iter().map(number).collect();
            of.dedup();
            assert_eq!(of.len(), 1, "{cluster} has one number: {of:?}");
        }
    }
    // Whole network, two clusters, two pairs: five clusters in all, as in cascade.csv.
    let last = rows.iter().filter_map(|row| row[4].parse::<usize>().ok()).max();
    let cascade = place.read("results/tiny/cascade.csv");
    assert_eq!(last, Some(cascade.lines().count() - 1));
}
