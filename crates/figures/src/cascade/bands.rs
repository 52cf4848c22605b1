//! The bands and blocks of a cascade, the thin lines between them, and their labels.
//!
//! One outline a strand and one path for all lines of a kind keep the document small.

use super::columns::{Column, Columns};
use super::layout::{Clusters, Strand, Stretch};
use super::panel::CascadePanel;
use super::style::count_within;
use crate::canvas::{Canvas, Point, Rect};
use crate::font::CAP_HEIGHT;
use crate::label::Label;
use crate::style::{INK, Stroke, TICK_SIZE, cluster_fill, ink_on, mixed_with_white};

/// Strands that never are this thick cannot be seen.
const VISIBLE: f64 = 0.1;
/// Bands and states at least this thick and wide are set apart by white lines.
const SET_APART: f64 = 3.0;
const HAIRLINE: f64 = 0.6;
/// Distance of the white lines over a block.
const HATCH: f64 = 2.4;
const HATCH_WIDTH: f64 = 0.5;
/// Share of the colour of a band, beside white, in its block.
const BLOCK_STRENGTH: f64 = 0.6;
/// Outline of the state that another panel shows.
const SHOWN_WIDTH: f64 = 1.1;
/// An open edge fades to white in so many steps of this width.
const FADE_STEPS: i32 = 6;
const FADE_STEP: f64 = 1.4;

/// Draws everything within the frame.
pub(super) fn draw(
    canvas: &mut Canvas,
    panel: &CascadePanel,
    strands: &[Strand],
    columns: &Columns,
) {
    let page = Page { panel, columns };
    for strand in strands {
        if let Some(outline) = page.outline(strand) {
            canvas.area(&outline, &fill(strand), 1.0);
        }
    }
    let white = |width| Stroke::solid("#ffffff", width);
    canvas.segments(&page.hatching(strands), white(HATCH_WIDTH), 1.0);
    canvas.segments(&page.between_bands(strands), white(HAIRLINE), 1.0);
    canvas.segments(&page.between_states(), white(HAIRLINE), 1.0);
    page.fade(canvas);
    page.outline_shown(canvas);
    for strand in strands {
        page.draw_labels(canvas, strand);
    }
}

/// A cascade on the page.
struct Page<'a> {
    panel: &'a CascadePanel,
    columns: &'a Columns,
}

/// A horizontal line: its height, and where it begins and ends.
type Level = (f64, f64, f64);

