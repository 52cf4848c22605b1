//! Below the bands: the critical couplings at which states meet, and the axis of ε.

use super::columns::Columns;
use super::panel::CascadeState;
use super::style::{AXIS_GAP, NUMBER_GAP, TICK_LENGTH};
use crate::axis::{Axis, Scale, Tick};
use crate::canvas::{Anchor, Canvas, Rect};
use crate::font::CAP_HEIGHT;
use crate::label::Label;
use crate::numbers::{number, told_apart};
use crate::style::{AXIS_WIDTH, INK, LABEL_SIZE, MARKER_INK, Stroke, TICK_SIZE};

/// Distances from the bands to the values of critical couplings, and to the axis.
const VALUES: f64 = AXIS_GAP + 1.5 + CAP_HEIGHT * TICK_SIZE;
const AXIS: f64 = VALUES + 4.5;
const NUMBERS: f64 = AXIS + TICK_LENGTH + NUMBER_GAP + CAP_HEIGHT * TICK_SIZE;
const NAME: f64 = NUMBERS + 4.0 + CAP_HEIGHT * LABEL_SIZE;
/// Room below the bands.
pub(super) const BELOW: f64 = NAME + 3.0;

/// Least distance between labels side by side.
const GAP: f64 = 5.0;
/// Least distance between powers of ten on a long axis.
const SPACING: f64 = 28.0;
/// Beyond so many decades only powers of ten have numbers.
const LONG: f64 = 3.0;
/// Below this ratio of its ends an axis has numbers in equal steps.
const SHORT: f64 = 3.0;

/// Draws the critical couplings and the axis.
pub(super) fn draw(canvas: &mut Canvas, states: &[CascadeState], columns: &Columns, cell: Rect) {
    let frame = columns.frame;
    let bounds = [frame.left - 2.0 * GAP, cell.right];
    draw_values(canvas, columns, states, bounds);
    draw_axis(canvas, columns, bounds);
    let middle = (frame.left + frame.right) / 2.0;
    // A state of all couplings leaves no number to write at the axis.
    let name = if columns.axis.is_some() {
        Label::math("ε")
    } else {
        Label::text("every ").with_math("ε > 0")
    };
    canvas.label(&name, [middle, frame.bottom + NAME], LABEL_SIZE, Anchor::Middle);
}

/// A mark at every critical coupling, and values where there is room: the first, the one at which
/// the prediction ends, then those at which the longest states begin.
fn draw_values(canvas: &mut Canvas, columns: &Columns, states: &[CascadeState], bounds: [f64; 2]) {
    let (frame, ends) = (columns.frame, &columns.ends(states)[..]);
    let ink = Stroke::solid(MARKER_INK, AXIS_WIDTH);
    let mut places: Vec<f64> = columns.transitions(states);
    places.dedup_by(|next, last| *next - *last < AXIS_WIDTH);
    let mark = |x: &f64| [[*x, frame.bottom + 0.5], [*x, frame.bottom + AXIS_GAP]];
    canvas.segments(&places.iter().map(mark).collect::<Vec<_>>(), ink, 1.0);
    let values: Vec<f64> = ends.iter().map(|&(value, _)| value).collect();
    let labels = told_apart(&values);
    let next = |k: usize| ends.get(k + 1).map_or(frame.right, |end| end.1);
    let mut order: Vec<usize> = (0..ends.len()).collect();
    order.sort_by(|&a, &b| (next(b) - ends[b].1).total_cmp(&(next(a) - ends[a].1)));
    let is_end = |k: usize| !columns.is_open[1] && k + 1 == ends.len();
    order.sort_by_key(|&k| (k != 0, !is_end(k)));
    // At the edge of the panel a value stands beside its mark rather than nowhere.
    let place = |k: usize| {
        let half = labels[k].width(TICK_SIZE) / 2.0;
        (ends[k].1.min(bounds[1] - half), labels[k].clone())
    };
    let labels = order.into_iter().map(place).collect();
    for (x, label) in side_by_side(labels, bounds) {
        canvas.label(&label, [x, frame.bottom + VALUES], TICK_SIZE, Anchor::Middle);
    }
}

