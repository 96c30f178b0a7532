//! Values in the cells of regular grids as colours, with a colour bar.

use super::Figure;
use super::chart::Scale;
use super::colour::Colour;
use super::colour_bar::ColourBar;
use super::drawing::{Area, Drawing, Fill, Stroke};
use super::geometry::clip_polyline;
use super::image::{Image, Samples};
use super::layout::{Layout, Request, are_usable};
use super::scale::{can_show, range_of};

/// One grid of cells.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MapPanel {
    /// Text above, such as `t = 1.0 s`.
    pub label: String,
    /// Cells along x and y.
    pub cells: [usize; 2],
    /// One value per cell from the lower left, x fastest; grey where not finite, as within
    /// obstacles. All is grey when their number is not that of the cells.
    pub values: Vec<f64>,
    /// Closed polygons drawn as lines, in the unit of the axes.
    pub outlines: Vec<Vec<[f64; 2]>>,
    /// Grains, drawn over the cells.
    pub disks: Vec<MapDisk>,
}

/// A grain over a map, in the unit of the axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MapDisk {
    /// Centre.
    pub center: [f64; 2],
    /// Radius; nothing is drawn where it is not above zero.
    pub radius: f64,
}

/// Maps in a grid with the same scale, colours and axes.
///
/// A map is one image, with the mean of several cells in a pixel where there are more cells than
/// can be seen: at most 2.5 pixels for a pixel of the figure, 1600 along an axis, and a million in
/// all.
///
/// ```
/// use granular_io::figure::{MapFigure, MapPanel};
/// let values = vec![0.0, 1.0, 2.0, 3.0, f64::NAN, 5.0];
/// let panel = MapPanel { cells: [3, 2], values, ..MapPanel::default() };
/// let figure = MapFigure::new("Channel", "speed [m/s]", [[0.0, 0.0], [3.0, 2.0]], vec![panel]);
/// assert!(figure.figure().svg().contains("<image"));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MapFigure {
    /// Text above all; none when empty.
    pub title: String,
    /// What the colours show, with its unit in brackets; no colour bar when empty.
    pub quantity: String,
    /// First and last value of the colours. When `None`, from the least to the largest value of
    /// all panels, or as [`MapFigure::diverging`] tells. Where values lie beyond, that end of the
    /// colour bar is an arrow.
    pub values: Option<[f64; 2]>,
    /// Colours from blue over white at zero to red, for quantities with a sign such as vorticity.
    /// The range is symmetric: to the larger bound of `values`, or when `None` to the largest
    /// absolute value. When that is more than 1.25 times the 99.5th percentile of the absolute
    /// values, it is to the percentile, so that a few extreme cells, mostly at a wall, do not make
    /// the others pale.
    pub diverging: bool,
    /// Lower left and upper right corner of the grid, in the unit of the axes. Cells are counted
    /// where these enclose no area.
    pub corners: [[f64; 2]; 2],
    /// Labels of the axes, with units in brackets.
    pub axes: [String; 2],
    /// Maps per row; at least one.
    pub columns: usize,
    /// Width of the figure in pixels; it becomes narrower where maps are tall.
    pub width: f64,
    /// The maps, row by row.
    pub panels: Vec<MapPanel>,
}

/// Share of the cells that the colours of a diverging map tell apart.
const TOLD_APART: f64 = 0.995;
/// Absolute values beyond that share are extreme when they are as many times as large.
const EXTREME: f64 = 1.25;
/// Pixels of an image per pixel of the figure at most: about 300 per inch in print.
const DENSITY: f64 = 2.5;
/// Pixels of an image along an axis at most.
const LONGEST: usize = 1600;
/// Pixels of an image at most.
const LARGEST: f64 = 1e6;

impl MapFigure {
    /// Maps above one another, 760 pixels wide, with axes in metres.
    pub fn new(
        title: impl Into<String>,
        quantity: impl Into<String>,
        corners: [[f64; 2]; 2],
        panels: Vec<MapPanel>,
    ) -> Self {
        Self {
            title: title.into(),
            quantity: quantity.into(),
            corners,
            axes: ["x [m]".to_owned(), "y [m]".to_owned()],
            columns: 1,
            width: 760.0,
            panels,
            ..Self::default()
        }
    }

    /// The figure.
    pub fn figure(&self) -> Figure {
        let bar = !self.quantity.is_empty() && self.shown().next().is_some();
        let layout = Layout::of(&Request {
            title: &self.title,
            labels: self.panels.iter().any(|panel| !panel.label.is_empty()),
            bar,
            note: false,
            count: self.panels.len(),
            columns: self.columns,
            width: self.width,
            corners: self.usable_corners(),
        });
        let mut drawing = layout.drawing(&self.title);
        let [low, high] = self.range();
        let colour = if self.diverging { Colour::of_signed_share } else { Colour::of_share };
        let paint = |value: f64| {
            if value.is_finite() { colour((value - low) / (high - low)) } else { Colour::NEUTRAL }
        };
        for (index, panel) in self.panels.iter().enumerate() {
            let area = layout.panel(index);
            if let Some(image) = panel.image([area.width(), area.height()], &paint) {
                drawing.image(image, area);
            }
            panel.draw_disks(&mut drawing, &layout, area);
            panel.draw_outlines(&mut drawing, &layout, area);
            drawing.rectangle(area, None, Some(Stroke::plain(Colour::FRAME, 0.8)));
            layout.draw_label(&mut drawing, index, &panel.label);
            layout.draw_axes(&mut drawing, index, &self.axes);
        }
        if bar {
            let beyond = [self.shown().any(|value| value < low), self.shown().any(|value| value > high)];
            let bar = ColourBar { quantity: &self.quantity, range: [low, high], colour, strips: 160, beyond };
            bar.draw(&mut drawing, &layout);
        }
        Figure { drawing }
    }

