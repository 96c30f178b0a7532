//! A list of shapes, in the order in which they are painted. Lengths are CSS pixels, y points
//! down.

use super::colour::Colour;
use super::font::{Font, Weight};
use super::image::Image;

/// A point in pixels.
pub(super) type Spot = [f64; 2];

/// A part of an outline.
#[derive(Clone, Copy, Debug)]
pub(super) enum Segment {
    Move(Spot),
    Line(Spot),
    Quad(Spot, Spot),
    Close,
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stroke {
    pub(super) colour: Colour,
    pub(super) width: f64,
    pub(super) dashed: bool,
}

impl Stroke {
    pub(super) fn plain(colour: Colour, width: f64) -> Self {
        Self { colour, width, dashed: false }
    }
}

/// A fill with its opacity.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fill {
    pub(super) colour: Colour,
    pub(super) opacity: f64,
}

impl Fill {
    pub(super) fn solid(colour: Colour) -> Self {
        Self { colour, opacity: 1.0 }
    }
}

#[derive(Clone, Debug)]
pub(super) enum Shape {
    Path {
        outline: Vec<Segment>,
        fill: Option<Fill>,
        stroke: Option<Stroke>,
    },
    Circle {
        center: Spot,
        radius: f64,
        fill: Option<Fill>,
        stroke: Option<Stroke>,
    },
    /// A text on the base line through `at`, `width` pixels wide, with its outlines for what has no fonts.
    Text {
        text: String,
        at: Spot,
        width: f64,
        lettering: Lettering,
        outline: Vec<Segment>,
    },
    Image {
        image: Image,
        area: Area,
    },
}

/// Where a text lies against its spot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// Size, weight, colour and direction of a text.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lettering {
    pub(super) size: f64,
    pub(super) weight: Weight,
    pub(super) colour: Colour,
    pub(super) anchor: Anchor,
    /// Read from below to above.
    pub(super) upward: bool,
}

impl Lettering {
    pub(super) fn plain(size: f64, anchor: Anchor) -> Self {
        Self { size, weight: Weight::Regular, colour: Colour::TEXT, anchor, upward: false }
    }

    pub(super) fn heading(size: f64, anchor: Anchor) -> Self {
        Self { weight: Weight::Semibold, ..Self::plain(size, anchor) }
    }
}

/// An area of a figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Area {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

impl Area {
    pub(super) fn width(&self) -> f64 {
        self.right - self.left
    }
    pub(super) fn height(&self) -> f64 {
        self.bottom - self.top
    }
    pub(super) fn center(&self) -> Spot {
        [0.5 * (self.left + self.right), 0.5 * (self.top + self.bottom)]
    }
    pub(super) fn contains(&self, [x, y]: Spot) -> bool {
        (self.left..=self.right).contains(&x) && (self.top..=self.bottom).contains(&y)
    }
    pub(super) fn grown(&self, by: f64) -> Self {
        let Self { left, top, right, bottom } = *self;
        Self { left: left - by, top: top - by, right: right + by, bottom: bottom + by }
    }
}

/// The shapes of a figure.
#[derive(Clone, Debug)]
pub(super) struct Drawing {
    pub(super) size: [f64; 2],
    pub(super) title: String,
    pub(super) shapes: Vec<Shape>,
}

impl Drawing {
    /// An empty drawing; its size is kept within what can be painted.
    pub(super) fn new(size: [f64; 2], title: &str) -> Self {
        let within = |length: f64| if length.is_finite() { length.clamp(40.0, 6000.0).ceil() } else { 400.0 };
        Self { size: size.map(within), title: title.to_owned(), shapes: Vec::new() }
    }

    pub(super) fn polyline(&mut self, spots: &[Spot], stroke: Stroke) {
        if spots.len() > 1 {
            let outline = open_outline(spots);
            self.shapes.push(Shape::Path { outline, fill: None, stroke: Some(stroke) });
        }
    }

    pub(super) fn line(&mut self, from: Spot, to: Spot, stroke: Stroke) {
        self.polyline(&[from, to], stroke);
    }

    pub(super) fn polygon(&mut self, spots: &[Spot], fill: Option<Fill>, stroke: Option<Stroke>) {
        if spots.len() > 2 {
            let mut outline = open_outline(spots);
            outline.push(Segment::Close);
            self.shapes.push(Shape::Path { outline, fill, stroke });
        }
    }

    pub(super) fn rectangle(&mut self, area: Area, fill: Option<Fill>, stroke: Option<Stroke>) {
        let Area { left, top, right, bottom } = area;
        self.polygon(&[[left, top], [right, top], [right, bottom], [left, bottom]], fill, stroke);
    }

    pub(super) fn circle(&mut self, center: Spot, radius: f64, fill: Fill, stroke: Option<Stroke>) {
        self.shapes.push(Shape::Circle { center, radius, fill: Some(fill), stroke });
    }

    pub(super) fn ring(&mut self, center: Spot, radius: f64, stroke: Stroke) {
        self.shapes.push(Shape::Circle { center, radius, fill: None, stroke: Some(stroke) });
    }

    /// Pixels that fill an area; none when it has no extent.
    pub(super) fn image(&mut self, image: Image, area: Area) {
        if area.width() > 0.0 && area.height() > 0.0 {
            self.shapes.push(Shape::Image { image, area });
        }
    }

    /// Writes a text on the base line through `at`.
    pub(super) fn text(&mut self, text: &str, at: Spot, lettering: Lettering) {
        let font = Font::new(lettering.weight);
        let width = font.width(text, lettering.size);
        let shift = match lettering.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => -0.5 * width,
            Anchor::End => -width,
        };
        let place = |[x, y]: Spot| {
            let [x, y] = [x + shift, y];
            if lettering.upward { [at[0] + y, at[1] - x] } else { [at[0] + x, at[1] + y] }
        };
        let outline = font.outline(text, lettering.size).into_iter().map(|segment| match segment {
            Segment::Move(a) => Segment::Move(place(a)),
            Segment::Line(a) => Segment::Line(place(a)),
            Segment::Quad(a, b) => Segment::Quad(place(a), place(b)),
            Segment::Close => Segment::Close,
        });
        let (text, outline) = (text.to_owned(), outline.collect());
        self.shapes.push(Shape::Text { text, at, width, lettering, outline });
    }

    /// Writes a text, smaller where it would be wider than `width`.
    pub(super) fn text_within(&mut self, text: &str, at: Spot, width: f64, mut lettering: Lettering) {
        let natural = Font::new(lettering.weight).width(text, lettering.size);
        if natural > width {
            lettering.size *= (width / natural).max(0.55);
        }
        self.text(text, at, lettering);
    }
}

fn open_outline(spots: &[Spot]) -> Vec<Segment> {
    let rest = spots[1..].iter().map(|&spot| Segment::Line(spot));
    std::iter::once(Segment::Move(spots[0])).chain(rest).collect()
}
