//! Positions panel: nodes where they are in space, seen from above (axial), from behind (coronal)
//! and from the right (sagittal), all at one scale, coloured by cluster.
//!
//! Axes as in neuroimaging: x to the right of the subject, y to the front, z up. The left of the
//! subject is at the left of the page, and views share the axes along which they stand.

use std::collections::BTreeMap;

use super::canvas::{Anchor, Canvas, Point, Rect};
use super::drawable::Drawable;
use super::error::FigureError;
use super::font::CAP_HEIGHT;
use super::label::Label;
use super::style::{HEADER, MARKER_INK, TICK_SIZE, UNCLUSTERED, cluster_fill};
use super::title;

const X: usize = 0;
const Y: usize = 1;
const Z: usize = 2;
/// Radius of a dot over the distance of dots spread evenly over the largest view.
const CLOSENESS: f64 = 0.47;
const RADII: [f64; 2] = [0.5, 3.0];
/// Room under a view for its name, where its baseline is, and room between views side by side.
const NAME_ROW: f64 = 15.0;
const NAME_DROP: f64 = 10.0;
const GAP: f64 = 8.0;
/// Radius of the dots in the key, and room up to their names.
const KEY_DOT: f64 = 2.5;
const KEY_LEAD: f64 = 8.0;
/// Slices in depth of a view: nearer ones are drawn over those behind.
const SLICES: usize = 12;
/// Extent of a network whose nodes all share one place, in place of none.
const POINT_EXTENT: f64 = 1.0;

/// Nodes in space, from three sides.
#[derive(Clone, Debug, Default)]
pub struct PositionsPanel {
    /// Stands above the views, such as ε = 15; may be empty.
    pub title: Label,
    /// Places of the nodes, (right, front, up), in any unit; finite, at least one.
    pub positions: Vec<[f64; 3]>,
    /// Number of each node's cluster, which has its own colour up to 30; none is grey.
    pub clusters: Vec<Option<usize>>,
    /// Names of the clusters that are not called by their numbers.
    pub names: BTreeMap<usize, Label>,
    /// Name of the grey nodes in the legend, such as "not synchronisable"; empty for no legend.
    pub grey_label: Label,
}

/// One direction of sight.
struct View {
    name: &'static str,
    /// Coordinates to the right and up on the page.
    across: usize,
    up: usize,
    /// What of a node's position grows towards the eye.
    nearness: fn(&[f64; 3]) -> f64,
    /// Column and row of the view.
    column: usize,
    row: usize,
}

const VIEWS: [View; 3] = [
    View { name: "coronal", across: X, up: Z, nearness: |p| -p[Y], column: 0, row: 0 },
    View { name: "sagittal", across: Y, up: Z, nearness: |p| p[X], column: 1, row: 0 },
    View { name: "axial", across: X, up: Y, nearness: |p| p[Z], column: 0, row: 1 },
];

/// How positions become places on the page.
struct Layout {
    /// Middle of the box around all nodes, and its sides in points.
    centre: [f64; 3],
    size: [f64; 3],
    /// Points over the unit of the positions.
    scale: f64,
    /// Middles of the two columns and of the two rows of views.
    columns: [f64; 2],
    rows: [f64; 2],
}

impl Drawable for PositionsPanel {
    /// Draws the views as large as the cell allows: coronal above axial, sagittal at the right,
    /// the legend below it.
    fn draw(
        &self,
        canvas: &mut Canvas,
        cell: Rect,
        _left_margin: f64,
        panel: &str,
    ) -> Result<(), FigureError> {
        self.check(panel)?;
        let layout = self.layout(cell, panel)?;
        for view in &VIEWS {
            self.draw_view(canvas, view, &layout);
        }
        let middle = (cell.left + cell.right) / 2.0;
        title::draw(canvas, &self.title, middle, (cell, cell.right), panel);
        let right_column = layout.columns[1] - layout.size[Y] / 2.0;
        let room = [cell.right - right_column, layout.size[Y]];
        self.draw_legend(canvas, [right_column, layout.rows[1]], room);
        Ok(())
    }
}

