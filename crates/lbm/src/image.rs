//! Pictures in the PNG format.

use png::{ColorType, Decoder, DecodingError, Transformations};
use std::io::{BufRead, Error, Seek};

/// Columns and rows, and the brightness from 0 to 1 of all pixels, the lowest row first.
pub(crate) fn brightness(image: impl BufRead + Seek) -> Result<([usize; 2], Vec<f64>), DecodingError> {
    let mut decoder = Decoder::new(image);
    decoder.set_transformations(Transformations::normalize_to_color8());
    let mut reader = decoder.read_info()?;
    let too_large = || DecodingError::IoError(Error::other("larger than the memory of this computer"));
    let mut bytes = vec![0; reader.output_buffer_size().ok_or_else(too_large)?];
    let frame = reader.next_frame(&mut bytes)?;
    let (width, height) = (frame.width as usize, frame.height as usize);
    let samples = frame.color_type.samples();
    let mut found = Vec::with_capacity(width * height);
    for row in bytes[..frame.buffer_size()].chunks_exact(frame.line_size).rev() {
        found.extend(row.chunks_exact(samples).take(width).map(|pixel| luminance(frame.color_type, pixel)));
    }
    Ok(([width, height], found))
}

fn luminance(color: ColorType, pixel: &[u8]) -> f64 {
    let sample = |i: usize| f64::from(pixel[i]) / 255.0;
    let (light, opacity) = match color {
        ColorType::Rgb | ColorType::Rgba => {
            let light = 0.2126 * sample(0) + 0.7152 * sample(1) + 0.0722 * sample(2);
            (light, if color == ColorType::Rgba { sample(3) } else { 1.0 })
        }
        ColorType::GrayscaleAlpha => (sample(0), sample(1)),
        _ => (sample(0), 1.0),
    };
    1.0 - opacity * (1.0 - light)
}
