//! Snapshots of disks with a colour bar, walls and force chains.

use super::Figure;
use super::chart::Scale;
use super::colour::Colour;
use super::drawing::{Anchor, Area, Drawing, Fill, Lettering, Spot, Stroke};
use super::font::{Font, Weight};
use super::geometry::clip_line;
use super::plot::{TICK, TICK_SIZE};
use super::scale::{Mapping, Ticks, range_of, three_digits, ticks};

/// A disk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grain {
    /// Center, in the unit of the axes.
    pub center: [f64; 2],
    /// Radius, in the unit of the axes.
    pub radius: f64,
    /// What the colour shows; grey when not finite.
    pub value: f64,
}

/// A contact drawn as a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chain {
    /// One end, mostly the center of a grain.
    pub from: [f64; 2],
    /// The other end.
    pub to: [f64; 2],
    /// Force; the line is the wider the larger it is, and none is drawn for zero.
    pub force: f64,
}

/// One snapshot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GrainPanel {
    /// Text above, such as `t = 1.0 τ`.
    pub label: String,
    /// Disks.
    pub grains: Vec<Grain>,
    /// Walls as lines between two points.
    pub walls: Vec<[[f64; 2]; 2]>,
    /// Contacts, drawn above the grains.
    pub chains: Vec<Chain>,
}

/// Snapshots in a grid with the same scale, colours and axes.
///
/// ```
/// use granular_io::figure::{Grain, GrainFigure, GrainPanel};
/// let grains = vec![Grain { center: [0.0, 0.0], radius: 0.5, value: 1.0 }];
/// let panel = GrainPanel { label: "t = 1.0 τ".into(), grains, ..GrainPanel::default() };
/// let figure = GrainFigure::new("Collapse", "speed [m/s]", vec![panel]).figure();
/// assert!(figure.svg().contains("<circle"));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GrainFigure {
    /// Text above all; none when empty.
    pub title: String,
    /// What the colours show, with its unit in brackets; no colour bar when empty.
    pub quantity: String,
    /// What the widths of chains show, with its unit in brackets; for the note below.
    pub force: String,
    /// First and last value of the colours; from the data when `None`.
    pub values: Option<[f64; 2]>,
    /// Lower left and upper right corner to show; all when `None`. Grains whose center lies
    /// outside are left out.
    pub corners: Option<[[f64; 2]; 2]>,
    /// Labels of the axes, with units in brackets.
    pub axes: [String; 2],
    /// Snapshots per row; at least one.
    pub columns: usize,
    /// Width of the figure in pixels; it becomes narrower where snapshots are tall.
    pub width: f64,
    /// The snapshots, row by row.
    pub panels: Vec<GrainPanel>,
}

/// Height of all snapshots together in pixels at most.
const TALLEST: f64 = 860.0;
/// Room between snapshots side by side, so that the numbers below do not meet.
const GAP: f64 = 30.0;
/// Room between snapshots above one another.
const SMALL_GAP: f64 = 14.0;

impl GrainFigure {
    /// Snapshots above one another, 760 pixels wide, with axes in metres.
    pub fn new(title: impl Into<String>, quantity: impl Into<String>, panels: Vec<GrainPanel>) -> Self {
        Self {
            title: title.into(),
            quantity: quantity.into(),
            axes: ["x [m]".to_owned(), "y [m]".to_owned()],
            columns: 1,
            width: 760.0,
            panels,
            ..Self::default()
        }
    }

    /// The figure.
    pub fn figure(&self) -> Figure {
        let layout = Layout::of(self);
        let mut drawing = Drawing::new(layout.size, &self.title);
        if !self.title.is_empty() {
            let heading = Lettering::heading(15.0, Anchor::Middle);
            let room = layout.size[0] - 16.0;
            drawing.text_within(&self.title, [0.5 * layout.size[0], 23.0], room, heading);
        }
        for (index, panel) in self.panels.iter().enumerate() {
            self.draw_panel(&mut drawing, &layout, index, panel);
        }
        if layout.bar {
            self.draw_bar(&mut drawing, &layout);
        }
        let strongest = self.strongest();
        if strongest > 0.0 && !self.force.is_empty() {
            let text = format!("Line width: {}, widest {}", self.force, three_digits(strongest));
            let note = Lettering { colour: Colour::FAINT_TEXT, ..Lettering::plain(10.5, Anchor::Start) };
            drawing.text(&text, [layout.left, layout.size[1] - 7.0], note);
        }
        Figure { drawing }
    }

