//! Line panel: quantities against one variable, such as errors δx_i against the coupling ε, with
//! the spread over seeds, vertical markers at critical couplings, and notes at single points.
//!
//! A value that is not finite, or not positive on a logarithmic axis, leaves a gap in its line.

use super::axis::{self, Axes, Axis, Scale, Tick};
use super::canvas::{Anchor, Canvas, Point, Rect};
use super::drawable::Drawable;
use super::error::FigureError;
use super::font::CAP_HEIGHT;
use super::label::Label;
use super::legend::{self, Entry};
use super::markers::{self, MarkerGroup};
use super::series::{self, Series};
use super::style::{
    AXIS_WIDTH, INK, LABEL_SIZE, LINK_INK, NOTE_SIZE, SHADE, Stroke, TICK_SIZE, YELLOW_SHADE,
};

const TICK_LENGTH: f64 = 3.0;
/// Room under the frame for numbers and the name of the axis.
const BELOW: f64 = 28.5;
/// Room at the right, half a number at the end of the axis.
const RIGHT: f64 = 8.0;
/// Room above the frame where there are no labels of markers.
const ABOVE: f64 = 8.0;
/// Room above the frame for the names of spans.
const SPAN_ROW: f64 = 13.0;
/// Height of the sample of a shaded span in the legend.
const SHADE_SAMPLE: f64 = 7.0;
/// Share of the height of a frame that a legend above it may take.
const LEGEND_SHARE: f64 = 0.5;
/// Least distance between numbers along x and along y.
const X_SPACING: f64 = 28.0;
const Y_SPACING: f64 = 16.0;

/// Curves in a frame.
#[derive(Clone, Debug, Default)]
pub struct LinePanel {
    /// Name of the horizontal axis.
    pub x_label: Label,
    /// Name of the vertical axis.
    pub y_label: Label,
    /// Scale of the vertical axis.
    pub y_scale: Scale,
    /// Range of x; none for what the series cover, with a small margin.
    pub x_range: Option<[f64; 2]>,
    /// Range of y; none for what the series and their spread cover.
    pub y_range: Option<[f64; 2]>,
    /// Whether a thin line marks y = 0.
    pub zero_line: bool,
    /// The curves, at least one with a point that can be drawn.
    pub series: Vec<Series>,
    /// Vertical lines.
    pub markers: Vec<MarkerGroup>,
    /// Labelled points.
    pub notes: Vec<Note>,
    /// Spans of x with a background, those of the last on top.
    pub shaded: Vec<Shade>,
    /// Whether every point stands alone as a mark, rather than joined to the next by a line; the
    /// spread is not drawn then.
    pub marks_only: bool,
    /// Named spans of x, with thin lines at their ends. Names stand above the frame where there
    /// is room, and nowhere where vertical markers have labels there.
    pub spans: Vec<Span>,
}

/// Spans of x with the same background.
#[derive(Clone, Debug)]
pub struct Shade {
    /// [from, to].
    pub spans: Vec<[f64; 2]>,
    /// What they are, in the legend; an empty label for no entry.
    pub label: Label,
    /// Which background.
    pub tone: Tone,
}

/// A background.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    /// Light grey.
    Grey,
    /// Light yellow.
    Yellow,
}

impl Tone {
    fn ink(self) -> &'static str {
        match self {
            Self::Grey => SHADE,
            Self::Yellow => YELLOW_SHADE,
        }
    }
}

/// A named span of x, such as the nodes of one community.
#[derive(Clone, Debug)]
pub struct Span {
    /// Lower end.
    pub from: f64,
    /// Upper end.
    pub to: f64,
    /// Its name; an empty label for none.
    pub label: Label,
}

/// A dot with a label beside it; without the label where there is no room for it.
#[derive(Clone, Debug)]
pub struct Note {
    /// Where it stands, (x, y). A note outside the ranges is left out.
    pub at: [f64; 2],
    /// What it says.
    pub label: Label,
}

impl Drawable for LinePanel {
    /// Width that numbers and name of the y axis take in a cell of this height.
    fn left_margin(&self, height: f64, panel: &str) -> Result<f64, FigureError> {
        let [_, y_range] = self.ranges(panel)?;
        let frame_height = height - self.above() - BELOW;
        let numbers = Axis::new(self.y_scale, y_range, [frame_height.max(1.0), 0.0]);
        let ticks = numbers.ticks(Y_SPACING);
        let labels = ticks.iter().filter_map(|t| t.label.as_ref());
        let widest = labels.map(|l| l.width(TICK_SIZE)).fold(0.0, f64::max);
        Ok(widest + 1.45 * LABEL_SIZE + 7.0)
    }

