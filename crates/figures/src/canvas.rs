//! The page: an SVG document written element by element, in points of 1/72 inch from the upper
//! left corner, with coordinates to 1/100 point so that equal data give equal bytes.

use std::fmt;

use base64::Engine;
use xmlwriter::{Indent, Options, XmlWriter};

use super::font::{FAMILY, Face};
use super::label::Label;
use super::style::{INK, Shape, Stroke};

/// A place on the page: x to the right, y down.
pub(super) type Point = [f64; 2];

/// A rectangle on the page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rect {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

impl Rect {
    pub(super) fn width(&self) -> f64 {
        self.right - self.left
    }

    pub(super) fn height(&self) -> f64 {
        self.bottom - self.top
    }

    /// Whether a point lies inside or on the edge.
    pub(super) fn contains(&self, [x, y]: Point) -> bool {
        (self.left..=self.right).contains(&x) && (self.top..=self.bottom).contains(&y)
    }

    /// The rectangle with every side moved outwards.
    pub(super) fn grown(&self, by: f64) -> Self {
        Self {
            left: self.left - by,
            top: self.top - by,
            right: self.right + by,
            bottom: self.bottom + by,
        }
    }
}

/// Which part of a label stands at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// An SVG document being written.
pub(super) struct Canvas {
    xml: XmlWriter,
    n_clips: usize,
}

impl Canvas {
    /// An empty white page.
    pub(super) fn new(width: f64, height: f64, title: &str) -> Self {
        let options = Options { indent: Indent::Spaces(0), ..Options::default() };
        let mut canvas = Self { xml: XmlWriter::new(options), n_clips: 0 };
        canvas.xml.start_element("svg");
        canvas.attribute("xmlns", "http://www.w3.org/2000/svg");
        canvas.attribute("width", format_args!("{width:.2}pt"));
        canvas.attribute("height", format_args!("{height:.2}pt"));
        canvas.attribute("viewBox", format_args!("0 0 {width:.2} {height:.2}"));
        canvas.attribute("font-family", FAMILY);
        canvas.xml.start_element("title");
        canvas.text(title);
        canvas.xml.end_element();
        canvas.xml.set_preserve_whitespaces(false);
        canvas.rect(Rect { left: 0.0, top: 0.0, right: width, bottom: height }, "#ffffff");
        canvas
    }

    /// The document.
    pub(super) fn finish(self) -> String {
        self.xml.end_document()
    }

    /// Lines through the points.
    pub(super) fn polyline(&mut self, points: &[Point], stroke: Stroke) {
        self.xml.start_element("polyline");
        self.points(points);
        self.attribute("fill", "none");
        self.stroke(stroke);
        self.attribute("stroke-linejoin", "round");
        self.xml.end_element();
    }

    /// A line between two points.
    pub(super) fn line(&mut self, from: Point, to: Point, stroke: Stroke) {
        self.xml.start_element("line");
        for (name, value) in [("x1", from[0]), ("y1", from[1]), ("x2", to[0]), ("y2", to[1])] {
            self.number(name, value);
        }
        self.stroke(stroke);
        self.xml.end_element();
    }

    /// A filled area without an outline.
    pub(super) fn area(&mut self, corners: &[Point], fill: &str, opacity: f64) {
        self.xml.start_element("polygon");
        self.points(corners);
        self.attribute("fill", fill);
        self.number("fill-opacity", opacity);
        self.xml.end_element();
    }

    /// A filled rectangle.
    pub(super) fn rect(&mut self, rect: Rect, fill: &str) {
        self.xml.start_element("rect");
        self.sides(rect);
        self.attribute("fill", fill);
        self.xml.end_element();
    }

    /// The outline of a rectangle.
    pub(super) fn frame(&mut self, rect: Rect, stroke: Stroke) {
        self.xml.start_element("rect");
        self.sides(rect);
        self.attribute("fill", "none");
        self.stroke(stroke);
        self.xml.end_element();
    }

    /// A filled circle with an outline.
    pub(super) fn circle(&mut self, centre: Point, radius: f64, fill: &str, stroke: Stroke) {
        self.xml.start_element("circle");
        for (name, value) in [("cx", centre[0]), ("cy", centre[1]), ("r", radius)] {
            self.number(name, value);
        }
        self.attribute("fill", fill);
        self.stroke(stroke);
        self.xml.end_element();
    }

    /// A small filled mark with an outline.
    pub(super) fn mark(&mut self, shape: Shape, at: Point, radius: f64, fill: &str, ink: Stroke) {
        if shape == Shape::Circle {
            return self.circle(at, radius, fill, ink);
        }
        self.xml.start_element("polygon");
        self.points(&shape.corners(at, radius));
        self.attribute("fill", fill);
        self.stroke(ink);
        self.xml.end_element();
    }

