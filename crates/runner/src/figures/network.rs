//! Network panel: nodes coloured by cluster, links as wide as their weights, one scale along
//! both axes.

use super::canvas::{Anchor, Canvas, Point, Rect};
use super::error::FigureError;
use super::font::CAP_HEIGHT;
use super::label::Label;
use super::placement::{Placement, circle, grouped};
use super::stress::{hop_distances, least_stress};
use super::style::{INK, LINK_INK, NOTE_SIZE, Stroke, UNCLUSTERED, cluster_fill, ink_on};

/// Largest radius of a node, and the smallest, at which those of a crowd may overlap.
const MAX_RADIUS: f64 = 9.5;
const MIN_RADIUS: f64 = 1.2;
/// Radius over the distance of the two closest nodes.
const CLOSENESS: f64 = 0.36;
/// Largest size of a label inside a node, and the smallest that is still drawn.
const MAX_LABEL: f64 = 8.5;
const MIN_LABEL: f64 = 4.0;
/// Width of a link of median weight in a sparse network, and the narrowest and widest drawn.
const LINK_WIDTH: f64 = 1.1;
const LINK_WIDTHS: [f64; 2] = [0.15, 4.0];
/// Links up to which they are drawn at full width; more of them share the same ink.
const MANY_LINKS: f64 = 30.0;

/// Nodes and links.
#[derive(Clone, Debug, Default)]
pub struct NetworkPanel {
    /// The nodes, at least one.
    pub nodes: Vec<Node>,
    /// The links, each once.
    pub links: Vec<Link>,
    /// Where the nodes stand.
    pub placement: Placement,
    /// Names of clusters 0, 1, …, shown below the network; empty for none.
    pub cluster_labels: Vec<Label>,
}

/// A node.
#[derive(Clone, Debug)]
pub struct Node {
    /// Stands inside the node. Where the longest label of the network would have to be smaller
    /// than 4 pt to fit, no node is labelled.
    pub label: String,
    /// Number of its cluster, which has the colour of series of this style; none is grey.
    pub cluster: Option<usize>,
}

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

impl NetworkPanel {
    /// Draws the network as large as the cell allows.
    pub(super) fn draw(
        &self,
        canvas: &mut Canvas,
        cell: Rect,
        panel: &str,
    ) -> Result<(), FigureError> {
        self.check(panel)?;
        let legend_height = if self.cluster_labels.is_empty() { 0.0 } else { 1.7 * NOTE_SIZE };
        let room = Rect { bottom: cell.bottom - legend_height, ..cell }.grown(-MAX_RADIUS - 2.0);
        let (width, height) = (room.width(), room.height());
        if width < 20.0 || height < 20.0 {
            return Err(FigureError::TooSmall { panel: panel.into(), width, height });
        }
        let places = fitted(&self.places(panel)?, room);
        self.draw_links(canvas, &places);
        self.draw_nodes(canvas, &places);
        self.draw_legend(canvas, cell);
        Ok(())
    }

    fn check(&self, panel: &str) -> Result<(), FigureError> {
        let n_nodes = self.nodes.len();
        if n_nodes == 0 {
            return Err(FigureError::Empty { panel: panel.into(), what: "nodes" });
        }
        for link in &self.links {
            let node = link.from.max(link.to);
            if node >= n_nodes {
                return Err(FigureError::NodeOutOfRange { panel: panel.into(), node, n_nodes });
            }
            if !(link.weight.is_finite() && link.weight > 0.0) {
                return Err(FigureError::BadWeight { panel: panel.into(), weight: link.weight });
            }
        }
        Ok(())
    }

    /// Positions in any unit, y down.
    fn places(&self, panel: &str) -> Result<Vec<Point>, FigureError> {
        let n_nodes = self.nodes.len();
        let pairs: Vec<_> = self.links.iter().map(|l| (l.from, l.to)).collect();
        let given = match &self.placement {
            Placement::Circle => return Ok(circle(n_nodes)),
            Placement::Stress => return Ok(least_stress(&hop_distances(n_nodes, &pairs))),
            Placement::Grouped => {
                let clusters: Vec<_> = self.nodes.iter().map(|n| n.cluster).collect();
                return Ok(grouped(&clusters, &pairs));
            }
            Placement::At(given) => given,
        };
        if given.len() != n_nodes {
            let (panel, n_positions) = (panel.into(), given.len());
            return Err(FigureError::PositionCount { panel, n_positions, n_nodes });
        }
        if let Some(node) = given.iter().position(|p| p.iter().any(|c| !c.is_finite())) {
            let [x, y] = given[node];
            return Err(FigureError::BadPosition { panel: panel.into(), node, x, y });
        }
        Ok(given.iter().map(|&[x, y]| [x, -y]).collect())
    }

    fn draw_links(&self, canvas: &mut Canvas, places: &[Point]) {
        let mut weights: Vec<f64> = self.links.iter().map(|l| l.weight).collect();
        weights.sort_by(f64::total_cmp);
        let Some(median) = weights.get(weights.len() / 2) else { return };
        let crowding = (MANY_LINKS / weights.len() as f64).sqrt().min(1.0);
        let [narrowest, widest] = LINK_WIDTHS;
        for link in &self.links {
            let width = LINK_WIDTH * crowding * link.weight / median;
            let stroke = Stroke::solid(LINK_INK, width.clamp(narrowest, widest));
            canvas.line(places[link.from], places[link.to], stroke);
        }
    }

