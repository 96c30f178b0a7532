//! Drawings as PNG.

use super::colour::Colour;
use super::drawing::{Area, Drawing, Fill, Segment, Shape, Stroke};
use super::image::{Image, Samples};
use tiny_skia::{ColorU8, FillRule, LineJoin, Paint, Path, PathBuilder, Pixmap, StrokeDash, Transform};

/// Pixels of the PNG per pixel of the drawing.
const DENSITY: f32 = 2.0;

pub(super) fn png(drawing: &Drawing) -> Vec<u8> {
    let [width, height] = drawing.size.map(|length| (length as f32 * DENSITY) as u32);
    let mut pixels = Pixmap::new(width, height).expect("the size of a drawing is kept within bounds");
    pixels.fill(tiny_skia::Color::WHITE);
    for shape in &drawing.shapes {
        paint(&mut pixels, shape);
    }
    pixels.encode_png().expect("pixels in memory can be encoded")
}

fn paint(pixels: &mut Pixmap, shape: &Shape) {
    let (path, fill, stroke) = match shape {
        Shape::Image { image, area } => return paint_image(pixels, image, *area),
        Shape::Path { outline, fill, stroke } => (path(outline), *fill, *stroke),
        Shape::Circle { center, radius, fill, stroke } => {
            let [x, y] = center.map(|x| x as f32);
            (PathBuilder::from_circle(x, y, *radius as f32), *fill, *stroke)
        }
        Shape::Text { outline, lettering, .. } => (path(outline), Some(Fill::solid(lettering.colour)), None),
    };
    // What has no extent has no path, and leaves no trace.
    let Some(path) = path else { return };
    let scaled = Transform::from_scale(DENSITY, DENSITY);
    if let Some(fill) = fill {
        pixels.fill_path(&path, &ink(fill.colour, fill.opacity), FillRule::Winding, scaled, None);
    }
    if let Some(stroke) = stroke {
        pixels.stroke_path(&path, &ink(stroke.colour, 1.0), &pen(&stroke), scaled, None);
    }
}

/// Each pixel gets the mean colour of the part of the image that it covers: plain squares where the
/// image is enlarged, no moiré where it is made smaller.
fn paint_image(pixels: &mut Pixmap, image: &Image, area: Area) {
    let edge = |place: f64| place * f64::from(DENSITY);
    let (width, height) = (pixels.width() as usize, pixels.height() as usize);
    let columns = Samples::of([edge(area.left), edge(area.right)], image.width(), width);
    let rows = Samples::of([edge(area.top), edge(area.bottom)], image.height(), height);
    let pixels = pixels.pixels_mut();
    for (y, row) in &rows.each {
        for (x, column) in &columns.each {
            let (mut colour, mut covered) = ([0.0; 3], 0.0);
            for &(j, high) in row {
                for &(i, wide) in column {
                    let Colour(part) = image.at(i, j);
                    colour = std::array::from_fn(|k| colour[k] + high * wide * f64::from(part[k]));
                    covered += high * wide;
                }
            }
            let pixel = &mut pixels[y * width + x];
            let behind = [pixel.red(), pixel.green(), pixel.blue()];
            let mixed: [u8; 3] = std::array::from_fn(|k| {
                (colour[k] + (1.0 - covered).max(0.0) * f64::from(behind[k])).round() as u8
            });
            // The paper below is opaque, and so stays the pixel.
            *pixel = ColorU8::from_rgba(mixed[0], mixed[1], mixed[2], 255).premultiply();
        }
    }
}

fn ink(colour: Colour, opacity: f64) -> Paint<'static> {
    let [red, green, blue] = colour.0;
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(red, green, blue, (opacity * 255.0).round() as u8);
    paint
}

fn pen(stroke: &Stroke) -> tiny_skia::Stroke {
    let dash = if stroke.dashed { StrokeDash::new(vec![6.0, 4.0], 0.0) } else { None };
    tiny_skia::Stroke {
        width: stroke.width as f32,
        line_join: LineJoin::Round,
        dash,
        ..tiny_skia::Stroke::default()
    }
}

fn path(outline: &[Segment]) -> Option<Path> {
    let mut builder = PathBuilder::new();
    for segment in outline {
        match *segment {
            Segment::Move([x, y]) => builder.move_to(x as f32, y as f32),
            Segment::Line([x, y]) => builder.line_to(x as f32, y as f32),
            Segment::Quad([a, b], [x, y]) => builder.quad_to(a as f32, b as f32, x as f32, y as f32),
            Segment::Close => builder.close(),
        }
    }
    builder.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fine_pattern_becomes_grey_and_edges_mix_with_the_paper() {
        let stripes = (0..1000).map(|i| Colour([if i % 2 == 0 { 0 } else { 255 }; 3])).collect();
        let mut drawing = Drawing::new([140.0, 60.0], "");
        // The left edge is a quarter of the way through a pixel of the PNG.
        let area = Area { left: 20.125, top: 10.0, right: 120.125, bottom: 30.0 };
        drawing.image(Image::of(1000, stripes).unwrap(), area);
        let pixels = Pixmap::decode_png(&png(&drawing)).unwrap();
        let red = |x: u32, y: u32| f64::from(pixels.pixel(x, y).unwrap().red());
        // Five stripes to a pixel: at most three of them are of one kind.
        assert!((41..240).all(|x| (102.0..=153.0).contains(&red(x, 40))), "no moiré");
        // A quarter of paper, then stripes of a fifth: black, white, black, three quarters of white.
        assert_eq!(red(40, 40), (255.0_f64 * (0.25 + 1.75 * 0.2)).round());
        assert_eq!([red(39, 40), red(242, 40), red(100, 19), red(100, 60)], [255.0; 4]);
        assert!(red(100, 20) < 160.0 && red(100, 59) < 160.0);
    }
}
