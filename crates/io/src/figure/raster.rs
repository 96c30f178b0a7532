//! Drawings as PNG.

use super::colour::Colour;
use super::drawing::{Drawing, Fill, Segment, Shape, Stroke};
use tiny_skia::{FillRule, LineJoin, Paint, Path, PathBuilder, Pixmap, StrokeDash, Transform};

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
        Shape::Path { outline, fill, stroke } => (path(outline), *fill, *stroke),
        Shape::Circle { center, radius, fill, stroke } => {
            let [x, y] = center.map(|x| x as f32);
            (PathBuilder::from_circle(x, y, *radius as f32), *fill, *stroke)
        }
        Shape::Text { outline, colour, .. } => (path(outline), Some(Fill::solid(*colour)), None),
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