    fn draw_nodes(&self, canvas: &mut Canvas, places: &[Point]) {
        let radius = (CLOSENESS * closest(places)).clamp(MIN_RADIUS, MAX_RADIUS);
        let labels: Vec<Label> = self.nodes.iter().map(|n| Label::text(n.label.as_str())).collect();
        let widest = labels.iter().map(|l| l.width(1.0)).fold(0.0, f64::max);
        let size = MAX_LABEL.min(1.65 * radius / widest).min(1.4 * radius);
        for ((node, label), &[x, y]) in self.nodes.iter().zip(&labels).zip(places) {
            let fill = node.cluster.map_or_else(|| UNCLUSTERED.into(), cluster_fill);
            canvas.circle([x, y], radius, &fill, Stroke::solid(INK, (0.08 * radius).min(0.6)));
            if size >= MIN_LABEL {
                let at = [x, y + CAP_HEIGHT * size / 2.0];
                canvas.label_in(label, at, size, ink_on(&fill));
            }
        }
    }

    /// Coloured dots with the names of the clusters, in a row at the bottom.
    fn draw_legend(&self, canvas: &mut Canvas, cell: Rect) {
        const DOT: f64 = 3.2;
        const GAP: f64 = 10.0;
        let lead = 2.0 * DOT + 3.0;
        let widths: Vec<f64> =
            self.cluster_labels.iter().map(|l| lead + l.width(NOTE_SIZE)).collect();
        let total = widths.iter().sum::<f64>() + GAP * (widths.len().saturating_sub(1)) as f64;
        let mut left = (cell.left + cell.right - total) / 2.0;
        let middle = cell.bottom - 0.7 * NOTE_SIZE;
        for (k, (label, width)) in self.cluster_labels.iter().zip(widths).enumerate() {
            canvas.circle([left + DOT, middle], DOT, &cluster_fill(k), Stroke::solid(INK, 0.4));
            let at = [left + lead, middle + CAP_HEIGHT * NOTE_SIZE / 2.0];
            canvas.label(label, at, NOTE_SIZE, Anchor::Start);
            left += width + GAP;
        }
    }
}

/// Places moved and scaled, by the same factor along both axes, to fill a rectangle.
fn fitted(places: &[Point], room: Rect) -> Vec<Point> {
    let extent = |c: usize| {
        let values = places.iter().map(|p| p[c]);
        let low = values.clone().fold(f64::INFINITY, f64::min);
        (low, values.fold(f64::NEG_INFINITY, f64::max))
    };
    let ((left, right), (top, bottom)) = (extent(0), extent(1));
    let factor = (room.width() / (right - left)).min(room.height() / (bottom - top));
    // Nodes that all share one place have no extent to scale.
    let factor = if factor.is_finite() { factor } else { 0.0 };
    let middle = [(room.left + room.right) / 2.0, (room.top + room.bottom) / 2.0];
    let centre = [left / 2.0 + right / 2.0, top / 2.0 + bottom / 2.0];
    let moved = |c: usize, value: f64| middle[c] + factor * (value - centre[c]);
    places.iter().map(|&[x, y]| [moved(0, x), moved(1, y)]).collect()
}

/// Distance of the two closest nodes; infinite for a single one.
fn closest(places: &[Point]) -> f64 {
    let pairs =
        places.iter().enumerate().flat_map(|(k, a)| places[..k].iter().map(move |b| (a, b)));
    pairs.map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROOM: Rect = Rect { left: 10.0, top: 20.0, right: 110.0, bottom: 70.0 };

    fn svg_of(panel: &NetworkPanel) -> Result<String, FigureError> {
        let mut canvas = Canvas::new(200.0, 200.0, "");
        let cell = Rect { left: 0.0, top: 0.0, right: 200.0, bottom: 200.0 };
        panel.draw(&mut canvas, cell, "(a1)").map(|()| canvas.finish())
    }

    fn pair(weight: f64) -> NetworkPanel {
        let node = |name: &str, cluster| Node { label: name.into(), cluster };
        NetworkPanel {
            nodes: vec![node("left", Some(0)), node("right", None)],
            links: vec![Link { from: 0, to: 1, weight }],
            ..NetworkPanel::default()
        }
    }

    #[test]
    fn a_square_stays_square_in_a_wide_room() {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let places = fitted(&corners, ROOM);
        assert_eq!(places[0], [35.0, 20.0]);
        assert_eq!(places[2], [85.0, 70.0]);
    }

    #[test]
    fn nodes_at_one_place_stand_in_the_middle() {
        assert_eq!(fitted(&[[3.0, 4.0]; 2], ROOM), [[60.0, 45.0]; 2]);
    }

    #[test]
    fn nodes_bear_their_labels_and_the_colours_of_their_clusters() {
        let svg = svg_of(&pair(1.0)).unwrap();
        for expected in [">left<", ">right<", &cluster_fill(0), UNCLUSTERED] {
            assert!(svg.contains(expected), "no {expected} in {svg}");
        }
    }

    #[test]
    fn broken_networks_are_refused() {
        assert!(matches!(svg_of(&NetworkPanel::default()), Err(FigureError::Empty { .. })));
        assert!(matches!(svg_of(&pair(f64::NAN)), Err(FigureError::BadWeight { .. })));
        let mut panel = pair(1.0);
        panel.links[0].to = 2;
        assert!(matches!(svg_of(&panel), Err(FigureError::NodeOutOfRange { node: 2, .. })));
        let mut panel = pair(1.0);
        panel.placement = Placement::At(vec![[0.0, 0.0]]);
        assert!(matches!(svg_of(&panel), Err(FigureError::PositionCount { n_positions: 1, .. })));
        panel.placement = Placement::At(vec![[0.0, 0.0], [f64::NAN, 1.0]]);
        assert!(matches!(svg_of(&panel), Err(FigureError::BadPosition { node: 1, .. })));
    }
}
