//! Links of a network: few of them as lines of their own widths, many as thin translucent ones
//! that darken where they lie dense, in one element a width and layer so that files stay small.

use std::collections::BTreeMap;

use super::canvas::{Canvas, Point};
use super::style::{LINK_INK, Stroke, cluster_fill};

/// Width of a link of median weight in a sparse network, and the narrowest and widest drawn.
const LINK_WIDTH: f64 = 1.1;
const LINK_WIDTHS: [f64; 2] = [0.25, 4.0];
/// Widths are drawn as multiples of this, a fifth of the narrowest.
const WIDTH_STEP: f64 = 0.05;
/// Links up to which they are drawn at full width; more of them share the same ink.
const MANY_LINKS: f64 = 30.0;
/// Links from which they are translucent, those within a cluster in its colour.
const CROWD: usize = 200;
/// Layers that links of a crowd are dealt to; only those of different layers darken each other.
const LAYERS: usize = 12;
/// Opacity of one layer, at most.
const LAYER_OPACITY: f64 = 0.3;
/// Ink of a crowd of links over the area of the network, at most: more of them are fainter, so that
/// the nodes stand out however many links there are.
const INK: f64 = 0.35;
/// Faintest layer that can still be seen.
const LEAST_OPACITY: f64 = 0.03;

/// A link between two nodes, numbered from 0.
#[derive(Clone, Copy, Debug)]
pub struct Link {
    /// One end.
    pub from: usize,
    /// The other end.
    pub to: usize,
    /// Finite and above zero; widths are proportional to weights, within limits.
    pub weight: f64,
}

/// Draws the links between places on the page, thin ones first.
pub(super) fn draw(
    canvas: &mut Canvas,
    links: &[Link],
    places: &[Point],
    clusters: &[Option<usize>],
) {
    let widths = widths(links);
    let is_crowd = links.len() > CROWD;
    let opacity = if is_crowd { crowd_opacity(links, &widths, places) } else { 1.0 };
    let mut paths: BTreeMap<_, Vec<[Point; 2]>> = BTreeMap::new();
    for (k, (link, width)) in links.iter().zip(widths).enumerate() {
        let within = clusters[link.from].filter(|_| clusters[link.from] == clusters[link.to]);
        let (layer, inked_as) = if is_crowd { (k % LAYERS, within) } else { (0, None) };
        let steps = (width / WIDTH_STEP).round() as u32;
        let ends = [places[link.from], places[link.to]];
        paths.entry((layer, steps, inked_as)).or_default().push(ends);
    }
    for ((_, steps, inked_as), ends) in paths {
        let ink = inked_as.map_or(LINK_INK, cluster_fill);
        let stroke = Stroke::solid(ink, f64::from(steps) * WIDTH_STEP);
        canvas.segments(&ends, stroke, opacity);
    }
}

/// Opacity at which a crowd of links has so much ink, over the area that the nodes span.
fn crowd_opacity(links: &[Link], widths: &[f64], places: &[Point]) -> f64 {
    let extent = |c: usize| {
        let values = places.iter().map(|place| place[c]);
        values.clone().fold(f64::NEG_INFINITY, f64::max) - values.fold(f64::INFINITY, f64::min)
    };
    let ink = |(link, width): (&Link, &f64)| {
        let [a, b] = [places[link.from], places[link.to]];
        width * (a[0] - b[0]).hypot(a[1] - b[1])
    };
    let covered = links.iter().zip(widths).map(ink).sum::<f64>() / (extent(0) * extent(1));
    if covered > 0.0 { (INK / covered).clamp(LEAST_OPACITY, LAYER_OPACITY) } else { LAYER_OPACITY }
}

/// Width of each link: in proportion to its weight, within limits.
fn widths(links: &[Link]) -> Vec<f64> {
    let mut weights: Vec<f64> = links.iter().map(|l| l.weight).collect();
    weights.sort_by(f64::total_cmp);
    let Some(&median) = weights.get(weights.len() / 2) else { return Vec::new() };
    let crowding = (MANY_LINKS / weights.len() as f64).sqrt().min(1.0);
    let [narrowest, widest] = LINK_WIDTHS;
    let width = |link: &Link| LINK_WIDTH * crowding * link.weight / median;
    links.iter().map(|link| width(link).clamp(narrowest, widest)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use resvg::usvg::roxmltree::Document;

    /// Attribute `name` of every path drawn for a ring of nodes with these weights.
    fn drawn(name: &str, weights: &[f64], clusters: &[Option<usize>]) -> Vec<Option<String>> {
        let n_nodes = clusters.len();
        let places: Vec<Point> = (0..n_nodes).map(|i| [i as f64, (i * i) as f64]).collect();
        let link =
            |(k, &weight)| Link { from: k % n_nodes, to: (k / n_nodes + k + 1) % n_nodes, weight };
        let links: Vec<Link> = weights.iter().enumerate().map(link).collect();
        let mut canvas = Canvas::new(100.0, 100.0, "");
        draw(&mut canvas, &links, &places, clusters);
        let svg = canvas.finish();
        let document = Document::parse(&svg).unwrap();
        let paths = document.descendants().filter(|n| n.has_tag_name("path"));
        paths.map(|n| n.attribute(name).map(str::to_owned)).collect()
    }

    #[test]
    fn few_links_of_two_weights_are_two_opaque_paths() {
        let weights = [1.0, 1.0, 1.5, 1.0, 1.5];
        assert_eq!(drawn("stroke-opacity", &weights, &[None; 5]), [None, None]);
        let widths: Vec<f64> = drawn("stroke-width", &weights, &[Some(0); 5])
            .into_iter()
            .map(|width| width.unwrap().parse().unwrap())
            .collect();
        assert_eq!(widths, [1.1, 1.65]);
    }

    #[test]
    fn a_crowd_of_links_is_translucent_and_every_link_is_drawn_once() {
        let clusters: Vec<_> = (0..100).map(|i| Some(i / 50)).collect();
        let weights = vec![1.0; 5000];
        let paths = drawn("d", &weights, &clusters);
        assert!(paths.len() <= 3 * LAYERS, "{}", paths.len());
        let n_links = paths.iter().flatten().map(|d| d.matches('M').count()).sum::<usize>();
        assert_eq!(n_links, 5000);
        assert!(drawn("stroke-opacity", &weights, &clusters).iter().all(Option::is_some));
        let inks = drawn("stroke", &weights, &clusters);
        for ink in [LINK_INK, cluster_fill(0), cluster_fill(1)] {
            assert!(inks.iter().flatten().any(|found| found == ink), "no {ink}");
        }
    }

    #[test]
    fn the_more_links_the_fainter_they_are() {
        let faint = |n: usize| {
            let clusters: Vec<_> = (0..100).map(|_| None).collect();
            let opacity = drawn("stroke-opacity", &vec![1.0; n], &clusters)[0].clone().unwrap();
            opacity.parse::<f64>().unwrap()
        };
        let [few, many, most] = [250, 9_000, 900_000].map(faint);
        assert!(few > many && many > most && most >= LEAST_OPACITY, "{few}, {many}, {most}");
    }

    #[test]
    fn no_links_draw_nothing() {
        assert_eq!(drawn("d", &[], &[None; 3]), [None; 0]);
    }
}
