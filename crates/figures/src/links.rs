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
/// Opacity of one layer.
const LAYER_OPACITY: f64 = 0.3;

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
        canvas.segments(&ends, stroke, if is_crowd { LAYER_OPACITY } else { 1.0 });
    }
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
    fn no_links_draw_nothing() {
        assert_eq!(drawn("d", &[], &[None; 3]), [None; 0]);
    }
}