impl Page<'_> {
    fn y(&self, node: usize) -> f64 {
        let frame = self.columns.frame;
        frame.top + node as f64 / self.panel.n_nodes as f64 * frame.height()
    }

    fn extent(&self, column: &Column, stretch: &Stretch) -> Rect {
        let [top, bottom] = [stretch.from, stretch.to].map(|node| self.y(node));
        Rect { left: column.left, right: column.right, top, bottom }
    }

    /// The extents of a strand, one a state, from the left.
    fn extents(&self, strand: &Strand) -> Vec<(Rect, Stretch)> {
        let drawn = self.columns.drawn.iter();
        drawn.filter_map(|c| strand.at(c.state).map(|s| (self.extent(c, s), *s))).collect()
    }

    /// The corners of a strand; none where nothing of it can be seen.
    fn outline(&self, strand: &Strand) -> Option<Vec<Point>> {
        let extents = self.extents(strand);
        if !extents.iter().any(|(extent, _)| extent.height() >= VISIBLE) {
            return None;
        }
        let above = extents.iter().flat_map(|(e, _)| [[e.left, e.top], [e.right, e.top]]);
        let below =
            extents.iter().rev().flat_map(|(e, _)| [[e.right, e.bottom], [e.left, e.bottom]]);
        let mut corners: Vec<Point> = Vec::new();
        for corner in above.chain(below) {
            // A point on a line between two others is no corner.
            if let [.., a, b] = corners[..]
                && a[1] == b[1]
                && b[1] == corner[1]
            {
                corners.pop();
            }
            corners.push(corner);
        }
        Some(corners)
    }

    fn hatching(&self, strands: &[Strand]) -> Vec<[Point; 2]> {
        let top = self.columns.frame.top;
        let mut levels = Vec::new();
        let blocks = strands.iter().filter(|strand| strand.is_block);
        for (extent, _) in blocks.flat_map(|strand| self.extents(strand)) {
            // Fewer than three lines would look like bands of their own.
            if extent.height() < 4.0 * HATCH {
                continue;
            }
            let inside = extent.grown(-HATCH / 2.0);
            let first = ((inside.top - top) / HATCH).ceil() as i32;
            let last = ((inside.bottom - top) / HATCH).floor() as i32;
            let level = |k| (top + f64::from(k) * HATCH, extent.left, extent.right);
            levels.extend((first..=last).map(level));
        }
        joined(levels)
    }

    /// Lines where two thick bands meet, or a thick band and nodes that are alone.
    fn between_bands(&self, strands: &[Strand]) -> Vec<[Point; 2]> {
        let mut levels = Vec::new();
        for column in &self.columns.drawn {
            let mut edges: Vec<usize> = vec![0, self.panel.n_nodes];
            let stretches = strands.iter().filter_map(|strand| strand.at(column.state));
            edges.extend(stretches.flat_map(|stretch| [stretch.from, stretch.to]));
            edges.sort_unstable();
            edges.dedup();
            let places: Vec<f64> = edges.into_iter().map(|node| self.y(node)).collect();
            let thick = places.windows(3).filter(|w| (w[1] - w[0]).min(w[2] - w[1]) >= SET_APART);
            levels.extend(thick.map(|w| (w[1], column.left, column.right)));
        }
        joined(levels)
    }

    /// Lines where states meet, with room between them.
    fn between_states(&self) -> Vec<[Point; 2]> {
        let Rect { left, top, right, bottom } = self.columns.frame;
        let mut lines = Vec::new();
        let mut last = left;
        for x in self.columns.drawn.iter().skip(1).map(|column| column.left) {
            if x - last >= SET_APART && right - x >= SET_APART {
                lines.push([[x, top], [x, bottom]]);
                last = x;
            }
        }
        lines
    }

    /// The state that another panel shows, in a frame of its own.
    fn outline_shown(&self, canvas: &mut Canvas) {
        let is_shown = |column: &&Column| Some(column.state) == self.panel.shown;
        if let Some(column) = self.columns.drawn.iter().find(is_shown) {
            let extent = Rect { left: column.left, right: column.right, ..self.columns.frame };
            canvas.frame(extent, Stroke::solid(INK, SHOWN_WIDTH));
        }
    }

    /// Bands that go on beyond the frame fade away at its edge.
    fn fade(&self, canvas: &mut Canvas) {
        // Half a point more on every side covers blurred edges of the bands.
        let grown = self.columns.frame.grown(0.5);
        for (side, is_open) in self.columns.is_open.into_iter().enumerate() {
            let [edge, inwards] = [[grown.left, 1.0], [grown.right, -1.0]][side];
            for k in (0..FADE_STEPS).filter(|_| is_open).map(f64::from) {
                let end = edge + inwards * (0.5 + (k + 1.0) * FADE_STEP);
                let [top, bottom] = [grown.top, grown.bottom];
                let corners = [[edge, top], [end, top], [end, bottom], [edge, bottom]];
                // Layers over one another leave no seams. Under those from step k inwards the share
                // (k + 1/2) / (k + 3/2) of each in turn leaves (k + 1/2) of all steps.
                let is_last = k + 1.0 == f64::from(FADE_STEPS);
                let through = if is_last { 0.9 } else { (k + 0.5) / (k + 1.5) };
                canvas.area(&corners, "#ffffff", 1.0 - through);
            }
        }
    }

    /// Names of clusters and counts of blocks, where there is room and they are news.
    fn draw_labels(&self, canvas: &mut Canvas, strand: &Strand) {
        let fill = fill(strand);
        let mut shown: Option<(Label, Rect)> = None;
        for column in &self.columns.drawn {
            let Some(stretch) = strand.at(column.state) else { continue };
            let extent = self.extent(column, stretch);
            let Some(label) = self.label(column, stretch, extent) else { continue };
            // A band that stands elsewhere, in a state laid out anew, needs its name again.
            let middle = (extent.top + extent.bottom) / 2.0;
            let goes_on = |(name, last): &(Label, Rect)| {
                *name == label && (last.top..last.bottom).contains(&middle)
            };
            if shown.as_ref().is_some_and(goes_on) {
                continue;
            }
            let middle = [(extent.left + extent.right) / 2.0, (extent.top + extent.bottom) / 2.0];
            let baseline = [middle[0], middle[1] + CAP_HEIGHT * TICK_SIZE / 2.0];
            if strand.is_block {
                canvas.rect(ground(&label, middle), &fill);
            }
            canvas.label_in(&label, baseline, TICK_SIZE, ink_on(&fill));
            shown = Some((label, extent));
        }
    }

    fn label(&self, column: &Column, stretch: &Stretch, extent: Rect) -> Option<Label> {
        let width = column.width() - 4.0;
        if extent.height() < 1.2 * TICK_SIZE {
            return None;
        }
        match stretch.clusters {
            Clusters::Block(1) => count_within(1, "cluster", [width; 2]),
            Clusters::Block(n) => count_within(n, "clusters", [width; 2]),
            Clusters::One(cluster) => {
                let label = self.panel.states[column.state].clusters[cluster].label.clone();
                (!label.is_empty() && label.width(TICK_SIZE) <= width).then_some(label)
            }
        }
    }
}

/// What a label around this point covers, so that no lines run through it.
fn ground(label: &Label, [x, y]: Point) -> Rect {
    let [width, height] = [label.width(TICK_SIZE) / 2.0 + 1.5, 0.55 * TICK_SIZE];
    Rect { left: x - width, right: x + width, top: y - height, bottom: y + height }
}

/// Lines at one height that touch, as one.
fn joined(mut levels: Vec<Level>) -> Vec<[Point; 2]> {
    levels.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut lines: Vec<[Point; 2]> = Vec::new();
    for (y, left, right) in levels {
        match lines.last_mut() {
            Some([_, end]) if end[1] == y && left <= end[0] => end[0] = right,
            _ => lines.push([[left, y], [right, y]]),
        }
    }
    lines
}

/// The colour of a band; blocks are lighter.
fn fill(strand: &Strand) -> String {
    let white = if strand.is_block { 1.0 - BLOCK_STRENGTH } else { 0.0 };
    mixed_with_white(cluster_fill(strand.colour), white)
}