    /// Draws the panel into a cell, its frame `left_margin` from the left. The legend stands in
    /// the frame where it hides nothing, else above it.
    fn draw(
        &self,
        canvas: &mut Canvas,
        cell: Rect,
        left_margin: f64,
        panel: &str,
    ) -> Result<(), FigureError> {
        let ranges = self.ranges(panel)?;
        let mut frame = Rect {
            left: cell.left + left_margin,
            top: cell.top + self.above(),
            right: cell.right - RIGHT,
            bottom: cell.bottom - BELOW,
        };
        check_room(frame, panel)?;
        let entries = self.entries();
        let place = self.legend_place(&entries, frame, self.axes(ranges, frame));
        if place.is_none() && !entries.is_empty() {
            let most = LEGEND_SHARE * frame.height();
            let height =
                legend::draw_strip(canvas, &entries, [frame.left, cell.top], [frame.width(), most]);
            frame.top += height;
            check_room(frame, panel)?;
        }
        let axes = self.axes(ranges, frame);
        self.draw_data(canvas, frame, axes);
        self.draw_span_names(canvas, frame, axes);
        markers::draw_labels(canvas, &self.markers, &axes.x, frame);
        if let (Some(place), false) = (place, entries.is_empty()) {
            legend::draw_inside(canvas, &entries, place, frame);
        }
        self.draw_notes(canvas, frame, axes);
        self.draw_frame(canvas, cell, frame, axes);
        Ok(())
    }
}

impl LinePanel {
    fn above(&self) -> f64 {
        if self.has_marker_labels() {
            markers::ROW_HEIGHT
        } else if self.spans.iter().any(|s| !s.label.is_empty()) {
            SPAN_ROW
        } else {
            ABOVE
        }
    }

    fn has_marker_labels(&self) -> bool {
        self.markers.iter().flat_map(|g| &g.markers).any(|m| m.label.is_some())
    }

    /// Ranges of x and y in transformed values.
    fn ranges(&self, panel: &str) -> Result<[[f64; 2]; 2], FigureError> {
        series::check(&self.series, self.y_scale, panel)?;
        let x_values = self.series.iter().flat_map(|s| s.x.iter().copied());
        let zero = self.zero_line.then_some(0.0);
        let y_values = self.series.iter().flat_map(Series::y_values).chain(zero);
        let empty = || FigureError::Empty { panel: panel.into(), what: "series" };
        let x = axis::range(x_values, self.x_range, Scale::Linear, 0.02, panel)?;
        let y = axis::range(y_values, self.y_range, self.y_scale, 0.04, panel)?;
        Ok([x.ok_or_else(empty)?, y.ok_or_else(empty)?])
    }

    fn axes(&self, [x, y]: [[f64; 2]; 2], frame: Rect) -> Axes {
        Axes {
            x: Axis::new(Scale::Linear, x, [frame.left, frame.right]),
            y: Axis::new(self.y_scale, y, [frame.bottom, frame.top]),
        }
    }

