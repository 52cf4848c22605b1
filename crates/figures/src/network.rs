//! Network panel: nodes coloured by cluster, links as wide as their weights, one scale along
//! both axes.

use std::ops::Range;

use super::canvas::{Anchor, Canvas, Point, Rect};
use super::circle::circle;
use super::drawable::Drawable;
use super::error::FigureError;
use super::font::CAP_HEIGHT;
use super::label::Label;
use super::links::{self, Link};
use super::placement::{Placement, grouped};
use super::stress::{hop_distances, least_stress};
use super::style::{
    HEADER, INK, LETTER_SIZE, NOTE_SIZE, Stroke, UNCLUSTERED, cluster_fill, ink_on,
};
use super::title;

/// Largest radius of a node, and the smallest, at which those of a crowd may overlap.
const MAX_RADIUS: f64 = 9.5;
const MIN_RADIUS: f64 = 1.2;
/// Room between nodes and the edge beside the radius of the largest.
const MARGIN: f64 = 2.0;
const MAX_MARGIN: f64 = MAX_RADIUS + MARGIN;
/// Radius over the distance of close nodes.
const CLOSENESS: f64 = 0.36;
/// Largest size of a label inside a node, and the smallest that is still drawn.
const MAX_LABEL: f64 = 8.5;
const MIN_LABEL: f64 = 7.0;

/// Radius of the dots in the legend, room up to their names, and between entries and rows.
const DOT: f64 = 3.2;
const DOT_LEAD: f64 = 2.0 * DOT + 3.0;
const ENTRY_GAP: f64 = 10.0;
const LEGEND_ROW: f64 = 1.4 * NOTE_SIZE;
/// Clusters that are named at all.
const MOST_NAMED: usize = 60;
/// Share of the height of a panel that its legend may take.
const LEGEND_SHARE: f64 = 0.3;

/// Nodes and links.
#[derive(Clone, Debug, Default)]
pub struct NetworkPanel {
    /// Stands above the network, such as the range of ε in which its clusters hold; may be empty.
    pub title: Label,
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
    /// than 7 pt to fit, no node is labelled.
    pub label: String,
    /// Number of its cluster, which has the colour of series of this style; none is grey.
    pub cluster: Option<usize>,
}

impl Drawable for NetworkPanel {
    /// Draws the network as large as the cell allows.
    fn draw(
        &self,
        canvas: &mut Canvas,
        cell: Rect,
        _left_margin: f64,
        panel: &str,
    ) -> Result<(), FigureError> {
        self.check(panel)?;
        let (legend, n_more) = self.legend(cell);
        let legend_height = match legend.len() {
            0 => 0.0,
            n_rows => 1.7 * NOTE_SIZE + (n_rows - 1) as f64 * LEGEND_ROW,
        };
        let legend_height = legend_height + if n_more > 0 { LEGEND_ROW } else { 0.0 };
        let header = if self.title.is_empty() { 0.0 } else { HEADER };
        let room = Rect { top: cell.top + header, bottom: cell.bottom - legend_height, ..cell };
        let [width, height] = [room.width(), room.height()].map(|side| side - 2.0 * MAX_MARGIN);
        if width < 20.0 || height < 20.0 {
            return Err(FigureError::TooSmall { panel: panel.into(), width, height });
        }
        let given = self.places(panel)?;
        let mut places = spread_over(&given, room);
        // The letter of the panel stands in the corner.
        let [right, bottom] =
            [cell.left + Label::text(panel).width(LETTER_SIZE), cell.top + LETTER_SIZE];
        let letter = Rect { right, bottom, ..cell }.grown(radius(&places));
        if places.iter().any(|&place| letter.contains(place)) {
            places = spread_over(&given, Rect { top: room.top + LETTER_SIZE, ..room });
        }
        let clusters: Vec<_> = self.nodes.iter().map(|n| n.cluster).collect();
        links::draw(canvas, &self.links, &places, &clusters);
        self.draw_nodes(canvas, &places);
        let middle = (cell.left + cell.right) / 2.0;
        title::draw(canvas, &self.title, middle, (cell, cell.right), panel);
        let mut cell = cell;
        if n_more > 0 {
            let at = [middle, cell.bottom - 0.7 * NOTE_SIZE + CAP_HEIGHT * NOTE_SIZE / 2.0];
            canvas.label(&Label::text(format!("and {n_more} more")), at, NOTE_SIZE, Anchor::Middle);
            cell.bottom -= LEGEND_ROW;
        }
        self.draw_legend(canvas, cell, legend);
        Ok(())
    }
}

