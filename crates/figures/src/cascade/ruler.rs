//! Below the bands: the critical couplings at which states meet, and the axis of ε.

use super::columns::Columns;
use super::{AXIS_GAP, CascadeState, NUMBER_GAP, TICK_LENGTH};
use crate::axis::{Axis, Scale, Tick};
use crate::canvas::{Anchor, Canvas, Rect};
use crate::font::CAP_HEIGHT;
use crate::label::Label;
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
    draw_values(canvas, &columns.ends(states), frame, bounds);
    draw_axis(canvas, columns, bounds);
    let middle = (frame.left + frame.right) / 2.0;
    canvas.label(&Label::math("ε"), [middle, frame.bottom + NAME], LABEL_SIZE, Anchor::Middle);
}

/// A mark at every critical coupling, and values where there is room: the first, then those at
/// which the longest states begin.
fn draw_values(canvas: &mut Canvas, ends: &[(f64, f64)], frame: Rect, bounds: [f64; 2]) {
    let ink = Stroke::solid(MARKER_INK, AXIS_WIDTH);
    let mut places: Vec<f64> = ends.iter().map(|end| end.1).collect();
    places.dedup_by(|next, last| *next - *last < AXIS_WIDTH);
    let mark = |x: &f64| [[*x, frame.bottom + 0.5], [*x, frame.bottom + AXIS_GAP]];
    canvas.segments(&places.iter().map(mark).collect::<Vec<_>>(), ink, 1.0);
    let values: Vec<f64> = ends.iter().map(|&(value, _)| value).collect();
    let labels = told_apart(&values);
    let next = |k: usize| ends.get(k + 1).map_or(frame.right, |end| end.1);
    let mut order: Vec<usize> = (0..ends.len()).collect();
    order.sort_by(|&a, &b| (next(b) - ends[b].1).total_cmp(&(next(a) - ends[a].1)));
    order.sort_by_key(|&k| k != 0);
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

/// Values to three significant digits, or as many more, up to nine, as tell neighbours apart.
fn told_apart(values: &[f64]) -> Vec<Label> {
    let label = |k: usize| {
        let neighbours = [k.checked_sub(1), Some(k + 1)];
        let neighbours: Vec<f64> =
            neighbours.into_iter().flatten().filter_map(|j| values.get(j).copied()).collect();
        let differs = |digits: &usize| {
            neighbours.iter().all(|&other| number(other, *digits) != number(values[k], *digits))
        };
        number(values[k], (3..=9).find(differs).unwrap_or(9))
    };
    (0..values.len()).map(label).collect()
}

/// A number to so many significant digits, without zeros at its end.
fn number(value: f64, digits: usize) -> Label {
    let scientific = format!("{value:.*e}", digits - 1);
    let (mantissa, exponent) = scientific.split_once('e').expect("this notation has an exponent");
    let exponent: i32 = exponent.parse().expect("an exponent is a whole number");
    let trimmed = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_string(),
        false => text.to_string(),
    };
    if (-3..5).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        return Label::text(trimmed(&format!("{value:.decimals$}")));
    }
    let mantissa = trimmed(mantissa);
    let base = if mantissa == "1" { "10".into() } else { format!("{mantissa}×10") };
    Label::text(base).superscript(&exponent.to_string())
}
