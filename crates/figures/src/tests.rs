//! The figure as a whole: what a reader of the SVG and of the PNG finds in it.

pub(super) mod overprint;

use super::*;
use resvg::usvg::roxmltree::Document;

fn curve(name: &str, style: usize, y: impl Fn(f64) -> f64) -> Series {
    let x: Vec<f64> = (0..=40).map(|k| 1.0 + 0.1 * f64::from(k)).collect();
    let y = x.iter().map(|&x| y(x)).collect();
    Series { label: Label::math("δx").subscript(name), style, x, y, ..Series::default() }
}

fn errors_panel() -> LinePanel {
    let marker = |k: &str, x| Marker { x, label: Some(Label::math("ε").subscript(k)) };
    LinePanel {
        x_label: Label::text("coupling ").with_math("ε"),
        y_label: Label::math("δx").subscript("m").superscript("c"),
        zero_line: true,
        series: vec![curve("1", 0, |x| (4.1 - x).max(0.0)), curve("6", 1, |x| (2.7 - x).max(0.0))],
        markers: vec![MarkerGroup {
            style: MarkerStyle::Predicted,
            legend: Some(Label::text("predicted")),
            markers: vec![marker("2", 4.09), marker("3", 2.72), marker("99", 6.0)],
        }],
        ..LinePanel::default()
    }
}

fn network_panel() -> NetworkPanel {
    let nodes =
        ["1", "2", "3", "4", "5", "6"].map(|label| Node { label: label.into(), cluster: None });
    let links = (0..6).map(|k| Link { from: k, to: (k + 1) % 6, weight: 1.0 });
    NetworkPanel { nodes: nodes.to_vec(), links: links.collect(), ..NetworkPanel::default() }
}

fn figure(contents: Vec<(&str, Content)>) -> Figure {
    let columns = vec![1.0; contents.len()];
    let panels = contents.into_iter().enumerate().map(|(k, (letter, content))| Panel {
        letter: letter.into(),
        rows: 0..1,
        columns: k..k + 1,
        content,
    });
    Figure {
        title: "A test".into(),
        width_mm: 170.0,
        height_mm: 70.0,
        columns,
        rows: vec![1.0],
        panels: panels.collect(),
    }
}

fn with_lines(lines: LinePanel) -> Figure {
    figure(vec![("(a1)", Content::Network(network_panel())), ("(a2)", Content::Lines(lines))])
}

fn count(svg: &str, tag: &str) -> usize {
    Document::parse(svg).unwrap().descendants().filter(|n| n.has_tag_name(tag)).count()
}

pub(super) fn texts(svg: &str) -> Vec<String> {
    let document = Document::parse(svg).unwrap();
    let labels = document.descendants().filter(|n| n.has_tag_name("text"));
    labels
        .map(|n| {
            n.descendants()
                .filter_map(|d| d.text().filter(|_| d.is_text()).map(str::to_owned))
                .collect::<String>()
        })
        .collect()
}

#[test]
fn every_label_is_in_the_svg_as_text() {
    let svg = with_lines(errors_panel()).svg().unwrap();
    let texts = texts(&svg);
    for expected in ["(a1)", "(a2)", "coupling ε", "δxcm", "δx1", "δx6", "predicted", "ε2", "ε3"]
    {
        assert!(texts.iter().any(|t| t == expected), "no {expected} among {texts:?}");
    }
    assert!(!texts.iter().any(|t| t == "ε99"), "a marker beyond the range has a label");
}

#[test]
fn a_nan_leaves_a_gap() {
    let lines = |values: &[usize], value: f64| {
        let mut panel = errors_panel();
        for &k in values {
            panel.series[0].y[k] = value;
        }
        with_lines(panel).svg().unwrap()
    };
    let whole = count(&lines(&[], 0.0), "polyline");
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let broken = lines(&[10, 11, 20], value);
        assert_eq!(count(&broken, "polyline"), whole + 2);
        assert!(!broken.contains("NaN") && !broken.contains("inf"), "{broken}");
    }
}

#[test]
fn zeros_on_a_logarithmic_axis_leave_a_gap() {
    let mut panel = LinePanel { y_scale: Scale::Log, ..errors_panel() };
    panel.zero_line = false;
    panel.series[0].y[5] = 0.0;
    panel.series[1] = curve("6", 1, |x| 10f64.powf(-x));
    let svg = with_lines(panel).svg().unwrap();
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
    assert!(texts(&svg).iter().any(|t| t == "10−5"));
}

