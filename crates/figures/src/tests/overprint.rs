//! What labels cover, and that none covers a part of another.

use resvg::usvg::roxmltree::{Document, Node as Element};

use super::{errors_panel, figure, network_panel};
use crate::font::{CAP_HEIGHT, Face, text_width};
use crate::*;

/// What every label covers, baseline to the height of a capital, as [left, top, right, bottom].
pub(crate) fn boxes(svg: &str) -> Vec<(String, [f64; 4])> {
    let document = Document::parse(svg).unwrap();
    let number =
        |node: &Element<'_, '_>, name| node.attribute(name).map(|v| v.parse::<f64>().unwrap());
    let labels = document.descendants().filter(|node| node.has_tag_name("text"));
    let covered = |label: Element<'_, '_>| {
        let (mut width, mut size, mut text) = (0.0, 0.0_f64, String::new());
        for piece in label.children().filter(|node| node.has_tag_name("tspan")) {
            let is_italic = piece.attribute("font-style").is_some();
            let face = if is_italic { Face::Italic } else { Face::Regular };
            let piece_size = number(&piece, "font-size").unwrap();
            size = size.max(piece_size);
            width += text_width(piece.text().unwrap(), face, piece_size);
            width += number(&piece, "dx").unwrap_or(0.0);
            text += piece.text().unwrap();
        }
        let [x, y] = ["x", "y"].map(|name| number(&label, name).unwrap());
        let left = match label.attribute("text-anchor").unwrap() {
            "start" => 0.0,
            "middle" => width / 2.0,
            _ => width,
        };
        let high = CAP_HEIGHT * size;
        let covered = match label.attribute("transform") {
            // Turned about its middle: "rotate(-90 x y)".
            Some(turned) => {
                let middle = turned.trim_end_matches(')').split(' ').skip(1);
                let middle: Vec<f64> = middle.map(|c| c.parse().unwrap()).collect();
                let [from, to] = [-0.5, 0.5].map(|share| middle[1] + share * width);
                [middle[0] - high, from, middle[0], to]
            }
            None => [x - left, y - high, x - left + width, y],
        };
        (text, covered)
    };
    labels.map(covered).collect()
}

/// Asserts that no label covers a part of another, nor leaves the page.
fn assert_clear(figure: &Figure) {
    let labels = boxes(&figure.svg().unwrap());
    let [width, height] = [figure.width_mm, figure.height_mm].map(|mm| mm * 72.0 / 25.4);
    for (k, (text, a)) in labels.iter().enumerate() {
        let is_inside = a[0] >= 0.0 && a[1] >= 0.0 && a[2] <= width && a[3] <= height;
        assert!(is_inside, "{text} at {a:?} leaves the page");
        for (other, b) in &labels[k + 1..] {
            let is_clear = a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1];
            assert!(is_clear, "{text} at {a:?} and {other} at {b:?}");
        }
    }
}

#[test]
fn labels_never_overprint_in_any_panel() {
    let msf = |zeros: &[f64]| {
        msf_panel(&MsfCurve {
            sigma: vec![0.0, 1.0, 2.0],
            lambda: vec![0.1, -0.1, 0.1],
            standard_error: vec![0.01; 3],
            stable: vec![(0.5, Some(1.5))],
            zeros: zeros.iter().map(|&zero| (zero, format!("{zero}"))).collect(),
        })
    };
    let mut crowded = errors_panel();
    crowded.markers[0].markers = (0..40)
        .map(|k| Marker {
            x: 3.0 + 0.01 * f64::from(k),
            label: Some(Label::math("ε").subscript(&k.to_string()).superscript("max")),
        })
        .collect();
    let mut network = network_panel();
    network.title = Label::text("a title that is nearly too long");
    network.cluster_labels = (1..30).map(|m| Label::text(format!("a group {m}"))).collect();
    network.placement =
        Placement::At((0..6).map(|k| [f64::from(k / 3), 0.1 * f64::from(k % 3)]).collect());
    network.nodes.iter_mut().for_each(|node| node.label = "long".into());
    let groups = (0..9).map(|g| Group { label: Label::text(format!("gr {g}")), nodes: g..g + 1 });
    let matrix = HeatMapPanel {
        title: Label::math("r").with_text(" = 0.91, 2 of 16 runs came to no end"),
        n_nodes: 9,
        values: (0..81).map(f64::from).collect(),
        bar_label: Label::math("δx").subscript("ij"),
        groups: groups.collect(),
        ..HeatMapPanel::default()
    };
    let positions = PositionsPanel {
        title: Label::math("ε").with_text(" = 15.125, predicted"),
        positions: (0..90).map(|k| [f64::from(k % 9), f64::from(k % 7), f64::from(k)]).collect(),
        clusters: (0..90).map(|k| (k > 9).then_some(k % 25)).collect(),
        names: [(0, Label::text("caudal anterior cingulate of the left"))].into(),
        grey_label: Label::text("not synchronisable"),
    };
    for width_mm in [90.0, 130.0, 170.0] {
        let contents = vec![
            vec![("(a)", Content::Lines(msf(&[0.5, 0.52, 0.54, 0.56, 0.58, 1.5])))],
            vec![
                ("(a)", Content::Lines(crowded.clone())),
                ("(b)", Content::Lines(msf(&[0.5, 1.5]))),
            ],
            vec![
                ("(a1)", Content::Network(network.clone())),
                ("(a2)", Content::HeatMap(matrix.clone())),
            ],
            vec![
                ("(b1)", Content::HeatMap(matrix.clone())),
                ("(c1)", Content::Positions(positions.clone())),
            ],
        ];
        for contents in contents {
            assert_clear(&Figure { width_mm, ..figure(contents) });
        }
    }
}
