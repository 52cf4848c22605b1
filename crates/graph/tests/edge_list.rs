//! The edge-list reader: what it understands, what it refuses and where, and what it costs.

use std::io::Read;

use graph::Network;
use graph::formats::edge_list::{EdgeListError, read};
use graph::formats::{MAX_LINE_BYTES, TextError};
use proptest::prelude::*;

fn links(network: &Network) -> Vec<(&str, &str, f64)> {
    let labels = network.labels();
    let mut links = Vec::new();
    for (i, row) in network.adjacency().outer_iterator().enumerate() {
        let later = row.iter().filter(|&(j, _)| i < j);
        links.extend(later.map(|(j, &a)| (labels[i].as_str(), labels[j].as_str(), a)));
    }
    links
}

#[track_caller]
fn check_links(text: &str, expected: &[(&str, &str, f64)]) {
    assert_eq!(links(&read(text.as_bytes()).unwrap()), expected, "{text:?}");
}

#[track_caller]
fn check_labels(text: &str, expected: &[&str]) {
    assert_eq!(read(text.as_bytes()).unwrap().labels(), expected, "{text:?}");
}

#[track_caller]
fn check_refused(text: impl AsRef<[u8]>, message: &str) {
    assert_eq!(read(text.as_ref()).unwrap_err().to_string(), message);
}

#[test]
fn the_nepal_grid_has_15_nodes_and_62_links() {
    let file = include_str!("../../../experiments/networks/nepal.edges");
    let network = read(file.as_bytes()).unwrap();
    assert_eq!((network.n_nodes(), network.n_links()), (15, 62));
    // Degrees follow from the description: 14 meets {6..13} and 15.
    let degrees = [7., 7., 7., 7., 7., 13., 13., 13., 8., 8., 8., 8., 8., 9., 1.];
    assert_eq!(network.strengths(), degrees);
}

#[test]
fn the_weights_of_the_six_node_network_are_read_where_given() {
    let file = include_str!("../../../experiments/networks/six-node.edges");
    let network = read(file.as_bytes()).unwrap();
    assert_eq!(network.strengths(), [3.0, 3.5, 3.5, 3.0, 3.5, 3.5]);
    assert_eq!(network.labels(), ["1", "2", "3", "4", "5", "6"]);
}

#[test]
fn blanks_tabs_and_commas_separate_columns() {
    let expected = [("a", "b", 2.0)];
    for text in ["a b 2", "a\tb\t2", "a,b,2", " a , b , 2 ", "a b,2\n", "a\t ,b 2e0 "] {
        check_links(text, &expected);
    }
}

#[test]
fn comments_and_blank_lines_are_passed_over() {
    let text = "# head\n% head\n\n  \t\n  # more\na b # trailing\nb c 3 % trailing\n#end";
    check_links(text, &[("a", "b", 1.0), ("b", "c", 3.0)]);
}

#[test]
fn a_comment_sign_inside_a_label_belongs_to_it() {
    check_links("a#1 50%", &[("a#1", "50%", 1.0)]);
}

