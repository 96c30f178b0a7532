//! Snapshots of disks with a colour bar, walls and force chains.

use super::Figure;
use super::chart::Scale;
use super::colour::Colour;
use super::colour_bar::ColourBar;
use super::drawing::{Anchor, Area, Drawing, Fill, Lettering, Spot, Stroke};
use super::font::{Font, Weight};
use super::geometry::clip_line;
use super::layout::{Layout, Request, are_usable};
use super::scale::{range_of, three_digits};

/// Size of the names of marks in pixels.
const LABEL: f64 = 11.0;

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

/// A cell of a grain, drawn below it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Patch {
    /// Corners of its outline, in the unit of the axes.
    pub outline: Vec<[f64; 2]>,
    /// What the colour shows; white when not finite.
    pub value: f64,
}

/// A line that is no wall, such as the edge of a place where grains come in, with its name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mark {
    /// Its points, in the unit of the axes; one point is drawn as a cross.
    pub points: Vec<[f64; 2]>,
    /// Whether the last point is joined to the first.
    pub closed: bool,
    /// Whether the line is broken.
    pub dashed: bool,
    /// Text at its middle; none when empty.
    pub label: String,
}

/// One snapshot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GrainPanel {
    /// Text above, such as `t = 1.0 τ`.
    pub label: String,
    /// Disks; with cells in the figure their outlines only.
    pub grains: Vec<Grain>,
    /// Cells, light to dark with their values; then the colours are of them.
    pub cells: Vec<Patch>,
    /// Walls as lines between two points.
    pub walls: Vec<[[f64; 2]; 2]>,
    /// Contacts, drawn above the grains.
    pub chains: Vec<Chain>,
    /// Other lines and their names, drawn above all.
    pub marks: Vec<Mark>,
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
    /// Small text below, after that of chains; none when empty.
    pub note: String,
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
        let note = self.notes();
        let barred = !self.quantity.is_empty() && self.values().any(f64::is_finite);
        let layout = Layout::of(&Request {
            title: &self.title,
            labels: self.panels.iter().any(|panel| !panel.label.is_empty()),
            bar: barred,
            note: !note.is_empty(),
            count: self.panels.len(),
            columns: self.columns,
            width: self.width,
            corners: corners_of(self),
        });
        let mut drawing = layout.drawing(&self.title);
        for (index, panel) in self.panels.iter().enumerate() {
            self.draw_panel(&mut drawing, &layout, index, panel);
        }
        if barred {
            let (quantity, range) = (self.quantity.as_str(), self.colours());
            let colour = if self.has_cells() { Colour::of_density } else { Colour::of_share };
            let bar = ColourBar { quantity, range, colour, strips: 64, beyond: [false; 2] };
            bar.draw(&mut drawing, &layout);
        }
        if !note.is_empty() {
            let small = Lettering { colour: Colour::FAINT_TEXT, ..Lettering::plain(10.5, Anchor::Start) };
            let room = layout.size[0] - layout.left - 8.0;
            drawing.text_within(&note, [layout.left, layout.size[1] - 7.0], room, small);
        }
        Figure { drawing }
    }

    /// The text below.
    fn notes(&self) -> String {
        let widths = (self.strongest() > 0.0 && !self.force.is_empty())
            .then(|| format!("Line width: {}, widest {}", self.force, three_digits(self.strongest())));
        let own = Some(self.note.clone()).filter(|note| !note.is_empty());
        widths.into_iter().chain(own).collect::<Vec<_>>().join("; ")
    }

    fn has_cells(&self) -> bool {
        self.panels.iter().any(|panel| !panel.cells.is_empty())
    }

    fn values(&self) -> impl Iterator<Item = f64> {
        let of_cells = self.has_cells();
        let grains = self.panels.iter().flat_map(|panel| panel.grains.iter().map(|grain| grain.value));
        let cells = self.panels.iter().flat_map(|panel| panel.cells.iter().map(|cell| cell.value));
        grains.filter(move |_| !of_cells).chain(cells)
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
        layout.draw_label(drawing, index, &panel.label);
        let [low, high] = self.colours();
        // Of grains that are small in the figure, lines of one width would hide the greys.
        let fine = |radius: f64| (0.05 * radius).clamp(0.04, 0.6);
        let mean = panel.grains.iter().map(|grain| grain.radius * layout.scale).sum::<f64>();
        let width = fine(mean / panel.grains.len().max(1) as f64);
        for cell in &panel.cells {
            let spots: Vec<Spot> = cell.outline.iter().map(|&corner| place(corner)).collect();
            let share = (cell.value - low) / (high - low);
            let fill = share.is_finite().then(|| Fill::solid(Colour::of_density(share)));
            drawing.polygon(&spots, fill, Some(Stroke::plain(Colour::FRAME, width)));
        }
        for grain in &panel.grains {
            let radius = grain.radius * layout.scale;
            if !(radius > 0.0 && area.grown(0.5).contains(place(grain.center))) {
                continue;
            }
            if self.has_cells() {
                drawing.ring(place(grain.center), radius, Stroke::plain(Colour::of_series(1), fine(radius)));
                continue;
            }
            let share = (grain.value - low) / (high - low);
            let colour = if share.is_finite() { Colour::of_share(share) } else { Colour::NEUTRAL };
            let edge = (radius > 2.5).then_some(Stroke::plain(Colour::FRAME, 0.35));
            drawing.circle(place(grain.center), radius, Fill::solid(colour), edge);
        }
        self.draw_lines(drawing, area, panel, &place);
        for mark in &panel.marks {
            draw_mark(drawing, area, (mark, !panel.grains.is_empty()), &place);
        }
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
}

