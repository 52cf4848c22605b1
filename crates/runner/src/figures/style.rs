//! Sizes, strokes and colours shared by every panel. Lengths are points of 1/72 inch.
//!
//! Colours: M. Okabe and K. Ito, "Color Universal Design" (2008), chosen to be told apart with
//! every common form of colour vision; lines differ in dashes and marks as well, for grey prints.

/// Thin lines: frames and ticks.
pub(super) const AXIS_WIDTH: f64 = 0.6;
/// Lines of data.
pub(super) const SERIES_WIDTH: f64 = 1.0;
/// Numbers at ticks.
pub(super) const TICK_SIZE: f64 = 8.0;
/// Names of axes.
pub(super) const LABEL_SIZE: f64 = 10.0;
/// Legends, labels of markers and of points.
pub(super) const NOTE_SIZE: f64 = 9.0;
/// Letters of panels.
pub(super) const LETTER_SIZE: f64 = 10.0;

/// Frames and text.
pub(super) const INK: &str = "#000000";
/// Predicted critical couplings.
pub(super) const MARKER_INK: &str = "#555555";
/// Links, and the line at zero.
pub(super) const LINK_INK: &str = "#8c8c8c";
/// Background of shaded spans.
pub(super) const SHADE: &str = "#eeeeee";
/// Nodes that belong to no cluster.
pub(super) const UNCLUSTERED: &str = "#dddddd";

const PALETTE: [&str; 7] =
    ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"];
const DASHES: [&str; 4] = ["", "6 2", "6 1.5 1.2 1.5", "2 1.2"];
const SHAPES: [Shape; 6] = [
    Shape::Circle,
    Shape::Square,
    Shape::Triangle,
    Shape::Diamond,
    Shape::TriangleDown,
    Shape::Pentagon,
];

/// A line to draw.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stroke {
    pub(super) colour: &'static str,
    pub(super) width: f64,
    /// Lengths of dashes and gaps; empty for a solid line.
    pub(super) dash: &'static str,
}

impl Stroke {
    /// A solid line.
    pub(super) fn solid(colour: &'static str, width: f64) -> Self {
        Self { colour, width, dash: "" }
    }
}

/// The outline of a mark on a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    Circle,
    Square,
    Triangle,
    Diamond,
    TriangleDown,
    Pentagon,
}

impl Shape {
    /// Corners around `centre`, all of about the area of a circle of this radius; none for a
    /// circle.
    pub(super) fn corners(self, [x, y]: [f64; 2], radius: f64) -> Vec<[f64; 2]> {
        let (n, first, scale) = match self {
            Self::Circle => return Vec::new(),
            Self::Square => (4, 45.0, 1.25),
            Self::Triangle => (3, -90.0, 1.45),
            Self::Diamond => (4, 0.0, 1.3),
            Self::TriangleDown => (3, 90.0, 1.45),
            Self::Pentagon => (5, -90.0, 1.2),
        };
        (0..n)
            .map(|k| {
                let angle = (first + 360.0 * f64::from(k) / f64::from(n)).to_radians();
                [x + scale * radius * angle.cos(), y + scale * radius * angle.sin()]
            })
            .collect()
    }
}

/// How series `number` is drawn: its line and the marks on it.
pub(super) fn series_style(number: usize) -> (Stroke, Shape) {
    let colour = PALETTE[number % PALETTE.len()];
    let dash = DASHES[number % DASHES.len()];
    (Stroke { colour, width: SERIES_WIDTH, dash }, SHAPES[number % SHAPES.len()])
}

/// Fill of the nodes of cluster `number`: the palette, then its tints, then its shades, then the
/// palette again (after 21 clusters).
pub(super) fn cluster_fill(number: usize) -> String {
    let [r, g, b] = channels(PALETTE[number % PALETTE.len()]);
    let mix = |c: f64| match number / PALETTE.len() % 3 {
        0 => c,
        1 => 0.45 * c + 0.55 * 255.0,
        _ => 0.55 * c + 0.1 * 255.0,
    };
    format!("#{:02x}{:02x}{:02x}", mix(r) as u8, mix(g) as u8, mix(b) as u8)
}

/// Black or white, whichever reads better on `fill` (relative luminance of WCAG 2, without its
/// gamma, which does not change the choice for this palette).
pub(super) fn ink_on(fill: &str) -> &'static str {
    let [r, g, b] = channels(fill);
    if 0.2126 * r + 0.7152 * g + 0.0722 * b < 0.56 * 255.0 { "#ffffff" } else { INK }
}

fn channels(hex: &str) -> [f64; 3] {
    let channel = |at| u8::from_str_radix(&hex[at..at + 2], 16).expect("a colour is #rrggbb");
    [1, 3, 5].map(|at| f64::from(channel(at)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn first_twenty_one_clusters_have_their_own_colours() {
        let fills: HashSet<_> = (0..21).map(cluster_fill).collect();
        assert_eq!(fills.len(), 21);
        assert_eq!(cluster_fill(21), cluster_fill(0));
    }

    #[test]
    fn first_twelve_series_differ_without_colour() {
        let drawn: HashSet<_> = (0..12)
            .map(|k| {
                let (stroke, shape) = series_style(k);
                (stroke.dash, format!("{shape:?}"))
            })
            .collect();
        assert_eq!(drawn.len(), 12);
    }

    #[test]
    fn ink_is_white_on_blue_and_black_on_orange() {
        assert_eq!(ink_on("#0072b2"), "#ffffff");
        assert_eq!(ink_on("#e69f00"), INK);
        assert_eq!(ink_on(UNCLUSTERED), INK);
    }
}
