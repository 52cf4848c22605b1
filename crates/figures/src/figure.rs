//! Panels with letters in a grid, drawn one after another on a page.

use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::canvas::{Anchor, Canvas, Rect};
use super::content::Content;
use super::drawable::Drawable;
use super::error::FigureError;
use super::font::CAP_HEIGHT;
use super::label::Label;
use super::style::{LETTER_SIZE, NOTE_SIZE};

/// Points of 1/72 inch in a millimetre.
pub(super) const POINTS_PER_MM: f64 = 72.0 / 25.4;
/// Space between neighbouring columns and rows, in points.
pub(super) const COLUMN_GAP: f64 = 8.0;
pub(super) const ROW_GAP: f64 = 6.0;
/// Margin around the page.
const EDGE: f64 = 2.0;

/// Panels in a grid.
#[derive(Clone, Debug)]
pub struct Figure {
    /// For readers that show it, and for those who cannot see the figure.
    pub title: String,
    /// Width on paper in mm; text keeps its size (7 pt and more) whatever the width.
    pub width_mm: f64,
    /// Height on paper in mm.
    pub height_mm: f64,
    /// Widths of the columns, as shares of the whole.
    pub columns: Vec<f64>,
    /// Heights of the rows, as shares of the whole.
    pub rows: Vec<f64>,
    /// The panels, drawn in this order.
    pub panels: Vec<Panel>,
}

/// A panel and its place in the grid.
#[derive(Clone, Debug)]
pub struct Panel {
    /// Stands in its upper left corner: "(a1)"; empty for none.
    pub letter: String,
    /// Rows it covers, from 0.
    pub rows: Range<usize>,
    /// Columns it covers, from 0.
    pub columns: Range<usize>,
    /// What it shows.
    pub content: Content,
}

/// A figure as it could be drawn.
#[derive(Debug)]
pub struct Drawn {
    /// SVG text; the same figure always gives the same bytes.
    pub svg: String,
    /// Why panels were left empty, one reason a panel.
    pub left_out: Vec<FigureError>,
}

/// An error and the number of the panel that it is about; none where the whole page cannot be.
type Failure = (Option<usize>, FigureError);

impl Figure {
    /// The figure, a panel that cannot be drawn left empty but for a word that says so.
    ///
    /// # Errors
    /// A [`FigureError`] of the page itself: its size, its grid, or no panels at all.
    pub fn drawn(&self) -> Result<Drawn, FigureError> {
        let mut failed: Vec<(usize, FigureError)> = Vec::new();
        loop {
            let is_empty = |panel: usize| failed.iter().any(|(failed, _)| *failed == panel);
            match self.attempt(&is_empty) {
                Ok(svg) => {
                    let left_out = failed.into_iter().map(|(_, error)| error).collect();
                    return Ok(Drawn { svg, left_out });
                }
                Err((Some(panel), error)) => failed.push((panel, error)),
                Err((None, error)) => return Err(error),
            }
        }
    }

    /// The figure with these panels alone, called by their letters without parentheses, at the size they
    /// have in the whole; none where no panel is called so.
    pub fn only(&self, letters: &[String]) -> Option<Self> {
        let is_kept = |panel: &&Panel| {
            letters.iter().any(|letter| panel.letter.trim_matches(['(', ')']) == letter)
        };
        let mut panels: Vec<Panel> = self.panels.iter().filter(is_kept).cloned().collect();
        if panels.is_empty() {
            return None;
        }
        let (columns, width_mm) = closed_up(
            &self.columns,
            self.width_mm,
            COLUMN_GAP,
            panels.iter_mut().map(|p| &mut p.columns),
        );
        let (rows, height_mm) =
            closed_up(&self.rows, self.height_mm, ROW_GAP, panels.iter_mut().map(|p| &mut p.rows));
        Some(Self { title: self.title.clone(), width_mm, height_mm, columns, rows, panels })
    }

    /// The figure as SVG text, every panel of which can be drawn.
    #[cfg(test)]
    pub(super) fn svg(&self) -> Result<String, FigureError> {
        self.attempt(&|_| false).map_err(|(_, error)| error)
    }

    fn attempt(&self, is_empty: &dyn Fn(usize) -> bool) -> Result<String, Failure> {
        self.check().map_err(|error| (None, error))?;
        let [width, height] = [self.width_mm, self.height_mm].map(|mm| mm * POINTS_PER_MM);
        let mut canvas = Canvas::new(width, height, &self.title);
        let columns = spans(&self.columns, width, COLUMN_GAP);
        let rows = spans(&self.rows, height, ROW_GAP);
        let cells: Vec<Rect> = self.panels.iter().map(|p| cell(p, &columns, &rows)).collect();
        let margins = self.left_margins(&cells, is_empty)?;
        for (number, (panel, &cell)) in self.panels.iter().zip(&cells).enumerate() {
            let letter = &panel.letter;
            if is_empty(number) {
                let middle = [(cell.left + cell.right) / 2.0, (cell.top + cell.bottom) / 2.0];
                canvas.label(&Label::text("not drawn"), middle, NOTE_SIZE, Anchor::Middle);
            } else {
                guarded(letter, || panel.content.draw(&mut canvas, cell, margins[number], letter))
                    .map_err(|error| (Some(number), error))?;
            }
            let at = [cell.left, cell.top + CAP_HEIGHT * LETTER_SIZE + 1.0];
            canvas.label(&Label::text(letter.as_str()), at, LETTER_SIZE, Anchor::Start);
        }
        Ok(canvas.finish())
    }

