//! Images made of coloured pixels, and how pixels of another size cover them.

use super::colour::Colour;
use tiny_skia::{ColorU8, Pixmap};

/// Coloured pixels, row by row from the upper left.
#[derive(Clone, Debug)]
pub(super) struct Image {
    width: usize,
    pixels: Vec<Colour>,
}

impl Image {
    /// An image of whole rows; `None` when it would have no pixel.
    pub(super) fn of(width: usize, pixels: Vec<Colour>) -> Option<Self> {
        (width > 0 && !pixels.is_empty() && pixels.len().is_multiple_of(width))
            .then_some(Self { width, pixels })
    }

    pub(super) fn width(&self) -> usize {
        self.width
    }

    pub(super) fn height(&self) -> usize {
        self.pixels.len() / self.width
    }

    pub(super) fn at(&self, column: usize, row: usize) -> Colour {
        self.pixels[row * self.width + column]
    }

    /// The bytes of a PNG file with one pixel per pixel.
    pub(super) fn png(&self) -> Vec<u8> {
        let mut pixels = Pixmap::new(self.width as u32, self.height() as u32)
            .expect("images are made small, and never empty");
        for (pixel, Colour([red, green, blue])) in pixels.pixels_mut().iter_mut().zip(&self.pixels) {
            *pixel = ColorU8::from_rgba(*red, *green, *blue, 255).premultiply();
        }
        pixels.encode_png().expect("pixels in memory can be encoded")
    }
}

/// Which sources each target along one axis covers.
pub(super) struct Samples {
    /// The targets that cover any source; for each source the part of the target it fills.
    pub(super) each: Vec<(usize, Vec<(usize, f64)>)>,
}

impl Samples {
    /// `sources` of the same length between two places, where target `i` lies from `i` to `i + 1`.
    pub(super) fn of([from, to]: [f64; 2], sources: usize, targets: usize) -> Self {
        let pitch = (to - from) / sources as f64;
        let first = (from.max(0.0) as usize).min(targets);
        let last = (to.max(0.0).ceil() as usize).clamp(first, targets);
        let parts = |target: usize| {
            let (low, high) = ((target as f64).max(from), (target as f64 + 1.0).min(to));
            let begin = (((low - from) / pitch) as usize).min(sources - 1);
            let end = (((high - from) / pitch).ceil() as usize).clamp(begin + 1, sources);
            let part = |source: usize| {
                let (left, right) = (from + pitch * source as f64, from + pitch * (source + 1) as f64);
                (source, right.min(high) - left.max(low))
            };
            (begin..end).map(part).filter(|(_, part)| *part > 1e-9).collect::<Vec<_>>()
        };
        let each = (first..last).map(|target| (target, parts(target)));
        Self { each: each.filter(|(_, parts)| !parts.is_empty()).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_are_filled_in_parts() {
        let one_each = Samples::of([0.0, 3.0], 3, 3).each;
        assert_eq!(one_each, [(0, vec![(0, 1.0)]), (1, vec![(1, 1.0)]), (2, vec![(2, 1.0)])]);
        let smaller = Samples::of([0.0, 2.0], 4, 2).each;
        assert_eq!(smaller, [(0, vec![(0, 0.5), (1, 0.5)]), (1, vec![(2, 0.5), (3, 0.5)])]);
        let larger = Samples::of([0.5, 4.5], 2, 4).each;
        assert_eq!(larger[0], (0, vec![(0, 0.5)]));
        assert_eq!(larger[2], (2, vec![(0, 0.5), (1, 0.5)]));
        // What lies outside is cut.
        assert_eq!(larger.len(), 4);
        assert!(Samples::of([-5.0, -2.0], 2, 4).each.is_empty());
        assert!(Samples::of([5.0, 7.0], 2, 4).each.is_empty());
    }

    #[test]
    fn an_image_has_whole_rows() {
        assert!(Image::of(0, vec![]).is_none() && Image::of(2, vec![]).is_none());
        assert!(Image::of(2, vec![Colour::WHITE; 3]).is_none());
        let image = Image::of(2, vec![Colour([1, 2, 3]); 6]).unwrap();
        let pixels = Pixmap::decode_png(&image.png()).unwrap();
        assert_eq!((pixels.width(), pixels.height()), (2, 3));
        let pixel = pixels.pixel(1, 2).unwrap();
        assert_eq!([pixel.red(), pixel.green(), pixel.blue(), pixel.alpha()], [1, 2, 3, 255]);
    }
}
