//! How our own SVG is read again, to become pixels or a page: with the bundled faces only, the same on
//! machines without any fonts.

use std::sync::Arc;

use resvg::usvg::{Options, fontdb};

use super::font::Face;

/// Options of the reader.
pub(super) fn options() -> Options<'static> {
    let mut options = Options::default();
    for face in [Face::Regular, Face::Italic] {
        options.fontdb_mut().load_font_source(fontdb::Source::Binary(Arc::new(face.bytes())));
    }
    options
}