impl PositionsPanel {
    fn check(&self, panel: &str) -> Result<(), FigureError> {
        let (n_nodes, n_clusters) = (self.positions.len(), self.clusters.len());
        if n_nodes == 0 {
            return Err(FigureError::Empty { panel: panel.into(), what: "nodes" });
        }
        if n_clusters != n_nodes {
            return Err(FigureError::ClusterCount { panel: panel.into(), n_clusters, n_nodes });
        }
        match self.positions.iter().position(|p| p.iter().any(|c| !c.is_finite())) {
            Some(node) => {
                let position = self.positions[node].to_vec();
                Err(FigureError::BadPosition { panel: panel.into(), node, position })
            }
            None => Ok(()),
        }
    }

    /// Middle of the box around all nodes, and its sides.
    fn extent(&self) -> ([f64; 3], [f64; 3]) {
        let ends = [X, Y, Z].map(|c| {
            let values = self.positions.iter().map(|p| p[c]);
            let low = values.clone().fold(f64::INFINITY, f64::min);
            (low, values.fold(f64::NEG_INFINITY, f64::max))
        });
        let sides = ends.map(|(low, high)| high - low);
        let largest = sides.into_iter().fold(0.0, f64::max);
        // A flat network still needs a little room across.
        let least = if largest > 0.0 { 0.1 * largest } else { POINT_EXTENT };
        (ends.map(|(low, high)| low / 2.0 + high / 2.0), sides.map(|side| side.max(least)))
    }

    /// One scale for all views, the largest that fits.
    fn layout(&self, cell: Rect, panel: &str) -> Result<Layout, FigureError> {
        let (centre, extent) = self.extent();
        let height = cell.height() - HEADER - 2.0 * NAME_ROW;
        let room = [cell.width() - GAP - 2.0 * RADII[1], height - 2.0 * RADII[1]];
        let [width, height] = room;
        if width < 40.0 || height < 40.0 {
            return Err(FigureError::TooSmall { panel: panel.into(), width, height });
        }
        let scale = (width / (extent[X] + extent[Y])).min(height / (extent[Z] + extent[Y]));
        let size = extent.map(|side| scale * side);
        let left = cell.left + (cell.width() - GAP - size[X] - size[Y]) / 2.0;
        let top = cell.top + HEADER + RADII[1] + (height - size[Z] - size[Y]) / 2.0;
        Ok(Layout {
            centre,
            size,
            scale,
            columns: [left + size[X] / 2.0, left + size[X] + GAP + size[Y] / 2.0],
            rows: [top + size[Z] / 2.0, top + size[Z] + NAME_ROW + size[Y] / 2.0],
        })
    }

    fn radius(&self, [x, y, z]: [f64; 3]) -> f64 {
        let area = (x * y).max(y * z).max(x * z);
        let spacing = (area / self.positions.len() as f64).sqrt();
        (CLOSENESS * spacing).clamp(RADII[0], RADII[1])
    }

    /// Far slices first; within one, grey nodes, then clusters in ascending order.
    fn draw_view(&self, canvas: &mut Canvas, view: &View, layout: &Layout) {
        let (x, y) = (layout.columns[view.column], layout.rows[view.row]);
        let radius = self.radius(layout.size);
        let mut by_depth: Vec<usize> = (0..self.positions.len()).collect();
        let nearness = |&node: &usize| (view.nearness)(&self.positions[node]);
        by_depth.sort_by(|a, b| nearness(a).total_cmp(&nearness(b)));
        for slice in by_depth.chunks(by_depth.len().div_ceil(SLICES)) {
            let mut of_cluster: BTreeMap<Option<usize>, Vec<Point>> = BTreeMap::new();
            for &node in slice {
                let offset = |c: usize| layout.scale * (self.positions[node][c] - layout.centre[c]);
                let place = [x + offset(view.across), y - offset(view.up)];
                of_cluster.entry(self.clusters[node]).or_default().push(place);
            }
            for (cluster, places) in of_cluster {
                canvas.dots(&places, radius, cluster.map_or(UNCLUSTERED, cluster_fill));
            }
        }
        let below = [x, y + layout.size[view.up] / 2.0 + NAME_DROP];
        let name = Label::text(view.name);
        // Beside another view a name has the width of its own.
        if name.width(TICK_SIZE) <= layout.size[view.across] + GAP {
            canvas.label_in(&name, below, TICK_SIZE, MARKER_INK);
        }
    }

