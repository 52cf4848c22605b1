//! The states side by side: where each stands along ε, which falls from left to right.
//!
//! Critical couplings keep their true places on a logarithmic scale. States without an end (the
//! first towards ε = ∞, the last towards ε = 0) go on to the edge of the frame.

use super::panel::CascadeState;
use crate::axis::{Axis, Scale};
use crate::canvas::Rect;

/// A dot of a PNG at 300 dots per inch, in points: states narrower than this cannot be seen.
const DOT: f64 = 0.24;
/// Least share of the frame for a state without an end.
const OPEN_SHARE: f64 = 0.1;

/// A state on the page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Column {
    /// Its number.
    pub(super) state: usize,
    pub(super) left: f64,
    pub(super) right: f64,
}

impl Column {
    pub(super) fn width(&self) -> f64 {
        self.right - self.left
    }
}

/// All states on the page.
pub(super) struct Columns {
    pub(super) frame: Rect,
    /// Whether the first and the last state go on beyond the frame.
    pub(super) is_open: [bool; 2],
    /// Where ε stands; none where no state has an end.
    pub(super) axis: Option<Axis>,
    /// Smallest and largest ε in the frame.
    pub(super) range: [f64; 2],
    /// States wide enough to see, from the left, without gaps.
    pub(super) drawn: Vec<Column>,
    /// Width of states without an end.
    open: f64,
}

impl Columns {
    /// Lays the states over a frame; an open first state is `least_open` wide or wider.
    pub(super) fn new(states: &[CascadeState], frame: Rect, least_open: f64) -> Self {
        let is_open = [
            states.first().is_some_and(|s| s.epsilon.1.is_none()),
            states.last().is_some_and(|s| s.epsilon.0 == 0.0),
        ];
        let widths = [least_open, 0.0].map(|least| least.max(OPEN_SHARE * frame.width()));
        let [before, after] = [0, 1].map(|side| if is_open[side] { widths[side] } else { 0.0 });
        let ends = ends(states);
        let range = match (ends.first(), ends.last()) {
            (Some(&high), Some(&low)) => log_range([low, high], frame.width(), [before, after]),
            _ => [0.0, 1.0],
        };
        let axis =
            (!ends.is_empty()).then(|| Axis::new(Scale::Log, range, [frame.right, frame.left]));
        let drawn = drawn(states, frame, axis);
        let range = range.map(|end| 10f64.powf(end));
        Self { frame, is_open, axis, range, drawn, open: before + after }
    }

    /// Width left for the states with two ends.
    pub(super) fn least_width(&self) -> f64 {
        self.frame.width() - self.open
    }

    /// Places at which one state follows another: not the end of the first above, nor that of the last
    /// below, which are ends of what is known.
    pub(super) fn transitions(&self, states: &[CascadeState]) -> Vec<f64> {
        let between = states.iter().skip(1).filter_map(|state| state.epsilon.1);
        between.filter_map(|end| self.axis?.at(end)).collect()
    }

    /// Ends of states, falling, with their places.
    pub(super) fn ends(&self, states: &[CascadeState]) -> Vec<(f64, f64)> {
        let place = |end| Some((end, self.axis?.at(end)?));
        ends(states).into_iter().filter_map(place).collect()
    }
}

/// The ends of all ranges that have a place on a logarithmic scale, falling.
fn ends(states: &[CascadeState]) -> Vec<f64> {
    let first = states.first().and_then(|state| state.epsilon.1);
    let lower = states.iter().map(|state| state.epsilon.0).filter(|&end| end > 0.0);
    first.into_iter().chain(lower).collect()
}

/// log₁₀ ε at the right and at the left edge of a frame with these widths before and after the
/// first and last end.
fn log_range([low, high]: [f64; 2], width: f64, [before, after]: [f64; 2]) -> [f64; 2] {
    let [low, high] = [low.log10(), high.log10()];
    let inner = width - before - after;
    if high > low {
        let per_point = (high - low) / inner;
        return [low - after * per_point, high + before * per_point];
    }
    // A single end has no scale of its own: the frame is a decade.
    let share = if before + after > 0.0 { before / (before + after) } else { 0.5 };
    [low - (1.0 - share), low + share]
}

fn drawn(states: &[CascadeState], frame: Rect, axis: Option<Axis>) -> Vec<Column> {
    let mut drawn = Vec::new();
    let mut left = frame.left;
    for (number, state) in states.iter().enumerate() {
        let is_last = number + 1 == states.len();
        let end = axis.and_then(|axis| axis.at(state.epsilon.0)).filter(|_| !is_last);
        let right = end.unwrap_or(frame.right);
        if is_last || right - left >= DOT {
            drawn.push(Column { state: number, left, right });
            left = right;
        }
    }
    drawn
}
