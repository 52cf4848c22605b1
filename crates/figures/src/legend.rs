//! Where a box of text can stand without hiding data, and the legend that stands there.

use super::canvas::{Anchor, Canvas, Point, Rect};
use super::font::CAP_HEIGHT;
use super::label::Label;
use super::style::{NOTE_SIZE, Shape, Stroke};

/// Width of the sample of a line.
const SAMPLE: f64 = 20.0;
/// Width of a mark alone.
const MARK_SAMPLE: f64 = 6.0;
const SAMPLE_GAP: f64 = 4.0;
/// Distance between the entries of one row.
const STRIP_GAP: f64 = 9.0;
const ROW: f64 = 1.3 * NOTE_SIZE;
/// Rows above and below a point in which its label may stand.
const ROWS_BESIDE: i32 = 4;
/// Distance kept from the frame and from data.
const CLEARANCE: f64 = 4.0;

/// One row: a sample of a line, its mark, and what it stands for.
pub(super) struct Entry<'a> {
    /// Whether there is a line, or the mark alone.
    pub(super) has_line: bool,
    pub(super) stroke: Stroke,
    pub(super) shape: Option<Shape>,
    pub(super) label: &'a Label,
}

impl Entry<'_> {
    fn sample(&self) -> f64 {
        if self.has_line { SAMPLE } else { MARK_SAMPLE }
    }

    fn width(&self) -> f64 {
        self.sample() + SAMPLE_GAP + self.label.width(NOTE_SIZE)
    }
}

/// Width and height of a legend of one entry a row, in points.
pub(super) fn size(entries: &[Entry]) -> [f64; 2] {
    let widest = entries.iter().map(Entry::width).fold(0.0, f64::max);
    [widest, ROW * entries.len() as f64]
}

/// Where each entry of a legend starts (left, middle of the row) when they fill rows from left
/// to right, and the height of these rows; the upper left corner is at the origin.
fn strip(entries: &[Entry], width: f64) -> (Vec<Point>, f64) {
    let (mut left, mut middle) = (0.0, ROW / 2.0);
    let mut places = Vec::new();
    for entry in entries {
        if left > 0.0 && left + entry.width() > width {
            (left, middle) = (0.0, middle + ROW);
        }
        places.push([left, middle]);
        left += entry.width() + STRIP_GAP;
    }
    (places, middle + ROW / 2.0)
}

/// Draws a legend in rows from left to right, its upper left corner at `corner`, and gives its
/// height. Entries beyond the height there is are left out, and a last one tells how many.
pub(super) fn draw_strip(
    canvas: &mut Canvas,
    entries: &[Entry],
    [left, top]: Point,
    [width, most_height]: [f64; 2],
) -> f64 {
    let (mut places, mut height) = strip(entries, width);
    let n_shown = fitting(&places, most_height);
    if n_shown < entries.len() {
        places.truncate(n_shown);
        let more = Label::text(format!("and {} more", entries.len() - n_shown));
        let middle = places.last().map_or(ROW / 2.0, |place| place[1] + ROW);
        let at = [left, top + middle + CAP_HEIGHT * NOTE_SIZE / 2.0];
        canvas.label(&more, at, NOTE_SIZE, Anchor::Start);
        height = middle + ROW / 2.0;
    }
    for (entry, [x, middle]) in entries.iter().zip(places) {
        draw_entry(canvas, entry, [left + x, top + middle]);
    }
    height
}

/// How many entries stand within a height, a row left over for the number of those that do not.
fn fitting(places: &[Point], most_height: f64) -> usize {
    let within = |height: f64| places.iter().filter(|p| p[1] + ROW / 2.0 <= height).count();
    match within(most_height) {
        all if all == places.len() => all,
        _ => within(most_height - ROW),
    }
}

/// Upper left corner, inside the frame, of a box that covers none of `points`, as near to the
/// upper right corner as can be and on as few `lines` (places of vertical lines) as can be; none
/// where every place would cover data.
pub(super) fn free_place(
    [width, height]: [f64; 2],
    frame: Rect,
    points: &[Point],
    lines: &[f64],
) -> Option<Point> {
    let room = frame.grown(-CLEARANCE);
    let [spare_x, spare_y] = [room.width() - width, room.height() - height];
    if spare_x < 0.0 || spare_y < 0.0 {
        return None;
    }
    let steps = 24;
    let places = (0..=steps).flat_map(|i| (0..=steps).map(move |j| (i, j))).map(|(i, j)| {
        let share = |k: i32| f64::from(k) / f64::from(steps);
        [room.right - width - share(i) * spare_x, room.top + share(j) * spare_y]
    });
    let cost = |[left, top]: Point| {
        let covered = Rect { left, top, right: left + width, bottom: top + height };
        let crossed = lines.iter().filter(|&&x| x > left - 1.5 && x < left + width + 1.5).count();
        let is_free = !points.iter().any(|&p| covered.grown(CLEARANCE).contains(p));
        // A line behind the text weighs as much as half the width of the frame.
        let far = (room.right - width - left) / frame.width() + (top - room.top) / frame.height();
        is_free.then_some(0.5 * crossed as f64 + far)
    };
    let priced = places.filter_map(|place| Some((place, cost(place)?)));
    priced.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(place, _)| place)
}