impl NetworkPanel {
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
            let position = given[node].to_vec();
            return Err(FigureError::BadPosition { panel: panel.into(), node, position });
        }
        Ok(given.iter().map(|&[x, y]| [x, -y]).collect())
    }

    fn draw_nodes(&self, canvas: &mut Canvas, places: &[Point]) {
        let radius = radius(places);
        let labels: Vec<Label> = self.nodes.iter().map(|n| Label::text(n.label.as_str())).collect();
        let widest = labels.iter().map(|l| l.width(1.0)).fold(0.0, f64::max);
        let size = MAX_LABEL.min(1.65 * radius / widest).min(1.4 * radius);
        // Of nodes that stand over one another the first is named.
        let mut named: Vec<Point> = Vec::new();
        for ((node, label), &[x, y]) in self.nodes.iter().zip(&labels).zip(places) {
            let fill = node.cluster.map_or(UNCLUSTERED, cluster_fill);
            canvas.circle([x, y], radius, fill, Stroke::solid(INK, (0.08 * radius).min(0.6)));
            let is_clear =
                |other: &Point| (x - other[0]).abs() > widest * size || (y - other[1]).abs() > size;
            if size >= MIN_LABEL && named.iter().all(is_clear) {
                named.push([x, y]);
                let at = [x, y + CAP_HEIGHT * size / 2.0];
                canvas.label_in(label, at, size, ink_on(fill));
            }
        }
    }

    /// Coloured dots with the names of the clusters, in rows at the bottom.
    fn draw_legend(&self, canvas: &mut Canvas, cell: Rect, rows: Vec<LegendRow>) {
        let n_rows = rows.len();
        for (k, LegendRow { clusters, width }) in rows.into_iter().enumerate() {
            let mut left = (cell.left + cell.right - width) / 2.0;
            let middle = cell.bottom - 0.7 * NOTE_SIZE - (n_rows - 1 - k) as f64 * LEGEND_ROW;
            for cluster in clusters {
                let fill = cluster_fill(cluster);
                canvas.circle([left + DOT, middle], DOT, fill, Stroke::solid(INK, 0.4));
                let at = [left + DOT_LEAD, middle + CAP_HEIGHT * NOTE_SIZE / 2.0];
                let label = &self.cluster_labels[cluster];
                canvas.label(label, at, NOTE_SIZE, Anchor::Start);
                left += DOT_LEAD + label.width(NOTE_SIZE) + ENTRY_GAP;
            }
        }
    }

    /// The rows of the legend that leave the network the most of its cell, and how many clusters
    /// are not named in them.
    fn legend(&self, cell: Rect) -> (Vec<LegendRow>, usize) {
        let mut rows = self.legend_rows(cell.width());
        let most = (LEGEND_SHARE * cell.height() / LEGEND_ROW) as usize;
        let n_clusters = self.cluster_labels.len();
        if rows.len() > most || n_clusters > MOST_NAMED {
            rows.truncate(most.saturating_sub(1));
        }
        let n_named = rows.last().map_or(0, |row| row.clusters.end);
        (rows, n_clusters - n_named)
    }

    /// Names of clusters in as few rows as fit into a width, about equally many in each.
    fn legend_rows(&self, room: f64) -> Vec<LegendRow> {
        let n = self.cluster_labels.len().min(MOST_NAMED);
        let width = |clusters: &Range<usize>| {
            let entries = self.cluster_labels[clusters.clone()].iter();
            let widths: f64 = entries.map(|l| DOT_LEAD + l.width(NOTE_SIZE)).sum();
            widths + ENTRY_GAP * (clusters.len() - 1) as f64
        };
        let rows = |per_row: usize| -> Vec<LegendRow> {
            let starts = (0..n).step_by(per_row);
            let clusters = starts.map(|start| start..(start + per_row).min(n));
            clusters.map(|clusters| LegendRow { width: width(&clusters), clusters }).collect()
        };
        let tried = (1..=n).map(|n_rows| rows(n.div_ceil(n_rows)));
        let mut fitting = tried.skip_while(|r| r.len() < n && r.iter().any(|r| r.width > room));
        fitting.next().unwrap_or_default()
    }
}

/// Places that fill a rectangle, so that nodes of the radius they have there are whole.
fn spread_over(places: &[Point], room: Rect) -> Vec<Point> {
    let largest = fitted(places, room.grown(-MARGIN));
    let margin = radius(&largest) + MARGIN;
    fitted(places, room.grown(-margin))
}

/// Radius of nodes at these places.
fn radius(places: &[Point]) -> f64 {
    (CLOSENESS * closest(places)).clamp(MIN_RADIUS, MAX_RADIUS)
}

