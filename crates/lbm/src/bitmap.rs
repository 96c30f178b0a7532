//! Obstacles drawn as images.

use crate::setup::SetupError;
use granular_core::D2;
use granular_core::glam::DVec2;
use granular_core::shape::SolidShape;

/// Which pixels of an image are solid. Brightness goes from 0, black, to 1, white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solid {
    /// Those darker than a brightness, such as 0.5.
    Darker(f64),
    /// Those brighter than a brightness, such as 0.5.
    Brighter(f64),
}

/// A body drawn in square pixels, in the plane; see [`crate::Extruded`] for space.
///
/// Between the centres of pixels brightness varies bilinearly, so that the contour is smooth where the image is: a disk
/// of 25 pixels drawn with soft edges is met within a tenth of a pixel, one in black and white within half a pixel.
/// Outside of the image all is fluid.
///
/// ```
/// use granular_core::glam::DVec2;
/// use granular_lbm::{Bitmap, SolidShape};
///
/// // A step, its lowest row first, in pixels of 1 mm.
/// let step = Bitmap::new(DVec2::ZERO, 1e-3, [3, 2], &[true, true, true, true, false, false])?;
/// assert!(step.contains(DVec2::new(0.5e-3, 1.5e-3)) && !step.contains(DVec2::new(2.5e-3, 1.5e-3)));
/// # Ok::<(), granular_lbm::SetupError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Bitmap {
    low: DVec2,
    spacing: f64,
    size: [usize; 2],
    /// Above zero where solid, the lowest row first.
    solidity: Vec<f64>,
}

impl Bitmap {
    /// Pixels that are solid or not, of `size` columns and rows, the lowest row first, with the lowest corner at `low`
    /// \[m\] and edges of `spacing` \[m\].
    ///
    /// # Errors
    /// When the number of pixels is not that of the size, or length or corner make no sense.
    pub fn new(low: DVec2, spacing: f64, size: [usize; 2], solid: &[bool]) -> Result<Self, SetupError> {
        let solidity = solid.iter().map(|solid| if *solid { 0.5 } else { -0.5 }).collect();
        Self::checked(Self { low, spacing, size, solidity })
    }

    /// Pixels by brightness, otherwise as [`Bitmap::new`].
    ///
    /// # Errors
    /// As [`Bitmap::new`], and when a brightness is not finite or the threshold is not between 0 and 1.
    pub fn of_brightness(
        low: DVec2,
        spacing: f64,
        size: [usize; 2],
        brightness: &[f64],
        solid: Solid,
    ) -> Result<Self, SetupError> {
        let (threshold, sign) = match solid {
            Solid::Darker(threshold) => (threshold, -1.0),
            Solid::Brighter(threshold) => (threshold, 1.0),
        };
        if !(threshold > 0.0 && threshold < 1.0) {
            return Err(SetupError::new("brightness of a solid", threshold.to_string(), "between 0 and 1"));
        }
        if let Some(value) = brightness.iter().find(|value| !value.is_finite()) {
            return Err(SetupError::new("brightness of a pixel", value.to_string(), "a finite number"));
        }
        let solidity = brightness.iter().map(|value| sign * (value - threshold)).collect();
        Self::checked(Self { low, spacing, size, solidity })
    }

    /// An image in the PNG format, upright: its last row is the lowest. Colours count by their luminance
    /// (Rec. 709), transparent pixels as white. Needs the cargo feature `png`.
    ///
    /// # Errors
    /// When the image cannot be read, and as [`Bitmap::of_brightness`].
    #[cfg(feature = "png")]
    pub fn from_png(
        image: impl std::io::BufRead + std::io::Seek,
        low: DVec2,
        spacing: f64,
        solid: Solid,
    ) -> Result<Self, SetupError> {
        let (size, brightness) = crate::image::brightness(image)
            .map_err(|why| SetupError::new("image", why.to_string(), "a picture in the PNG format"))?;
        Self::of_brightness(low, spacing, size, &brightness, solid)
    }

    fn checked(self) -> Result<Self, SetupError> {
        let [width, height] = self.size;
        let pixels = width.checked_mul(height);
        if pixels.is_none_or(|pixels| pixels == 0 || pixels != self.solidity.len()) {
            let value = format!("{} for {width} x {height}", self.solidity.len());
            return Err(SetupError::new("pixels", value, "columns times rows, one at least"));
        }
        if !(self.spacing > 0.0 && self.spacing.is_finite()) {
            let value = format!("{} m", self.spacing);
            return Err(SetupError::new("edge of a pixel", value, "a positive number"));
        }
        if !self.low.is_finite() {
            return Err(SetupError::new("corner of an image", self.low.to_string(), "finite numbers"));
        }
        Ok(self)
    }
}

impl SolidShape<D2> for Bitmap {
    fn contains(&self, point: DVec2) -> bool {
        let at = (point - self.low) / self.spacing;
        let [width, height] = self.size;
        if !(at.x >= 0.0 && at.y >= 0.0 && at.x <= width as f64 && at.y <= height as f64) {
            return false;
        }
        // From the centre of the first pixel to that of the last one; half a pixel beyond as at that.
        let along = |at: f64, count: usize| {
            let at = (at - 0.5).clamp(0.0, (count - 1) as f64);
            let first = (at as usize).min(count.saturating_sub(2));
            (first, (first + 1).min(count - 1), at - first as f64)
        };
        let ((left, right, x), (lower, upper, y)) = (along(at.x, width), along(at.y, height));
        let pixel = |column: usize, row: usize| self.solidity[row * width + column];
        let below = pixel(left, lower) * (1.0 - x) + pixel(right, lower) * x;
        let above = pixel(left, upper) * (1.0 - x) + pixel(right, upper) * x;
        below * (1.0 - y) + above * y >= 0.0
    }

    fn bounds(&self) -> (DVec2, DVec2) {
        let [width, height] = self.size;
        (self.low, self.low + self.spacing * DVec2::new(width as f64, height as f64))
    }
}