#[test]
fn equal_figures_give_equal_bytes() {
    let [one, two] = [(); 2].map(|()| with_lines(errors_panel()).svg().unwrap());
    assert_eq!(one, two);
    assert_eq!(png(&one, 100.0).unwrap(), png(&two, 100.0).unwrap());
    let mut other = errors_panel();
    other.series[0].y[3] += 0.1;
    assert_ne!(with_lines(other).svg().unwrap(), one);
}

#[test]
fn the_png_is_of_the_size_on_paper_and_shows_every_colour() {
    let svg = with_lines(errors_panel()).svg().unwrap();
    let bytes = png(&svg, 150.0).unwrap();
    let mut reader = ::png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((info.width, info.height), (1004, 413));
    let has = |rgb: [u8; 3]| pixels.chunks(3).any(|p| p == rgb);
    assert!(has([255; 3]) && has([0; 3]) && has([0xd3; 3]) && has([0x00, 0x72, 0xb2]));
}

#[test]
fn frames_of_one_column_stand_flush() {
    let mut wide = errors_panel();
    wide.series[0].y[0] = -12345.0;
    let mut figure =
        figure(vec![("(a)", Content::Lines(errors_panel())), ("(b)", Content::Lines(wide))]);
    (figure.columns, figure.rows) = (vec![1.0], vec![1.0, 1.0]);
    figure.height_mm = 140.0;
    (figure.panels[1].rows, figure.panels[1].columns) = (1..2, 0..1);
    let svg = figure.svg().unwrap();
    let document = Document::parse(&svg).unwrap();
    let frames = document
        .descendants()
        .filter(|n| n.attribute("fill") == Some("none") && n.has_tag_name("rect"));
    let lefts: Vec<_> = frames.map(|n| n.attribute("x").unwrap()).collect();
    assert_eq!(lefts.len(), 2);
    assert_eq!(lefts[0], lefts[1]);
}

#[test]
fn a_marker_beyond_every_number_is_left_out() {
    let mut panel = errors_panel();
    for x in [f64::NAN, f64::INFINITY, -1e300] {
        panel.markers[0].markers.push(Marker { x, label: Some(Label::text("nowhere")) });
    }
    assert!(!with_lines(panel).svg().unwrap().contains("nowhere"));
}

#[test]
fn empty_and_uneven_data_are_refused_by_name() {
    let message = |panel: LinePanel| with_lines(panel).svg().unwrap_err().to_string();
    assert_eq!(message(LinePanel::default()), "panel (a2) has no series");
    let mut panel = errors_panel();
    panel.series[1].y.pop();
    assert_eq!(message(panel), "series 2 of panel (a2) has 41 values of x and 40 of its y");
    let mut panel = errors_panel();
    panel.series[0].y.fill(f64::NAN);
    let expected = "series 1 of panel (a2) has no point that can be drawn among its 41";
    assert_eq!(message(panel), expected);
}

#[test]
fn impossible_grids_are_refused() {
    let mut outside = with_lines(errors_panel());
    outside.panels[1].columns = 1..3;
    assert!(matches!(outside.svg(), Err(FigureError::OutsideGrid { n_columns: 2, .. })));
    assert!(matches!(figure(vec![]).svg(), Err(FigureError::NoPanels)));
    let mut flat = with_lines(errors_panel());
    flat.height_mm = 12.0;
    assert!(matches!(flat.svg(), Err(FigureError::TooSmall { .. })));
    flat.height_mm = f64::NAN;
    assert!(matches!(flat.svg(), Err(FigureError::BadSize { .. })));
}

#[test]
fn marks_alone_are_joined_by_no_line_and_groups_are_named() {
    let mode = |k: &str, scale: f64| Mode {
        label: Label::math("v").subscript(k),
        components: (0..40).map(|i| if i == 7 { f64::NAN } else { scale * f64::from(i) }).collect(),
    };
    let groups = [0..10, 10..38, 38..40]
        .map(|nodes| Group { label: Label::text(format!("division {}", nodes.start)), nodes });
    let panel = components_panel(&[mode("2", 1.0), mode("3", -0.5)], &groups);
    let svg = with_lines(panel).svg().unwrap();
    assert_eq!(count(&svg, "polyline"), 0);
    // Each mode is one path: circles with a move for every finite component, and squares.
    let document = Document::parse(&svg).unwrap();
    let paths = document.descendants().filter(|n| n.has_tag_name("path"));
    let moves: Vec<_> = paths.map(|n| n.attribute("d").unwrap().matches('M').count()).collect();
    assert_eq!(moves[moves.len() - 2..], [39, 39]);
    let texts = texts(&svg);
    for expected in ["node i", "vk,i", "v2", "v3", "division 0", "division 10"] {
        assert!(texts.iter().any(|t| t == expected), "no {expected} among {texts:?}");
    }
    assert!(!texts.iter().any(|t| t == "division 38"), "a name is wider than its group");
}