    /// Many marks of one kind, as one element.
    pub(super) fn marks(&mut self, shape: Shape, at: &[Point], radius: f64, fill: &str) {
        if shape == Shape::Circle {
            return self.dots(at, radius, fill);
        }
        let mut path = String::new();
        for &at in at {
            for (k, [x, y]) in shape.corners(at, radius).into_iter().enumerate() {
                path += &format!("{}{x:.2} {y:.2}", if k == 0 { 'M' } else { 'L' });
            }
            path.push('Z');
        }
        self.xml.start_element("path");
        self.attribute("d", path);
        self.attribute("fill", fill);
        self.xml.end_element();
    }

    /// Many discs of one colour as one element: the round ends of lines too short to see.
    pub(super) fn dots(&mut self, at: &[Point], radius: f64, fill: &str) {
        let path: String = at.iter().map(|[x, y]| format!("M{x:.2} {y:.2}h.01")).collect();
        self.xml.start_element("path");
        self.attribute("d", path);
        self.attribute("stroke", fill);
        self.number("stroke-width", 2.0 * radius);
        self.attribute("stroke-linecap", "round");
        self.xml.end_element();
    }

    /// Many lines as one element, to 1/10 point since there are many. Where they cross they
    /// darken no further.
    pub(super) fn segments(&mut self, ends: &[[Point; 2]], stroke: Stroke, opacity: f64) {
        let segment =
            |[[x, y], [to_x, to_y]]: &[Point; 2]| format!("M{x:.1} {y:.1}L{to_x:.1} {to_y:.1}");
        self.xml.start_element("path");
        self.attribute("d", ends.iter().map(segment).collect::<String>());
        self.stroke(stroke);
        if opacity < 1.0 {
            self.number("stroke-opacity", opacity);
        }
        self.xml.end_element();
    }

    /// A picture, the bytes of a PNG, over a rectangle: its pixels with sharp edges, or blended
    /// where they are finer than those of the reader.
    pub(super) fn picture(&mut self, png: &[u8], rect: Rect, is_sharp: bool) {
        let data = base64::engine::general_purpose::STANDARD.encode(png);
        self.xml.start_element("image");
        // The older name of the attribute is the one that every reader of SVG knows.
        self.attribute("xmlns:xlink", "http://www.w3.org/1999/xlink");
        self.sides(rect);
        self.attribute("preserveAspectRatio", "none");
        if is_sharp {
            // The name in SVG 1.1, and the one in CSS that browsers follow.
            self.attribute("image-rendering", "optimizeSpeed");
            self.attribute("style", "image-rendering:pixelated");
        }
        self.attribute("xlink:href", format_args!("data:image/png;base64,{data}"));
        self.xml.end_element();
    }

    /// A label whose baseline passes through `at`.
    pub(super) fn label(&mut self, label: &Label, at: Point, size: f64, anchor: Anchor) {
        self.write_label(label, at, size, anchor, INK, false);
    }

    /// A label in a colour of its own.
    pub(super) fn label_in(&mut self, label: &Label, at: Point, size: f64, ink: &str) {
        self.write_label(label, at, size, Anchor::Middle, ink, false);
    }

    /// A label read from below upwards, its middle at `at`.
    pub(super) fn label_upwards(&mut self, label: &Label, at: Point, size: f64) {
        self.write_label(label, at, size, Anchor::Middle, INK, true);
    }

    /// Draws with everything outside `rect` cut away.
    pub(super) fn clipped(&mut self, rect: Rect, draw: impl FnOnce(&mut Self)) {
        self.n_clips += 1;
        let id = format!("clip{}", self.n_clips);
        self.xml.start_element("clipPath");
        self.attribute("id", &id);
        self.xml.start_element("rect");
        self.sides(rect);
        self.xml.end_element();
        self.xml.end_element();
        self.xml.start_element("g");
        self.attribute("clip-path", format_args!("url(#{id})"));
        draw(self);
        self.xml.end_element();
    }