    fn values(&self) -> impl Iterator<Item = f64> {
        self.panels.iter().flat_map(|panel| panel.grains.iter().map(|grain| grain.value))
    }

    fn strongest(&self) -> f64 {
        let forces = self.panels.iter().flat_map(|panel| panel.chains.iter().map(|chain| chain.force));
        forces.filter(|force| force.is_finite()).fold(0.0, f64::max)
    }

    fn colours(&self) -> [f64; 2] {
        range_of(Scale::Linear, self.values, self.values(), 0.0)
    }

    fn draw_panel(&self, drawing: &mut Drawing, layout: &Layout, index: usize, panel: &GrainPanel) {
        let area = layout.panel(index);
        let place = |[x, y]: [f64; 2]| [layout.x(area).place(x), layout.y(area).place(y)];
        drawing.rectangle(area, None, Some(Stroke::plain(Colour::GRID, 0.8)));
        let at = [area.left, area.top - 5.0];
        drawing.text_within(&panel.label, at, area.width(), Lettering::heading(12.5, Anchor::Start));
        let [low, high] = self.colours();
        for grain in &panel.grains {
            let radius = grain.radius * layout.scale;
            if !(radius > 0.0 && area.grown(0.5).contains(place(grain.center))) {
                continue;
            }
            let share = (grain.value - low) / (high - low);
            let colour = if share.is_finite() { Colour::of_share(share) } else { Colour::NEUTRAL };
            let edge = (radius > 2.5).then_some(Stroke::plain(Colour::FRAME, 0.35));
            drawing.circle(place(grain.center), radius, Fill::solid(colour), edge);
        }
        self.draw_lines(drawing, area, panel, &place);
        layout.draw_axes(drawing, index, &self.axes);
    }

    fn draw_lines(
        &self,
        drawing: &mut Drawing,
        area: Area,
        panel: &GrainPanel,
        place: &dyn Fn([f64; 2]) -> Spot,
    ) {
        let strongest = self.strongest();
        let mut line = |[from, to]: [[f64; 2]; 2], stroke| {
            if from.into_iter().chain(to).all(f64::is_finite)
                && let Some([from, to]) = clip_line(&area, place(from), place(to))
            {
                drawing.line(from, to, stroke);
            }
        };
        for &wall in &panel.walls {
            line(wall, Stroke::plain(Colour::TEXT, 2.0));
        }
        for chain in panel.chains.iter().filter(|chain| chain.force > 0.0) {
            let width = (4.5 * chain.force / strongest).min(4.5);
            // Thinner lines would only grey the picture.
            if width > 0.15 {
                line([chain.from, chain.to], Stroke::plain(Colour::of_series(1), width));
            }
        }
    }

    fn draw_bar(&self, drawing: &mut Drawing, layout: &Layout) {
        let range = self.colours();
        let middle = 0.5 * (layout.top + layout.bottom);
        let half = (0.5 * (layout.bottom - layout.top)).clamp(40.0, 150.0);
        let left = layout.right + 18.0;
        let area = Area { left, top: middle - half, right: left + 13.0, bottom: middle + half };
        let strips = 64;
        let height = area.height() / f64::from(strips);
        for i in 0..strips {
            let top = area.top + height * f64::from(i);
            // Each strip reaches below the next: no white seams.
            let strip = Area { top, bottom: (top + 1.5 * height).min(area.bottom), ..area };
            let colour = Colour::of_share(1.0 - (f64::from(i) + 0.5) / f64::from(strips));
            drawing.rectangle(strip, Some(Fill::solid(colour)), None);
        }
        let stroke = Stroke::plain(Colour::FRAME, 0.8);
        drawing.rectangle(area, None, Some(stroke));
        let mapping = Mapping::new(Scale::Linear, range, area.bottom, area.top);
        let Ticks { ticks, factor, .. } = ticks(Scale::Linear, range, 5);
        let mut widest = 10.0_f64;
        for tick in &ticks {
            let y = mapping.place(tick.value);
            drawing.line([area.right, y], [area.right + TICK, y], stroke);
            let at = [area.right + TICK + 4.0, y + 0.36 * TICK_SIZE];
            drawing.text(&tick.label, at, Lettering::plain(TICK_SIZE, Anchor::Start));
            widest = widest.max(Font::new(Weight::Regular).width(&tick.label, TICK_SIZE));
        }
        drawing.text(&factor, [area.left, area.top - 6.0], Lettering::plain(TICK_SIZE, Anchor::Start));
        let label = Lettering { upward: true, ..Lettering::plain(13.0, Anchor::Middle) };
        let at = [area.right + TICK + widest + 21.0, middle];
        drawing.text_within(&self.quantity, at, layout.bottom - layout.top + 40.0, label);
    }
}

