//! Heat map: a square matrix over pairs of nodes in colours, node 1 in the upper left corner, with
//! a colour bar, and groups of nodes set apart by thin lines.
//!
//! The matrix is one picture. At 300 dots per inch, the usual resolution of a PNG in print, every
//! cell is a whole number of dots wide where that costs little of the size.

mod axes;

use self::axes::{LABEL_GAP, NodeAxes, TICK_LENGTH};
use super::axis::{self, Axis, Scale, Tick};
use super::canvas::{Anchor, Canvas, Point, Rect};
use super::colour_map::{Picture, block_means};
use super::drawable::Drawable;
use super::error::FigureError;
use super::font::CAP_HEIGHT;
use super::groups::{self, Group};
use super::label::Label;
use super::style::{
    AXIS_WIDTH, HEADER, INK, LABEL_SIZE, NOTE_SIZE, Stroke, TICK_SIZE, UNCLUSTERED,
};
use super::title;

/// A dot of a PNG at 300 dots per inch, in points.
const DOT: f64 = 0.24;
/// Share of its size that a matrix may lose for cells of whole dots.
const SNAP_LOSS: f64 = 0.13;
/// Pixels along the side of an embedded picture, at least: readers that blend pixels in spite of
/// what the file says then blur the edges of cells only.
const LEAST_PIXELS: usize = 600;
/// Distances of the colour bar from the matrix and from its numbers, and its width.
const BAR_GAP: f64 = 6.0;
const BAR_WIDTH: f64 = 7.0;
const NUMBER_GAP: f64 = 2.5;
/// Least distance between numbers along the bar.
const VALUE_SPACING: f64 = 16.0;

/// A square matrix in colours.
#[derive(Clone, Debug, Default)]
pub struct HeatMapPanel {
    /// Stands above the matrix, such as ε = 7.6; may be empty.
    pub title: Label,
    /// Number of rows, N.
    pub n_nodes: usize,
    /// The matrix row by row, shape (N, N). Cells that are not finite are grey.
    pub values: Vec<f64>,
    /// Values at the two ends of the colours, beyond which colours stay the same; none for the
    /// smallest and the largest finite value.
    pub range: Option<[f64; 2]>,
    /// Stands above the colour bar, such as δe_ij.
    pub bar_label: Label,
    /// Stands in a matrix without a single finite value, such as "all runs escaped".
    pub without_values: Label,
    /// Groups of nodes. Their names stand along both axes where there is room; node numbers do
    /// where no group has a name.
    pub groups: Vec<Group>,
}

/// Where the parts stand.
struct Places {
    matrix: Rect,
    bar: Rect,
}

impl Drawable for HeatMapPanel {
    /// Draws the matrix as large as the cell allows, below its title.
    fn draw(
        &self,
        canvas: &mut Canvas,
        cell: Rect,
        _left_margin: f64,
        panel: &str,
    ) -> Result<(), FigureError> {
        self.check(panel)?;
        let range = self.value_range(panel)?;
        let Places { matrix, bar } = self.places(cell, range.unwrap_or([0.0, 1.0]), panel)?;
        self.draw_matrix(canvas, matrix, range)?;
        self.axes().draw(canvas, matrix);
        // What has no values needs no colours to read them by.
        match range {
            Some(range) => self.draw_bar(canvas, bar, range)?,
            None => {
                let at = [matrix.left, matrix.top].map(|start| start + matrix.width() / 2.0);
                canvas.label(&self.without_values, at, NOTE_SIZE, Anchor::Middle);
            }
        }
        let middle = (matrix.left + matrix.right) / 2.0;
        let mut right = cell.right;
        if range.is_some() {
            right = bar.left;
            let at = [bar.left, title::baseline(cell)];
            canvas.label(&self.bar_label, at, LABEL_SIZE, Anchor::Start);
        }
        title::draw(canvas, &self.title, middle, (cell, right), panel);
        Ok(())
    }
}

impl HeatMapPanel {
    fn check(&self, panel: &str) -> Result<(), FigureError> {
        let (n_nodes, n_values) = (self.n_nodes, self.values.len());
        if n_nodes == 0 {
            return Err(FigureError::Empty { panel: panel.into(), what: "nodes" });
        }
        if n_nodes.checked_mul(n_nodes) != Some(n_values) {
            return Err(FigureError::NotSquare { panel: panel.into(), n_nodes, n_values });
        }
        groups::check(&self.groups, n_nodes, panel)
    }

