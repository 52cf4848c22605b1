//! The two axes of a matrix over pairs of nodes: names of groups where they have any, else numbers.

use crate::axis::{Axis, Scale, Tick};
use crate::canvas::{Anchor, Canvas, Rect};
use crate::font::CAP_HEIGHT;
use crate::groups::{self, Group};
use crate::label::Label;
use crate::style::{AXIS_WIDTH, INK, Stroke, TICK_SIZE};

/// Distance of labels from the frame.
pub(super) const LABEL_GAP: f64 = 3.5;
pub(super) const TICK_LENGTH: f64 = 2.0;
/// Least distance between numbers.
const NODE_SPACING: f64 = 20.0;

/// The axes of so many nodes.
#[derive(Clone, Copy)]
pub(super) struct NodeAxes<'a> {
    pub groups: &'a [Group],
    pub n_nodes: usize,
}

impl NodeAxes<'_> {
    /// Names of groups or numbers of nodes below the matrix and at its left.
    pub fn draw(self, canvas: &mut Canvas, matrix: Rect) {
        let ink = Stroke::solid(INK, AXIS_WIDTH);
        let [across, down] = [[matrix.left, matrix.right], [matrix.top, matrix.bottom]];
        for (x, y) in self.ticks(across).into_iter().zip(self.ticks(down)) {
            canvas.line([x, matrix.bottom], [x, matrix.bottom + TICK_LENGTH], ink);
            canvas.line([matrix.left - TICK_LENGTH, y], [matrix.left, y], ink);
        }
        let baseline = matrix.bottom + LABEL_GAP + CAP_HEIGHT * TICK_SIZE;
        for (x, label) in self.labels(across) {
            canvas.label(&label, [x, baseline], TICK_SIZE, Anchor::Middle);
        }
        for (y, label) in self.labels(down) {
            let at = [matrix.left - LABEL_GAP, y + CAP_HEIGHT * TICK_SIZE / 2.0];
            canvas.label(&label, at, TICK_SIZE, Anchor::End);
        }
    }

    fn has_names(self) -> bool {
        self.groups.iter().any(|g| !g.label.is_empty())
    }

    fn node_axis(self, ends: [f64; 2]) -> Axis {
        Axis::new(Scale::Linear, [0.5, self.n_nodes as f64 + 0.5], ends)
    }

    /// Numbers of nodes along an axis between these places, without those of half nodes.
    fn numbers(self, ends: [f64; 2]) -> Vec<Tick> {
        let mut ticks = self.node_axis(ends).ticks(NODE_SPACING);
        ticks.retain(|t| t.label.is_some());
        ticks
    }

    /// Places of ticks along an axis: where groups meet, else at the numbers.
    fn ticks(self, ends: [f64; 2]) -> Vec<f64> {
        if !self.has_names() {
            return self.numbers(ends).iter().map(|tick| tick.at).collect();
        }
        let axis = self.node_axis(ends);
        let between = groups::boundaries(self.groups, self.n_nodes);
        between.into_iter().filter_map(|node| axis.at(node as f64 + 0.5)).collect()
    }

    /// Labels along an axis, each with the place of its middle. A name wider than its group is
    /// left out on both axes, so that they read the same.
    pub fn labels(self, ends: [f64; 2]) -> Vec<(f64, Label)> {
        if !self.has_names() {
            let numbers = self.numbers(ends).into_iter();
            return numbers.filter_map(|tick| Some((tick.at, tick.label?))).collect();
        }
        let axis = self.node_axis(ends);
        let place = |group: &Group| {
            let [from, to] = group.span();
            let (from, to) = axis.at(from).zip(axis.at(to))?;
            let fits = group.label.width(TICK_SIZE) <= to - from;
            fits.then(|| ((from + to) / 2.0, group.label.clone()))
        };
        self.groups.iter().filter_map(place).collect()
    }
}
