//! States on the way, as a user plots them.

use crate::run;
use crate::support::{SIX_NODES, Toml, Workplace, tiny};

fn with_series(keys: &str) -> Toml {
    tiny().and(&format!("\n[sweep.series]\n{keys}\n"))
}

/// The header, and rows of numbers.
fn table(place: &Workplace, name: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut table = csv::Reader::from_path(place.path(name)).expect("a table can be opened");
    let header = table.headers().expect("it has a header").iter().map(str::to_owned).collect();
    let number = |field: &str| field.parse::<f64>().expect("a number");
    let rows = table.records().map(|row| row.expect("a row").iter().map(number).collect());
    (header, rows.collect())
}

#[test]
fn states_of_chosen_nodes_are_a_row_a_sample_from_the_end_of_the_transient() {
    let keys = "nodes = [2, 5]\nepsilon = [1.0, 5.0]\nseeds = 2";
    let (place, _) = run(&with_series(keys), SIX_NODES, 0);
    let names: Vec<String> = place.names("results/tiny");
    let series = names.iter().filter(|name| name.starts_with("series_"));
    let expected = [(1, 1), (1, 2), (5, 1), (5, 2)]
        .map(|(epsilon, seed)| format!("series_epsilon_{epsilon}_seed_{seed}.csv"));
    assert_eq!(series.collect::<Vec<_>>(), expected.iter().collect::<Vec<_>>());
    let (header, rows) = table(&place, "results/tiny/series_epsilon_1_seed_1.csv");
    assert_eq!(header, ["time", "x_2", "y_2", "z_2", "x_5", "y_5", "z_5"]);
    // 40 time units of samples, ten steps of 0.01 each, with both ends.
    assert_eq!(rows.len(), 401);
    for (number, row) in rows.iter().enumerate() {
        assert!((row[0] - (40.0 + 0.1 * number as f64)).abs() < 1e-9, "{row:?}");
        assert!(row[1..].iter().all(|x| x.abs() < 100.0));
    }
    // Far above the last transition all nodes are one, at weak coupling they are not.
    let (_, strong) = table(&place, "results/tiny/series_epsilon_5_seed_1.csv");
    let apart = |rows: &[Vec<f64>]| {
        rows.iter().map(|row| (row[1] - row[4]).abs()).sum::<f64>() / rows.len() as f64
    };
    assert!(apart(&strong) < 1e-6, "{}", apart(&strong));
    assert!(apart(&rows) > 1.0, "{}", apart(&rows));
}

#[test]
fn an_error_is_the_mean_of_the_differences_of_the_states_that_were_written() {
    let keys = "nodes = [2, 1]\ncomponents = [\"x\"]\nepsilon = [1.0]";
    let (place, _) = run(&with_series(keys), SIX_NODES, 0);
    let (header, rows) = table(&place, "results/tiny/series_epsilon_1_seed_1.csv");
    assert_eq!(header, ["time", "x_2", "x_1"]);
    // The state at the end of the transient is in no average.
    let averaged = &rows[1..];
    let mean = averaged.iter().map(|row| (row[2] - row[1]).abs()).sum::<f64>();
    let mean = mean / averaged.len() as f64;
    let mut sweep = csv::Reader::from_path(place.path("results/tiny/sweep.csv")).unwrap();
    let at = sweep.headers().unwrap().iter().position(|name| name == "error_1_to_2").unwrap();
    let first = sweep.records().next().unwrap().unwrap();
    assert_eq!((&first[0], &first[1]), ("1.0", "1"));
    let written: f64 = first[at].parse().unwrap();
    assert!((mean - written).abs() < 1e-12 * written, "{mean} {written}");
}

#[test]
fn every_third_state_of_one_component_begins_where_it_is_asked_to() {
    let keys =
        "nodes = [\"4\"]\ncomponents = [\"z\"]\nevery = 3\nfrom = 0\nto = 6\nepsilon = [2.0]";
    let (place, _) = run(&with_series(keys), SIX_NODES, 0);
    let (header, rows) = table(&place, "results/tiny/series_epsilon_2_seed_1.csv");
    assert_eq!(header, ["time", "z_4"]);
    let times: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(times.len(), 21);
    assert!(times.iter().enumerate().all(|(n, t)| (t - 0.3 * n as f64).abs() < 1e-9), "{times:?}");
}

#[test]
fn check_tells_how_large_series_will_be() {
    let place = Workplace::new();
    place.write("tiny.toml", with_series("nodes = [1, 2]").0);
    let said = place.answer(&["check", "tiny.toml"]).with_status(0).stdout;
    let line = said.lines().find(|line| line.starts_with("series")).expect("a line about series");
    assert!(line.contains("5 replicas, 401 states of 6 numbers each; about 281 kB"), "{line}");
}
