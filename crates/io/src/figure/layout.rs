//! Where panels with the same axes lie, and the numbers at their axes.

use super::chart::Scale;
use super::colour::Colour;
use super::drawing::{Anchor, Area, Drawing, Lettering, Stroke};
use super::font::{Font, Weight};
use super::plot::{TICK, TICK_SIZE};
use super::scale::{Mapping, Ticks, ticks};

/// Height of all panels together in pixels at most.
const TALLEST: f64 = 860.0;
/// Room between panels side by side, so that the numbers below do not meet.
const GAP: f64 = 30.0;
/// Room between panels above one another.
const SMALL_GAP: f64 = 14.0;

/// Height of a colour bar in pixels at least.
pub(super) const SHORTEST_BAR: f64 = 80.0;

/// What a layout is for.
pub(super) struct Request<'a> {
    pub(super) title: &'a str,
    /// Whether a panel has a label.
    pub(super) labels: bool,
    /// Whether there is a colour bar.
    pub(super) bar: bool,
    /// Whether there is a note below all.
    pub(super) note: bool,
    pub(super) count: usize,
    pub(super) columns: usize,
    pub(super) width: f64,
    /// Lower left and upper right corner in units of the axes; [`are_usable`].
    pub(super) corners: [[f64; 2]; 2],
}

/// Where the panels lie.
pub(super) struct Layout {
    pub(super) size: [f64; 2],
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
    columns: usize,
    count: usize,
    panel: [f64; 2],
    head: f64,
    /// Pixels per unit of the axes.
    pub(super) scale: f64,
    corners: [[f64; 2]; 2],
    ticks: [Ticks; 2],
}

impl Layout {
    pub(super) fn of(request: &Request<'_>) -> Self {
        let corners = request.corners;
        let count = request.count.max(1);
        let columns = request.columns.clamp(1, count);
        let rows = count.div_ceil(columns);
        let world = [corners[1][0] - corners[0][0], corners[1][1] - corners[0][1]];
        let head = if request.labels { 20.0 } else { 4.0 };
        let (left, right) = (66.0, if request.bar { 104.0 } else { 16.0 });
        let top = if request.title.is_empty() { 6.0 } else { 34.0 };
        let below = if request.note { 66.0 } else { 50.0 };
        let room = request.width.clamp(240.0, 6000.0) - left - right - GAP * (columns - 1) as f64;
        let tallest = (TALLEST / rows as f64 - head).max(60.0);
        let scale = (room / columns as f64 / world[0]).min(tallest / world[1]);
        let panel = world.map(|length| (length * scale).max(12.0));
        let width = panel[0] * columns as f64 + GAP * (columns - 1) as f64;
        let height = (panel[1] + head) * rows as f64 + SMALL_GAP * (rows - 1) as f64;
        let each = |k: usize, pixels: f64| {
            let wanted = (panel[k] / pixels).clamp(2.0, 8.0) as usize;
            ticks(Scale::Linear, [corners[0][k], corners[1][k]], wanted)
        };
        // A colour bar does not become as flat as the panels.
        let least = if request.bar { top + head + SHORTEST_BAR + 12.0 } else { 0.0 };
        Self {
            size: [left + width + right, (top + height + below).max(least)],
            left,
            top: top + head,
            right: left + width,
            bottom: top + height,
            columns,
            count,
            panel,
            head,
            scale,
            corners,
            ticks: [each(0, 78.0), each(1, 42.0)],
        }
    }

    /// A drawing of this size with the title above.
    pub(super) fn drawing(&self, title: &str) -> Drawing {
        let mut drawing = Drawing::new(self.size, title);
        if !title.is_empty() {
            let heading = Lettering::heading(15.0, Anchor::Middle);
            drawing.text_within(title, [0.5 * self.size[0], 23.0], self.size[0] - 16.0, heading);
        }
        drawing
    }

    pub(super) fn panel(&self, index: usize) -> Area {
        let (column, row) = ((index % self.columns) as f64, (index / self.columns) as f64);
        let [width, height] = self.panel;
        let left = self.left + column * (width + GAP);
        let top = self.top + row * (height + self.head + SMALL_GAP);
        Area { left, top, right: left + width, bottom: top + height }
    }

    pub(super) fn x(&self, area: Area) -> Mapping {
        Mapping::new(Scale::Linear, [self.corners[0][0], self.corners[1][0]], area.left, area.right)
    }

    pub(super) fn y(&self, area: Area) -> Mapping {
        Mapping::new(Scale::Linear, [self.corners[0][1], self.corners[1][1]], area.bottom, area.top)
    }

    /// Numbers stand at the left and below the last panel of each column.
    pub(super) fn draw_axes(&self, drawing: &mut Drawing, index: usize, labels: &[String; 2]) {
        let area = self.panel(index);
        let stroke = Stroke::plain(Colour::FRAME, 0.8);
        let small = |anchor| Lettering::plain(TICK_SIZE, anchor);
        let [x_ticks, y_ticks] = &self.ticks;
        let with_factor = |label: &str, ticks: &Ticks| {
            if ticks.factor.is_empty() { label.to_owned() } else { format!("{label}  {}", ticks.factor) }
        };
        if index.is_multiple_of(self.columns) {
            let mut widest = 10.0_f64;
            for tick in &y_ticks.ticks {
                let y = self.y(area).place(tick.value);
                drawing.line([area.left - TICK, y], [area.left, y], stroke);
                let at = [area.left - TICK - 4.0, y + 0.36 * TICK_SIZE];
                drawing.text(&tick.label, at, small(Anchor::End));
                widest = widest.max(Font::new(Weight::Regular).width(&tick.label, TICK_SIZE));
            }
            let label = Lettering { upward: true, ..Lettering::plain(13.0, Anchor::Middle) };
            let at = [area.left - TICK - widest - 13.0, area.center()[1]];
            drawing.text_within(&with_factor(&labels[1], y_ticks), at, area.height() + 20.0, label);
        }
        if index + self.columns >= self.count {
            for tick in &x_ticks.ticks {
                let x = self.x(area).place(tick.value);
                drawing.line([x, area.bottom], [x, area.bottom + TICK], stroke);
                let half = 0.5 * Font::new(Weight::Regular).width(&tick.label, TICK_SIZE);
                if x - half > area.left - 0.5 * GAP && x + half < area.right + 0.5 * GAP {
                    drawing.text(&tick.label, [x, area.bottom + TICK + 13.0], small(Anchor::Middle));
                }
            }
            let at = [area.center()[0], area.bottom + 38.0];
            let label = Lettering::plain(13.0, Anchor::Middle);
            drawing.text_within(&with_factor(&labels[0], x_ticks), at, area.width(), label);
        }
    }

    /// The label above a panel.
    pub(super) fn draw_label(&self, drawing: &mut Drawing, index: usize, label: &str) {
        let area = self.panel(index);
        let at = [area.left, area.top - 5.0];
        drawing.text_within(label, at, area.width(), Lettering::heading(12.5, Anchor::Start));
    }
}

/// Whether corners enclose an area whose numbers can be told apart.
pub(super) fn are_usable(corners: [[f64; 2]; 2]) -> bool {
    (0..2).all(|k| {
        let length = corners[1][k] - corners[0][k];
        length.is_finite() && length > 1e-9 * corners[0][k].abs().max(corners[1][k].abs())
    })
}
