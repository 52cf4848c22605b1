//! Small multiples: curves in a square of small frames, row by row, that share the range of y and each have
//! their own of x. Numbers of y and names of axes stand outside only; a curve is cut where it leaves its
//! frame.
//!
//! Source of the form: E. R. Tufte, Envisioning Information (1990), chapter 4.

use super::axis::{Axes, Axis, Scale, Tick};
use super::canvas::{Anchor, Canvas, Rect};
use super::drawable::Drawable;
use super::error::FigureError;
use super::font::CAP_HEIGHT;
use super::label::Label;
use super::series::{self, Series};
use super::style::{AXIS_WIDTH, INK, LINK_INK, NOTE_SIZE, SHADE, Stroke};
use super::title;

/// Numbers, and the words in the frames.
const NUMBER_SIZE: f64 = 6.5;
const NAME_SIZE: f64 = 7.5;
const TICK_LENGTH: f64 = 2.0;
/// Room for a title, and for the name of the axis below.
const ABOVE: f64 = 15.0;
const BELOW: f64 = 9.0;
/// Room for the numbers under each frame, and between neighbours.
const NUMBERS: f64 = 9.5;
const GAP: f64 = 6.5;
/// Least distance between numbers along x and along y.
const X_SPACING: f64 = 20.0;
const Y_SPACING: f64 = 9.5;
/// How far a number under a frame may stand out at its sides.
const OVERHANG: f64 = 2.0;
/// Distance of a word from the frame it stands in.
const INSET: f64 = 3.0;

/// Small multiples.
#[derive(Clone, Debug, Default)]
pub struct MultiplesPanel {
    /// Stands above all of them.
    pub title: Label,
    /// Name of the horizontal axes.
    pub x_label: Label,
    /// Name of the vertical axes.
    pub y_label: Label,
    /// Range of y in every frame.
    pub y_range: [f64; 2],
    /// How many stand side by side.
    pub columns: usize,
    /// The frames, row by row.
    pub multiples: Vec<Multiple>,
}

/// One small frame.
#[derive(Clone, Debug, Default)]
pub struct Multiple {
    /// Stands in its upper right corner.
    pub name: Label,
    /// The curve.
    pub series: Series,
    /// Range of x.
    pub x_range: [f64; 2],
    /// Spans of x with a background.
    pub shaded: Vec<[f64; 2]>,
}

impl Drawable for MultiplesPanel {
    fn draw(
        &self,
        canvas: &mut Canvas,
        cell: Rect,
        _left_margin: f64,
        panel: &str,
    ) -> Result<(), FigureError> {
        if self.multiples.is_empty() || self.columns == 0 {
            return Err(FigureError::Empty { panel: panel.into(), what: "curves" });
        }
        let [from, to] = self.y_range;
        if !(from.is_finite() && to.is_finite() && from < to) {
            return Err(FigureError::BadRange { panel: panel.into(), from, to });
        }
        let left = self.y_label.width(NOTE_SIZE) + 5.0 + self.width_of_numbers(cell);
        let inner = Rect {
            left: cell.left + left,
            top: cell.top + ABOVE,
            right: cell.right - INSET,
            bottom: cell.bottom - BELOW,
        };
        title::draw(canvas, &self.title, 0.0, (cell, cell.right), panel);
        for (number, multiple) in self.multiples.iter().enumerate() {
            let frame = self.frame(inner, number);
            let (width, height) = (frame.width(), frame.height());
            if width < 20.0 || height < 15.0 {
                return Err(FigureError::TooSmall { panel: panel.into(), width, height });
            }
            series::check(std::slice::from_ref(&multiple.series), Scale::Linear, panel)?;
            let is_first = number % self.columns == 0;
            multiple.draw(canvas, frame, (self.y_range, is_first), panel)?;
        }
        let middle = [(inner.left + inner.right) / 2.0, (inner.top + inner.bottom) / 2.0];
        let below = [middle[0], cell.bottom - 1.0];
        canvas.label(&self.x_label, below, NOTE_SIZE, Anchor::Middle);
        // A symbol, which is read more easily upright.
        let at = [cell.left, middle[1] + CAP_HEIGHT * NOTE_SIZE / 2.0];
        canvas.label(&self.y_label, at, NOTE_SIZE, Anchor::Start);
        Ok(())
    }
}

impl MultiplesPanel {
    fn rows(&self) -> usize {
        self.multiples.len().div_ceil(self.columns)
    }

    fn frame(&self, inner: Rect, number: usize) -> Rect {
        let (row, column) = ((number / self.columns) as f64, (number % self.columns) as f64);
        let pitch = (inner.width() + GAP) / self.columns as f64;
        let step = inner.height() / self.rows() as f64;
        let (left, top) = (inner.left + column * pitch, inner.top + row * step);
        Rect { left, top, right: left + pitch - GAP, bottom: top + step - NUMBERS }
    }

    fn width_of_numbers(&self, cell: Rect) -> f64 {
        let height = (cell.height() - ABOVE - BELOW) / self.rows() as f64 - NUMBERS;
        let axis = Axis::new(Scale::Linear, self.y_range, [height.max(1.0), 0.0]);
        let labels = axis.ticks(Y_SPACING).into_iter().filter_map(|tick| tick.label);
        labels.map(|label| label.width(NUMBER_SIZE)).fold(0.0, f64::max)
    }
}

