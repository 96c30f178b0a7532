//! The legend of a chart, placed where it covers no data.

use super::chart::{Series, Style};
use super::colour::Colour;
use super::drawing::{Anchor, Area, Drawing, Fill, Lettering, Spot, Stroke};
use super::font::{Font, Weight};
use super::plot::Plot;

const SIZE: f64 = 11.5;
const ROW: f64 = 18.0;
/// Room for the sample of a line.
const SAMPLE: f64 = 26.0;
const MARGIN: f64 = 7.0;

/// Size of a legend; it lists the series that have a label.
pub(super) struct Legend {
    width: f64,
    height: f64,
}

impl Legend {
    pub(super) fn of(series: &[Series]) -> Self {
        let font = Font::new(Weight::Regular);
        let widths: Vec<f64> =
            series.iter().filter(|s| !s.label.is_empty()).map(|s| font.width(&s.label, SIZE)).collect();
        if widths.is_empty() {
            return Self { width: 0.0, height: 0.0 };
        }
        let widest = widths.iter().copied().fold(0.0, f64::max);
        Self { width: widest + SAMPLE + 8.0 + 2.0 * MARGIN, height: ROW * widths.len() as f64 + MARGIN }
    }

    fn at(&self, left: f64, top: f64) -> Area {
        Area { left, top, right: left + self.width, bottom: top + self.height }
    }

    /// A place inside the plot that covers no data, if there is one.
    pub(super) fn place(&self, plot: &Plot, series: &[Series]) -> Option<Area> {
        let frame = plot.area.grown(-8.0);
        if self.width == 0.0 {
            return Some(self.at(frame.left, frame.top));
        }
        let (right, bottom) = (frame.right - self.width, frame.bottom - self.height);
        let [x, y] = frame.center();
        let [x, y] = [x - 0.5 * self.width, y - 0.5 * self.height];
        let corners = [[right, frame.top], [frame.left, frame.top], [right, bottom], [frame.left, bottom]];
        let edges = [[right, y], [frame.left, y], [x, frame.top], [x, bottom]];
        let fits = |area: &Area| area.left >= frame.left && area.top >= frame.top;
        let spots = covered_spots(plot, series);
        let mut places = corners.into_iter().chain(edges).map(|[left, top]| self.at(left, top));
        places.find(|place| fits(place) && !spots.iter().any(|&spot| place.grown(5.0).contains(spot)))
    }

    /// A place to the right of the plot, and the plot that is left. A long legend takes at most
    /// half of the width and then lies over the data.
    pub(super) fn beside(&self, frame: Area) -> (Area, Area) {
        let room = (self.width + 10.0).min(0.5 * frame.width());
        let narrow = Area { right: frame.right - room, ..frame };
        (narrow, self.at(frame.right - self.width + 6.0, frame.top))
    }

    pub(super) fn draw(&self, drawing: &mut Drawing, place: Area, series: &[Series]) {
        if self.width == 0.0 {
            return;
        }
        let fill = Fill { colour: Colour::WHITE, opacity: 0.92 };
        drawing.rectangle(place, Some(fill), Some(Stroke::plain(Colour::GRID, 0.8)));
        let listed = series.iter().enumerate().filter(|(_, series)| !series.label.is_empty());
        for (row, (index, series)) in listed.enumerate() {
            let y = place.top + 0.5 * MARGIN + ROW * (row as f64 + 0.5);
            let left = place.left + MARGIN;
            draw_sample(drawing, [left, y], series, index);
            let at = [left + SAMPLE + 8.0, y + 0.36 * SIZE];
            drawing.text(&series.label, at, Lettering::plain(SIZE, Anchor::Start));
        }
    }
}

fn draw_sample(drawing: &mut Drawing, [left, y]: Spot, series: &Series, index: usize) {
    let colour = colour_of(series, index);
    let (right, middle) = (left + SAMPLE, [left + 0.5 * SAMPLE, y]);
    if matches!(series.style, Style::Band { .. }) {
        let area = Area { left, top: y - 5.0, right, bottom: y + 5.0 };
        drawing.rectangle(area, Some(Fill { colour, opacity: 0.2 }), None);
    }
    if matches!(series.style, Style::Line | Style::LineAndMarkers | Style::Dashed | Style::Band { .. }) {
        let stroke = Stroke { colour, width: 1.8, dashed: series.style == Style::Dashed };
        drawing.line([left, y], [right, y], stroke);
    }
    if matches!(series.style, Style::ErrorBars(_)) {
        drawing.line([middle[0], y - 7.0], [middle[0], y + 7.0], Stroke::plain(colour, 1.2));
    }
    if matches!(series.style, Style::Markers | Style::LineAndMarkers | Style::ErrorBars(_)) {
        marker(drawing, middle, 3.8, series, index);
    }
}

/// Colour of a series, its own or by its place.
pub(super) fn colour_of(series: &Series, index: usize) -> Colour {
    Colour::of_series(series.colour.unwrap_or(index % 7))
}

/// A sign whose form goes with the place of the series, so that colour is not all that tells
/// series apart.
pub(super) fn marker(drawing: &mut Drawing, [x, y]: Spot, size: f64, series: &Series, index: usize) {
    let fill = Fill::solid(colour_of(series, index));
    let edge = (size > 3.0).then_some(Stroke::plain(Colour::WHITE, 0.8));
    let around = |spots: &[Spot]| spots.iter().map(|[a, b]| [x + a * size, y + b * size]).collect::<Vec<_>>();
    match index % 5 {
        0 => drawing.circle([x, y], size, fill, edge),
        1 => {
            let square = around(&[[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]]);
            drawing.polygon(&square, Some(fill), edge);
        }
        2 => drawing.polygon(&around(&[[0.0, -1.25], [1.15, 0.85], [-1.15, 0.85]]), Some(fill), edge),
        3 => {
            let diamond = around(&[[0.0, -1.3], [1.15, 0.0], [0.0, 1.3], [-1.15, 0.0]]);
            drawing.polygon(&diamond, Some(fill), edge);
        }
        _ => drawing.polygon(&around(&[[0.0, 1.25], [1.15, -0.85], [-1.15, -0.85]]), Some(fill), edge),
    }
}

/// Spots along all that is drawn, close enough that no legend slips between.
fn covered_spots(plot: &Plot, series: &[Series]) -> Vec<Spot> {
    let mut spots = Vec::new();
    for one in series {
        let mut curves = vec![one.points.clone()];
        let at_x = |edge: &[f64]| one.points.iter().zip(edge).map(|(point, &y)| [point[0], y]).collect();
        match &one.style {
            Style::Band { low, high } => curves.extend([at_x(low), at_x(high)]),
            Style::ErrorBars(half) => {
                let shifted = |sign: f64| {
                    one.points.iter().zip(half).map(|([x, y], h)| [*x, y + sign * h]).collect::<Vec<_>>()
                };
                curves.extend([shifted(-1.0), shifted(1.0)]);
            }
            _ => (),
        }
        let lines = !matches!(one.style, Style::Markers | Style::ErrorBars(_));
        for run in curves.into_iter().flat_map(|curve| plot.runs(curve.into_iter())) {
            spots.extend(&run);
            let pairs = run.windows(2).filter(|_| lines);
            for [from, to] in
                pairs.filter_map(|pair| super::geometry::clip_line(&plot.area, pair[0], pair[1]))
            {
                let length = (to[0] - from[0]).hypot(to[1] - from[1]);
                let parts = (length / 6.0).ceil() as usize;
                spots.extend((1..parts).map(|i| {
                    let t = i as f64 / parts as f64;
                    [from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])]
                }));
            }
        }
    }
    spots
}