    /// Values at the ends of the colours, none where no value is finite. Values that are all the
    /// same have the darkest colour.
    fn value_range(&self, panel: &str) -> Result<Option<[f64; 2]>, FigureError> {
        let values = self.values.iter().copied();
        let least = values.clone().filter(|v| v.is_finite()).fold(f64::INFINITY, f64::min);
        if least == f64::INFINITY {
            return Ok(None);
        }
        let range = axis::range(values, self.range, Scale::Linear, 0.0, panel)?;
        let from = |from: f64| if self.range.is_none() { from.max(least) } else { from };
        Ok(range.map(|[low, to]| [from(low), to]))
    }

    /// A square matrix, and a bar as high as it at its right.
    fn places(&self, cell: Rect, range: [f64; 2], panel: &str) -> Result<Places, FigureError> {
        let [left, right] = self.margins(cell, range);
        let below = LABEL_GAP + CAP_HEIGHT * TICK_SIZE + 2.0;
        let (width, height) = (cell.width() - left - right, cell.height() - HEADER - below);
        if width.min(height) < 30.0 {
            return Err(FigureError::TooSmall { panel: panel.into(), width, height });
        }
        let side = snapped_side(width.min(height), self.n_nodes);
        let whole_dots = |x: f64| (x / DOT).round() * DOT;
        let start = whole_dots(cell.left + left + (width - side) / 2.0);
        let top = whole_dots(cell.top + HEADER);
        let matrix = Rect { left: start, top, right: start + side, bottom: top + side };
        let bar_left = matrix.right + BAR_GAP;
        let bar = Rect { left: bar_left, right: bar_left + BAR_WIDTH, ..matrix };
        Ok(Places { matrix, bar })
    }

    /// Room at the left for labels, and at the right for the bar and its numbers.
    fn margins(&self, cell: Rect, range: [f64; 2]) -> [f64; 2] {
        let widest = |labels: Vec<Label>| {
            labels.iter().map(|label| label.width(TICK_SIZE)).fold(0.0, f64::max)
        };
        let nodes = self.axes().labels([cell.top, cell.bottom]).into_iter().map(|(_, label)| label);
        let ticks = value_axis(range, [cell.bottom, cell.top]).ticks(VALUE_SPACING);
        // Room for two decimals even where there are none keeps the matrices of a column flush.
        let mut numbers = vec![Label::text("0.00")];
        numbers.extend(ticks.into_iter().filter_map(|tick| tick.label));
        let bar = BAR_WIDTH + NUMBER_GAP + widest(numbers);
        [LABEL_GAP + widest(nodes.collect()), BAR_GAP + bar.max(self.bar_label.width(LABEL_SIZE))]
    }

    fn draw_matrix(
        &self,
        canvas: &mut Canvas,
        matrix: Rect,
        range: Option<[f64; 2]>,
    ) -> Result<(), FigureError> {
        let Some(range) = range else {
            canvas.rect(matrix, UNCLUSTERED);
            canvas.frame(matrix, Stroke::solid(INK, AXIS_WIDTH));
            return Ok(());
        };
        let dots = matrix.width() / DOT;
        // Cells finer than half a dot are drawn by their means: nobody could tell them apart.
        let by = (self.n_nodes as f64 / (2.0 * dots)).ceil().max(1.0) as usize;
        let picture = if by > 1 {
            let (n, means) = block_means(&self.values, self.n_nodes, by);
            Picture::new([n, n], &means, range)
        } else {
            let n = self.n_nodes;
            Picture::new([n, n], &self.values, range).magnified(LEAST_PIXELS.div_ceil(n))
        };
        canvas.picture(&picture.png()?, matrix, (self.n_nodes as f64) < dots);
        let white = Stroke::solid("#ffffff", AXIS_WIDTH);
        for node in groups::boundaries(&self.groups, self.n_nodes) {
            let share = node as f64 / self.n_nodes as f64;
            let [x, y] = [matrix.left, matrix.top].map(|start| start + share * matrix.width());
            canvas.line([x, matrix.top], [x, matrix.bottom], white);
            canvas.line([matrix.left, y], [matrix.right, y], white);
        }
        canvas.frame(matrix, Stroke::solid(INK, AXIS_WIDTH));
        Ok(())
    }

