//! What a kind of panel must be able to do.

use crate::canvas::{Canvas, Rect};
use crate::error::FigureError;

/// A panel that draws itself into a cell of the grid.
pub(crate) trait Drawable {
    /// Room that it wants at the left of a frame in a cell of this height, the same for all panels that
    /// begin in one column; none for a panel without a frame.
    fn left_margin(&self, _height: f64, _panel: &str) -> Result<f64, FigureError> {
        Ok(0.0)
    }

    /// Draws the panel as large as the cell allows, a frame `left_margin` from the left.
    ///
    /// - `panel`: its letter, for errors.
    fn draw(
        &self,
        canvas: &mut Canvas,
        cell: Rect,
        left_margin: f64,
        panel: &str,
    ) -> Result<(), FigureError>;
}