fn draw_mark(
    drawing: &mut Drawing,
    area: Area,
    (mark, on_grains): (&Mark, bool),
    place: &dyn Fn([f64; 2]) -> Spot,
) {
    let stroke = Stroke { colour: Colour::of_series(1), width: 1.3, dashed: mark.dashed };
    if mark.points.iter().flatten().any(|x| !x.is_finite()) {
        return;
    }
    let spots: Vec<Spot> = mark.points.iter().map(|&point| place(point)).collect();
    if let [[x, y]] = spots[..] {
        drawing.line([x - 4.0, y], [x + 4.0, y], stroke);
        drawing.line([x, y - 4.0], [x, y + 4.0], stroke);
    }
    let closing = spots.last().zip(spots.first()).filter(|_| mark.closed && spots.len() > 2);
    for (from, to) in spots.windows(2).map(|pair| (&pair[0], &pair[1])).chain(closing) {
        if let Some([from, to]) = clip_line(&area, *from, *to) {
            drawing.line(from, to, stroke);
        }
    }
    if mark.label.is_empty() || spots.is_empty() {
        return;
    }
    let ends = |k: usize| {
        spots.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], spot| {
            [low.min(spot[k]), high.max(spot[k])]
        })
    };
    let ([left, right], [top, bottom]) = (ends(0), ends(1));
    let half = 0.5 * Font::new(Weight::Regular).width(&mark.label, LABEL) + 2.0;
    // Within what encloses it, below a point, at the top of what is upright, and else above the line.
    let y = match spots.len() {
        1 => bottom + 1.4 * LABEL,
        _ if mark.closed && right - left > 2.0 * half && bottom - top > LABEL => 0.5 * (top + bottom + LABEL),
        _ if !mark.closed && bottom - top > right - left => top.max(area.top) + 1.6 * LABEL,
        _ => top - 4.0,
    };
    let x = (0.5 * (left + right)).clamp(area.left + half, (area.right - half).max(area.left + half));
    let y = y.clamp(area.top + LABEL, (area.bottom - 3.0).max(area.top + LABEL));
    // Grains behind it would make it unreadable.
    if on_grains {
        let paper = Area { left: x - half, top: y - LABEL, right: x + half, bottom: y + 3.0 };
        drawing.rectangle(paper, Some(Fill { colour: Colour::WHITE, opacity: 0.8 }), None);
    }
    let lettering = Lettering { colour: Colour::of_series(1), ..Lettering::plain(LABEL, Anchor::Middle) };
    drawing.text(&mark.label, [x, y], lettering);
}

/// Lower left and upper right corner of all that is drawn.
fn corners_of(figure: &GrainFigure) -> [[f64; 2]; 2] {
    let ends = |k: usize| {
        let grains = figure.panels.iter().flat_map(move |panel| {
            let sides = panel.grains.iter().flat_map(move |grain| {
                [grain.center[k] - grain.radius.abs(), grain.center[k] + grain.radius.abs()]
            });
            let walls = panel.walls.iter().flatten().map(move |end| end[k]);
            let chains = panel.chains.iter().flat_map(move |chain| [chain.from[k], chain.to[k]]);
            let marks = panel.marks.iter().flat_map(move |mark| mark.points.iter().map(move |end| end[k]));
            sides.chain(walls).chain(chains).chain(marks)
        });
        let [low, high] = range_of(Scale::Linear, None, grains, 0.0);
        // Whole grains and walls are to be seen.
        [low - 0.01 * (high - low), high + 0.01 * (high - low)]
    };
    let ([left, right], [bottom, top]) = (ends(0), ends(1));
    let all = [[left, bottom], [right, top]];
    let asked = figure.corners.unwrap_or(all);
    if are_usable(asked) { asked } else { all }
}