    /// Room at the left of each panel, the same for all panels that begin in one column, so
    /// that their frames stand flush.
    fn left_margins(
        &self,
        cells: &[Rect],
        is_empty: &dyn Fn(usize) -> bool,
    ) -> Result<Vec<f64>, Failure> {
        let mut of_column = vec![0.0_f64; self.columns.len()];
        for (number, (panel, cell)) in self.panels.iter().zip(cells).enumerate() {
            if is_empty(number) {
                continue;
            }
            let letter = &panel.letter;
            let own = guarded(letter, || panel.content.left_margin(cell.height(), letter))
                .map_err(|error| (Some(number), error))?;
            let margin = &mut of_column[panel.columns.start];
            *margin = margin.max(own);
        }
        Ok(self.panels.iter().map(|p| of_column[p.columns.start]).collect())
    }

    fn check(&self) -> Result<(), FigureError> {
        let is_length = |x: &f64| x.is_finite() && *x > 0.0;
        let (width, height) = (self.width_mm, self.height_mm);
        if !is_length(&width) || !is_length(&height) {
            return Err(FigureError::BadSize { width, height });
        }
        if self.panels.is_empty() {
            return Err(FigureError::NoPanels);
        }
        for shares in [&self.columns, &self.rows] {
            if !shares.iter().all(is_length) {
                return Err(FigureError::BadShares { shares: shares.clone() });
            }
        }
        let (n_rows, n_columns) = (self.rows.len(), self.columns.len());
        let fits = |r: &Range<usize>, n| r.start < r.end && r.end <= n;
        for p in &self.panels {
            if !fits(&p.rows, n_rows) || !fits(&p.columns, n_columns) {
                return Err(FigureError::OutsideGrid {
                    panel: p.letter.clone(),
                    rows: (p.rows.start, p.rows.end),
                    columns: (p.columns.start, p.columns.end),
                    n_rows,
                    n_columns,
                });
            }
        }
        Ok(())
    }
}

/// A panic in drawing is a fault of ours, but what was computed is not lost to it. What was half
/// drawn is thrown away with its page.
fn guarded<T>(
    panel: &str,
    work: impl FnOnce() -> Result<T, FigureError>,
) -> Result<T, FigureError> {
    catch_unwind(AssertUnwindSafe(work))
        .unwrap_or_else(|_| Err(FigureError::Panicked { panel: panel.into() }))
}

/// Start and end of each column or row on a page of this extent.
fn spans(shares: &[f64], extent: f64, gap: f64) -> Vec<[f64; 2]> {
    let gaps = gap * shares.len().saturating_sub(1) as f64;
    let unit = (extent - 2.0 * EDGE - gaps) / shares.iter().sum::<f64>();
    let mut start = EDGE;
    let mut spans = Vec::new();
    for share in shares {
        spans.push([start, start + share * unit]);
        start += share * unit + gap;
    }
    spans
}

/// The shares of the columns or rows that are covered and the extent in mm that these have together; the
/// covered ranges then count these alone.
fn closed_up<'a>(
    shares: &[f64],
    extent_mm: f64,
    gap: f64,
    covered: impl Iterator<Item = &'a mut Range<usize>>,
) -> (Vec<f64>, f64) {
    let covered: Vec<&mut Range<usize>> = covered.collect();
    let is_kept: Vec<bool> =
        (0..shares.len()).map(|k| covered.iter().any(|range| range.contains(&k))).collect();
    let n_before = |end: usize| is_kept.iter().take(end).filter(|&&kept| kept).count();
    let kept: Vec<f64> =
        shares.iter().zip(&is_kept).filter(|(_, kept)| **kept).map(|(share, _)| *share).collect();
    let spans = spans(shares, extent_mm * POINTS_PER_MM, gap);
    let lengths = spans.iter().zip(&is_kept).filter(|(_, kept)| **kept).map(|([a, b], _)| b - a);
    let points = lengths.sum::<f64>() + gap * (kept.len() - 1) as f64 + 2.0 * EDGE;
    covered.into_iter().for_each(|range| *range = n_before(range.start)..n_before(range.end));
    (kept, points / POINTS_PER_MM)
}

fn cell(panel: &Panel, columns: &[[f64; 2]], rows: &[[f64; 2]]) -> Rect {
    Rect {
        left: columns[panel.columns.start][0],
        right: columns[panel.columns.end - 1][1],
        top: rows[panel.rows.start][0],
        bottom: rows[panel.rows.end - 1][1],
    }
}