    /// Entries of the legend: curves and groups of markers that have a name.
    fn entries(&self) -> Vec<Entry<'_>> {
        let curves = self.series.iter().filter(|s| !s.label.is_empty()).map(|s| {
            let (stroke, shape) = s.drawn_as();
            Entry { has_line: !self.marks_only, stroke, shape, label: &s.label }
        });
        let lines = self.markers.iter().filter_map(|g| {
            let label = g.legend.as_ref()?;
            let stroke = markers::stroke(g.style);
            Some(Entry { has_line: true, stroke, shape: None, label })
        });
        let shades = self.shaded.iter().filter(|shade| !shade.label.is_empty()).map(|shade| {
            let stroke = Stroke::solid(shade.tone.ink(), SHADE_SAMPLE);
            Entry { has_line: true, stroke, shape: None, label: &shade.label }
        });
        curves.chain(lines).chain(shades).collect()
    }

    fn legend_place(&self, entries: &[Entry], frame: Rect, axes: Axes) -> Option<Point> {
        let mut taken = self.drawn_points(axes);
        let noted = self.notes.iter().filter_map(|n| axes.at(n.at[0], n.at[1]));
        taken.extend(noted.flat_map(|[x, y]| [-40.0, -20.0, 0.0, 20.0, 40.0].map(|d| [x + d, y])));
        let lines: Vec<f64> =
            markers::visible(&self.markers, &axes.x).iter().map(|&(x, ..)| x).collect();
        legend::free_place(legend::size(entries), frame, &taken, &lines)
    }

    /// Points along everything drawn, a few points of length apart.
    fn drawn_points(&self, axes: Axes) -> Vec<Point> {
        let along = if self.marks_only { series::points } else { series::points_along };
        self.series.iter().flat_map(|s| along(s, axes)).collect()
    }

    fn draw_data(&self, canvas: &mut Canvas, frame: Rect, axes: Axes) {
        canvas.clipped(frame, |canvas| {
            for shade in &self.shaded {
                for &[from, to] in &shade.spans {
                    if let (Some(left), Some(right)) = (axes.x.at(from), axes.x.at(to)) {
                        canvas.rect(Rect { left, right, ..frame }, shade.tone.ink());
                    }
                }
            }
            if let (true, Some(y)) = (self.zero_line, axes.y.at(0.0)) {
                let thin = Stroke::solid(LINK_INK, AXIS_WIDTH);
                canvas.line([frame.left, y], [frame.right, y], thin);
            }
            markers::draw_lines(canvas, &self.markers, &axes.x, frame);
            self.draw_span_ends(canvas, frame, axes);
            if !self.marks_only {
                series::draw(canvas, &self.series, axes);
            }
        });
        // A mark alone is drawn whole, even on the frame.
        if self.marks_only {
            series::draw_marks_only(canvas, &self.series, axes, frame);
        }
    }

    /// Lines between spans, and between them and other points; none at the ends of all points.
    fn draw_span_ends(&self, canvas: &mut Canvas, frame: Rect, axes: Axes) {
        let mut ends: Vec<f64> = self.spans.iter().flat_map(|s| [s.from, s.to]).collect();
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        let has =
            |side: &dyn Fn(f64) -> bool| self.series.iter().flat_map(|s| &s.x).any(|&x| side(x));
        ends.retain(|&end| has(&|x| x < end) && has(&|x| x > end));
        for x in ends.into_iter().filter_map(|end| axes.x.at(end)) {
            canvas.line([x, frame.top], [x, frame.bottom], Stroke::solid(LINK_INK, AXIS_WIDTH));
        }
    }

    fn draw_span_names(&self, canvas: &mut Canvas, frame: Rect, axes: Axes) {
        if self.has_marker_labels() {
            return;
        }
        for Span { from, to, label } in &self.spans {
            let Some((left, right)) = axes.x.at(*from).zip(axes.x.at(*to)) else { continue };
            let [left, right] = [left, right].map(|x| x.clamp(frame.left, frame.right));
            if label.width(TICK_SIZE) <= right - left {
                let at = [(left + right) / 2.0, frame.top - 3.5];
                canvas.label(label, at, TICK_SIZE, Anchor::Middle);
            }
        }
    }

    fn draw_frame(&self, canvas: &mut Canvas, cell: Rect, frame: Rect, axes: Axes) {
        let ink = Stroke::solid(INK, AXIS_WIDTH);
        canvas.frame(frame, ink);
        for Tick { at, label } in axes.x.ticks(X_SPACING) {
            let length = if label.is_some() { TICK_LENGTH } else { TICK_LENGTH / 2.0 };
            canvas.line([at, frame.bottom], [at, frame.bottom - length], ink);
            if let Some(label) = label {
                let baseline = frame.bottom + 3.5 + CAP_HEIGHT * TICK_SIZE;
                canvas.label(&label, [at, baseline], TICK_SIZE, Anchor::Middle);
            }
        }
        for Tick { at, label } in axes.y.ticks(Y_SPACING) {
            let length = if label.is_some() { TICK_LENGTH } else { TICK_LENGTH / 2.0 };
            canvas.line([frame.left, at], [frame.left + length, at], ink);
            if let Some(label) = label {
                let baseline = at + CAP_HEIGHT * TICK_SIZE / 2.0;
                canvas.label(&label, [frame.left - 3.5, baseline], TICK_SIZE, Anchor::End);
            }
        }
        let middle = [(frame.left + frame.right) / 2.0, (frame.top + frame.bottom) / 2.0];
        let x_at = [middle[0], frame.bottom + 15.0 + CAP_HEIGHT * LABEL_SIZE];
        canvas.label(&self.x_label, x_at, LABEL_SIZE, Anchor::Middle);
        let y_at = [cell.left + 1.1 * LABEL_SIZE, middle[1]];
        canvas.label_upwards(&self.y_label, y_at, LABEL_SIZE);
    }

    fn draw_notes(&self, canvas: &mut Canvas, frame: Rect, axes: Axes) {
        let taken = self.drawn_points(axes);
        let mut boxes: Vec<Rect> = Vec::new();
        for note in self.notes.iter().filter(|n| axes.x.holds(n.at[0]) && axes.y.holds(n.at[1])) {
            let Some(at) = axes.at(note.at[0], note.at[1]) else { continue };
            canvas.circle(at, 2.0, INK, Stroke::solid("#ffffff", 0.5));
            let height = 1.1 * NOTE_SIZE;
            let size = [note.label.width(NOTE_SIZE), height];
            let Some([left, top]) = legend::beside(at, size, frame, &taken, &boxes) else {
                continue;
            };
            boxes.push(Rect { left, top, right: left + size[0], bottom: top + height });
            let baseline = top + 0.8 * height;
            canvas.label(&note.label, [left, baseline], NOTE_SIZE, Anchor::Start);
        }
    }
}

/// A frame too small to read is an error rather than a blot.
fn check_room(frame: Rect, panel: &str) -> Result<(), FigureError> {
    let (width, height) = (frame.width(), frame.height());
    if width < 30.0 || height < 30.0 {
        return Err(FigureError::TooSmall { panel: panel.into(), width, height });
    }
    Ok(())
}
