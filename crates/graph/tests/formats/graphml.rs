//! GraphML files.

use graph::Group;
use graph::formats::Attributes;
use graph::formats::graphml::read;

use super::{dense, fixture, refusal};

fn named(names: &[(&str, &str)]) -> Attributes {
    let name = |what| names.iter().find(|(w, _)| *w == what).map(|(_, name)| (*name).to_owned());
    let position = name("position").map(|p| p.split(' ').map(str::to_owned).collect());
    Attributes {
        weight: name("weight"),
        label: name("label"),
        group: name("group"),
        position: position.unwrap_or_default(),
    }
}

/// A document around what stands in its graph.
fn document(content: &str) -> String {
    format!(
        "<graphml>\n<key id=\"w\" for=\"edge\" attr.name=\"weight\"/>\n\
         <graph edgedefault=\"undirected\">\n{content}\n</graph>\n</graphml>"
    )
}

#[track_caller]
fn check_refused(text: &str, attributes: &Attributes, message: &str) {
    assert_eq!(refusal(read(text.as_bytes(), attributes)), message);
}

#[test]
fn networkxs_undirected_graph_comes_with_all_that_was_asked_for() {
    let attributes = named(&[("weight", "strength"), ("group", "area"), ("position", "x y z")]);
    let network = read(fixture!("undirected.graphml"), &attributes).unwrap();
    assert_eq!(dense(&network), [[0.0, 2.5, 0.0], [2.5, 0.0, 0.5], [0.0, 0.5, 1.0]]);
    assert!(!network.is_directed());
    assert_eq!(network.labels(), ["V1", "A1", "M1 & S1"]);
    let groups = [("visual", vec![0, 2]), ("auditory", vec![1])];
    let groups = groups.map(|(name, nodes)| Group { name: name.to_owned(), nodes });
    assert_eq!(network.groups(), groups);
    let positions = [[0.5, 1.0, -0.5], [-2.0, 1.0, -0.5], [3.0, 1.0, -0.5]];
    assert_eq!(network.positions(), Some(&positions[..]));
}

#[test]
fn networkxs_attributes_are_chosen_by_name() {
    let lengths = named(&[("weight", "length"), ("label", "full"), ("position", "y x")]);
    let network = read(fixture!("undirected.graphml"), &lengths).unwrap();
    assert_eq!(dense(&network), [[0.0, 10.0, 0.0], [10.0, 0.0, 7.0], [0.0, 7.0, 0.0]]);
    assert_eq!(network.labels(), ["area <V1>", "area <A1>", "area <M1 & S1>"]);
    assert_eq!(network.positions().unwrap()[1], [1.0, -2.0, 0.0]);
    let plain = read(fixture!("undirected.graphml"), &Attributes::default()).unwrap();
    assert_eq!(dense(&plain), [[0.0, 1.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]]);
    assert_eq!((plain.groups().len(), plain.positions()), (0, None));
}

