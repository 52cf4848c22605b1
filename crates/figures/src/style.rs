//! Sizes, strokes and colours shared by every panel. Lengths are points of 1/72 inch.
//!
//! The first six colours: M. Okabe and K. Ito, "Color Universal Design" (2008), chosen to be told
//! apart with every common form of colour vision; lines differ in dashes and marks as well, for
//! grey prints. Those that follow, for clusters only, were found as C. Glasbey et al. do (Color
//! Res. Appl. 32, 304 (2007)): each is the colour farthest from all before it, from white and from
//! the grey of unclustered nodes, here in B. Ottosson's Oklab space, garish ones left out.

use std::sync::LazyLock;

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
/// Height of the row of a panel's letter and title.
pub(super) const HEADER: f64 = 16.0;
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
/// The same for what is to be told from these.
pub(super) const YELLOW_SHADE: &str = "#fbf3d0";
/// Nodes that belong to no cluster, and cells without a value.
pub(super) const UNCLUSTERED: &str = "#d3d3d3";

/// Colours of clusters, and of the lines that belong to them. Black, the seventh of Okabe and Ito, is
/// not among them: it would be heavy over an area, and it is the ink of all text.
#[rustfmt::skip]
const PALETTE: [&str; 29] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#69001e", "#004b00",
    "#2d1e87", "#962d96", "#3cf096", "#785a3c", "#f0e100", "#ffa5ff", "#8778f0",
    "#b41e3c", "#87b400", "#2df0ff", "#007800", "#3c4b69", "#96872d", "#876996", "#690069",
    "#5a3cb4", "#ff9696", "#4bc3a5", "#b4a5ff", "#1e7869", "#5a3c00",
];
/// Rounds of the palette that differ, and the share of its colours in each beside the one before.
const N_TINTS: i32 = 3;
const TINT_STRENGTH: f64 = 0.75;
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
    let colour = cluster_fill(number);
    let dash = DASHES[number % DASHES.len()];
    (Stroke { colour, width: SERIES_WIDTH, dash }, SHAPES[number % SHAPES.len()])
}

/// The colour of cluster `number` in every panel; after those of the palette it begins anew, in
/// lighter tints.
pub(super) fn cluster_fill(number: usize) -> &'static str {
    static FILLS: LazyLock<Vec<String>> = LazyLock::new(|| {
        let tint = |tint: i32| {
            move |colour: &&str| mixed_with_white(colour, 1.0 - TINT_STRENGTH.powi(tint))
        };
        (0..N_TINTS).flat_map(|k| PALETTE.iter().map(tint(k)).collect::<Vec<_>>()).collect()
    });
    &FILLS[number % FILLS.len()]
}

/// A colour with this share of white in it.
pub(super) fn mixed_with_white(colour: &str, white: f64) -> String {
    let [r, g, b] = channels(colour).map(|c| (c + white * (255.0 - c)).round() as u32);
    format!("#{r:02x}{g:02x}{b:02x}")
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

    /// Lightness and the two opponent axes of B. Ottosson's Oklab (2020).
    fn oklab(hex: &str) -> [f64; 3] {
        let [r, g, b] = channels(hex)
            .map(|c| c / 255.0)
            .map(|c| if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) });
        let l = (0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b).cbrt();
        let m = (0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b).cbrt();
        let s = (0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b).cbrt();
        [
            0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
            1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
            0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s,
        ]
    }

    #[test]
    fn clusters_the_page_and_unclustered_nodes_look_different() {
        // Black and white are 1 apart in Oklab; the tenth of that is seen at a glance.
        let mut shown: Vec<_> = (0..29).map(|k| oklab(cluster_fill(k))).collect();
        shown.extend([oklab("#ffffff"), oklab(UNCLUSTERED)]);
        for (k, a) in shown.iter().enumerate().take(29) {
            for b in &shown[k + 1..] {
                let distance = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
                assert!(distance > 0.11, "cluster {k}: {distance}");
            }
        }
        let fills: HashSet<_> = (0..87).map(cluster_fill).collect();
        assert_eq!(fills.len(), 87, "the palette begins anew in tints");
    }

    #[test]
    fn lines_have_the_colours_of_the_clusters_of_their_numbers() {
        for k in 0..100 {
            assert_eq!(series_style(k).0.colour, cluster_fill(k));
        }
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
