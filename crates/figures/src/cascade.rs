//! Cascade panel: the predicted clusters of every state as bands that split as ε falls.
//!
//! Along x stands ε on a logarithmic scale, falling from left to right as the story is told. Along
//! y stand nodes: in each state a cluster is a band as high as it has nodes, within the extent of
//! the cluster it came from, the largest first; grey below them are nodes that are alone. Bands too
//! thin to print are one hatched block. What is drawn grows with the room, not with the clusters.
//!
//! The form: J. B. Kruskal and J. M. Landwehr, "Icicle plots", Am. Stat. 37, 162 (1983), on its side.

mod bands;
mod check;
mod columns;
mod layout;
mod panel;
mod ruler;
mod style;

use super::axis::{Axis, Scale, Tick};
use super::canvas::{Anchor, Canvas, Rect};
use super::drawable::Drawable;
use super::error::FigureError;
use super::font::CAP_HEIGHT;
use super::label::Label;
use super::numbers::grouped;
use super::style::{AXIS_WIDTH, INK, LABEL_SIZE, MARKER_INK, Stroke, TICK_SIZE, UNCLUSTERED};
use columns::{Column, Columns};
use style::{AXIS_GAP, NUMBER_GAP, TICK_LENGTH, count_within};

pub use panel::{CascadeCluster, CascadePanel, CascadeState};

/// Bands thinner than this, 0.35 mm, are drawn as one block.
const LEAST_BAND: f64 = 0.35 * 72.0 / 25.4;
/// Least distance between numbers of nodes.
const NODE_SPACING: f64 = 16.0;
/// Height of a row of counts above the bands.
const COUNT_ROW: f64 = 10.0;
/// Room at the right, half a number.
const RIGHT: f64 = 8.0;
/// Room beyond the end of a prediction, for words read upwards.
const BEYOND: f64 = 14.0;

impl Drawable for CascadePanel {
    /// Draws the states over the whole width of the cell.
    fn draw(
        &self,
        canvas: &mut Canvas,
        cell: Rect,
        _left_margin: f64,
        panel: &str,
    ) -> Result<(), FigureError> {
        self.check(panel)?;
        let frame = self.frame(cell);
        let columns = Columns::new(&self.states, frame, self.open_width());
        let (width, height) = (columns.least_width(), frame.height());
        if width < 30.0 || height < 30.0 {
            return Err(FigureError::TooSmall { panel: panel.into(), width, height });
        }
        let least = (LEAST_BAND / height * self.n_nodes as f64).ceil() as usize;
        let strands = layout::strands(self, least);
        canvas.rect(frame, UNCLUSTERED);
        bands::draw(canvas, self, &strands, &columns);
        self.draw_counts(canvas, &columns);
        self.draw_nodes(canvas, cell, frame);
        if self.ends_above_zero() {
            draw_end(canvas, frame);
        }
        ruler::draw(canvas, &self.states, &columns, cell);
        Ok(())
    }
}

impl CascadePanel {
    fn frame(&self, cell: Rect) -> Rect {
        let numbers = self.node_ticks([cell.bottom, cell.top]);
        let labels = numbers.iter().filter_map(|tick| tick.label.as_ref());
        let widest = labels.map(|label| label.width(TICK_SIZE)).fold(0.0, f64::max);
        let left = 1.45 * LABEL_SIZE + widest + NUMBER_GAP + TICK_LENGTH + AXIS_GAP;
        Rect {
            left: cell.left + left,
            top: cell.top + self.count_rows().len() as f64 * COUNT_ROW + 4.5,
            right: cell.right - RIGHT - if self.ends_above_zero() { BEYOND } else { 0.0 },
            bottom: cell.bottom - ruler::BELOW,
        }
    }

    /// Whether nothing is predicted below some ε. No cluster is known to change there.
    fn ends_above_zero(&self) -> bool {
        self.states.last().is_some_and(|state| state.epsilon.0 > 0.0)
    }

    /// Whether any node is alone in any state.
    fn has_alone(&self) -> bool {
        self.states.iter().any(|state| state.n_alone(self.n_nodes) > 0)
    }