impl Multiple {
    fn draw(
        &self,
        canvas: &mut Canvas,
        frame: Rect,
        (y_range, has_numbers): ([f64; 2], bool),
        panel: &str,
    ) -> Result<(), FigureError> {
        let [from, to] = self.x_range;
        if !(from.is_finite() && to.is_finite() && from < to) {
            return Err(FigureError::BadRange { panel: panel.into(), from, to });
        }
        let axes = Axes {
            x: Axis::new(Scale::Linear, self.x_range, [frame.left, frame.right]),
            y: Axis::new(Scale::Linear, y_range, [frame.bottom, frame.top]),
        };
        canvas.clipped(frame, |canvas| {
            for &[from, to] in &self.shaded {
                if let (Some(left), Some(right)) = (axes.x.at(from), axes.x.at(to)) {
                    canvas.rect(Rect { left, right, ..frame }, SHADE);
                }
            }
            if let Some(y) = axes.y.at(0.0) {
                let thin = Stroke::solid(LINK_INK, AXIS_WIDTH);
                canvas.line([frame.left, y], [frame.right, y], thin);
            }
            series::draw(canvas, std::slice::from_ref(&self.series), axes);
        });
        draw_ticks(canvas, frame, axes, has_numbers);
        let baseline = frame.top + INSET + CAP_HEIGHT * NAME_SIZE;
        canvas.label(&self.name, [frame.right - INSET, baseline], NAME_SIZE, Anchor::End);
        Ok(())
    }
}

fn draw_ticks(canvas: &mut Canvas, frame: Rect, axes: Axes, has_numbers: bool) {
    let ink = Stroke::solid(INK, AXIS_WIDTH);
    canvas.frame(frame, ink);
    for Tick { at, label } in axes.x.ticks(X_SPACING) {
        let Some(label) = label else { continue };
        canvas.line([at, frame.bottom], [at, frame.bottom - TICK_LENGTH], ink);
        // Numbers at the ends of two neighbours stay apart.
        let half = label.width(NUMBER_SIZE) / 2.0 - OVERHANG;
        let middle = at.max(frame.left + half).min(frame.right - half);
        let baseline = frame.bottom + 2.0 + CAP_HEIGHT * NUMBER_SIZE;
        canvas.label(&label, [middle, baseline], NUMBER_SIZE, Anchor::Middle);
    }
    for Tick { at, label } in axes.y.ticks(Y_SPACING) {
        let Some(label) = label else { continue };
        canvas.line([frame.left, at], [frame.left + TICK_LENGTH, at], ink);
        if has_numbers {
            let baseline = at + CAP_HEIGHT * NUMBER_SIZE / 2.0;
            canvas.label(&label, [frame.left - 2.0, baseline], NUMBER_SIZE, Anchor::End);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel(n: usize) -> MultiplesPanel {
        let series = Series { x: vec![0.0, 1.0], y: vec![1.0, -1.0], ..Series::default() };
        let multiple = Multiple {
            name: Label::math("x"),
            series,
            x_range: [0.0, 1.0],
            shaded: vec![[0.5, 2.0]],
        };
        let multiples = vec![multiple; n];
        MultiplesPanel { y_range: [-1.0, 1.0], columns: 3, multiples, ..MultiplesPanel::default() }
    }

    const CELL: Rect = Rect { left: 0.0, top: 0.0, right: 250.0, bottom: 180.0 };

    fn drawn(panel: &MultiplesPanel) -> Result<String, FigureError> {
        let mut canvas = Canvas::new(250.0, 180.0, "");
        panel.draw(&mut canvas, CELL, 0.0, "(a)").map(|()| canvas.finish())
    }

    #[test]
    fn frames_stand_in_rows_within_the_cell_and_apart() {
        let panel = panel(9);
        let frames: Vec<Rect> = (0..9).map(|k| panel.frame(CELL, k)).collect();
        assert_eq!(frames[0].top, frames[2].top);
        assert!(frames[0].right < frames[1].left && frames[0].bottom < frames[3].top);
        assert!(frames[8].right <= CELL.right + 1e-9 && frames[8].bottom < CELL.bottom);
    }

    #[test]
    fn numbers_of_y_stand_at_the_first_of_each_row_only() {
        let zeros = |svg: &str| svg.matches(">0.0<").count() + svg.matches(">0<").count();
        let [one, three] = [1, 3].map(|n| drawn(&panel(n)).unwrap());
        let of_x = zeros(&three) - zeros(&one);
        assert_eq!(of_x, 2, "two frames more bring two zeros of x more");
    }

    #[test]
    fn no_curves_no_range_and_no_room_are_errors() {
        assert!(matches!(drawn(&panel(0)), Err(FigureError::Empty { .. })));
        let flat = MultiplesPanel { y_range: [1.0, 1.0], ..panel(1) };
        assert!(matches!(drawn(&flat), Err(FigureError::BadRange { .. })));
        let narrow = MultiplesPanel { columns: 40, ..panel(40) };
        assert!(matches!(drawn(&narrow), Err(FigureError::TooSmall { .. })));
    }
}
