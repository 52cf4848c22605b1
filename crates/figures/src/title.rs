//! The title of a panel: in the row of its letter, above the middle of what it belongs to, clear of the
//! letter at its left and of what stands at its right.

use super::canvas::{Anchor, Canvas, Rect};
use super::font::CAP_HEIGHT;
use super::label::Label;
use super::style::{LABEL_SIZE, LETTER_SIZE, NOTE_SIZE};

/// Least distance from what stands beside it.
const GAP: f64 = 5.0;
/// Sizes that are tried, the largest first.
const SIZES: [f64; 3] = [NOTE_SIZE, 8.0, 7.0];

/// Where the baselines of this row are.
pub(super) fn baseline(cell: Rect) -> f64 {
    cell.top + CAP_HEIGHT * LABEL_SIZE + 1.0
}

/// Draws a title with its middle as near to `middle` as the letter of the panel and the place `right`
/// allow, at the largest size at which it fits; a title too long for any is left out.
pub(super) fn draw(
    canvas: &mut Canvas,
    title: &Label,
    middle: f64,
    (cell, right): (Rect, f64),
    letter: &str,
) {
    let left = cell.left + Label::text(letter).width(LETTER_SIZE) + GAP;
    let right = right - GAP;
    let fits = |size: &f64| title.width(*size) <= right - left;
    if let Some(size) = SIZES.into_iter().find(fits) {
        let half = title.width(size) / 2.0;
        let at = [middle.max(left + half).min(right - half), baseline(cell)];
        canvas.label(title, at, size, Anchor::Middle);
    }
}
