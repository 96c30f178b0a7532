//! The bar that tells which colour is which value.

use super::chart::Scale;
use super::colour::Colour;
use super::drawing::{Anchor, Area, Drawing, Fill, Lettering, Stroke};
use super::font::{Font, Weight};
use super::layout::{Layout, SHORTEST_BAR};
use super::plot::{TICK, TICK_SIZE};
use super::scale::{Mapping, Ticks, ticks};

/// A colour bar at the right of all panels.
pub(super) struct ColourBar<'a> {
    /// What the colours show, with its unit.
    pub(super) quantity: &'a str,
    /// Values of the first and the last colour.
    pub(super) range: [f64; 2],
    /// The colour at a share of the range.
    pub(super) colour: fn(f64) -> Colour,
    /// Number of colours that are told apart.
    pub(super) strips: u32,
    /// Whether there are values below and above the range; that end becomes an arrow.
    pub(super) beyond: [bool; 2],
}

/// Height of the arrow at an end.
const ARROW: f64 = 10.0;

impl ColourBar<'_> {
    pub(super) fn draw(&self, drawing: &mut Drawing, layout: &Layout) {
        let half = (0.5 * (layout.bottom - layout.top)).clamp(0.5 * SHORTEST_BAR, 150.0);
        // Beside a flat panel it reaches down, not up into the title.
        let middle = (0.5 * (layout.top + layout.bottom)).max(layout.top + half);
        let left = layout.right + 18.0;
        let [below, above] = self.beyond.map(|beyond| if beyond { ARROW } else { 0.0 });
        let (top, bottom) = (middle - half + above, middle + half - below);
        let area = Area { left, top, right: left + 13.0, bottom };
        self.draw_colours(drawing, area);
        let mapping = Mapping::new(Scale::Linear, self.range, area.bottom, area.top);
        let Ticks { ticks, factor, .. } = ticks(Scale::Linear, self.range, 5);
        let mut widest = 10.0_f64;
        for tick in &ticks {
            let y = mapping.place(tick.value);
            drawing.line([area.right, y], [area.right + TICK, y], Stroke::plain(Colour::FRAME, 0.8));
            let at = [area.right + TICK + 4.0, y + 0.36 * TICK_SIZE];
            drawing.text(&tick.label, at, Lettering::plain(TICK_SIZE, Anchor::Start));
            widest = widest.max(Font::new(Weight::Regular).width(&tick.label, TICK_SIZE));
        }
        let at = [area.left, area.top - above - 6.0];
        drawing.text(&factor, at, Lettering::plain(TICK_SIZE, Anchor::Start));
        let label = Lettering { upward: true, ..Lettering::plain(13.0, Anchor::Middle) };
        let at = [area.right + TICK + widest + 21.0, middle];
        let room = (layout.bottom - layout.top + 40.0).max(2.0 * half + 10.0);
        drawing.text_within(self.quantity, at, room, label);
    }

    fn draw_colours(&self, drawing: &mut Drawing, area: Area) {
        let height = area.height() / f64::from(self.strips);
        for i in 0..self.strips {
            let top = area.top + height * f64::from(i);
            // Each strip reaches below the next, by a pixel of the PNG at least: no white seams.
            let reach = height + (0.5 * height).max(0.6);
            let strip = Area { top, bottom: (top + reach).min(area.bottom), ..area };
            let colour = (self.colour)(1.0 - (f64::from(i) + 0.5) / f64::from(self.strips));
            drawing.rectangle(strip, Some(Fill::solid(colour)), None);
        }
        let Area { left, top, right, bottom } = area;
        let middle = 0.5 * (left + right);
        let mut edge = vec![[left, top], [right, top], [right, bottom], [left, bottom]];
        if self.beyond[0] {
            let tip = [middle, bottom + ARROW];
            let fill = Some(Fill::solid((self.colour)(0.0)));
            drawing.polygon(&[[left, bottom], tip, [right, bottom]], fill, None);
            edge.insert(3, tip);
        }
        if self.beyond[1] {
            let tip = [middle, top - ARROW];
            let fill = Some(Fill::solid((self.colour)(1.0)));
            drawing.polygon(&[[left, top], tip, [right, top]], fill, None);
            edge.insert(1, tip);
        }
        drawing.polygon(&edge, None, Some(Stroke::plain(Colour::FRAME, 0.8)));
    }
}
