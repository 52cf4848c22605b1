//! From SVG to PDF, as vectors and with text as text, in the bundled faces only.

use krilla::geom::Size;
use krilla::page::PageSettings;
use krilla::{Document, SerializeSettings};
use krilla_svg::{SurfaceExt, SvgSettings};
use resvg::usvg::Tree;

use super::error::FigureError;
use super::reader::options;

/// Points over the user unit of SVG, which is 1/96 inch.
const POINTS_PER_UNIT: f32 = 0.75;

/// An SVG of ours as the bytes of a PDF of one page; the same text always gives the same bytes.
///
/// # Errors
/// [`FigureError::Pdf`] for a text that is no SVG, or that cannot be written.
pub fn pdf(svg: &str) -> Result<Vec<u8>, FigureError> {
    let failed = |reason: String| FigureError::Pdf { reason };
    let tree = Tree::from_str(svg, &options()).map_err(|error| failed(error.to_string()))?;
    let [width, height] = [tree.size().width(), tree.size().height()].map(|s| s * POINTS_PER_UNIT);
    let no_size = || failed(format!("{width} pt × {height} pt is no size of a page"));
    // No date of making, which would differ from run to run.
    let settings = SerializeSettings { xmp_metadata: false, ..SerializeSettings::default() };
    let mut document = Document::new_with(settings);
    let page = PageSettings::from_wh(width, height).ok_or_else(no_size)?;
    let mut page = document.start_page_with(page);
    let mut surface = page.surface();
    let size = Size::from_wh(width, height).ok_or_else(no_size)?;
    surface.draw_svg(&tree, size, SvgSettings::default()).ok_or_else(no_size)?;
    surface.finish();
    page.finish();
    document.finish().map_err(|error| failed(format!("{error:?}")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::{Anchor, Canvas};
    use crate::label::Label;

    fn labelled(text: &str) -> Vec<u8> {
        let mut canvas = Canvas::new(72.0, 36.0, "");
        let label = Label::text(text).with_math("ε");
        canvas.label(&label, [5.0, 20.0], 12.0, Anchor::Start);
        pdf(&canvas.finish()).unwrap()
    }

    fn holds(bytes: &[u8], text: &str) -> bool {
        bytes.windows(text.len()).any(|window| window == text.as_bytes())
    }

    #[test]
    fn a_page_has_its_size_in_points_and_its_text_as_text() {
        let bytes = labelled("nodes");
        assert!(bytes.starts_with(b"%PDF-"));
        assert!(holds(&bytes, "/MediaBox[0 0 72 36]"));
        // A font with a table from its glyphs to characters, once for each face.
        let text = String::from_utf8_lossy(&bytes);
        assert_eq!(text.matches("/ToUnicode").count(), 2);
    }

    #[test]
    fn equal_figures_give_equal_bytes() {
        assert_eq!(labelled("nodes"), labelled("nodes"));
        assert_ne!(labelled("nodes"), labelled("edges"));
    }

    #[test]
    fn no_svg_is_an_error() {
        assert!(matches!(pdf("<a/>"), Err(FigureError::Pdf { .. })));
    }
}