/// Where the snapshots lie.
struct Layout {
    size: [f64; 2],
    left: f64,
    top: f64,
    right: f64,
    bottom: f64,
    columns: usize,
    count: usize,
    panel: [f64; 2],
    head: f64,
    /// Pixels per unit of the axes.
    scale: f64,
    corners: [[f64; 2]; 2],
    ticks: [Ticks; 2],
    bar: bool,
}

impl Layout {
    fn of(figure: &GrainFigure) -> Self {
        let count = figure.panels.len().max(1);
        let columns = figure.columns.clamp(1, count);
        let rows = count.div_ceil(columns);
        let corners = corners_of(figure);
        let world = [corners[1][0] - corners[0][0], corners[1][1] - corners[0][1]];
        let bar = !figure.quantity.is_empty() && figure.values().any(f64::is_finite);
        let head = if figure.panels.iter().any(|panel| !panel.label.is_empty()) { 20.0 } else { 4.0 };
        let (left, right) = (66.0, if bar { 104.0 } else { 16.0 });
        let top = if figure.title.is_empty() { 6.0 } else { 34.0 };
        let below = if figure.force.is_empty() || figure.strongest() <= 0.0 { 50.0 } else { 66.0 };
        let room = figure.width.clamp(240.0, 6000.0) - left - right - GAP * (columns - 1) as f64;
        let tallest = (TALLEST / rows as f64 - head).max(60.0);
        let scale = (room / columns as f64 / world[0]).min(tallest / world[1]);
        let panel = world.map(|length| (length * scale).max(12.0));
        let width = panel[0] * columns as f64 + GAP * (columns - 1) as f64;
        let height = (panel[1] + head) * rows as f64 + SMALL_GAP * (rows - 1) as f64;
        let each = |k: usize, pixels: f64| {
            let wanted = (panel[k] / pixels).clamp(2.0, 8.0) as usize;
            ticks(Scale::Linear, [corners[0][k], corners[1][k]], wanted)
        };
        Self {
            size: [left + width + right, top + height + below],
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
            bar,
        }
    }

    fn panel(&self, index: usize) -> Area {
        let (column, row) = ((index % self.columns) as f64, (index / self.columns) as f64);
        let [width, height] = self.panel;
        let left = self.left + column * (width + GAP);
        let top = self.top + row * (height + self.head + SMALL_GAP);
        Area { left, top, right: left + width, bottom: top + height }
    }

    fn x(&self, area: Area) -> Mapping {
        Mapping::new(Scale::Linear, [self.corners[0][0], self.corners[1][0]], area.left, area.right)
    }

    fn y(&self, area: Area) -> Mapping {
        Mapping::new(Scale::Linear, [self.corners[0][1], self.corners[1][1]], area.bottom, area.top)
    }

    /// Numbers stand at the left and below the last snapshot of each column.
    fn draw_axes(&self, drawing: &mut Drawing, index: usize, labels: &[String; 2]) {
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
}

/// Lower left and upper right corner of all that is drawn.
fn corners_of(figure: &GrainFigure) -> [[f64; 2]; 2] {
    let ends = |k: usize| {
        let grains = figure.panels.iter().flat_map(move |panel| {
            let sides = panel.grains.iter().flat_map(move |grain| {
                [grain.center[k] - grain.radius.abs(), grain.center[k] + grain.radius.abs()]
            });
            sides.chain(panel.walls.iter().flatten().map(move |end| end[k]))
        });
        let [low, high] = range_of(Scale::Linear, None, grains, 0.0);
        // Whole grains and walls are to be seen.
        [low - 0.01 * (high - low), high + 0.01 * (high - low)]
    };
    let ([left, right], [bottom, top]) = (ends(0), ends(1));
    let all = [[left, bottom], [right, top]];
    let asked = figure.corners.unwrap_or(all);
    let usable = (0..2).all(|k| {
        let length = asked[1][k] - asked[0][k];
        length.is_finite() && length > 1e-9 * asked[0][k].abs().max(asked[1][k].abs())
    });
    if usable { asked } else { all }
}