    /// The values that become colours.
    fn shown(&self) -> impl Iterator<Item = f64> {
        let whole = self.panels.iter().filter(|panel| panel.is_whole());
        whole.flat_map(|panel| panel.values.iter().copied()).filter(|value| value.is_finite())
    }

    fn range(&self) -> [f64; 2] {
        if !self.diverging {
            return range_of(Scale::Linear, self.values, self.shown(), 0.0);
        }
        let size = self.values.map(|[low, high]| low.abs().max(high.abs())).filter(has_size);
        let size = size.or_else(|| self.usual_size()).unwrap_or(1.0);
        [-size, size]
    }

    /// The largest absolute value, or what all but a few extreme cells are below.
    fn usual_size(&self) -> Option<f64> {
        let shown = self.shown().map(f64::abs);
        let mut sizes: Vec<f64> = shown.filter(|&size| can_show(Scale::Linear, size)).collect();
        sizes.sort_unstable_by(f64::total_cmp);
        let largest = sizes.last().copied().filter(has_size)?;
        let place = (TOLD_APART * sizes.len() as f64).ceil() as usize;
        // Nearly all may be zero; then the others are what is to be seen.
        let usual = sizes.get(place.saturating_sub(1)).copied().filter(has_size).unwrap_or(largest);
        Some(if largest > EXTREME * usual { usual } else { largest })
    }

    fn usable_corners(&self) -> [[f64; 2]; 2] {
        if are_usable(self.corners) {
            return self.corners;
        }
        let cells = self.panels.iter().map(|panel| panel.cells).find(|cells| !cells.contains(&0));
        [[0.0; 2], cells.unwrap_or([1, 1]).map(|n| n as f64)]
    }
}

/// Whether colours up to this absolute value can be told apart: numbers below lose their digits.
fn has_size(size: &f64) -> bool {
    can_show(Scale::Linear, *size) && *size > 1e-280
}

impl MapPanel {
    fn is_whole(&self) -> bool {
        self.cells[0].checked_mul(self.cells[1]) == Some(self.values.len())
    }

    /// The cells as an image that fills `size` pixels of the figure.
    fn image(&self, size: [f64; 2], paint: &dyn Fn(f64) -> Colour) -> Option<Image> {
        if !self.is_whole() || self.values.is_empty() {
            return Image::of(1, vec![paint(f64::NAN)]);
        }
        let [width, height] = pixels_for(self.cells, size);
        let along = |cells: usize, pixels: usize| Samples::of([0.0, pixels as f64], cells, pixels).each;
        let columns = along(self.cells[0], width);
        let rows = along(self.cells[1], height);
        // Images begin at the top.
        let pixels = rows
            .iter()
            .rev()
            .flat_map(|(_, row)| columns.iter().map(|(_, column)| paint(self.mean(row, column))));
        Image::of(columns.len(), pixels.collect())
    }

    /// Mean over the cells of a pixel that have a value; none where most have none.
    fn mean(&self, row: &[(usize, f64)], column: &[(usize, f64)]) -> f64 {
        if let ([(j, _)], [(i, _)]) = (row, column) {
            return self.values[j * self.cells[0] + i];
        }
        let (mut sum, mut valued, mut all) = (0.0, 0.0, 0.0);
        for (j, high) in row {
            for (i, wide) in column {
                let value = self.values[j * self.cells[0] + i];
                all += high * wide;
                if value.is_finite() {
                    sum += high * wide * value;
                    valued += high * wide;
                }
            }
        }
        if valued < 0.5 * all { f64::NAN } else { sum / valued }
    }

    /// Disks whose centres are in the map.
    fn draw_disks(&self, drawing: &mut Drawing, layout: &Layout, area: Area) {
        let (x, y) = (layout.x(area), layout.y(area));
        for disk in &self.disks {
            let (center, radius) =
                ([0, 1].map(|k| [&x, &y][k].place(disk.center[k])), disk.radius * layout.scale);
            if radius > 0.0 && area.contains(center) {
                let edge = (radius > 1.0).then_some(Stroke::plain(Colour::FRAME, (0.1 * radius).min(0.5)));
                drawing.circle(center, radius, Fill::solid(Colour::GRAIN), edge);
            }
        }
    }

    fn draw_outlines(&self, drawing: &mut Drawing, layout: &Layout, area: Area) {
        let (x, y) = (layout.x(area), layout.y(area));
        for outline in self.outlines.iter().filter(|outline| outline.len() > 1) {
            let closed = outline.iter().chain(outline.first());
            let spots: Vec<_> = closed.map(|&[at, up]| [x.place(at), y.place(up)]).collect();
            for run in spots.split(|spot| !spot.iter().all(|place| place.is_finite())) {
                for piece in clip_polyline(&area, run) {
                    drawing.polyline(&piece, Stroke::plain(Colour::TEXT, 0.9));
                }
            }
        }
    }
}

/// Columns and rows of an image of `cells` that fills `size` pixels of the figure.
fn pixels_for(cells: [usize; 2], size: [f64; 2]) -> [usize; 2] {
    let seen = |k: usize| ((DENSITY * size[k]).ceil() as usize).clamp(1, LONGEST);
    let pixels = [cells[0].min(seen(0)), cells[1].min(seen(1))];
    let excess = pixels[0] as f64 * pixels[1] as f64 / LARGEST;
    if excess <= 1.0 {
        return pixels;
    }
    pixels.map(|n| ((n as f64 / excess.sqrt()) as usize).max(1))
}

#[cfg(test)]
mod tests;