    fn axes(&self) -> NodeAxes<'_> {
        NodeAxes { groups: &self.groups, n_nodes: self.n_nodes }
    }

    fn draw_bar(
        &self,
        canvas: &mut Canvas,
        bar: Rect,
        [from, to]: [f64; 2],
    ) -> Result<(), FigureError> {
        let n = 256;
        let value = |k: i32| to - f64::from(k) / f64::from(n - 1) * (to - from);
        let values: Vec<f64> = (0..n).map(value).collect();
        let picture = Picture::new([1, values.len()], &values, [from, to]);
        canvas.picture(&picture.png()?, bar, false);
        let ink = Stroke::solid(INK, AXIS_WIDTH);
        canvas.frame(bar, ink);
        for Tick { at, label } in value_axis([from, to], [bar.bottom, bar.top]).ticks(VALUE_SPACING)
        {
            let Some(label) = label else { continue };
            canvas.line([bar.right - TICK_LENGTH, at], [bar.right, at], ink);
            let start: Point = [bar.right + NUMBER_GAP, at + CAP_HEIGHT * TICK_SIZE / 2.0];
            canvas.label(&label, start, TICK_SIZE, Anchor::Start);
        }
        Ok(())
    }
}

fn value_axis(range: [f64; 2], ends: [f64; 2]) -> Axis {
    Axis::new(Scale::Linear, range, ends)
}

/// The largest side, in points, of a matrix of n rows that fits into `room` and has cells of a
/// whole number of dots; all the room where that would waste too much of it.
fn snapped_side(room: f64, n: usize) -> f64 {
    let row = n as f64 * DOT;
    let snapped = (room / row).floor() * row;
    if snapped >= (1.0 - SNAP_LOSS) * room { snapped } else { (room / DOT).floor() * DOT }
}

#[cfg(test)]
mod tests {
    use super::*;
    use resvg::usvg::roxmltree::Document;

    const CELL: Rect = Rect { left: 2.0, top: 2.0, right: 162.0, bottom: 152.0 };

    /// |i − j| over n nodes.
    fn distances(n: usize) -> HeatMapPanel {
        let values =
            (0..n).flat_map(|i| (0..n).map(move |j| (i as f64 - j as f64).abs())).collect();
        let bar_label = Label::math("δe").subscript("ij");
        HeatMapPanel { n_nodes: n, values, bar_label, ..HeatMapPanel::default() }
    }

    fn group(name: &str, nodes: std::ops::Range<usize>) -> Group {
        Group { label: Label::text(name), nodes }
    }

    fn svg_of(panel: &HeatMapPanel) -> Result<String, FigureError> {
        let mut canvas = Canvas::new(164.0, 154.0, "");
        panel.draw(&mut canvas, CELL, 0.0, "(b1)").map(|()| canvas.finish())
    }

    /// Colours at the middles of cells of the rendered matrix, and the whole dots of one cell.
    fn rendered(panel: &HeatMapPanel, cells: &[(usize, usize)]) -> (Vec<[u8; 3]>, f64) {
        let svg = svg_of(panel).unwrap();
        let document = Document::parse(&svg).unwrap();
        let image = document.descendants().find(|n| n.has_tag_name("image")).unwrap();
        let [left, top, side] =
            ["x", "y", "width"].map(|name| image.attribute(name).unwrap().parse::<f64>().unwrap());
        let bytes = crate::png(&svg, 300.0).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        let dots = side / DOT / panel.n_nodes as f64;
        let at = |start: f64, k: usize| (start / DOT + (k as f64 + 0.5) * dots) as usize;
        let colour = |&(i, j): &(usize, usize)| {
            let pixel = 3 * (at(top, i) * info.width as usize + at(left, j));
            [pixels[pixel], pixels[pixel + 1], pixels[pixel + 2]]
        };
        (cells.iter().map(colour).collect(), dots)
    }