#[test]
fn the_source_of_networkxs_directed_edge_drives_its_target() {
    let network = read(fixture!("directed.graphml"), &Attributes::default()).unwrap();
    // Nodes 3, 1, 2 and edges 3 → 1, 1 → 2: the row of 1 has 3, the row of 2 has 1.
    assert_eq!(dense(&network), [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(network.labels(), ["3", "1", "2"]);
    assert!(network.is_directed());
    let weighted = read(fixture!("directed.graphml"), &named(&[("weight", "weight")]));
    assert_eq!(refusal(weighted), "line 2, column 360: expected a value of `weight` for this edge");
}

#[test]
fn a_default_stands_for_missing_values() {
    let text = "<graphml><key id='w' for='edge' attr.name='weight'><default> 0.5 </default></key>\
                <graph edgedefault='directed'><node id='a'/><node id='b'/>\
                <edge source='a' target='b'/><edge source='b' target='a'>\
                <data key='w'>2</data></edge></graph></graphml>";
    let network = read(text.as_bytes(), &named(&[("weight", "weight")])).unwrap();
    assert_eq!(dense(&network), [[0.0, 2.0], [0.5, 0.0]]);
}

#[test]
fn edges_may_differ_from_the_graph_and_come_before_their_nodes() {
    let text = document(
        "<edge source='b' target='a'/><node id='a'/><node id='b'/><node id='c'/>\
         <edge source='c' target='a' directed='true'/>",
    );
    let network = read(text.as_bytes(), &Attributes::default()).unwrap();
    assert_eq!(network.labels(), ["a", "b", "c"]);
    assert_eq!(dense(&network), [[0.0, 1.0, 1.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]);
    assert!(network.is_directed());
}

#[test]
fn prefixes_comments_entities_and_foreign_data_are_understood() {
    let text = "\u{feff}<?xml version='1.0'?><!DOCTYPE g:graphml><!-- <graph> -->\
                <g:graphml xmlns:g='http://graphml.graphdrawing.org/xmlns'>\
                <g:key id='n' for='node' attr.name='name'/><g:key id='y' for='node'/>\
                <g:graph edgedefault='directed'><g:node id='&lt;&#x41;'>\
                <g:data key='n'>a<![CDATA[<&>]]>&amp;&#98;</g:data>\
                <g:data key='y'><y:ShapeNode><y:Fill/></y:ShapeNode></g:data>\
                </g:node></g:graph></g:graphml>";
    let by_id = read(text.as_bytes(), &Attributes::default()).unwrap();
    assert_eq!(by_id.labels(), ["<A"]);
    let by_name = read(text.as_bytes(), &named(&[("label", "name")])).unwrap();
    assert_eq!(by_name.labels(), ["a<&>&b"]);
}

#[test]
fn malformed_documents_are_refused_where_they_are_wrong() {
    let cases = [
        ("", "line 1, column 1: expected the element `graphml`, found the end of the file"),
        ("1 2\n", "line 1, column 1: expected the element `graphml`, found 1 2"),
        ("\n <svg/>", "line 2, column 2: expected the element `graphml`, found <svg>"),
        ("<graphml>\n", "line 2: expected the end of `graphml` before the end of the file"),
        (
            "<graphml>\n<graph edgedefault='directed'></graphml>",
            "line 2, column 31: ill-formed document: expected `</graph>`, but `</graphml>` was found",
        ),
        (
            "<graphml><graph/></graphml>",
            "line 1, column 10: expected the attribute `edgedefault` in <graph>",
        ),
        (
            "<graphml>\n<graph edgedefault='both'/></graphml>",
            "line 2, column 1: expected edgedefault to be `directed` or `undirected`, found `both`",
        ),
        ("<graphml></graphml>", "expected an element `graph` in `graphml`, found none"),
        (
            "<graphml><key for='node'/></graphml>",
            "line 1, column 10: expected the attribute `id` in <key>",
        ),
        (
            "<graphml><key id='a' id='b'/></graphml>",
            "line 1, column 10: expected each attribute once, found id again",
        ),
        (
            "<graphml>&nbsp;</graphml>",
            "line 1, column 10: expected one of the entities that XML defines, found &nbsp",
        ),
        (
            "<graphml><key id='a'/><key id='a'/></graphml>",
            "line 1, column 23: the key `a` was already declared",
        ),
        ("<graphml><graph edgedefault='directed'/></graphml>", "the network has no nodes"),
        (
            "<graphml/><graphml/>",
            "line 1, column 11: expected nothing after the element `graphml`, found <graphml>",
        ),
    ];
    for (text, message) in cases {
        check_refused(text, &Attributes::default(), message);
    }
}

#[test]
fn graphs_that_make_no_network_are_refused_where_they_are_wrong() {
    let nodes = "<node id='a'/>\n<node id='b'/>\n";
    let cases = [
        ("<node id='a'/>", "line 6, column 1: the node `a` was already declared"),
        ("<node/>", "line 6, column 1: expected the attribute `id` in <node>"),
        (
            " <edge source='a' target='c'/>",
            "line 6, column 2: expected the `id` of a node, found `c`",
        ),
        ("<edge source='a'/>", "line 6, column 1: expected the attribute `target` in <edge>"),
        (
            "<edge source='a' target='b'/>\n<edge source='b' target='a'/>",
            "line 7: the edge from `b` to `a` was already given in line 6",
        ),
        (
            "<edge source='a' target='b' directed='yes'/>",
            "line 6, column 1: expected directed to be `true` or `false`, found `yes`",
        ),
        ("<hyperedge/>", "line 6, column 1: expected a node or an edge, found <hyperedge>"),
        (
            "<node id='c'><graph edgedefault='directed'/></node>",
            "line 6, column 14: expected data, found <graph>",
        ),
        (
            "<edge source='a' target='b'><data key='q'>1</data></edge>",
            "line 6, column 29: expected the `id` of a key declared before, found `q`",
        ),
        ("text", "line 5, column 15: expected elements only, found text"),
    ];
    for (content, message) in cases {
        check_refused(&document(&format!("{nodes}{content}")), &Attributes::default(), message);
    }
    let weighted = named(&[("weight", "weight")]);
    for (value, shown) in [("heavy", "heavy"), ("NaN", "NaN"), ("", ""), ("1e999", "1e999")] {
        let edge = format!("<edge source='a' target='b'><data key='w'>{value}</data></edge>");
        let message =
            format!("line 6, column 1: expected `weight` to be a finite number, found `{shown}`");
        check_refused(&document(&format!("{nodes}{edge}")), &weighted, &message);
    }
}

#[test]
fn attributes_that_a_file_lacks_are_refused_with_those_that_it_has() {
    let text = document("<node id='a'/>");
    check_refused(
        &text,
        &named(&[("weight", "strength")]),
        "expected an attribute called `strength` of edges; the file declares: `weight`",
    );
    check_refused(
        &text,
        &named(&[("label", "weight")]),
        "expected an attribute called `weight` of nodes; the file declares: none",
    );
    let message = "expected two or three attributes as a position, found 1";
    check_refused(&text, &named(&[("position", "x")]), message);
}

#[test]
fn bytes_that_are_not_utf_8_are_refused() {
    let text = b"<graphml><graph edgedefault='directed'><node id='\xe4'/></graph></graphml>";
    let message = refusal(read(&text[..], &Attributes::default()));
    assert!(message.starts_with("line 1, column 40: "), "{message}");
    assert!(message.to_lowercase().contains("utf-8"), "{message}");
}

#[test]
fn a_tag_without_end_is_refused_in_bounded_memory() {
    use std::io::Read;
    let source = b"<graphml a='".chain(std::io::repeat(b'a')).take(100 << 20);
    let message = refusal(read(source, &Attributes::default()));
    let expected = "line 1: reading failed: a tag or a run of text is longer than 1048576 bytes";
    assert_eq!(message, expected);
}
