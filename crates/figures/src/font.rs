//! Widths of text in the bundled faces: Arimo 1.33, regular and italic, whose advance widths are
//! those of Arial and Helvetica, so that one layout is right in a PNG and in any browser.
//!
//! The faces are subsets (Latin, Greek, Cyrillic, common mathematical signs, no hinting) under
//! the SIL Open Font License 1.1; see `fonts/README.md`.

use skrifa::instance::{LocationRef, Size};
use skrifa::{FontRef, MetadataProvider};

const REGULAR: &[u8] = include_bytes!("fonts/Arimo-Regular.ttf");
const ITALIC: &[u8] = include_bytes!("fonts/Arimo-Italic.ttf");

/// What an SVG asks for: all of these have the same advance widths.
pub(super) const FAMILY: &str = "Arimo, Arial, Helvetica, 'Liberation Sans', sans-serif";

/// Height of a capital letter over the font size.
pub(super) const CAP_HEIGHT: f64 = 0.716;

/// One of the two bundled faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Face {
    Regular,
    Italic,
}

impl Face {
    /// The font file.
    pub(super) fn bytes(self) -> &'static [u8] {
        match self {
            Self::Regular => REGULAR,
            Self::Italic => ITALIC,
        }
    }
}

/// Sum of the advance widths, in the unit of `size`; a character that the face lacks counts as
/// the box drawn in its place.
pub(super) fn text_width(text: &str, face: Face, size: f64) -> f64 {
    let font = FontRef::new(face.bytes()).expect("the bundled font is whole");
    let charmap = font.charmap();
    let metrics = font.glyph_metrics(Size::new(1.0), LocationRef::default());
    let advance = |c| metrics.advance_width(charmap.map(c).unwrap_or_default()).unwrap_or(0.0);
    size * text.chars().map(|c| f64::from(advance(c))).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_all_as_wide_as_in_helvetica() {
        // Helvetica's metrics file gives 556/1000 em to each digit and 278/1000 to the full stop.
        for digit in '0'..='9' {
            let width = text_width(&digit.to_string(), Face::Regular, 1.0);
            assert!((width - 0.556).abs() < 1e-3, "{digit}: {width}");
        }
        assert!((text_width(".", Face::Regular, 10.0) - 2.78).abs() < 1e-2);
    }

    #[test]
    fn every_symbol_of_the_theory_is_in_both_faces() {
        for face in [Face::Regular, Face::Italic] {
            let charmap = FontRef::new(face.bytes()).unwrap().charmap();
            for symbol in "εδλΛσΓπ−×±≤ü–".chars() {
                assert!(charmap.map(symbol).is_some(), "{face:?} lacks {symbol}");
            }
        }
    }
}
