//! From SVG to PNG, with the bundled faces only: the same pixels on machines without any fonts.

use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::Tree;

use super::error::FigureError;
use super::reader::options;

/// Draws an SVG of ours at a resolution in dots per inch, as the bytes of an opaque PNG that
/// states its resolution.
///
/// # Errors
/// [`FigureError::Svg`] for a text that is no SVG; [`FigureError::BadPixels`] for a picture
/// without pixels or too large for memory.
pub fn png(svg: &str, dots_per_inch: f64) -> Result<Vec<u8>, FigureError> {
    let tree = Tree::from_str(svg, &options())?;
    // User units of SVG are 1/96 inch.
    let factor = (dots_per_inch / 96.0) as f32;
    let size = tree.size();
    let [width, height] = [size.width(), size.height()].map(|s| (s * factor).round() as u32);
    let mut pixels = Pixmap::new(width, height).ok_or(FigureError::BadPixels { width, height })?;
    pixels.fill(Color::WHITE);
    resvg::render(&tree, Transform::from_scale(factor, factor), &mut pixels.as_mut());
    encode(&pixels, dots_per_inch)
}

fn encode(pixels: &Pixmap, dots_per_inch: f64) -> Result<Vec<u8>, FigureError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, pixels.width(), pixels.height());
    encoder.set_color(png::ColorType::Rgb);
    let per_metre = (dots_per_inch / 0.0254).round() as u32;
    encoder.set_pixel_dims(Some(png::PixelDimensions {
        xppu: per_metre,
        yppu: per_metre,
        unit: png::Unit::Meter,
    }));
    // The page is opaque, so that premultiplied colours are the colours themselves.
    let rgb: Vec<u8> = pixels.data().chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    encoder.write_header()?.write_image_data(&rgb)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::{Anchor, Canvas};
    use crate::label::Label;

    fn decoded(bytes: &[u8]) -> (png::OutputInfo, Vec<u8>) {
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        (reader.next_frame(&mut pixels).unwrap(), pixels)
    }

    #[test]
    fn an_inch_at_300_dots_has_300_pixels() {
        let (info, _) = decoded(&png(&Canvas::new(72.0, 36.0, "").finish(), 300.0).unwrap());
        assert_eq!((info.width, info.height), (300, 150));
    }

    #[test]
    fn text_is_drawn_with_the_bundled_faces() {
        // Ink in the box of a capital letter: none would mean that no font was found.
        for label in [Label::text("H"), Label::math("Λ")] {
            let mut canvas = Canvas::new(20.0, 20.0, "");
            canvas.label(&label, [5.0, 15.0], 12.0, Anchor::Start);
            let (info, pixels) = decoded(&png(&canvas.finish(), 72.0).unwrap());
            let dark = pixels.chunks(3).filter(|p| p[0] < 128).count();
            assert!(
                dark > 8 && dark < (info.width * info.height / 2) as usize,
                "{label:?}: {dark}"
            );
        }
    }

    #[test]
    fn no_pixels_and_no_svg_are_errors() {
        let svg = Canvas::new(72.0, 36.0, "").finish();
        assert!(matches!(png(&svg, 0.1), Err(FigureError::BadPixels { width: 0, height: 0 })));
        assert!(matches!(png("<a/>", 72.0), Err(FigureError::Svg(_))));
    }
}
