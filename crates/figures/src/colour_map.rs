//! Values as colours, and pictures made of them.
//!
//! The colours are viridis (S. van der Walt & N. Smith, 2015, dedicated to the public domain),
//! dark for small values and light for large ones: equal steps look equal, in grey prints and
//! with every common form of colour vision too. `colorous` has the table.

use super::error::FigureError;

/// Colours of the map; one more index is left for cells without a value.
const N_LEVELS: usize = 255;
const NO_VALUE: u8 = 255;
/// Grey of cells without a value.
const NO_VALUE_RGB: [u8; 3] = [0xd3, 0xd3, 0xd3];

/// A picture of indices into the map, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Picture {
    pub(super) width: usize,
    pub(super) height: usize,
    levels: Vec<u8>,
}

impl Picture {
    /// Colours of the values from `from` (darkest) to `to`; values beyond have the colours of the
    /// ends, and those that are not finite are grey.
    pub(super) fn new([width, height]: [usize; 2], values: &[f64], [from, to]: [f64; 2]) -> Self {
        assert_eq!(values.len(), width * height, "a picture of {width} × {height}");
        let level = |&value: &f64| {
            let share = ((value - from) / (to - from)).clamp(0.0, 1.0);
            if value.is_finite() { (share * (N_LEVELS - 1) as f64).round() as u8 } else { NO_VALUE }
        };
        Self { width, height, levels: values.iter().map(level).collect() }
    }

    /// Every pixel as a square of `by` × `by` pixels.
    pub(super) fn magnified(&self, by: usize) -> Self {
        let widened = |row: &[u8]| -> Vec<u8> {
            row.iter().flat_map(|&level| std::iter::repeat_n(level, by)).collect()
        };
        let rows = self.levels.chunks(self.width);
        let levels = rows.flat_map(|row| widened(row).repeat(by)).collect();
        Self { width: by * self.width, height: by * self.height, levels }
    }

    /// The picture as a PNG, a byte a pixel.
    ///
    /// # Errors
    /// [`FigureError::Png`] for a picture without pixels or beyond 2³¹ of them along one side.
    pub(super) fn png(&self) -> Result<Vec<u8>, FigureError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_palette(palette());
        encoder.set_compression(png::Compression::High);
        encoder.write_header()?.write_image_data(&self.levels)?;
        Ok(bytes)
    }
}

fn palette() -> Vec<u8> {
    let map = (0..N_LEVELS).map(|level| {
        let colour = colorous::VIRIDIS.eval_rational(level, N_LEVELS);
        [colour.r, colour.g, colour.b]
    });
    map.chain([NO_VALUE_RGB]).flatten().collect()
}

/// Means over blocks of `by` × `by` values of a square matrix of `n` rows, of those that are
/// finite; the last blocks may be smaller. Returns the number of rows and the values.
pub(super) fn block_means(values: &[f64], n: usize, by: usize) -> (usize, Vec<f64>) {
    let n_blocks = n.div_ceil(by);
    let extent = |block: usize| block * by..((block + 1) * by).min(n);
    let mean = |row: usize, column: usize| {
        let cells = extent(row).flat_map(|i| values[i * n..][extent(column)].iter());
        let finite = cells.filter(|v| v.is_finite());
        let (sum, count) = finite.fold((0.0, 0), |(sum, count), v| (sum + v, count + 1));
        // A block without finite values has the mean 0/0, which is drawn as no value.
        sum / f64::from(count)
    };
    let blocks = (0..n_blocks).flat_map(|i| (0..n_blocks).map(move |j| (i, j)));
    (n_blocks, blocks.map(|(i, j)| mean(i, j)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rgb(picture: &Picture) -> Vec<[u8; 3]> {
        let bytes = picture.png().unwrap();
        let mut decoder = png::Decoder::new(std::io::Cursor::new(&bytes));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        pixels.chunks(3).map(|p| [p[0], p[1], p[2]]).collect()
    }

    #[test]
    fn ends_of_the_range_have_the_ends_of_viridis() {
        // matplotlib gives viridis(0) = #440154 and viridis(1) = #fde725.
        let picture = Picture::new([4, 1], &[0.0, 2.0, -9.0, 9.0], [0.0, 2.0]);
        let [dark, light] = [[0x44, 0x01, 0x54], [0xfd, 0xe7, 0x25]];
        for (found, expected) in rgb(&picture).into_iter().zip([dark, light, dark, light]) {
            let worst = found.iter().zip(expected).map(|(a, b)| a.abs_diff(b)).max();
            assert!(worst <= Some(2), "{found:?} instead of {expected:?}");
        }
    }

    #[test]
    fn lightness_never_falls_with_the_value() {
        let values: Vec<f64> = (0..N_LEVELS).map(|k| k as f64).collect();
        let colours = rgb(&Picture::new([N_LEVELS, 1], &values, [0.0, 254.0]));
        let luma = |c: &[u8; 3]| {
            0.2126 * f64::from(c[0]) + 0.7152 * f64::from(c[1]) + 0.0722 * f64::from(c[2])
        };
        assert!(colours.windows(2).all(|pair| luma(&pair[1]) >= luma(&pair[0]) - 1.0));
        assert!(luma(&colours[254]) > luma(&colours[0]) + 150.0);
    }

    #[test]
    fn values_that_are_not_finite_are_grey() {
        let picture = Picture::new([3, 1], &[f64::NAN, f64::INFINITY, 1.0], [0.0, 1.0]);
        let colours = rgb(&picture);
        assert_eq!(colours[..2], [NO_VALUE_RGB; 2]);
        assert_ne!(colours[2], NO_VALUE_RGB);
    }

    #[test]
    fn a_magnified_pixel_is_a_square() {
        let picture = Picture::new([2, 1], &[0.0, 1.0], [0.0, 1.0]).magnified(2);
        assert_eq!((picture.width, picture.height), (4, 2));
        assert_eq!(picture.levels, [0, 0, 254, 254, 0, 0, 254, 254]);
    }

    #[test]
    fn block_means_leave_out_what_is_not_finite() {
        let values = [1.0, 3.0, 5.0, 5.0, f64::NAN, 7.0, 2.0, 4.0, f64::INFINITY];
        let (n, means) = block_means(&values, 3, 2);
        assert_eq!((n, &means[..3]), (2, &[3.0, 6.0, 3.0][..]));
        assert!(means[3].is_nan());
    }
}
