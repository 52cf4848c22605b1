//! Vertical lines at values of x, such as critical couplings ε_k, with labels in a row above the
//! frame that never overlap.
//!
//! The labels stand where the sum of squared distances to their lines is smallest among all
//! placements that keep their order, their gaps and the ends of the row: with the widths before
//! each label taken off, that is an isotonic regression (Ayer et al., Ann. Math. Stat. 26, 641
//! (1955), pool adjacent violators), cut to the bounds.

use super::axis::Axis;
use super::canvas::{Anchor, Canvas, Rect};
use super::label::Label;
use super::style::{AXIS_WIDTH, MARKER_INK, NOTE_SIZE, Stroke};

/// Smallest gap between neighbouring labels, in points.
const GAP: f64 = 3.5;
/// Farthest that a label may stand from its line, about its width: leaders do not cross.
const FAR: f64 = 12.0;
/// Height of the slanted part that leads from a line to its label.
const LEADER: f64 = 6.0;
/// Height above the frame that a row of labels takes.
pub(super) const ROW_HEIGHT: f64 = LEADER + NOTE_SIZE + 2.0;

/// What a group of vertical lines stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MarkerStyle {
    /// Our own prediction: dashed lines.
    Predicted,
    /// Somebody else's value, for comparison: dotted lines.
    Reference,
}

/// Vertical lines of one meaning.
#[derive(Clone, Debug)]
pub struct MarkerGroup {
    /// How they are drawn.
    pub style: MarkerStyle,
    /// Their entry in the legend; none for no entry.
    pub legend: Option<Label>,
    /// The lines. Those outside the range of x, and those that are not finite, are left out.
    pub markers: Vec<Marker>,
}

/// One vertical line.
#[derive(Clone, Debug)]
pub struct Marker {
    /// Where it stands.
    pub x: f64,
    /// What stands above it; none for a bare line. Where labels of earlier markers leave it no room
    /// near its line, only the line is drawn.
    pub label: Option<Label>,
}

/// The stroke of a group.
pub(super) fn stroke(style: MarkerStyle) -> Stroke {
    let dash = match style {
        MarkerStyle::Predicted => "3.5 2",
        MarkerStyle::Reference => "0.8 1.6",
    };
    Stroke { colour: MARKER_INK, width: 0.8, dash }
}

/// Places on the page of the lines that are drawn, with their labels.
pub(super) fn visible<'a>(
    groups: &'a [MarkerGroup],
    axis: &Axis,
) -> Vec<(f64, MarkerStyle, Option<&'a Label>)> {
    let drawn = groups.iter().flat_map(|g| g.markers.iter().map(|m| (g.style, m)));
    drawn
        .filter(|(_, m)| axis.holds(m.x))
        .filter_map(|(style, m)| Some((axis.at(m.x)?, style, m.label.as_ref())))
        .collect()
}

/// Draws the lines across the frame.
pub(super) fn draw_lines(canvas: &mut Canvas, groups: &[MarkerGroup], axis: &Axis, frame: Rect) {
    for (x, style, _) in visible(groups, axis) {
        canvas.line([x, frame.top], [x, frame.bottom], stroke(style));
    }
}

/// Draws the labels above the frame, each with a short line down to its place.
pub(super) fn draw_labels(canvas: &mut Canvas, groups: &[MarkerGroup], axis: &Axis, frame: Rect) {
    let labelled: Vec<(f64, &Label)> =
        visible(groups, axis).into_iter().filter_map(|(x, _, label)| Some((x, label?))).collect();
    let wanted: Vec<[f64; 2]> =
        labelled.iter().map(|(x, label)| [*x, label.width(NOTE_SIZE)]).collect();
    // A label may stand over the corner of the frame by half its width, but no farther.
    for (at, centre) in near(&wanted, [frame.left - GAP, frame.right + GAP]) {
        let (x, label) = labelled[at];
        let leader = Stroke::solid(MARKER_INK, AXIS_WIDTH);
        canvas.line([x, frame.top], [centre, frame.top - LEADER + 1.5], leader);
        let at = [centre, frame.top - LEADER - 0.25 * NOTE_SIZE];
        canvas.label(label, at, NOTE_SIZE, Anchor::Middle);
    }
}

