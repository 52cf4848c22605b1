//! Distances and counts that all parts of the panel share.

use crate::label::Label;
use crate::numbers::grouped;
use crate::style::TICK_SIZE;

/// Distance of the two axes from the bands.
pub const AXIS_GAP: f64 = 4.0;
pub const TICK_LENGTH: f64 = 2.5;
/// Distance of numbers from what they belong to.
pub const NUMBER_GAP: f64 = 3.0;

/// A count with its word where that is no wider than the first width, without it where that is no
/// wider than the second.
pub fn count_within(n: usize, name: &str, widths: [f64; 2]) -> Option<Label> {
    let number = grouped(n);
    let labels = [Label::text(format!("{number} {name}")), Label::text(number)];
    labels.into_iter().zip(widths).find(|(l, width)| l.width(TICK_SIZE) <= *width).map(|(l, _)| l)
}
