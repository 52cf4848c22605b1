//! One curve of a line panel: points in order, joined by lines, with marks and spread.

use super::axis::{Axes, Scale};
use super::canvas::{Canvas, Point, Rect};
use super::error::FigureError;
use super::label::Label;
use super::style::{LINK_INK, Shape, Stroke, cluster_fill, series_style};

/// Marks on a curve, counted over its whole length, where it has more points than this.
const MARKS: usize = 12;
/// Width of the line of one curve of very many.
const MUTED_WIDTH: f64 = 0.4;
/// Radius of a mark.
const MARK_RADIUS: f64 = 1.9;
/// Marks of one series that stand alone, beyond which they become smaller.
const CROWD: f64 = 60.0;
/// Half the width of the caps of an error bar.
const CAP: f64 = 1.5;

/// A curve.
#[derive(Clone, Debug, Default)]
pub struct Series {
    /// Its entry in the legend; an empty label for none.
    pub label: Label,
    /// Number of its dashes and mark, and of its colour where that has none of its own.
    pub style: usize,
    /// Number of the cluster that it belongs to, whose colour it has.
    pub cluster: Option<usize>,
    /// Whether it is one of many that nobody could tell apart: thin, grey and without marks.
    pub muted: bool,
    /// Values of x, in the order in which they are joined.
    pub x: Vec<f64>,
    /// Values of y, one for each x.
    pub y: Vec<f64>,
    /// The spread about y, over seeds for example.
    pub spread: Option<Spread>,
}

/// The spread of a quantity at each x.
#[derive(Clone, Debug)]
pub struct Spread {
    /// Lower ends, one for each x, as values of y. On a logarithmic axis an end of zero or less
    /// leaves a gap.
    pub lower: Vec<f64>,
    /// Upper ends, one for each x.
    pub upper: Vec<f64>,
    /// How it is drawn.
    pub drawn: SpreadStyle,
}

/// How a spread is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpreadStyle {
    /// A shaded band.
    Band,
    /// A bar at every point.
    Bars,
}

impl Series {
    /// The line, and the mark on it.
    pub(super) fn drawn_as(&self) -> (Stroke, Option<Shape>) {
        if self.muted {
            return (Stroke::solid(LINK_INK, MUTED_WIDTH), None);
        }
        let (stroke, shape) = self.style();
        (stroke, Some(shape))
    }

    /// The line and the mark of a series that can be told apart.
    fn style(&self) -> (Stroke, Shape) {
        let (stroke, shape) = series_style(self.style);
        let colour = self.cluster.map_or(stroke.colour, cluster_fill);
        (Stroke { colour, ..stroke }, shape)
    }

    /// Every y that is to be seen.
    pub(super) fn y_values(&self) -> impl Iterator<Item = f64> {
        let spread = self.spread.iter().flat_map(|s| s.lower.iter().chain(&s.upper));
        self.y.iter().chain(spread).copied()
    }

    /// Stretches of neighbouring points that can be drawn, each with its number.
    fn stretches(&self, axes: Axes, y: &[f64]) -> Vec<Vec<(usize, Point)>> {
        let mut stretches = vec![Vec::new()];
        for (k, (&x, &y)) in self.x.iter().zip(y).enumerate() {
            match (axes.at(x, y), stretches.last_mut()) {
                (Some(point), Some(last)) => last.push((k, point)),
                _ => stretches.push(Vec::new()),
            }
        }
        stretches.retain(|s| !s.is_empty());
        stretches
    }
}

/// Checks that columns agree in length and that something can be drawn.
pub(super) fn check(series: &[Series], scale: Scale, panel: &str) -> Result<(), FigureError> {
    if series.is_empty() {
        return Err(FigureError::Empty { panel: panel.into(), what: "series" });
    }
    for (k, s) in series.iter().enumerate() {
        let mut columns = vec![("y", s.y.len())];
        if let Some(spread) = &s.spread {
            columns.push(("lower ends", spread.lower.len()));
            columns.push(("upper ends", spread.upper.len()));
        }
        if let Some(&(column, found)) = columns.iter().find(|c| c.1 != s.x.len()) {
            let (panel, n_x) = (panel.into(), s.x.len());
            return Err(FigureError::LengthMismatch { panel, series: k + 1, n_x, column, found });
        }
        let drawable = |(x, y): (&f64, &f64)| x.is_finite() && scale.transform(*y).is_some();
        if !s.x.iter().zip(&s.y).any(drawable) {
            let (panel, n_points) = (panel.into(), s.x.len());
            return Err(FigureError::NothingToDraw { panel, series: k + 1, n_points });
        }
    }
    Ok(())
}

