//! Networks that cannot be read, and nodes and modes that they do not have.

use crate::support::{SIX_NODES, Workplace, tiny};
use crate::{check_answer, check_network_refused, check_refused};

#[test]
fn a_network_file_that_is_missing_or_a_folder_is_said_to_be() {
    let names = |path: &str| tiny().set("network.file.path", path);
    check_refused(
        &names("\"networks/ring.edges\""),
        &["`network.file.path` names networks/ring.edges, which does not exist", "relative to"],
    );
    check_refused(&names("\"networks\""), &["names networks, which is a folder"]);
}

#[test]
fn an_empty_network_is_refused() {
    check_network_refused("", &["expected at least one link or node, found none"]);
    check_network_refused("# nothing\n", &["expected at least one link or node, found none"]);
}

#[test]
fn a_network_of_one_node_is_refused() {
    check_network_refused("1\n", &["one node; synchronisation needs two or more"]);
}

#[test]
fn a_weight_that_is_no_positive_number_is_refused_with_line_and_column() {
    for weight in ["NaN", "-2", "0", "inf", "heavy"] {
        let found = format!("found `{weight}`");
        check_network_refused(
            format!("{SIX_NODES}1 5 {weight}\n"),
            &["line 12, column 5", "expected a weight (a finite number above zero)", &found],
        );
    }
    check_network_refused(
        "1 2 1e308\n1 3 1e308\n",
        &["weights", "node `1`", "add up to more than 1.8e308"],
    );
}

#[test]
fn a_self_loop_a_repeated_and_a_malformed_link_are_refused_with_their_lines() {
    let check = |line: &str, expected: &[&str]| {
        check_network_refused(format!("{SIX_NODES}{line}\n"), expected);
    };
    check("4 4", &["line 12, column 3: expected a second node, found `4` again"]);
    check("2 1", &["line 12: the link `2`–`1` was already given in line 3"]);
    check("1 5 1.0 7", &["line 12, column 9", "found `7` as a fourth value"]);
    check("1,,5", &["line 12, column 3: expected a value"]);
    check("1; 5", &["line 12, column 2", "found ';'"]);
    check("\"1 5", &["line 12, column 1: expected a closing quote"]);
}

#[test]
fn a_network_that_is_no_text_is_refused() {
    check_network_refused(b"1 2\n\xff\xfe", &["line 2, column 1: expected text in UTF-8"]);
    let million = format!("1 2\n{}", "1".repeat(1_000_000));
    check_network_refused(million, &["line 2 is longer than 65536 bytes"]);
}

#[test]
fn an_unknown_node_is_answered_with_those_there_are() {
    let nodes = "its nodes are 1, 2, 3, 4, 5, 6";
    check_refused(
        &tiny().set("sweep.error_to", "7"),
        &["`sweep.error_to` names node \"7\"", nodes],
    );
    check_refused(
        &tiny().set("sweep.clusters", "[[1, 9]]"),
        &["`sweep.clusters` names node \"9\", which the network does not have", nodes],
    );
    check_refused(
        &tiny().and(
            "[claims.pair]\nof = \"cascade.clusters\"\nwhere.epsilon = 2.0\nequals = [[1, 9]]",
        ),
        &["`claims.pair.equals` names node \"9\"", nodes],
    );
}

#[test]
fn a_cluster_has_two_nodes_or_more_and_shares_none() {
    let clusters = |value: &str, expected: &str| {
        check_refused(&tiny().set("sweep.clusters", value), &["`sweep.clusters`", expected]);
    };
    clusters("[[1]]", "has the cluster [1]; a cluster has two nodes or more");
    clusters("[[]]", "has the cluster []; a cluster has two nodes or more");
    clusters("[[1, 1]]", "has node \"1\" twice");
    clusters("[[1, 2], [2, 3]]", "has node \"2\" twice; clusters share no nodes");
}

#[test]
fn modes_that_a_network_does_not_have_are_refused() {
    let modes = |value: &str, expected: &str| {
        let spectrum = format!("[spectrum]\nmodes = {value}");
        check_refused(&tiny().and(&spectrum), &["`spectrum.modes`", expected]);
    };
    modes("0", "is 0, but must be 1 or more");
    modes("-1", "must be \"auto\", \"all\", a whole number or { unstable_at = … }");
    modes("2.5", "must be \"auto\", \"all\", a whole number or { unstable_at = … }");
    modes(
        "\"some\"",
        "is the text \"some\", but must be \"auto\", \"all\", a whole number or { unstable_at = … }",
    );
    check_refused(
        &tiny().and("[figure]\nmark_modes = [7]"),
        &["`figure.mark_modes` has mode 7, but the modes computed are 1 to 6"],
    );
}

#[test]
fn arpack_is_not_asked_for_all_modes() {
    for modes in ["\"all\"", "6"] {
        check_refused(
            &tiny().and(&format!("[spectrum]\nsolver = \"arpack\"\nmodes = {modes}")),
            &["`spectrum.solver` is \"arpack\", which cannot find all 6 modes", "to 5 or less"],
        );
    }
}

#[test]
fn all_modes_of_a_network_too_large_for_the_dense_solver_are_refused() {
    let nodes: String = (1..=50_001).map(|node| format!("{node}\n")).collect();
    let place = Workplace::new();
    place.write("networks/six-node.edges", nodes);
    let all = tiny().without_table("sweep").and("[spectrum]\nmodes = \"all\"");
    place.write("tiny.toml", all.0);
    let answer = place.answer(&["run", "tiny.toml"]);
    let expected = ["`spectrum.modes` asks for 50001 modes", "the most is 50000 nodes", "leading"];
    check_answer(&place, answer, "tiny.toml", &expected);
}
