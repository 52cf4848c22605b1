//! What a reader of a figure sees: one colour and one name a cluster, marks where clusters change, the
//! panels that are asked for, and files of every kind.

use std::collections::{BTreeMap, BTreeSet};

use crate::support::{Toml, Workplace, tiny};

type Point = [f64; 2];

/// Runs an experiment and gives its place.
fn place_of(experiment: &Toml) -> Workplace {
    let place = Workplace::new();
    place.write("tiny.toml", &experiment.0);
    place.answer(&["run", "tiny.toml"]).with_status(0);
    place
}

fn svg_of(experiment: &Toml) -> String {
    place_of(experiment).read("results/tiny/figure.svg")
}

/// The attributes of every element of a name, as text.
fn elements<'a>(svg: &'a str, name: &str) -> Vec<&'a str> {
    let start = format!("<{name} ");
    svg.split(start.as_str()).skip(1).collect()
}

fn attribute<'a>(element: &'a str, name: &str) -> &'a str {
    let start = format!("{name}=\"");
    let value = element.split(start.as_str()).nth(1).expect("the element has the attribute");
    value.split('"').next().unwrap_or_default()
}

fn number(element: &str, name: &str) -> f64 {
    attribute(element, name).parse().expect("a number")
}

/// Every label with the place where it stands.
fn labels(svg: &str) -> Vec<(String, Point)> {
    let label = |element: &str| {
        let end = element.split("</text>").next().unwrap_or_default();
        let text = end.split('>').skip(1).filter_map(|piece| piece.split('<').next());
        (text.collect::<String>(), [number(element, "x"), number(element, "y")])
    };
    elements(svg, "text").into_iter().map(label).collect()
}

fn is_cluster(label: &str) -> bool {
    label.strip_prefix('C').is_some_and(|number| number.parse::<usize>().is_ok())
}

/// Colours of clusters by the key of the network: those of the dots before the names.
fn key(svg: &str) -> BTreeMap<String, String> {
    let dots = elements(svg, "circle");
    let named = labels(svg).into_iter().filter(|(text, _)| is_cluster(text));
    let colour = |(name, [x, y]): (String, Point)| {
        let is_before = |dot: &&&str| {
            let [dx, dy] = [x - number(dot, "cx"), y - number(dot, "cy")];
            (0.0..9.0).contains(&dx) && (0.0..5.0).contains(&dy)
        };
        Some((name, attribute(dots.iter().find(is_before)?, "fill").to_owned()))
    };
    named.filter_map(colour).collect()
}

/// Colours of clusters by the bands that their names stand in.
fn bands(svg: &str) -> Vec<(String, String)> {
    let bands: Vec<(Vec<Point>, &str)> = elements(svg, "polygon")
        .into_iter()
        .filter(|band| attribute(band, "fill-opacity") == "1.00")
        .map(|band| (corners(band), attribute(band, "fill")))
        .collect();
    let named = labels(svg).into_iter().filter(|(text, _)| is_cluster(text));
    let colour = |(name, [x, y]): (String, Point)| {
        let band = bands.iter().find(|(corners, _)| contains(corners, [x + 1.0, y - 1.0]))?;
        Some((name, band.1.to_owned()))
    };
    named.filter_map(colour).collect()
}

fn corners(band: &str) -> Vec<Point> {
    let corner = |pair: &str| {
        let (x, y) = pair.split_once(',')?;
        Some([x.parse().ok()?, y.parse().ok()?])
    };
    attribute(band, "points").split(' ').filter_map(corner).collect()
}

/// Whether a ray from a point to the right crosses the outline an odd number of times.
fn contains(corners: &[Point], [x, y]: Point) -> bool {
    let next = corners.iter().cycle().skip(1);
    let crosses = |(from, to): &(&Point, &Point)| {
        let share = (y - from[1]) / (to[1] - from[1]);
        (from[1] > y) != (to[1] > y) && from[0] + share * (to[0] - from[0]) > x
    };
    corners.iter().zip(next).filter(crosses).count() % 2 == 1
}

/// The tiny experiment without a sweep, whose figure has the predicted states.
fn predicted() -> Toml {
    tiny().without_table("sweep")
}

/// Names of the modes whose couplings are marked.
fn marks(svg: &str) -> BTreeSet<String> {
    let names = labels(svg).into_iter().map(|(text, _)| text);
    names.filter(|text| text.starts_with('ε') && text.len() > 'ε'.len_utf8()).collect()
}

#[test]
fn one_cluster_has_one_colour_and_one_number_in_the_network_and_in_the_states() {
    let svg = svg_of(&predicted());
    let (key, bands) = (key(&svg), bands(&svg));
    assert_eq!(key.keys().collect::<Vec<_>>(), ["C2", "C3"]);
    assert_ne!(key["C2"], key["C3"]);
    for name in key.keys() {
        let colours: Vec<_> = bands.iter().filter(|band| band.0 == *name).collect();
        assert!(!colours.is_empty(), "no {name} among {bands:?}");
        assert!(colours.iter().all(|band| band.1 == key[name]), "{colours:?} and {key:?}");
    }
}