/// Draws a legend of one entry a row inside the frame. Its white ground reaches to those sides of
/// the frame that are near, so that no stubs of lines stick out between.
pub(super) fn draw_inside(canvas: &mut Canvas, entries: &[Entry], corner: Point, frame: Rect) {
    let [left, top] = corner;
    let [width, height] = size(entries);
    let extent = Rect { left, top, right: left + width, bottom: top + height };
    let near = 2.0 * CLEARANCE;
    let ground = extent.grown(1.5);
    let ground = Rect {
        left: if left - frame.left < near { frame.left } else { ground.left },
        top: if top - frame.top < near { frame.top } else { ground.top },
        right: if frame.right - extent.right < near { frame.right } else { ground.right },
        bottom: if frame.bottom - extent.bottom < near { frame.bottom } else { ground.bottom },
    };
    canvas.rect(ground, "#ffffff");
    for (row, entry) in entries.iter().enumerate() {
        draw_entry(canvas, entry, [left, top + (row as f64 + 0.5) * ROW]);
    }
}

/// Draws an entry from its left end, at the middle of its row.
pub(super) fn draw_entry(canvas: &mut Canvas, entry: &Entry, [left, middle]: Point) {
    let sample = entry.sample();
    if entry.has_line {
        canvas.line([left, middle], [left + sample, middle], entry.stroke);
    }
    if let Some(shape) = entry.shape {
        let ink = Stroke::solid(entry.stroke.colour, 0.8);
        let fill = if entry.has_line { "#ffffff" } else { entry.stroke.colour };
        canvas.mark(shape, [left + sample / 2.0, middle], 2.0, fill, ink);
    }
    let at = [left + sample + SAMPLE_GAP, middle + CAP_HEIGHT * NOTE_SIZE / 2.0];
    canvas.label(entry.label, at, NOTE_SIZE, Anchor::Start);
}

/// Upper left corner of a box beside a point, where it covers least of `points`, within the frame and
/// clear of other boxes, as near as can be; none where there is no such place.
pub(super) fn beside(
    [x, y]: Point,
    [width, height]: [f64; 2],
    frame: Rect,
    points: &[Point],
    boxes: &[Rect],
) -> Option<Point> {
    let gap = 3.5;
    let corners = (0..ROWS_BESIDE).flat_map(|row| {
        let far = gap + f64::from(row) * height;
        [
            [x + gap, y - far - height],
            [x - gap - width, y - far - height],
            [x + gap, y + far],
            [x - gap - width, y + far],
        ]
    });
    let covered =
        |[left, top]: Point| Rect { left, top, right: left + width, bottom: top + height };
    let is_free = |corner: &Point| {
        let covered = covered(*corner);
        let is_inside = frame.contains(*corner) && frame.contains([covered.right, covered.bottom]);
        let is_met = |other: &Rect| {
            covered.left < other.right
                && other.left < covered.right
                && covered.top < other.bottom
                && other.top < covered.bottom
        };
        is_inside && !boxes.iter().any(is_met)
    };
    let hidden = |corner: &Point| {
        let covered = covered(*corner).grown(1.5);
        points.iter().filter(|&&point| covered.contains(point)).count()
    };
    corners.filter(is_free).min_by_key(hidden)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Rect = Rect { left: 0.0, top: 0.0, right: 100.0, bottom: 100.0 };

    #[test]
    fn an_empty_frame_has_its_legend_in_the_upper_right_corner() {
        let place = free_place([30.0, 20.0], FRAME, &[], &[]).unwrap();
        assert_eq!(place, [100.0 - CLEARANCE - 30.0, CLEARANCE]);
    }

    #[test]
    fn data_push_the_legend_away_and_may_leave_no_place() {
        let corner: Vec<Point> = (0..100).map(|k| [f64::from(k), f64::from(k) / 2.0]).collect();
        let [left, top] = free_place([30.0, 20.0], FRAME, &corner, &[]).unwrap();
        for [x, y] in corner {
            assert!(!(x > left && x < left + 30.0 && y > top && y < top + 20.0));
        }
        let everywhere: Vec<Point> =
            (0..400).map(|k| [f64::from(k % 20) * 5.0, f64::from(k / 20) * 5.0]).collect();
        assert_eq!(free_place([30.0, 20.0], FRAME, &everywhere, &[]), None);
        assert_eq!(free_place([101.0, 20.0], FRAME, &[], &[]), None);
    }

    #[test]
    fn a_vertical_line_is_avoided_where_there_is_room() {
        let [left, _] = free_place([30.0, 20.0], FRAME, &[], &[90.0]).unwrap();
        assert!(left + 30.0 < 90.0);
    }

    #[test]
    fn a_strip_breaks_into_rows_that_fit() {
        let label = Label::text("abc");
        let stroke = Stroke::solid("#000000", 1.0);
        let entry = || Entry { has_line: true, stroke, shape: None, label: &label };
        let entries = [entry(), entry(), entry()];
        let two = 2.0 * entry().width() + STRIP_GAP;
        let (places, height) = strip(&entries, two);
        assert_eq!(height, 2.0 * ROW);
        assert_eq!(places[2], [0.0, 1.5 * ROW]);
        assert_eq!(strip(&entries, 1.0).1, 3.0 * ROW);
    }

    #[test]
    fn entries_beyond_the_height_leave_a_row_for_their_number() {
        let places: Vec<Point> = (0..10).map(|row| [0.0, (f64::from(row) + 0.5) * ROW]).collect();
        assert_eq!(fitting(&places, 10.0 * ROW), 10);
        assert_eq!(fitting(&places, 5.0 * ROW), 4);
        assert_eq!(fitting(&places, 0.0), 0);
    }

    #[test]
    fn a_note_goes_to_the_side_without_data() {
        let falling: Vec<Point> = (0..100).map(|k| [f64::from(k), f64::from(k)]).collect();
        let [left, top] = beside([50.0, 50.0], [20.0, 8.0], FRAME, &falling, &[]).unwrap();
        assert!(left > 50.0 && top < 50.0);
        assert_eq!(beside([50.0, 50.0], [20.0, 8.0], FRAME, &[], &[FRAME]), None);
    }
}