/// Consecutive clusters named in one row, and the width of that row.
struct LegendRow {
    clusters: Range<usize>,
    width: f64,
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

/// Distance of the two closest nodes; in a crowd that of close ones, a twentieth of the nodes
/// having a neighbour still closer. Infinite for a single node.
fn closest(places: &[Point]) -> f64 {
    let distance = |i: usize, j: usize| {
        let [a, b] = [places[i], places[j]];
        if i == j { f64::INFINITY } else { (a[0] - b[0]).hypot(a[1] - b[1]) }
    };
    let n_nodes = places.len();
    let nearest = |i| (0..n_nodes).map(|j| distance(i, j)).fold(f64::INFINITY, f64::min);
    let mut distances: Vec<f64> = (0..n_nodes).map(nearest).collect();
    distances.sort_by(f64::total_cmp);
    distances[n_nodes / 20]
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROOM: Rect = Rect { left: 10.0, top: 20.0, right: 110.0, bottom: 70.0 };

    fn svg_of(panel: &NetworkPanel) -> Result<String, FigureError> {
        let mut canvas = Canvas::new(200.0, 200.0, "");
        let cell = Rect { left: 0.0, top: 0.0, right: 200.0, bottom: 200.0 };
        panel.draw(&mut canvas, cell, 0.0, "(a1)").map(|()| canvas.finish())
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
    fn one_close_pair_sets_the_distance_of_few_nodes_but_not_of_a_crowd() {
        let row = |n: i32| {
            let mut places: Vec<Point> = (0..n).map(|k| [f64::from(k), 0.0]).collect();
            places[0][0] = 0.9;
            places
        };
        assert!((closest(&row(10)) - 0.1).abs() < 1e-12);
        assert_eq!(closest(&row(100)), 1.0);
        assert_eq!(closest(&[[0.0; 2]]), f64::INFINITY);
    }

    #[test]
    fn nodes_at_one_place_stand_in_the_middle() {
        assert_eq!(fitted(&[[3.0, 4.0]; 2], ROOM), [[60.0, 45.0]; 2]);
    }

    #[test]
    fn no_node_stands_under_the_letter_of_the_panel() {
        let positions = |places: [[f64; 2]; 2]| {
            let placement = Placement::At(places.to_vec());
            let svg = svg_of(&NetworkPanel { placement, ..pair(1.0) }).unwrap();
            let ys = svg.split(" cy=\"").skip(1).map(|rest| rest.split('"').next().unwrap());
            ys.map(|y| y.parse::<f64>().unwrap()).fold(f64::INFINITY, f64::min)
        };
        // From the upper left to the lower right corner, and the other way round.
        let (under, clear) = ([[0.0, 1.0], [1.0, 0.0]], [[1.0, 1.0], [0.0, 0.0]]);
        assert!((positions(clear) - MAX_MARGIN).abs() < 0.1, "{}", positions(clear));
        assert!(positions(under) - MAX_RADIUS > LETTER_SIZE, "{}", positions(under));
    }

    #[test]
    fn nodes_bear_their_labels_and_the_colours_of_their_clusters() {
        let svg = svg_of(&pair(1.0)).unwrap();
        for expected in [">left<", ">right<", cluster_fill(0), UNCLUSTERED] {
            assert!(svg.contains(expected), "no {expected} in {svg}");
        }
    }

    #[test]
    fn a_long_legend_breaks_into_rows_that_fit() {
        let cluster_labels = (1..=7).map(|m| Label::math("C").subscript(&m.to_string())).collect();
        let panel = NetworkPanel { cluster_labels, ..pair(1.0) };
        let lengths = |room| {
            let rows = panel.legend_rows(room);
            assert!(room < 50.0 || rows.iter().all(|r| r.width <= room));
            rows.iter().map(|r| r.clusters.len()).collect::<Vec<_>>()
        };
        assert_eq!(lengths(400.0), [7]);
        assert_eq!(lengths(153.0), [4, 3]);
        assert_eq!(lengths(10.0), [1; 7]);
        assert!(pair(1.0).legend_rows(100.0).is_empty());
    }

    #[test]
    fn a_legend_of_very_many_clusters_leaves_room_for_the_network() {
        let named = |n: usize| NetworkPanel {
            cluster_labels: vec![Label::text("a cluster with a long name"); n],
            ..pair(1.0)
        };
        let svg = svg_of(&named(1000)).unwrap();
        assert!(svg.contains(">and 997 more<"), "{svg}");
        assert!(!svg_of(&named(3)).unwrap().contains("more"));
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
