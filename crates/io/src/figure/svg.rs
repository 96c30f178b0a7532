//! Drawings as SVG.

use super::drawing::{Anchor, Drawing, Fill, Lettering, Segment, Shape, Spot, Stroke};
use super::font::Weight;
use std::fmt::Write;

/// The font of the PNG, and what is near it where that is not installed.
const FAMILY: &str = "'Open Sans', 'Noto Sans', 'DejaVu Sans', Verdana, sans-serif";

/// Pixels of the drawing per pixel of an image from which on it is shown as squares.
const LARGE: f64 = 2.0;

pub(super) fn document(drawing: &Drawing) -> String {
    let [width, height] = drawing.size;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" role=\"img\" font-family=\"{FAMILY}\">\n<title>{}</title>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n",
        escaped(&drawing.title)
    );
    for shape in &drawing.shapes {
        put(&mut text, shape);
    }
    text.push_str("</svg>\n");
    text
}

fn put(text: &mut String, shape: &Shape) {
    let written = match shape {
        Shape::Image { image, area } => {
            let [x, y] = [area.left, area.top].map(number);
            let [width, height] = [area.width(), area.height()].map(number);
            // Viewers would blur the edges of cells that are large enough to be seen.
            let large = area.width() >= LARGE * image.width() as f64;
            let rendering = if large { " image-rendering=\"pixelated\"" } else { "" };
            let data = base64(&image.png());
            writeln!(
                text,
                "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" \
                 preserveAspectRatio=\"none\"{rendering} href=\"data:image/png;base64,{data}\"/>"
            )
        }
        Shape::Path { outline, fill, stroke } => {
            let style = style(fill.as_ref(), stroke.as_ref());
            writeln!(text, "<path d=\"{}\"{style}/>", path(outline))
        }
        Shape::Circle { center: [x, y], radius, fill, stroke } => {
            let (x, y, r) = (number(*x), number(*y), number(*radius));
            let style = style(fill.as_ref(), stroke.as_ref());
            writeln!(text, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\"{style}/>")
        }
        Shape::Text { text: label, at, width, lettering, .. } => {
            if label.trim().is_empty() {
                return;
            }
            writeln!(text, "<text{}>{}</text>", attributes(*at, *width, lettering), escaped(label))
        }
    };
    written.expect("writing to a string cannot fail");
}

/// Where and how a text stands. It is stretched to the width that it has in the bundled font, so that the figure keeps its
/// layout in any other.
fn attributes([x, y]: Spot, width: f64, lettering: &Lettering) -> String {
    let (size, colour) = (number(lettering.size), lettering.colour.hex());
    let (x, y, width) = (number(x), number(y), number(width));
    let mut attributes = format!(" x=\"{x}\" y=\"{y}\" font-size=\"{size}\" fill=\"{colour}\"");
    if lettering.weight == Weight::Semibold {
        attributes.push_str(" font-weight=\"600\"");
    }
    match lettering.anchor {
        Anchor::Start => {}
        Anchor::Middle => attributes.push_str(" text-anchor=\"middle\""),
        Anchor::End => attributes.push_str(" text-anchor=\"end\""),
    }
    if lettering.upward {
        attributes.push_str(&format!(" transform=\"rotate(-90 {x} {y})\""));
    }
    attributes + &format!(" textLength=\"{width}\" lengthAdjust=\"spacingAndGlyphs\"")
}

fn style(fill: Option<&Fill>, stroke: Option<&Stroke>) -> String {
    let mut style = match fill {
        None => " fill=\"none\"".to_owned(),
        Some(fill) if fill.opacity < 1.0 => {
            format!(" fill=\"{}\" fill-opacity=\"{}\"", fill.colour.hex(), number(fill.opacity))
        }
        Some(fill) => format!(" fill=\"{}\"", fill.colour.hex()),
    };
    if let Some(stroke) = stroke {
        let (colour, width) = (stroke.colour.hex(), number(stroke.width));
        style.push_str(&format!(" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linejoin=\"round\""));
        if stroke.dashed {
            style.push_str(" stroke-dasharray=\"6 4\"");
        }
    }
    style
}

fn path(outline: &[Segment]) -> String {
    let mut text = String::with_capacity(outline.len() * 14);
    let mut put = |letter: char, spots: &[Spot]| {
        text.push(letter);
        for (i, [x, y]) in spots.iter().enumerate() {
            text.push_str(if i > 0 { " " } else { "" });
            text.push_str(&number(*x));
            text.push(' ');
            text.push_str(&number(*y));
        }
    };
    for segment in outline {
        match *segment {
            Segment::Move(a) => put('M', &[a]),
            Segment::Line(a) => put('L', &[a]),
            Segment::Quad(a, b) => put('Q', &[a, b]),
            Segment::Close => put('Z', &[]),
        }
    }
    text
}

/// A hundredth of a pixel is enough.
fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn escaped(text: &str) -> String {
    let kept = text.chars().filter(|sign| !sign.is_control());
    kept.collect::<String>().replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

/// Bytes as text in the standard alphabet with padding (RFC 4648).
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let byte = |i: usize| u32::from(three.get(i).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for i in 0..4 {
            let letter = char::from(LETTERS[(bits >> (18 - 6 * i)) as usize & 63]);
            text.push(if i <= three.len() { letter } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::base64;

    #[test]
    fn base64_gives_the_examples_of_its_standard() {
        let cases = [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foob", "Zm9vYg==")];
        for (plain, coded) in cases {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
        assert_eq!(base64(&[0xfb, 0xff, 0xfe]), "+//+");
    }
}