#[test]
fn a_cluster_that_comes_back_is_called_and_coloured_as_before() {
    // Three leaves of a hub: the fastest mode parts them from the rest at strong coupling, the slowest at
    // weak coupling, and in between all are together.
    let place = Workplace::new();
    place.write("networks/six-node.edges", "1 2\n1 3\n1 4\n1 5\n5 6");
    let experiment = predicted()
        .without_table("claims.integers")
        .without_table("oscillator.lorenz")
        .set("coupling.to", "\"x\"")
        .set("msf.sigma", "{ from = 0.0, to = 6.0, points = 25 }")
        .set("msf.transient", "100.0")
        .set("msf.average", "1000.0")
        .and("[oscillator.rossler]");
    place.write("tiny.toml", &experiment.0);
    place.answer(&["run", "tiny.toml"]).with_status(0);
    let svg = place.read("results/tiny/figure.svg");
    let bands = bands(&svg);
    let table = place.read("results/tiny/cascade.csv");
    let leaves = |row: &&str| row.split(',').nth(3) == Some("3");
    assert_eq!(table.lines().skip(1).filter(leaves).count(), 2, "{table}");
    let number = table.lines().skip(1).find(leaves).and_then(|row| row.split(',').next());
    let name = format!("C{}", number.expect("a row"));
    let seen: Vec<_> = bands.iter().filter(|band| band.0 == name).collect();
    assert_eq!(seen.len(), 2, "{bands:?}");
    assert_eq!(seen[0].1, seen[1].1, "{bands:?}");
    assert_eq!(key(&svg)[&name], seen[0].1);
}

#[test]
fn columns_of_matrices_have_the_names_of_the_key() {
    let experiment = tiny()
        .without("sweep.clusters")
        .set("sweep.epsilon", "[3.5]")
        .and("[figure]\nkind = \"matrices\"");
    let svg = svg_of(&experiment);
    let names: BTreeSet<String> = key(&svg).into_keys().collect();
    assert_eq!(names.iter().collect::<Vec<_>>(), ["C2", "C3"]);
    let written: Vec<String> =
        labels(&svg).into_iter().map(|label| label.0).filter(|text| is_cluster(text)).collect();
    for name in &names {
        // In the key, over the eigenvectors, and on both sides of both matrices.
        let count = written.iter().filter(|text| *text == name).count();
        assert_eq!(count, 6, "{written:?}");
    }
    assert_eq!(written.len(), 12, "{written:?}");
}

#[test]
fn only_couplings_at_which_clusters_change_are_marked() {
    let names = |experiment: &Toml| marks(&svg_of(experiment)).into_iter().collect::<Vec<_>>();
    // Modes 5 and 6 become unstable within the sweep as well, where all nodes are alone already.
    assert_eq!(names(&tiny()), ["ε2", "ε3", "ε4"]);
    // Where the third is the last mode that is known, what becomes of clusters below it is not.
    let few = tiny().without_table("claims.integers").and("[spectrum]\nmodes = 3");
    assert_eq!(names(&few), ["ε2"]);
}

#[test]
fn where_a_prediction_ends_is_said_in_the_states() {
    let whole = labels(&svg_of(&predicted()));
    assert!(!whole.iter().any(|label| label.0 == "not predicted"));
    let few = predicted().without_table("claims.integers").and("[spectrum]\nmodes = 3");
    let few = labels(&svg_of(&few));
    assert!(few.iter().any(|label| label.0 == "not predicted"), "{few:?}");
}

#[test]
fn a_panel_that_is_asked_for_stands_alone_with_its_letter() {
    let svg = svg_of(&predicted().and("[figure]\npanels = [\"b\"]"));
    let labels: Vec<String> = labels(&svg).into_iter().map(|label| label.0).collect();
    let letters: Vec<_> = labels.iter().filter(|text| text.starts_with('(')).collect();
    assert_eq!(letters, ["(b)"]);
    assert!(labels.iter().any(|text| text == "nodes"), "{labels:?}");
    assert!(!labels.iter().any(|text| text == "Λ"), "{labels:?}");
    assert!(elements(&svg, "circle").is_empty(), "nodes of the network are drawn");
}

#[test]
fn beside_svg_and_png_is_a_pdf_of_one_page_with_its_fonts() {
    let place = place_of(&predicted());
    assert!(place.read("results/tiny/figure.svg").starts_with('<'));
    assert!(place.read_lossy("results/tiny/figure.png").contains("PNG"));
    let pdf = place.read_lossy("results/tiny/figure.pdf");
    assert!(pdf.starts_with("%PDF-") && pdf.trim_end().ends_with("%%EOF"));
    let pages = pdf.matches("/Type/Page").count() - pdf.matches("/Type/Pages").count();
    assert_eq!(pages, 1);
    let fonts = pdf.matches("/Type/FontDescriptor").count();
    assert!(fonts > 0, "no text");
    assert_eq!(pdf.matches("/FontFile2 ").count(), fonts, "a font is not embedded");
}