    #[test]
    fn row_one_is_at_the_top_and_cells_have_the_colours_of_their_values() {
        let mut panel = distances(10);
        panel.values.fill(0.0);
        (panel.values[9], panel.values[90]) = (1.0, f64::NAN);
        let (colours, dots) = rendered(&panel, &[(0, 0), (0, 9), (9, 0), (5, 5)]);
        let [dark, light, grey] = [[0x44, 0x01, 0x54], [0xfe, 0xe7, 0x25], [0xd3; 3]];
        for (found, expected) in colours.iter().zip([dark, light, grey, dark]) {
            let worst = found.iter().zip(expected).map(|(a, b)| a.abs_diff(b)).max();
            assert!(worst <= Some(2), "{colours:?}");
        }
        assert!((dots - dots.round()).abs() < 1e-6, "a cell is {dots} dots wide");
    }

    #[test]
    fn cells_are_whole_dots_wide_only_where_that_costs_little() {
        assert!((snapped_side(110.0, 90) - 108.0).abs() < 1e-9);
        // Two dots a cell would leave 86.4 points, three need 129.6.
        assert!((snapped_side(120.0, 180) - 120.0).abs() < DOT);
        assert!(snapped_side(100.0, 2000) > 99.0);
    }

    #[test]
    fn names_of_groups_stand_along_both_axes_and_numbers_only_without_them() {
        let mut panel = distances(90);
        let numbered = svg_of(&panel).unwrap();
        panel.groups = vec![group("west", 0..30), group("no room", 30..32), group("east", 32..90)];
        let named = svg_of(&panel).unwrap();
        assert_eq!(named.matches(">west<").count(), 2);
        assert_eq!(named.matches(">east<").count(), 2);
        assert!(!named.contains(">no room<"));
        // The colour bar ends at 89 and so has an 80, too.
        assert_eq!(numbered.matches(">80<").count(), named.matches(">80<").count() + 2);
    }

    #[test]
    fn the_range_asked_for_holds_whatever_the_values() {
        let mut panel = distances(4);
        assert_eq!(panel.value_range("(b1)").unwrap(), Some([0.0, 3.0]));
        panel.range = Some([-1.0, 0.5]);
        assert_eq!(panel.value_range("(b1)").unwrap(), Some([-1.0, 0.5]));
        assert!(svg_of(&panel).is_ok());
        panel.range = Some([1.0, 1.0]);
        assert!(matches!(svg_of(&panel), Err(FigureError::BadRange { .. })));
    }

    #[test]
    fn equal_values_are_drawn_with_the_darkest_colour() {
        for value in [0.0, 7.0, -2.0] {
            let mut panel = distances(5);
            panel.values.fill(value);
            assert_eq!(panel.value_range("(b1)").unwrap().unwrap()[0], value);
            assert_eq!(rendered(&panel, &[(2, 2)]).0, rendered(&distances(5), &[(2, 2)]).0);
        }
    }

    #[test]
    fn two_thousand_nodes_stay_below_a_megabyte() {
        let n = 2000;
        let panel = HeatMapPanel {
            // Scrambled bits, the worst case for compression.
            values: (0..n * n)
                .map(|k: usize| (k.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40) as f64)
                .collect(),
            ..distances(n)
        };
        let svg = svg_of(&panel).unwrap();
        assert!(svg.len() < 1_000_000, "{} bytes", svg.len());
    }

    #[test]
    fn a_matrix_without_values_says_why_and_has_no_colours() {
        let mut panel = distances(3);
        panel.values.fill(f64::NAN);
        panel.without_values = Label::text("all runs escaped");
        let svg = svg_of(&panel).unwrap();
        assert!(svg.contains(">all runs escaped<") && !svg.contains("<image"), "{svg}");
    }

    #[test]
    fn matrices_that_cannot_be_drawn_are_refused() {
        let refused = |panel: HeatMapPanel| svg_of(&panel).unwrap_err().to_string();
        assert_eq!(refused(HeatMapPanel::default()), "panel (b1) has no nodes");
        let mut panel = distances(3);
        panel.values.pop();
        assert_eq!(refused(panel), "panel (b1): 8 values make no matrix of 3 × 3");
        let panel = HeatMapPanel { groups: vec![group("a", 1..4)], ..distances(3) };
        assert!(matches!(svg_of(&panel), Err(FigureError::BadGroup { from: 1, to: 4, .. })));
    }
}