/// Draws every spread, then every line, then every mark, so that no line hides under a band.
pub(super) fn draw(canvas: &mut Canvas, series: &[Series], axes: Axes) {
    for s in series {
        draw_spread(canvas, s, axes);
    }
    let (muted, series): (Vec<&Series>, Vec<&Series>) = series.iter().partition(|s| s.muted);
    for s in muted.iter().chain(&series) {
        let (stroke, _) = s.drawn_as();
        for stretch in s.stretches(axes, &s.y) {
            let points: Vec<Point> = stretch.iter().map(|&(_, p)| p).collect();
            match points[..] {
                [alone] if s.muted => canvas.circle(alone, MUTED_WIDTH, LINK_INK, stroke),
                [_] => {}
                _ => canvas.polyline(&points, stroke),
            }
        }
    }
    for (k, s) in series.iter().enumerate() {
        // A curve alone needs no marks to be told from others.
        let phase = (series.len() > 1).then_some(k as f64 / series.len() as f64);
        draw_marks(canvas, s, axes, phase);
    }
}

/// Draws every point within the frame as a mark, none joined to the next.
pub(super) fn draw_marks_only(canvas: &mut Canvas, series: &[Series], axes: Axes, frame: Rect) {
    for s in series {
        let (stroke, shape) = s.style();
        let mut points = points(s, axes);
        points.retain(|&point| frame.contains(point));
        let radius = MARK_RADIUS * (CROWD / points.len() as f64).cbrt().clamp(0.4, 1.0);
        canvas.marks(shape, &points, radius, stroke.colour);
    }
}

/// The points themselves, those that can be drawn.
pub(super) fn points(series: &Series, axes: Axes) -> Vec<Point> {
    series.x.iter().zip(&series.y).filter_map(|(&x, &y)| axes.at(x, y)).collect()
}

/// Points along the curve and the edges of its spread, at most 3 points of length apart.
pub(super) fn points_along(series: &Series, axes: Axes) -> Vec<Point> {
    let mut edges = vec![&series.y];
    edges.extend(series.spread.iter().flat_map(|s| [&s.lower, &s.upper]));
    let stretches = edges.into_iter().flat_map(|y| series.stretches(axes, y));
    stretches.flat_map(|stretch| densely(&stretch)).collect()
}

fn densely(stretch: &[(usize, Point)]) -> Vec<Point> {
    let mut points = vec![stretch[0].1];
    for pair in stretch.windows(2) {
        let ([x, y], [to_x, to_y]) = (pair[0].1, pair[1].1);
        // Far points stand outside every frame, so a bounded number of steps is enough.
        let steps = ((to_x - x).hypot(to_y - y) / 3.0).ceil().clamp(1.0, 1e3) as u32;
        points.extend((1..=steps).map(|k| {
            let share = f64::from(k) / f64::from(steps);
            [x + share * (to_x - x), y + share * (to_y - y)]
        }));
    }
    points
}

fn draw_spread(canvas: &mut Canvas, series: &Series, axes: Axes) {
    let Some(spread) = &series.spread else { return };
    let (stroke, _) = series.style();
    let ends = |k: usize| {
        let x = series.x[k];
        axes.at(x, spread.lower[k]).zip(axes.at(x, spread.upper[k]))
    };
    let ends: Vec<_> = (0..series.x.len()).map(ends).collect();
    match spread.drawn {
        SpreadStyle::Band => {
            for stretch in ends.split(Option::is_none) {
                let lower = stretch.iter().flatten().map(|e| e.0);
                let upper = stretch.iter().flatten().map(|e| e.1);
                let corners: Vec<Point> = lower.chain(upper.rev()).collect();
                if corners.len() > 2 {
                    canvas.area(&corners, stroke.colour, 0.22);
                }
            }
        }
        SpreadStyle::Bars => {
            let thin = Stroke::solid(stroke.colour, 0.7);
            for (from, to) in ends.into_iter().flatten() {
                canvas.line(from, to, thin);
                for [x, y] in [from, to] {
                    canvas.line([x - CAP, y], [x + CAP, y], thin);
                }
            }
        }
    }
}

/// Marks on every point of a short curve; on a long one a few, shifted by `phase` of their
/// distance so that the marks of coinciding curves stand side by side, or none without a phase. A
/// point without neighbours always has its mark, since no line shows it.
fn draw_marks(canvas: &mut Canvas, series: &Series, axes: Axes, phase: Option<f64>) {
    let (stroke, shape) = series.style();
    let is_short = series.x.len() <= 2 * MARKS;
    let every = if is_short { 1 } else { series.x.len().div_ceil(MARKS) };
    let first = phase.map(|p| (p * every as f64) as usize).or(is_short.then_some(0));
    let ink = Stroke::solid(stroke.colour, 0.8);
    for stretch in series.stretches(axes, &series.y) {
        for &(k, at) in &stretch {
            if first == Some(k % every) || stretch.len() == 1 {
                canvas.mark(shape, at, MARK_RADIUS, "#ffffff", ink);
            }
        }
    }
}