#[test]
fn lines_stand_between_groups_only() {
    let mode = Mode { label: Label::math("v"), components: vec![0.1; 9] };
    let drawn = |ends: &[[usize; 2]]| {
        let group = |&[from, to]: &[usize; 2]| Group { label: Label::default(), nodes: from..to };
        let groups: Vec<Group> = ends.iter().map(group).collect();
        let panel = components_panel(std::slice::from_ref(&mode), &groups);
        count(&with_lines(panel).svg().unwrap(), "line")
    };
    let none = drawn(&[]);
    assert_eq!(drawn(&[[0, 9]]), none);
    assert_eq!(drawn(&[[0, 3], [3, 9]]), none + 1);
    assert_eq!(drawn(&[[0, 3], [5, 9]]), none + 2);
}

/// A network of Barabási and Albert's, three links a new node.
fn scale_free(n_nodes: usize) -> NetworkPanel {
    let mut state = 1_u64;
    let mut below = |n: usize| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as usize % n
    };
    let mut ends = vec![0, 1, 2];
    let mut links = Vec::new();
    for node in 3..n_nodes {
        for _ in 0..3 {
            let to = ends[below(ends.len())];
            if to != node {
                links.push(Link { from: node, to, weight: 1.0 });
                ends.extend([node, to]);
            }
        }
    }
    let nodes = (0..n_nodes).map(|k| Node { label: k.to_string(), cluster: None }).collect();
    NetworkPanel { nodes, links, placement: Placement::Stress, ..NetworkPanel::default() }
}

#[test]
fn a_thousand_nodes_and_two_thousand_states_are_drawn_in_seconds() {
    let states = (0..2000).map(|state: usize| {
        let n_clusters = 1 + state / 8;
        let cluster = |k: usize| CascadeCluster {
            n_nodes: 1000 / n_clusters,
            parent: (state > 0).then(|| k.min((state - 1) / 8)),
            label: Label::math("C").subscript(&k.to_string()),
            colour: k,
        };
        CascadeState {
            epsilon: (2000.0 - state as f64, (state > 0).then_some(2001.0 - state as f64)),
            clusters: (0..n_clusters)
                .map(cluster)
                .map(|c| CascadeCluster { parent: None, ..c })
                .collect(),
        }
    });
    let cascade = CascadePanel { n_nodes: 1000, states: states.collect(), shown: Some(700) };
    let started = std::time::Instant::now();
    let svg = figure(vec![
        ("(a)", Content::Network(scale_free(1000))),
        ("(b)", Content::Cascade(cascade)),
    ])
    .svg()
    .unwrap();
    let drawn = started.elapsed();
    png(&svg, 300.0).unwrap();
    let all = started.elapsed();
    println!("drawn in {drawn:?}, with its PNG in {all:?}");
    // Fifteen seconds before, and half of five now, but tests run many at once.
    assert!(all.as_secs_f64() < 10.0, "{all:?}");
    assert!(svg.len() < 1_000_000, "{} bytes", svg.len());
}

#[test]
fn a_panel_alone_has_the_size_it_has_in_the_whole() {
    let whole = with_lines(errors_panel());
    let alone = whole.only(&["a2".into()]).unwrap();
    assert_eq!((alone.panels.len(), alone.columns.len()), (1, 1));
    assert_eq!(alone.panels[0].columns, 0..1);
    assert!((alone.height_mm - whole.height_mm).abs() < 1e-9);
    let width_pt = (170.0 * 72.0 / 25.4 - 8.0 - 4.0) / 2.0 + 4.0;
    assert!((alone.width_mm * 72.0 / 25.4 - width_pt).abs() < 1e-9, "{} mm", alone.width_mm);
    let texts = texts(&alone.svg().unwrap());
    assert!(texts.iter().any(|t| t == "(a2)") && !texts.iter().any(|t| t == "(a1)"));
    assert!(whole.only(&["b".into()]).is_none());
}