fn draw_axis(canvas: &mut Canvas, columns: &Columns, bounds: [f64; 2]) {
    let ink = Stroke::solid(INK, AXIS_WIDTH);
    let frame = columns.frame;
    let y = frame.bottom + AXIS;
    canvas.line([frame.left, y], [frame.right, y], ink);
    let heads = [(frame.left, -1.0), (frame.right, 1.0)];
    for ((x, way), _) in heads.into_iter().zip(columns.is_open).filter(|(_, is_open)| *is_open) {
        canvas.area(&[[x + 4.0 * way, y], [x, y - 1.8], [x, y + 1.8]], INK, 1.0);
    }
    let Some(axis) = columns.axis else { return };
    let (places, numbers) = ticks(&axis, columns.range, frame);
    let numbers = side_by_side(numbers, bounds);
    for x in places {
        let is_major = numbers.iter().any(|(at, _)| *at == x);
        let length = if is_major { TICK_LENGTH } else { TICK_LENGTH / 2.0 };
        canvas.line([x, y], [x, y + length], ink);
    }
    for (x, label) in numbers {
        canvas.label(&label, [x, frame.bottom + NUMBERS], TICK_SIZE, Anchor::Middle);
    }
}

/// Places of all ticks, and numbers in the order in which they should be kept.
fn ticks(axis: &Axis, [low, high]: [f64; 2], frame: Rect) -> (Vec<f64>, Vec<(f64, Label)>) {
    let is_ordinary = low > 1e-290 && high < 1e290;
    let ticks = if is_ordinary && high / low < SHORT {
        even_ticks(axis, [low, high])
    } else if is_ordinary && (high / low).log10() <= LONG {
        digit_ticks(axis, [low, high])
    } else {
        axis.ticks(SPACING)
    };
    let inside = ticks.into_iter().filter(|t| (frame.left..=frame.right).contains(&t.at));
    let ticks: Vec<Tick> = inside.collect();
    let places = ticks.iter().map(|tick| tick.at).collect();
    (places, ticks.into_iter().filter_map(|tick| Some((tick.at, tick.label?))).collect())
}

/// Numbers in equal steps, at their places on a logarithmic axis.
fn even_ticks(axis: &Axis, [low, high]: [f64; 2]) -> Vec<Tick> {
    let shares = Axis::new(Scale::Linear, [low, high], [0.0, 1.0]).ticks(1.0 / 6.0);
    let place = |tick: Tick| {
        let at = axis.at(low + tick.at * (high - low))?;
        Some(Tick { at, label: tick.label })
    };
    shares.into_iter().filter_map(place).collect()
}

/// Numbers of one digit times a power of ten, those that divide a decade best first.
fn digit_ticks(axis: &Axis, [low, high]: [f64; 2]) -> Vec<Tick> {
    let decades = low.log10().floor() as i32..=high.log10().floor() as i32;
    let numbered: &[i32] =
        if high / low < 10.0 { &[1, 2, 5, 3, 4, 6, 8, 7, 9] } else { &[1, 2, 5] };
    let mut digits = numbered.to_vec();
    digits.extend((1..=9).filter(|digit| !numbered.contains(digit)));
    let values = digits.into_iter().flat_map(|digit| decades.clone().map(move |d| (digit, d)));
    let tick = |(digit, decade): (i32, i32)| {
        // Ten to a negative power is not exact, its inverse is.
        let power = 10f64.powi(decade.abs());
        let value = if decade < 0 { f64::from(digit) / power } else { f64::from(digit) * power };
        let label = numbered.contains(&digit).then(|| number(value, 1));
        Some(Tick { at: axis.at(value)?, label })
    };
    values.filter_map(tick).collect()
}

/// Labels, each with the place of its middle, that stand within the bounds and clear of all
/// before them.
pub(super) fn side_by_side(
    labels: Vec<(f64, Label)>,
    [left, right]: [f64; 2],
) -> Vec<(f64, Label)> {
    let mut taken: Vec<[f64; 2]> = Vec::new();
    let mut kept = Vec::new();
    for (x, label) in labels {
        let half = label.width(TICK_SIZE) / 2.0;
        let [from, to] = [x - half, x + half];
        let is_clear = taken.iter().all(|[start, end]| to + GAP <= *start || from >= end + GAP);
        if is_clear && from >= left && to <= right {
            taken.push([from, to]);
            kept.push((x, label));
        }
    }
    kept
}
