//! Labels with symbols: upright text, italic variables, subscripts and superscripts.
//!
//! A label is built, not parsed (`Label::math("δx").subscript("m").superscript("c")`), so that a node's name
//! may hold any character.

use super::font::{Face, text_width};

/// Size of a subscript or superscript over that of its base.
const SCRIPT_SCALE: f64 = 0.74;
/// Longest run of text, in characters.
const MOST_CHARS: usize = 40;
/// How far a subscript sinks and a superscript rises, over the size of the base.
const SUB_DROP: f64 = 0.22;
const SUP_RISE: f64 = 0.38;

/// A line of text with symbols.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Label {
    runs: Vec<Run>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Run {
    Text(String),
    Math(String),
    Scripts { sub: String, sup: String },
}

/// A stretch of one face, size and baseline.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Piece {
    pub(super) text: String,
    pub(super) face: Face,
    pub(super) size: f64,
    /// Horizontal move before it, from the end of the piece before.
    pub(super) shift: f64,
    /// Height of its baseline over that of the label.
    pub(super) rise: f64,
}

impl Label {
    /// Upright text, as it stands.
    pub fn text(text: impl Into<String>) -> Self {
        Self::default().with_text(text)
    }

    /// Symbols: letters italic, all else upright, hyphens as minus signs.
    pub fn math(symbols: &str) -> Self {
        Self::default().with_math(symbols)
    }

    /// Appends upright text.
    #[must_use]
    pub fn with_text(mut self, text: impl Into<String>) -> Self {
        self.runs.push(Run::Text(shortened(text.into())));
        self
    }

    /// Appends symbols.
    #[must_use]
    pub fn with_math(mut self, symbols: &str) -> Self {
        self.runs.push(Run::Math(shortened(symbols.replace('-', "−"))));
        self
    }

    /// Appends another label.
    #[must_use]
    pub fn with(mut self, other: Self) -> Self {
        self.runs.extend(other.runs);
        self
    }

    /// Appends a subscript, set as symbols; straight after a superscript it stands below it.
    #[must_use]
    pub fn subscript(mut self, symbols: &str) -> Self {
        *self.scripts(|sub, _| sub.is_empty()).0 = shortened(symbols.replace('-', "−"));
        self
    }

    /// Appends a superscript, set as symbols; straight after a subscript it stands above it.
    #[must_use]
    pub fn superscript(mut self, symbols: &str) -> Self {
        *self.scripts(|_, sup| sup.is_empty()).1 = shortened(symbols.replace('-', "−"));
        self
    }

    /// The scripts at the end of the label, new ones where there are none with room.
    fn scripts(&mut self, has_room: fn(&str, &str) -> bool) -> (&mut String, &mut String) {
        let open =
            matches!(self.runs.last(), Some(Run::Scripts { sub, sup }) if has_room(sub, sup));
        if !open {
            self.runs.push(Run::Scripts { sub: String::new(), sup: String::new() });
        }
        match self.runs.last_mut() {
            Some(Run::Scripts { sub, sup }) => (sub, sup),
            _ => unreachable!("the last run was just made or found to be scripts"),
        }
    }

    /// Whether there is nothing to draw.
    pub(super) fn is_empty(&self) -> bool {
        self.pieces(1.0).is_empty()
    }

    /// Width at a font size, in the unit of that size.
    pub(super) fn width(&self, size: f64) -> f64 {
        self.pieces(size).iter().map(|p| p.shift + text_width(&p.text, p.face, p.size)).sum()
    }

    /// The stretches to draw, in order.
    pub(super) fn pieces(&self, size: f64) -> Vec<Piece> {
        let mut pieces = Vec::new();
        for run in &self.runs {
            match run {
                Run::Text(text) => pieces.extend(piece(text.clone(), Face::Regular, size, 0.0)),
                Run::Math(symbols) => pieces.extend(math(symbols, size, 0.0)),
                Run::Scripts { sub, sup } => pieces.extend(scripts(sub, sup, size)),
            }
        }
        pieces
    }
}

/// Names come from files and may have any length: what no reader would finish ends in dots.
fn shortened(mut text: String) -> String {
    if let Some((end, _)) = text.char_indices().nth(MOST_CHARS) {
        text.truncate(end);
        text.push('…');
    }
    text
}

fn piece(text: String, face: Face, size: f64, rise: f64) -> Option<Piece> {
    (!text.is_empty()).then_some(Piece { text, face, size, shift: 0.0, rise })
}

/// Letters italic, all else upright.
fn math(symbols: &str, size: f64, rise: f64) -> Vec<Piece> {
    let mut pieces: Vec<Piece> = Vec::new();
    for symbol in symbols.chars() {
        let face = if symbol.is_alphabetic() { Face::Italic } else { Face::Regular };
        match pieces.last_mut() {
            Some(last) if last.face == face => last.text.push(symbol),
            _ => pieces.extend(piece(symbol.to_string(), face, size, rise)),
        }
    }
    pieces
}

/// The narrower of the two first, then the wider one moved back to the same start, so that what
/// follows stands after the wider.
fn scripts(sub: &str, sup: &str, size: f64) -> Vec<Piece> {
    let width = |pieces: &[Piece]| -> f64 {
        pieces.iter().map(|p| text_width(&p.text, p.face, p.size)).sum()
    };
    let below = math(sub, SCRIPT_SCALE * size, -SUB_DROP * size);
    let above = math(sup, SCRIPT_SCALE * size, SUP_RISE * size);
    let (first, mut second) =
        if width(&above) < width(&below) { (above, below) } else { (below, above) };
    if let Some(start) = second.first_mut() {
        start.shift = -width(&first);
    }
    [first, second].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(label: &Label) -> Vec<String> {
        label.pieces(10.0).into_iter().map(|p| p.text).collect()
    }

    #[test]
    fn letters_are_italic_and_parentheses_upright() {
        let pieces = Label::math("Λ(σ)").pieces(10.0);
        let faces: Vec<_> = pieces.iter().map(|p| (p.text.as_str(), p.face)).collect();
        use Face::{Italic, Regular};
        assert_eq!(faces, [("Λ", Italic), ("(", Regular), ("σ", Italic), (")", Regular)]);
    }

    #[test]
    fn a_superscript_after_a_subscript_stands_above_it() {
        let pieces = Label::math("δx").subscript("m").superscript("c").pieces(10.0);
        let [sup, sub] =
            [1, 2].map(|k| pieces.iter().find(|p| p.text == ["", "c", "m"][k]).unwrap());
        assert!(sub.rise < 0.0 && sup.rise > 0.0);
        assert!((sub.shift + text_width("c", Face::Italic, 7.4)).abs() < 1e-12);
    }

    #[test]
    fn stacked_scripts_are_as_wide_as_the_wider_one() {
        let base = text_width("x", Face::Italic, 10.0);
        let wider = text_width("m", Face::Italic, 7.4);
        for label in [
            Label::math("x").subscript("m").superscript("c"),
            Label::math("x").subscript("c").superscript("m"),
        ] {
            assert!((label.width(10.0) - base - wider).abs() < 1e-12, "{label:?}");
        }
    }

    #[test]
    fn two_subscripts_in_a_row_stand_side_by_side() {
        assert_eq!(texts(&Label::math("v").subscript("k").subscript("i")), ["v", "k", "i"]);
    }

    #[test]
    fn text_is_kept_as_it_stands() {
        assert_eq!(texts(&Label::text("A_1 $ <&>")), ["A_1 $ <&>"]);
        assert!(Label::text("").is_empty());
    }
}