#[test]
fn quotes_allow_separators_and_quotes_in_labels() {
    check_links(r##""area 17","#a;b, ""c""" "2.5""##, &[("area 17", "#a;b, \"c\"", 2.5)]);
}

#[test]
fn labels_are_any_text() {
    check_links("Zürich 東京 1\n", &[("Zürich", "東京", 1.0)]);
}

#[test]
fn lines_may_end_in_crlf_and_a_byte_order_mark_may_stand_first() {
    check_links("\u{feff}a b\r\nb c 2\r\n\r\n", &[("a", "b", 1.0), ("b", "c", 2.0)]);
}

#[test]
fn integer_labels_are_numbered_in_numeric_order() {
    check_labels("10 9\n2 10\n0 1", &["0", "1", "2", "9", "10"]);
    let beyond_u128 = format!("1{}", "0".repeat(50));
    check_labels(&format!("{beyond_u128} 7"), &["7", &beyond_u128]);
    check_labels("010 9\n10 9", &["9", "10", "010"]);
}

#[test]
fn other_labels_are_numbered_in_order_of_first_appearance() {
    check_labels("10 9\n2 b\n1 10", &["10", "9", "2", "b", "1"]);
    check_labels("2 1\n-1 2", &["2", "1", "-1"]);
}

#[test]
fn a_line_with_one_label_declares_a_node() {
    let network = read("c\na b\na\n\"d e\" # alone".as_bytes()).unwrap();
    assert_eq!(network.labels(), ["c", "a", "b", "d e"]);
    assert_eq!(network.isolated_nodes(), [0, 3]);
}

#[test]
fn a_link_given_twice_names_both_lines() {
    let message = "line 4: the link `b`–`a` was already given in line 1";
    check_refused("a b\nb c\n# no\nb a 2\nc b\na b", message);
    check_refused("1 2\n1 2", "line 2: the link `1`–`2` was already given in line 1");
}

#[test]
fn a_link_to_itself_is_refused() {
    check_refused("a b\n  c c", "line 2, column 5: expected a second node, found `c` again");
}

#[test]
fn weights_must_be_finite_numbers_above_zero() {
    let weights = ["0", "-0", "-1", "nan", "NaN", "inf", "-inf", "1e999", "1e-999", "abc", "1_000"];
    for weight in weights {
        let message = format!(
            "line 1, column 5: expected a weight (a finite number above zero), found `{weight}`"
        );
        check_refused(format!("a b {weight}"), &message);
    }
}

#[test]
fn a_header_line_is_answered_at_its_weight() {
    let message =
        "line 1, column 9: expected a weight (a finite number above zero), found `weight`";
    check_refused("from to weight\n1 2 3", message);
}

#[test]
fn a_fourth_column_is_refused() {
    let message = "line 2, column 7: expected at most two nodes and a weight, found `x` as a \
                   fourth value";
    check_refused("a b\na c 1 x", message);
}

#[test]
fn nothing_between_commas_is_refused() {
    let message = |column| {
        format!("line 1, column {column}: expected a value, found nothing between the separators")
    };
    check_refused("a,,2", &message(3));
    check_refused(",a", &message(1));
    check_refused("a,b,", &message(5));
    check_refused("a, # b", &message(4));
    check_refused("a \"\"", &message(3));
}

#[test]
fn a_semicolon_is_not_taken_for_part_of_a_label() {
    let message = "line 1, column 2: expected a blank, a comma or a quoted value, found ';'";
    check_refused("1;2\n2;3", message);
}

#[test]
fn invisible_characters_are_not_taken_for_part_of_a_label() {
    let message = |column, found| {
        format!(
            "line 1, column {column}: expected printable text, a blank, a tab or a comma, \
             found '{found}'"
        )
    };
    check_refused("é1\u{a0}2", &message(3, "\\u{a0}"));
    check_refused("1 2\r3 4", &message(4, "\\r"));
    check_refused("1 2\u{0}", &message(4, "\\0"));
}

#[test]
fn quotes_open_and_close_around_whole_values() {
    let message = "line 1, column 3: expected a closing quote before the end of the line";
    check_refused("a \"b\nc\"", message);
    let message = "line 1, column 4: expected a blank or a comma after the quote, found 'c'";
    check_refused("\"b\"c", message);
    let message = "line 1, column 2: expected a blank, a comma or a quoted value, found '\"'";
    check_refused("b\"c\"", message);
}

#[test]
fn a_file_without_nodes_is_refused() {
    check_refused("", "expected at least one link or node, found none in 0 lines");
    check_refused("# a\n\n%b", "expected at least one link or node, found none in 3 lines");
}

#[test]
fn bytes_that_are_not_utf8_are_refused_where_they_stand() {
    let message = "line 2, column 3: expected text in UTF-8, found the byte 0xfc";
    check_refused(b"a b\n\xc3\xa9Z\xfcrich b", message);
    // What a spreadsheet saves as "Unicode text" is UTF-16.
    let message = "line 1, column 1: expected text in UTF-8, found the byte 0xff";
    check_refused(b"\xff\xfe1\x002\x00", message);
}

#[test]
fn offending_text_is_quoted_only_at_its_beginning() {
    let weight = "x".repeat(60_000);
    let error = read(format!("a b {weight}").as_bytes()).unwrap_err();
    let EdgeListError::BadWeight { found, .. } = error else { panic!("{error}") };
    assert_eq!(found, format!("{}…", "x".repeat(40)));
}

#[test]
fn a_line_at_the_limit_is_read_and_one_byte_more_is_refused() {
    for end in ["", "\n", "\r\n"] {
        let comment = "#".repeat(MAX_LINE_BYTES);
        assert!(read(format!("a b\n{comment}{end}").as_bytes()).is_ok());
        let error = read(format!("a b\n{comment}#{end}").as_bytes()).unwrap_err();
        assert!(matches!(error, EdgeListError::Text(TextError::LineTooLong { line: 2, .. })));
    }
}

/// Counts the bytes taken from an endless line.
struct Endless {
    taken: usize,
}

impl Read for &mut Endless {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        buffer.fill(b'x');
        self.taken += buffer.len();
        Ok(buffer.len())
    }
}

