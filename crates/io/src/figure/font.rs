//! Outlines and widths of text in the bundled font.

use super::drawing::{Segment, Spot};
use ttf_parser::{Face, GlyphId, OutlineBuilder};

static REGULAR: &[u8] = include_bytes!("../../fonts/OpenSans-Regular-subset.ttf");
static SEMIBOLD: &[u8] = include_bytes!("../../fonts/OpenSans-Semibold-subset.ttf");

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Weight {
    Regular,
    Semibold,
}

pub(super) struct Font {
    face: Face<'static>,
}

/// A letter: what to draw, how large, and how far above the base line (in sizes of the text).
struct Letter {
    sign: char,
    scale: f64,
    rise: f64,
}

impl Letter {
    /// Superscripts and subscripts are small ordinary letters: the font lacks most of them.
    fn of(sign: char) -> Self {
        const RAISED: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻⁽⁾ⁿⁱ";
        const LOWERED: &str = "₀₁₂₃₄₅₆₇₈₉₊₋₍₎ₙᵢ";
        let plain = |signs: &str| {
            let index = signs.chars().position(|other| other == sign)?;
            "0123456789+\u{2212}()ni".chars().nth(index)
        };
        if let Some(sign) = plain(RAISED) {
            Self { sign, scale: 0.7, rise: 0.36 }
        } else if let Some(sign) = plain(LOWERED) {
            Self { sign, scale: 0.7, rise: -0.16 }
        } else {
            let sign = if sign == 'ϕ' { 'φ' } else { sign };
            Self { sign, scale: 1.0, rise: 0.0 }
        }
    }
}

impl Font {
    pub(super) fn new(weight: Weight) -> Self {
        let bytes = if weight == Weight::Regular { REGULAR } else { SEMIBOLD };
        Self { face: Face::parse(bytes, 0).expect("the bundled font is whole") }
    }

    /// Width of a text in pixels at a size in pixels.
    pub(super) fn width(&self, text: &str, size: f64) -> f64 {
        self.walk(text, size, |_, _| ())
    }

    /// Outline of a text that starts at the origin, y down.
    pub(super) fn outline(&self, text: &str, size: f64) -> Vec<Segment> {
        let mut pen = Pen { at: [0.0; 2], scale: 1.0, outline: Vec::new() };
        let unit = size / self.units();
        self.walk(text, size, |letter, x| {
            pen.at = [x, -letter.rise * size];
            pen.scale = unit * letter.scale;
            if is_arrow(letter.sign) {
                pen.scale = size;
                pen.arrow(letter.sign);
            } else {
                self.face.outline_glyph(self.glyph(letter.sign), &mut pen);
            }
        });
        pen.outline
    }

    /// Visits all letters with the place where they start, and returns the width.
    fn walk(&self, text: &str, size: f64, mut visit: impl FnMut(&Letter, f64)) -> f64 {
        let mut x = 0.0;
        for sign in text.chars() {
            let letter = Letter::of(sign);
            visit(&letter, x);
            x += self.advance(letter.sign) * letter.scale * size;
        }
        x
    }

    fn advance(&self, sign: char) -> f64 {
        if is_arrow(sign) {
            return 1.0;
        }
        let units = self.face.glyph_hor_advance(self.glyph(sign)).unwrap_or(1000);
        f64::from(units) / self.units()
    }

    fn units(&self) -> f64 {
        f64::from(self.face.units_per_em())
    }

    /// The empty box where the font has no such letter.
    fn glyph(&self, sign: char) -> GlyphId {
        self.face.glyph_index(sign).unwrap_or(GlyphId(0))
    }
}

fn is_arrow(sign: char) -> bool {
    matches!(sign, '→' | '←' | '↑' | '↓')
}

struct Pen {
    at: Spot,
    scale: f64,
    outline: Vec<Segment>,
}

impl Pen {
    fn place(&self, x: f32, y: f32) -> Spot {
        [self.at[0] + f64::from(x) * self.scale, self.at[1] - f64::from(y) * self.scale]
    }

    /// The font has no arrows; coordinates in sizes of the text around the middle of the letter.
    fn arrow(&mut self, sign: char) {
        const RIGHT: [[f32; 2]; 7] = [
            [-0.42, -0.035],
            [0.2, -0.035],
            [0.2, -0.17],
            [0.42, 0.0],
            [0.2, 0.17],
            [0.2, 0.035],
            [-0.42, 0.035],
        ];
        for (i, [x, y]) in RIGHT.into_iter().enumerate() {
            let [x, y] = match sign {
                '→' => [x, y],
                '←' => [-x, -y],
                '↑' => [-y, x],
                _ => [y, -x],
            };
            let spot = self.place(x + 0.5, y + 0.34);
            self.outline.push(if i == 0 { Segment::Move(spot) } else { Segment::Line(spot) });
        }
        self.outline.push(Segment::Close);
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.outline.push(Segment::Move(self.place(x, y)));
    }
    fn line_to(&mut self, x: f32, y: f32) {
        self.outline.push(Segment::Line(self.place(x, y)));
    }
    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.outline.push(Segment::Quad(self.place(x1, y1), self.place(x, y)));
    }
    /// The font has only quadratic curves; a cubic one would be drawn by its middle.
    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.quad_to(0.5 * (x1 + x2), 0.5 * (y1 + y2), x, y);
    }
    fn close(&mut self) {
        self.outline.push(Segment::Close);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_letters_that_labels_use_are_in_the_font() {
        let text = "ABCxyz 0123456789+-−±×·°µμαβγδεθλφϕρσΩΔ∂∑∏∫≈≠≤≥∞√→←↑↓…–—’⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺ⁿ₀₁₂₃₄éüßøÅ[]()/%";
        for weight in [Weight::Regular, Weight::Semibold] {
            let font = Font::new(weight);
            for sign in text.chars() {
                let letter = Letter::of(sign);
                assert!(is_arrow(letter.sign) || font.glyph(letter.sign) != GlyphId(0), "{sign}");
            }
            assert!(font.width("10⁻⁶", 10.0) < font.width("10−6", 10.0));
            assert_eq!(font.width("", 10.0), 0.0);
            assert!(font.width("\u{4e2d}", 10.0) > 0.0, "an unknown letter is a box");
        }
    }
}
