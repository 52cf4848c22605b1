//! The cascade in files that others read, and which of its clusters are exact.

use crate::support::Workplace;

/// Runs a prediction of a network with exact clusters and gives the place of its results.
fn predicted(edges: &str, options: &[&str]) -> Workplace {
    let place = Workplace::new();
    place.write("net.edges", edges);
    let lorenz = ["--oscillator", "lorenz", "--coupling", "x:y", "--quick"];
    place.answer(&[&["predict", "net.edges"][..], &lorenz, options].concat()).with_status(0);
    place
}

fn six_nodes() -> Workplace {
    predicted(crate::support::SIX_NODES, &["--matrix", "laplacian"])
}

/// The rows of a table, each a list of fields.
fn rows(place: &Workplace, name: &str) -> Vec<Vec<String>> {
    let mut table = csv::Reader::from_path(place.path(&format!("results/net/{name}"))).unwrap();
    table.records().map(|row| row.unwrap().iter().map(str::to_owned).collect()).collect()
}

#[test]
fn the_tree_tells_which_cluster_splits_into_which_and_where() {
    let place = six_nodes();
    let rows = rows(&place, "cascade.csv");
    // Fan, Wang & Wang (2023), Sec. III A: six nodes, two clusters of three, two pairs.
    let shape: Vec<_> = rows.iter().map(|row| row[..6].join(" ")).collect();
    let expected = ["1  1 6 1 0", "2 1 1 3 1 1", "3 1 1 3 3 1", "4 2 1 2 2 3", "5 3 1 2 3 3"];
    let shape_of_trios: Vec<_> = expected[..3].to_vec();
    assert_eq!(shape[..3], shape_of_trios);
    assert_eq!(rows.len(), 5);
    let pairs: Vec<_> = rows[3..].iter().map(|row| row[1..5].join(" ")).collect();
    assert_eq!(pairs, ["2 1 2 2", "3 1 2 3"]);
    // Each appears where its parent splits, at the critical coupling of the summary.
    let summary = place.json("results/net/summary.json");
    let epsilon_2 = summary["critical_couplings"][0]["epsilon"].as_f64().unwrap();
    assert_eq!(rows[0][8].parse(), Ok(epsilon_2));
    assert_eq!((&rows[1][7], &rows[2][7]), (&rows[0][8], &rows[0][8]));
    assert!(rows.iter().all(|row| row[9] == "exact"), "{rows:?}");
}

#[test]
fn every_node_names_its_innermost_cluster_and_where_it_is_left_alone() {
    let place = six_nodes();
    let (clusters, nodes) = (rows(&place, "cascade.csv"), rows(&place, "clusters.csv"));
    // The pairs are {2, 6} and {3, 5}; 1 and 4 are alone where the trios split.
    let of: Vec<_> = nodes.iter().map(|row| (row[1].as_str(), row[2].as_str())).collect();
    assert_eq!(of, [("1", "2"), ("2", "4"), ("3", "5"), ("4", "3"), ("5", "5"), ("6", "4")]);
    for row in &nodes {
        let cluster: usize = row[2].parse().unwrap();
        assert_eq!(row[3], clusters[cluster - 1][8], "{row:?}");
    }
}

#[test]
fn the_tree_is_one_line_of_newick_with_the_same_numbers() {
    let place = six_nodes();
    let newick = place.read("results/net/cascade.nwk");
    let lengths: Vec<&str> =
        newick.split([':', ',', ')', ';']).filter(|part| part.contains('.')).collect();
    assert_eq!(lengths.len(), 4, "{newick}");
    let mut bare = newick.clone();
    lengths.iter().for_each(|length| bare = bare.replacen(&format!(":{length}"), "", 1));
    assert_eq!(bare, "((4)2,(5)3)1;\n");
}

#[test]
fn components_are_trees_side_by_side() {
    // The zero mode is unstable at every ε: two triangles are never one cluster.
    let place = predicted("1 2\n2 3\n3 1\n4 5\n5 6\n6 4\n", &["--matrix", "laplacian"]);
    let rows = rows(&place, "cascade.csv");
    assert!(rows.iter().all(|row| row[1].is_empty()), "{rows:?}");
    assert_eq!(place.read("results/net/cascade.nwk").lines().count(), 2);
}

#[test]
fn nodes_that_agree_by_accident_are_approximate_and_said_to_be() {
    // A path of seven nodes with a tail at the fourth: 4 and 8 have equal components in v_2 alone.
    let edges = "1 2\n2 3\n3 4\n4 5\n5 6\n6 7\n4 8\n";
    let place = Workplace::new();
    place.write("net.edges", edges);
    let command = ["predict", "net.edges", "--oscillator", "lorenz", "--coupling", "x:y"];
    let options = ["--matrix", "laplacian", "--quick"];
    let said = place.answer(&[&command[..], &options].concat()).with_status(0).stdout;
    assert!(said.contains("the other clusters are approximate"), "{said}");
    let state = place.json("results/net/summary.json")["cascade"][1].clone();
    assert_eq!(state["clusters"], serde_json::json!([["4", "8"]]));
    assert_eq!((&state["n_exact"], &state["n_approximate"]), (&0.into(), &1.into()));
    assert_eq!(
        (&state["labels"][0]["kind"], &state["equitable"]),
        (&"approximate".into(), &false.into())
    );
    // The tail has one link, the fourth node three.
    assert!(state["labels"][0]["deviation"].as_f64().unwrap() > 0.1);
}