#[test]
fn an_endless_line_is_refused_before_it_fills_the_memory() {
    let mut source = Endless { taken: 0 };
    let error = read(&mut source).unwrap_err();
    let start = "x".repeat(40);
    let message =
        format!("line 1 is longer than {MAX_LINE_BYTES} bytes; it begins with `{start}…`");
    assert_eq!(error.to_string(), message);
    assert!(source.taken <= 3 * MAX_LINE_BYTES, "{} bytes taken", source.taken);
}

/// Gives a line, is interrupted, and then fails.
struct Failing(u32);

impl Read for Failing {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        self.0 += 1;
        match self.0 {
            1 => (&b"a b\n"[..]).read(buffer),
            2 => Err(std::io::ErrorKind::Interrupted.into()),
            _ => Err(std::io::Error::other("the disc is gone")),
        }
    }
}

#[test]
fn a_failing_source_is_answered_with_its_own_reason() {
    let EdgeListError::Text(error) = read(Failing(0)).unwrap_err() else { panic!() };
    assert_eq!(error.to_string(), "line 2: reading failed");
    let source = std::error::Error::source(&error).unwrap();
    assert_eq!(source.to_string(), "the disc is gone");
}

/// A million links take about a second; run with `--ignored --nocapture` to see it.
#[test]
#[ignore = "a measurement"]
fn a_million_links_are_read() {
    let n_nodes = 100_000usize;
    let step = |k: usize| 1 + 37 * k;
    let link = |l: usize| (l % n_nodes, (l % n_nodes + step(l / n_nodes)) % n_nodes);
    let text: String =
        (0..1_000_000).map(link).map(|(i, j)| format!("node{i} node{j} 1.5\n")).collect();
    let start = std::time::Instant::now();
    let network = read(text.as_bytes()).unwrap();
    println!("{} links in {:?}", network.n_links(), start.elapsed());
    assert_eq!((network.n_nodes(), network.n_links()), (n_nodes, 1_000_000));
}

/// Every node declared in order, then every link, all labels quoted.
fn written(labels: &[String], links: &[(usize, usize, f64)]) -> String {
    let quoted = |i: usize| format!("\"{}\"", labels[i].replace('"', "\"\""));
    let nodes: String = (0..labels.len()).map(|i| quoted(i) + "\n").collect();
    let link = |&(i, j, w): &(usize, usize, f64)| format!("{},{}\t{w}\n", quoted(i), quoted(j));
    nodes + &links.iter().map(link).collect::<String>()
}

prop_compose! {
    fn any_network()(labels in prop::collection::hash_set("[^\r\n]{1,6}", 1..12))
        (weights in prop::collection::vec(
            prop::option::of(prop::num::f64::POSITIVE | prop::num::f64::SUBNORMAL),
            labels.len() * (labels.len() - 1) / 2,
        ), labels in Just(labels)) -> (Vec<String>, Vec<(usize, usize, f64)>)
    {
        let pairs = (0..labels.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        let present = |((i, j), w): (_, Option<f64>)| w.map(|w: f64| (i, j, w.abs()));
        (labels.into_iter().collect(), pairs.zip(weights).filter_map(present).collect())
    }
}

proptest! {
    #[test]
    fn arbitrary_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let _ = read(&bytes[..]);
    }

    #[test]
    fn arbitrary_lines_never_panic(text in "([ab1,\"#%; \t\r\n\u{feff}.é-]{0,8}\n?){0,20}") {
        if let Ok(network) = read(text.as_bytes()) {
            prop_assert!(network.n_nodes() > 0);
        }
    }

    #[test]
    fn any_network_survives_being_written_and_read((labels, links) in any_network()) {
        let integers = labels.iter().all(|l| l.bytes().all(|b| b.is_ascii_digit()));
        prop_assume!(!integers);
        let read_back = read(written(&labels, &links).as_bytes()).unwrap();
        prop_assert_eq!(read_back, Network::undirected(labels, &links).unwrap());
    }

    #[test]
    fn shuffled_integer_labels_give_the_same_network(
        order in Just((0..9usize).collect::<Vec<_>>()).prop_shuffle(),
        present in prop::collection::vec(any::<bool>(), 36),
    ) {
        let pairs = (0..9).flat_map(|i| (0..i).map(move |j| (i, j)));
        let links: Vec<_> =
            pairs.zip(present).filter(|&(_, p)| p).map(|((i, j), _)| (i, j, 1.0)).collect();
        let labels: Vec<_> = (0..9).map(|i| (i + 5).to_string()).collect();
        let nodes: String = order.iter().map(|i| format!("{}\n", i + 5)).collect();
        let text: String = links.iter().map(|(i, j, _)| format!("{} {}\n", i + 5, j + 5)).collect();
        let read_back = read((nodes + &text).as_bytes()).unwrap();
        prop_assert_eq!(read_back, Network::undirected(labels, &links).unwrap());
    }
}