    // A label of one piece leaves its alignment to the reader; one of several starts where our
    // own measure says, since readers differ in what they count as the width of shifted pieces.
    fn write_label(
        &mut self,
        label: &Label,
        [x, y]: Point,
        size: f64,
        anchor: Anchor,
        ink: &str,
        upwards: bool,
    ) {
        if label.is_empty() {
            return;
        }
        let pieces = label.pieces(size);
        let (name, before) = match anchor {
            Anchor::Start => ("start", 0.0),
            Anchor::Middle => ("middle", 0.5),
            Anchor::End => ("end", 1.0),
        };
        let one_piece = pieces.len() < 2;
        let start = if one_piece { x } else { x - before * label.width(size) };
        self.xml.start_element("text");
        self.number("x", start);
        self.number("y", y);
        self.attribute("text-anchor", if one_piece { name } else { "start" });
        self.attribute("fill", ink);
        if upwards {
            self.attribute("transform", format_args!("rotate(-90 {x:.2} {y:.2})"));
        }
        self.xml.set_preserve_whitespaces(true);
        let mut rise = 0.0;
        for piece in pieces {
            self.xml.start_element("tspan");
            self.number("font-size", piece.size);
            if piece.face == Face::Italic {
                self.attribute("font-style", "italic");
            }
            if piece.shift != 0.0 {
                self.number("dx", piece.shift);
            }
            if piece.rise != rise {
                self.number("dy", rise - piece.rise);
            }
            rise = piece.rise;
            self.text(&piece.text);
            self.xml.end_element();
        }
        self.xml.end_element();
        self.xml.set_preserve_whitespaces(false);
    }

    fn sides(&mut self, rect: Rect) {
        self.number("x", rect.left);
        self.number("y", rect.top);
        self.number("width", rect.width());
        self.number("height", rect.height());
    }

    fn points(&mut self, points: &[Point]) {
        let text: Vec<_> = points.iter().map(|[x, y]| format!("{x:.2},{y:.2}")).collect();
        self.attribute("points", text.join(" "));
    }

    fn stroke(&mut self, stroke: Stroke) {
        self.attribute("stroke", stroke.colour);
        self.number("stroke-width", stroke.width);
        if !stroke.dash.is_empty() {
            self.attribute("stroke-dasharray", stroke.dash);
        }
    }

    fn number(&mut self, name: &str, value: f64) {
        self.attribute(name, format_args!("{value:.2}"));
    }

    fn attribute(&mut self, name: &str, value: impl fmt::Display) {
        self.xml.write_attribute(name, &value);
    }

    // The writer escapes `<` only, and XML has no place for most control characters, nor for two more.
    // Characters that turn the direction of the text after them would make it read as something else.
    fn text(&mut self, text: &str) {
        let turns = |c: char| matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        let is_shown =
            |c: char| !c.is_control() && !turns(c) && !matches!(c, '\u{fffe}' | '\u{ffff}');
        let shown: String =
            text.chars().map(|c| if is_shown(c) { c } else { '\u{fffd}' }).collect();
        self.xml.set_preserve_whitespaces(true);
        self.xml.write_text(&shown.replace('&', "&amp;").replace('>', "&gt;"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use resvg::usvg::roxmltree::Document;

    #[test]
    fn any_text_survives_the_trip_through_xml() {
        let hostile = "a<b>&amp; \"c\" 'd' ]]> é δ";
        let mut canvas = Canvas::new(100.0, 50.0, hostile);
        canvas.label(&Label::text(hostile), [1.0, 2.0], 8.0, Anchor::Start);
        let svg = canvas.finish();
        let document = Document::parse(&svg).unwrap();
        let found = |tag| {
            document.descendants().find(|n| n.has_tag_name(tag)).and_then(|n| n.text()).unwrap()
        };
        assert_eq!(found("title"), hostile);
        assert_eq!(found("tspan"), hostile);
    }

    #[test]
    fn control_characters_become_replacement_characters() {
        let mut canvas = Canvas::new(10.0, 10.0, "");
        canvas.label(&Label::text("a\u{1}\tb\u{202e}\u{ffff}c"), [1.0, 2.0], 8.0, Anchor::Start);
        let svg = canvas.finish();
        assert!(svg.contains("a\u{fffd}\u{fffd}b\u{fffd}\u{fffd}c"));
        assert!(Document::parse(&svg).is_ok());
    }

    #[test]
    fn baseline_returns_after_a_subscript() {
        let mut canvas = Canvas::new(10.0, 10.0, "");
        let label = Label::math("δx").subscript("i").with_text(" end");
        canvas.label(&label, [1.0, 2.0], 10.0, Anchor::Start);
        let svg = canvas.finish();
        let moves: Vec<f64> = Document::parse(&svg)
            .unwrap()
            .descendants()
            .filter_map(|n| n.attribute("dy").map(|dy| dy.parse::<f64>().unwrap()))
            .collect();
        assert_eq!(moves.len(), 2);
        assert_eq!(moves.iter().sum::<f64>(), 0.0);
        assert!(moves[0] > 0.0);
    }
}