/// Which labels, given by place and width, can stand near their lines, the first ones before others, and
/// the centre of each, from the left.
fn near(labels: &[[f64; 2]], bounds: [f64; 2]) -> Vec<(usize, f64)> {
    let placed = |chosen: &[usize]| {
        let of = |part: usize| chosen.iter().map(|&at| labels[at][part]).collect::<Vec<f64>>();
        spread(&of(0), &of(1), bounds)
    };
    let room = bounds[1] - bounds[0];
    let (mut chosen, mut taken): (Vec<usize>, f64) = (Vec::new(), 0.0);
    for (at, &[x, width]) in labels.iter().enumerate() {
        let mut with = chosen.clone();
        with.insert(chosen.partition_point(|&other| labels[other][0] <= x), at);
        let is_near = |(&at, centre): (&usize, f64)| (centre - labels[at][0]).abs() <= FAR;
        let fits = taken + width <= room;
        if fits && with.iter().zip(placed(&with)).all(is_near) {
            (chosen, taken) = (with, taken + width + GAP);
        }
    }
    let centres = placed(&chosen);
    chosen.into_iter().zip(centres).collect()
}

/// Centres of labels as close to `wanted` (ascending) as their widths and the bounds allow.
fn spread(wanted: &[f64], widths: &[f64], [low, high]: [f64; 2]) -> Vec<f64> {
    let Some((&first, &last)) = widths.first().zip(widths.last()) else { return Vec::new() };
    let mut offsets = vec![0.0];
    for pair in widths.windows(2) {
        offsets.push(offsets[offsets.len() - 1] + (pair[0] + pair[1]) / 2.0 + GAP);
    }
    let targets: Vec<f64> = wanted.iter().zip(&offsets).map(|(w, o)| w - o).collect();
    let leftmost = low + first / 2.0;
    let rightmost = (high - last / 2.0 - offsets[offsets.len() - 1]).max(leftmost);
    let fitted = isotonic(&targets);
    fitted.iter().zip(&offsets).map(|(t, o)| t.clamp(leftmost, rightmost) + o).collect()
}

/// The non-decreasing sequence closest to `values` in the mean square: neighbours that descend
/// are pooled into their mean.
fn isotonic(values: &[f64]) -> Vec<f64> {
    let mut pools: Vec<(f64, usize)> = Vec::new();
    for &value in values {
        pools.push((value, 1));
        while let [.., (before, m), (last, n)] = pools[..]
            && before > last
        {
            pools.truncate(pools.len() - 2);
            pools.push(((before * m as f64 + last * n as f64) / (m + n) as f64, m + n));
        }
    }
    pools.into_iter().flat_map(|(mean, n)| std::iter::repeat_n(mean, n)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn isotonic_regression_pools_what_descends() {
        // Worked by hand: 3, 1 pool to 2, 2; 6, 5, 4 pool to 5, 5, 5.
        assert_eq!(isotonic(&[3.0, 1.0, 6.0, 5.0, 4.0, 9.0]), [2.0, 2.0, 5.0, 5.0, 5.0, 9.0]);
    }

    #[test]
    fn labels_with_room_stay_on_their_lines() {
        assert_eq!(spread(&[10.0, 50.0], &[8.0, 8.0], [0.0, 100.0]), [10.0, 50.0]);
    }

    #[test]
    fn crowded_labels_keep_their_gaps_and_the_bounds() {
        let wanted = [1.0, 2.0, 3.0, 4.0, 98.0, 99.0, 99.5];
        let widths = [9.0, 11.0, 9.0, 12.0, 9.0, 9.0, 10.0];
        let centres = spread(&wanted, &widths, [0.0, 100.0]);
        let sides: Vec<_> =
            centres.iter().zip(&widths).map(|(c, w)| [c - w / 2.0, c + w / 2.0]).collect();
        assert!(sides[0][0] >= -1e-9 && sides[6][1] <= 100.0 + 1e-9, "{sides:?}");
        for pair in sides.windows(2) {
            assert!(pair[1][0] - pair[0][1] >= GAP - 1e-9, "{pair:?}");
        }
    }

    #[test]
    fn labels_without_room_near_their_lines_are_left_out_from_the_last() {
        let crowd: Vec<[f64; 2]> = (0..20).map(|k| [50.0 + f64::from(k), 10.0]).collect();
        let placed = near(&crowd, [0.0, 200.0]);
        assert!(placed.len() >= 2 && placed.len() < 5, "{placed:?}");
        assert!(placed.iter().any(|&(at, _)| at == 0), "the first is among them: {placed:?}");
        for &(at, centre) in &placed {
            assert!((centre - crowd[at][0]).abs() <= FAR, "{placed:?}");
        }
        for pair in placed.windows(2) {
            assert!(pair[1].1 - pair[0].1 >= 10.0 + GAP - 1e-9, "{placed:?}");
        }
        assert!(near(&[[4.0, 10.0]], [0.0, 9.0]).is_empty());
    }
}