    /// What is counted above the states, from the top: how much, and what one and many are called.
    fn count_rows(&self) -> Vec<CountRow> {
        let clusters: CountRow = |panel, state| {
            let n = panel.states[state].clusters.len();
            (n, if n == 1 { "cluster" } else { "clusters" })
        };
        let alone: CountRow = |panel, state| (panel.states[state].n_alone(panel.n_nodes), "alone");
        if self.has_alone() { vec![clusters, alone] } else { vec![clusters] }
    }

    /// Width of an open first state: its counts with their words, which stand for the whole rows.
    fn open_width(&self) -> f64 {
        let words = self.count_rows().into_iter().map(|row| {
            let (n, name) = row(self, 0);
            Label::text(format!("{} {name}", grouped(n))).width(TICK_SIZE)
        });
        words.fold(0.0, f64::max) + 6.0
    }

    /// The counts of the widest states first, as far as they stand clear of one another.
    fn draw_counts(&self, canvas: &mut Canvas, columns: &Columns) {
        let rows = self.count_rows();
        let mut widest: Vec<&Column> = columns.drawn.iter().collect();
        widest.sort_by(|a, b| b.width().total_cmp(&a.width()));
        for (k, row) in rows.iter().enumerate() {
            let rows_below = (rows.len() - 1 - k) as f64;
            let baseline = columns.frame.top - 3.5 - rows_below * COUNT_ROW;
            let label = |column: &&Column| {
                let (n, name) = row(self, column.state);
                let width = column.width();
                // A number alone may stand out over its state at both sides.
                let label = count_within(n, name, [width - 2.0, 2.0 * width])?;
                Some(((column.left + column.right) / 2.0, label))
            };
            let labels = widest.iter().filter_map(label).collect();
            let bounds = [columns.frame.left - 2.0, columns.frame.right + RIGHT];
            for (x, label) in ruler::side_by_side(labels, bounds) {
                canvas.label(&label, [x, baseline], TICK_SIZE, Anchor::Middle);
            }
        }
    }

    fn node_ticks(&self, ends: [f64; 2]) -> Vec<Tick> {
        let axis = Axis::new(Scale::Linear, [0.0, self.n_nodes as f64], ends);
        let mut ticks = axis.ticks(NODE_SPACING.max((ends[0] - ends[1]) / self.n_nodes as f64));
        ticks.retain(|tick| tick.label.is_some());
        ticks
    }

    /// The axis of nodes, at the left of the bands.
    fn draw_nodes(&self, canvas: &mut Canvas, cell: Rect, frame: Rect) {
        let ink = Stroke::solid(INK, AXIS_WIDTH);
        let x = frame.left - AXIS_GAP;
        canvas.line([x, frame.top], [x, frame.bottom], ink);
        for Tick { at, label } in self.node_ticks([frame.bottom, frame.top]) {
            canvas.line([x - TICK_LENGTH, at], [x, at], ink);
            if let Some(label) = label {
                let end = [x - TICK_LENGTH - NUMBER_GAP, at + CAP_HEIGHT * TICK_SIZE / 2.0];
                canvas.label(&label, end, TICK_SIZE, Anchor::End);
            }
        }
        let at = [cell.left + 1.1 * LABEL_SIZE, (frame.top + frame.bottom) / 2.0];
        canvas.label_upwards(&Label::text("nodes"), at, LABEL_SIZE);
    }
}

/// The end of the prediction, unlike a transition: a dashed line, and beyond it words alone.
fn draw_end(canvas: &mut Canvas, frame: Rect) {
    let dashed = Stroke { dash: "3 2", ..Stroke::solid(MARKER_INK, AXIS_WIDTH) };
    let x = frame.right + AXIS_GAP / 2.0;
    canvas.line([x, frame.top], [x, frame.bottom + AXIS_GAP], dashed);
    let at = [
        frame.right + BEYOND / 2.0 + CAP_HEIGHT * TICK_SIZE / 2.0 + 1.0,
        frame.top + frame.height() / 2.0,
    ];
    canvas.label_upwards(&Label::text("not predicted"), at, TICK_SIZE);
}

/// A number for each state and the word for what it counts.
type CountRow = fn(&CascadePanel, usize) -> (usize, &'static str);

#[cfg(test)]
mod tests;