#[test]
fn equal_sums_to_a_cluster_that_is_not_equitable_are_labelled_approximate() {
    // 1 and 2 receive 0.2 each from {3, 4, 8}, which falls apart: 4 and 8 are linked, 3 is not.
    let edges = "p 1\np 2\np' 1'\np' 2'\n4 8\n1 3 0.2\n2 4 0.2\n1' 3 0.2\n2' 4 0.2\n";
    let place = predicted(edges, &["--matrix", "laplacian"]);
    let state = place.json("results/net/summary.json")["cascade"][1].clone();
    let clusters = state["clusters"].as_array().unwrap();
    assert!(clusters.contains(&serde_json::json!(["1", "2"])), "{state}");
    assert!(clusters.contains(&serde_json::json!(["1'", "2'"])), "{state}");
    assert_eq!(state["n_exact"], 0, "{state}");
}

#[test]
fn an_approximate_cluster_says_which_exact_ones_it_holds() {
    let place = Workplace::new();
    place.write("net.edges", "a 1\na 2\nb 3\nb 4\nb 5\na b\n");
    let command = ["predict", "net.edges", "--oscillator", "lorenz", "--coupling", "x:y"];
    let options = ["--matrix", "laplacian", "--quick", "--threshold", "10"];
    let said = place.answer(&[&command[..], &options].concat()).with_status(0).stdout;
    assert!(said.contains("holds 2 exact clusters: {1, 2} {3, 4, 5}"), "{said}");
    let states = place.json("results/net/summary.json")["cascade"].clone();
    assert_eq!((&states[0]["n_exact"], &states[1]["n_exact"]), (&1.into(), &0.into()));
    let parts = serde_json::json!([["1", "2"], ["3", "4", "5"]]);
    assert_eq!(states[1]["labels"][0]["holds_exact"], parts);
    // Once the modes of the leaves against each other are unstable, nothing exact is left.
    assert_eq!(states[2]["labels"][0].get("holds_exact"), None);
}

#[test]
fn rows_of_the_cascade_count_the_modes_unstable_there() {
    let place = Workplace::new();
    place.write("net.edges", "1 2\n2 3\n3 4\n4 5\n5 6\n6 7\n7 8\n");
    let command = ["predict", "net.edges", "--oscillator", "lorenz", "--coupling", "x:y"];
    let options = ["--matrix", "laplacian", "--quick", "--threshold", "10"];
    let said = place.answer(&[&command[..], &options].concat()).with_status(0).stdout;
    assert!(said.contains("1 to 7"), "{said}");
    let states = place.json("results/net/summary.json")["cascade"].clone();
    assert_eq!(states[0]["n_unstable"], serde_json::json!([0, 0]));
    assert_eq!(states[1]["n_unstable"], serde_json::json!([1, 7]));
}

#[test]
fn every_node_of_an_exact_cluster_names_the_first_of_it() {
    let nodes = rows(&six_nodes(), "clusters.csv");
    let with: Vec<_> = nodes.iter().map(|row| (row[1].as_str(), row[4].as_str())).collect();
    assert_eq!(with, [("1", "1"), ("2", "2"), ("3", "3"), ("4", "3"), ("5", "3"), ("6", "2")]);
}

#[test]
fn a_threshold_hides_neither_the_loss_of_synchrony_nor_a_chain() {
    let place = Workplace::new();
    place.write("net.edges", "1 2\n2 3\n3 4\n4 5\n5 6\n6 7\n7 8\n");
    let command = ["predict", "net.edges", "--oscillator", "lorenz", "--coupling", "x:y"];
    let options = ["--matrix", "laplacian", "--quick", "--threshold", "0.2"];
    let said = place.answer(&[&command[..], &options].concat()).with_status(0).stdout;
    assert!(said.contains("beyond the threshold of 0.2"), "{said}");
    let summary = place.json("results/net/summary.json");
    let states = &summary["cascade"];
    assert_eq!(states[0]["clusters"], states[1]["clusters"]);
    assert_eq!(states[0]["epsilon"][0], summary["critical_couplings"][0]["epsilon"]);
    let exceeds = |state: usize| states[state]["labels"][0]["exceeds_threshold"].clone();
    assert_eq!((exceeds(0), exceeds(1)), (false.into(), true.into()));
    // The table and the tree show the loss too: all nodes twice, exact above it and a chain below.
    let table = rows(&place, "cascade.csv");
    let shown = |row: usize| [1, 3, 9, 13].map(|column| table[row][column].clone());
    assert_eq!(shown(0), ["", "8", "exact", "false"]);
    assert_eq!(shown(1), ["1", "8", "approximate", "true"]);
    let critical: f64 = table[0][8].parse().unwrap();
    assert_eq!(states[0]["epsilon"][0], critical);
    assert!(place.read("results/net/cascade.nwk").lines().next().unwrap().ends_with(")1;"));
}

#[test]
fn exact_clusters_are_equitable_and_said_to_be_exact() {
    let place = six_nodes();
    let states = place.json("results/net/summary.json")["cascade"].clone();
    for state in states.as_array().unwrap() {
        assert_eq!(state["n_approximate"], 0, "{state}");
        assert_eq!(state["equitable"], true, "{state}");
        assert!(state["exact_tolerance"].as_f64().unwrap() < 1e-9, "{state}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_summary_tells_memory_and_seconds_by_stage() {
    let place = six_nodes();
    let provenance = place.json("results/net/summary.json")["provenance"].clone();
    let bytes = provenance["peak_memory_bytes"].as_u64().unwrap();
    assert!((1 << 20..1 << 36).contains(&bytes), "{bytes}");
    let stages = provenance["stages_s"].as_object().unwrap();
    for stage in ["reading", "preparation", "spectrum", "msf", "clusters", "labels", "files"] {
        assert!(stages.contains_key(stage), "{stage} in {stages:?}");
    }
    let sum: f64 = stages.values().filter_map(serde_json::Value::as_f64).sum();
    assert!(sum <= provenance["wall_time_s"].as_f64().unwrap() + 0.02, "{provenance}");
}