    /// How many nodes are in clusters, then a key: each cluster with its name, as many as there is
    /// room for, and the grey nodes.
    fn draw_legend(&self, canvas: &mut Canvas, [left, middle]: Point, [width, height]: [f64; 2]) {
        if self.grey_label.is_empty() {
            return;
        }
        let mut numbers: Vec<usize> = self.clusters.iter().flatten().copied().collect();
        let (n_clustered, n_nodes) = (numbers.len(), self.clusters.len());
        numbers.sort_unstable();
        numbers.dedup();
        let plural = if numbers.len() == 1 { "" } else { "s" };
        let line_height = 1.35 * TICK_SIZE;
        let is_grey = n_clustered < n_nodes;
        let most = ((height / line_height) as usize).saturating_sub(2 + usize::from(is_grey));
        let n_named = if numbers.len() > most { most.saturating_sub(1) } else { numbers.len() };
        let mut lines = vec![
            (None, Label::text(format!("{} cluster{plural}", numbers.len()))),
            (None, Label::text(format!("{n_clustered} of {n_nodes} nodes"))),
        ];
        lines.extend(numbers[..n_named].iter().map(|&number| {
            let n_nodes = self.clusters.iter().filter(|&&of| of == Some(number)).count();
            let own = self.names.get(&number).cloned();
            let name = own.unwrap_or_else(|| Label::math("C").subscript(&(number + 1).to_string()));
            (Some(cluster_fill(number)), name.with_text(format!(": {n_nodes} nodes")))
        }));
        if n_named < numbers.len() {
            lines.push((None, Label::text(format!("and {} more", numbers.len() - n_named))));
        }
        if is_grey {
            lines.push((Some(UNCLUSTERED), self.grey_label.clone()));
        }
        let lead = |fill: Option<&str>| if fill.is_some() { KEY_LEAD } else { 0.0 };
        let widest = lines.iter().map(|(fill, line)| lead(*fill) + line.width(TICK_SIZE));
        // In a narrow column the whole key is smaller.
        let scale = (width / widest.fold(0.0, f64::max)).min(1.0);
        let above = (lines.len() - 1) as f64 / 2.0 * line_height;
        let half = scale * CAP_HEIGHT * TICK_SIZE / 2.0;
        for (k, (fill, line)) in lines.into_iter().enumerate() {
            let middle = middle + scale * (k as f64 * line_height - above);
            if let Some(fill) = fill {
                let radius = scale * KEY_DOT;
                canvas.dots(&[[left + radius, middle]], radius, fill);
            }
            let start = [left + scale * lead(fill), middle + half];
            canvas.label(&line, start, scale * TICK_SIZE, Anchor::Start);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::texts;
    use resvg::usvg::roxmltree::Document;

    const CELL: Rect = Rect { left: 0.0, top: 0.0, right: 200.0, bottom: 200.0 };

    fn corners() -> PositionsPanel {
        PositionsPanel {
            positions: vec![[0.0; 3], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 1.0]],
            clusters: vec![None, Some(0), Some(1), Some(2)],
            grey_label: Label::text("not synchronisable"),
            ..PositionsPanel::default()
        }
    }

    fn svg_of(panel: &PositionsPanel) -> Result<String, FigureError> {
        let mut canvas = Canvas::new(200.0, 200.0, "");
        panel.draw(&mut canvas, CELL, 0.0, "(a1)").map(|()| canvas.finish())
    }

    /// Places of the dots of one colour, in order of the views.
    fn dots(svg: &str, colour: &str) -> Vec<Point> {
        let document = Document::parse(svg).unwrap();
        let paths = document.descendants().filter(|n| n.attribute("stroke") == Some(colour));
        let place = |dot: &str| {
            let (x, y) = dot.split_once(' ').unwrap();
            [x.parse().unwrap(), y.trim_end_matches("h.01").parse().unwrap()]
        };
        let d: Vec<_> = paths.map(|n| n.attribute("d").unwrap().to_owned()).collect();
        d.iter().flat_map(|d| d.split('M').skip(1).map(place)).collect()
    }

    #[test]
    fn right_is_right_front_is_up_from_above_and_every_view_has_one_scale() {
        let svg = svg_of(&corners()).unwrap();
        let [origin, right, front, top] =
            [UNCLUSTERED, cluster_fill(0), cluster_fill(1), cluster_fill(2)]
                .map(|colour| dots(&svg, colour));
        let moved = |to: &[Point], view: usize| {
            [to[view][0] - origin[view][0], to[view][1] - origin[view][1]]
        };
        let [coronal, sagittal, axial] = [0, 1, 2];
        let unit = moved(&right, coronal)[0] / 2.0;
        assert!(unit > 10.0);
        let near = |a: Point, b: Point| (a[0] - b[0]).abs() < 0.03 && (a[1] - b[1]).abs() < 0.03;
        assert!(near(moved(&right, axial), [2.0 * unit, 0.0]));
        assert!(near(moved(&front, axial), [0.0, -3.0 * unit]));
        assert!(near(moved(&front, sagittal), [3.0 * unit, 0.0]));
        for view in [coronal, sagittal] {
            assert!(near(moved(&top, view), [0.0, -unit]));
        }
        // The same coordinate stands at the same place in views that share an axis.
        assert_eq!(origin[coronal][0], origin[axial][0]);
        assert_eq!(origin[coronal][1], origin[sagittal][1]);
    }

    #[test]
    fn nearer_nodes_are_drawn_over_those_behind() {
        let panel = PositionsPanel {
            positions: vec![[0.0, 0.0, 5.0], [0.0, 0.0, -5.0]],
            clusters: vec![Some(0), Some(1)],
            ..PositionsPanel::default()
        };
        let svg = svg_of(&panel).unwrap();
        assert!(svg.rfind(cluster_fill(0)) > svg.rfind(cluster_fill(1)));
    }

    #[test]
    fn the_legend_counts_clusters_and_their_nodes() {
        let svg = svg_of(&corners()).unwrap();
        for expected in [">3 clusters<", ">3 of 4 nodes<", ">not synchronisable<", ">axial<"] {
            assert!(svg.contains(expected), "no {expected} in {svg}");
        }
        let one = PositionsPanel { clusters: vec![Some(4); 4], ..corners() };
        let svg = svg_of(&one).unwrap();
        assert!(svg.contains(">1 cluster<"));
        assert!(!svg.contains("synchronisable"), "a key to grey nodes that there are not");
        let names = BTreeMap::from([(4, Label::text("left"))]);
        let named = texts(&svg_of(&PositionsPanel { names, ..one }).unwrap());
        assert!(named.contains(&"left: 4 nodes".to_string()), "{named:?}");
    }

    #[test]
    fn nodes_at_one_place_are_drawn_and_broken_ones_refused() {
        let mut panel = PositionsPanel { positions: vec![[7.0; 3]; 4], ..corners() };
        assert!(!svg_of(&panel).unwrap().contains("NaN"));
        panel.positions[2][1] = f64::NAN;
        assert!(matches!(svg_of(&panel), Err(FigureError::BadPosition { node: 2, .. })));
        panel.clusters.pop();
        assert!(matches!(svg_of(&panel), Err(FigureError::ClusterCount { n_clusters: 3, .. })));
        let none = PositionsPanel::default();
        assert!(matches!(svg_of(&none), Err(FigureError::Empty { .. })));
    }
}
