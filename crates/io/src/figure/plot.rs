//! Draws a chart into an area of a figure.

use super::chart::{Axis, Chart, Scale, Series, Style};
use super::colour::Colour;
use super::drawing::{Anchor, Area, Drawing, Fill, Lettering, Spot, Stroke};
use super::font::{Font, Weight};
use super::geometry::{clip_line, clip_polygon, clip_polyline};
use super::legend::{self, Legend};
use super::scale::{Mapping, Ticks, can_show, range_of, ticks};

pub(super) const TICK_SIZE: f64 = 11.5;
const LABEL_SIZE: f64 = 13.0;
const TITLE_SIZE: f64 = 14.5;
const NOTE_SIZE: f64 = 10.5;
const NOTE_HEIGHT: f64 = 15.0;
/// Length of the strokes at round numbers.
pub(super) const TICK: f64 = 4.0;

/// Where values lie in the figure.
pub(super) struct Plot {
    pub(super) area: Area,
    x: Mapping,
    y: Mapping,
    scales: [Scale; 2],
}

impl Plot {
    /// The spot of a point, if it can be shown on these scales.
    pub(super) fn spot(&self, [x, y]: [f64; 2]) -> Option<Spot> {
        let shown = can_show(self.scales[0], x) && can_show(self.scales[1], y);
        shown.then(|| [self.x.place(x), self.y.place(y)])
    }

    /// Runs of neighbouring points that can be shown.
    pub(super) fn runs(&self, points: impl Iterator<Item = [f64; 2]>) -> Vec<Vec<Spot>> {
        let mut runs = vec![Vec::new()];
        for point in points {
            match self.spot(point) {
                Some(spot) => runs.last_mut().expect("there is always a run").push(spot),
                None => runs.push(Vec::new()),
            }
        }
        runs.retain(|run| !run.is_empty());
        runs
    }
}

/// A chart with all that its layout depends on.
pub(super) struct Prepared<'a> {
    chart: &'a Chart,
    ranges: [[f64; 2]; 2],
    ticks: [Ticks; 2],
}

impl<'a> Prepared<'a> {
    /// A chart for an area of this width and height.
    pub(super) fn new(chart: &'a Chart, [width, height]: [f64; 2]) -> Self {
        let points = || chart.series.iter().flat_map(extremes);
        let x_range = range_of(chart.x.scale, chart.x.range, points().map(|point| point[0]), 0.03);
        let y_range = range_of(chart.y.scale, chart.y.range, points().map(|point| point[1]), 0.05);
        let x_ticks = ticks(chart.x.scale, x_range, count(width - 70.0, 78.0));
        let y_ticks = ticks(chart.y.scale, y_range, count(height - 70.0, 48.0));
        Self { chart, ranges: [x_range, y_range], ticks: [x_ticks, y_ticks] }
    }

    /// Room for texts around the frame.
    pub(super) fn margins(&self) -> Margins {
        let font = Font::new(Weight::Regular);
        let width = |label: &str| font.width(label, TICK_SIZE);
        let (chart, [x_ticks, y_ticks]) = (self.chart, &self.ticks);
        let widest = y_ticks.ticks.iter().map(|tick| width(&tick.label)).fold(10.0, f64::max);
        let last = x_ticks.ticks.last().map_or(0.0, |tick| 0.5 * width(&tick.label));
        let head = if chart.title.is_empty() { 6.0 } else { 28.0 };
        let factor = if y_ticks.factor.is_empty() { 0.0 } else { 14.0 };
        let y_label = if chart.y.label.is_empty() { 2.0 } else { 22.0 };
        let x_label = if chart.x.label.is_empty() && x_ticks.factor.is_empty() { 2.0 } else { 22.0 };
        let notes = NOTE_HEIGHT * chart.notes.len() as f64;
        Margins {
            left: y_label + widest + TICK + 5.0,
            top: head + factor,
            right: last.max(6.0),
            bottom: notes + x_label + 22.0,
        }
    }

    /// Draws the chart into an area with these margins, which are at least its own.
    pub(super) fn draw(&self, drawing: &mut Drawing, area: Area, margins: &Margins) {
        let (chart, [x_ticks, y_ticks]) = (self.chart, &self.ticks);
        let plot_in = |frame: Area| Plot {
            area: frame,
            x: Mapping::new(chart.x.scale, self.ranges[0], frame.left, frame.right),
            y: Mapping::new(chart.y.scale, self.ranges[1], frame.bottom, frame.top),
            scales: [chart.x.scale, chart.y.scale],
        };
        let frame = margins.within(area);
        let mut plot = plot_in(frame);
        let legend = Legend::of(&chart.series);
        let place = legend.place(&plot, &chart.series).unwrap_or_else(|| {
            let (narrow, beside) = legend.beside(frame);
            plot = plot_in(narrow);
            beside
        });
        draw_grid(drawing, &plot, x_ticks, y_ticks);
        for (i, series) in chart.series.iter().enumerate() {
            draw_series(drawing, &plot, series, i);
        }
        draw_axes(drawing, &plot, [&chart.x, &chart.y], [x_ticks, y_ticks]);
        draw_texts(drawing, area, &plot, chart);
        legend.draw(drawing, place, &chart.series);
    }
}

/// Room around the frame of a chart.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Margins {
    left: f64,
    top: f64,
    right: f64,
    bottom: f64,
}

impl Margins {
    /// The larger of both left and right, so that frames in a column are flush.
    pub(super) fn wider(self, other: Self) -> Self {
        Self { left: self.left.max(other.left), right: self.right.max(other.right), ..self }
    }

    /// The larger of both above and below, so that frames in a row are flush.
    pub(super) fn taller(self, other: Self) -> Self {
        Self { top: self.top.max(other.top), bottom: self.bottom.max(other.bottom), ..self }
    }

    fn within(&self, area: Area) -> Area {
        let (left, top) = (area.left + self.left, area.top + self.top);
        // In a figure that is too small for its texts something must still be drawn.
        let right = (area.right - self.right).max(left + 20.0);
        Area { left, top, right, bottom: (area.bottom - self.bottom).max(top + 20.0) }
    }
}

fn count(length: f64, each: f64) -> usize {
    (length / each).clamp(2.0, 10.0) as usize
}

/// All that must lie in the ranges of the axes.
fn extremes(series: &Series) -> Vec<[f64; 2]> {
    let mut all = series.points.clone();
    for (i, &[x, y]) in series.points.iter().enumerate() {
        match &series.style {
            Style::Band { low, high } => {
                all.extend(low.get(i).map(|&y| [x, y]));
                all.extend(high.get(i).map(|&y| [x, y]));
            }
            Style::ErrorBars(half) => {
                all.extend(half.get(i).into_iter().flat_map(|h| [[x, y - h], [x, y + h]]));
            }
            _ => (),
        }
    }
    // A point that lacks one coordinate is not drawn, so the other must not count either.
    all.retain(|[x, y]| x.is_finite() && y.is_finite());
    all
}

fn draw_grid(drawing: &mut Drawing, plot: &Plot, x_ticks: &Ticks, y_ticks: &Ticks) {
    let Area { left, top, right, bottom } = plot.area;
    let fine = Stroke::plain(Colour::FINE_GRID, 0.7);
    let coarse = Stroke::plain(Colour::GRID, 0.8);
    let columns = |ticks: &Ticks| ticks.ticks.iter().map(|tick| tick.value).collect::<Vec<_>>();
    for (values, stroke) in [(&x_ticks.fine, fine), (&columns(x_ticks), coarse)] {
        for x in values.iter().map(|&value| plot.x.place(value)) {
            drawing.line([x, top], [x, bottom], stroke);
        }
    }
    for (values, stroke) in [(&y_ticks.fine, fine), (&columns(y_ticks), coarse)] {
        for y in values.iter().map(|&value| plot.y.place(value)) {
            drawing.line([left, y], [right, y], stroke);
        }
    }
}

fn draw_axes(drawing: &mut Drawing, plot: &Plot, axes: [&Axis; 2], [x_ticks, y_ticks]: [&Ticks; 2]) {
    let Area { left, top, right, bottom } = plot.area;
    let stroke = Stroke::plain(Colour::FRAME, 0.9);
    drawing.rectangle(plot.area, None, Some(stroke));
    for tick in &x_ticks.ticks {
        let x = plot.x.place(tick.value);
        drawing.line([x, bottom], [x, bottom + TICK], stroke);
        drawing.text(&tick.label, [x, bottom + TICK + 13.0], Lettering::plain(TICK_SIZE, Anchor::Middle));
    }
    for tick in &y_ticks.ticks {
        let y = plot.y.place(tick.value);
        drawing.line([left - TICK, y], [left, y], stroke);
        let at = [left - TICK - 4.0, y + 0.36 * TICK_SIZE];
        drawing.text(&tick.label, at, Lettering::plain(TICK_SIZE, Anchor::End));
    }
    for &x in &x_ticks.fine {
        let x = plot.x.place(x);
        drawing.line([x, bottom], [x, bottom + 0.5 * TICK], stroke);
    }
    for &y in &y_ticks.fine {
        let y = plot.y.place(y);
        drawing.line([left - 0.5 * TICK, y], [left, y], stroke);
    }
    let small = |anchor| Lettering::plain(TICK_SIZE, anchor);
    drawing.text(&y_ticks.factor, [left, top - 5.0], small(Anchor::Start));
    drawing.text(&x_ticks.factor, [right, bottom + 38.0], small(Anchor::End));
    let label = Lettering::plain(LABEL_SIZE, Anchor::Middle);
    let [x, y] = plot.area.center();
    drawing.text_within(&axes[0].label, [x, bottom + 38.0], plot.area.width() - 80.0, label);
    let widest = y_ticks.ticks.iter().map(|t| Font::new(Weight::Regular).width(&t.label, TICK_SIZE));
    let at = [left - TICK - 4.0 - widest.fold(10.0, f64::max) - 9.0, y];
    let label = Lettering { upward: true, ..label };
    drawing.text_within(&axes[1].label, at, plot.area.height() + 20.0, label);
}

fn draw_texts(drawing: &mut Drawing, area: Area, plot: &Plot, chart: &Chart) {
    let x = plot.area.center()[0];
    let room = 2.0 * (x - area.left).min(area.right - x);
    let heading = Lettering::heading(TITLE_SIZE, Anchor::Middle);
    drawing.text_within(&chart.title, [x, area.top + 17.0], room, heading);
    let note = Lettering { colour: Colour::FAINT_TEXT, ..Lettering::plain(NOTE_SIZE, Anchor::Start) };
    let labelled = !chart.x.label.is_empty();
    let first = plot.area.bottom + if labelled { 57.0 } else { 37.0 };
    for (i, text) in chart.notes.iter().enumerate() {
        let at = [plot.area.left, first + NOTE_HEIGHT * i as f64];
        drawing.text_within(text, at, area.right - plot.area.left, note);
    }
}

fn draw_series(drawing: &mut Drawing, plot: &Plot, series: &Series, index: usize) {
    let colour = legend::colour_of(series, index);
    let line = |drawing: &mut Drawing, dashed| {
        let stroke = Stroke { colour, width: 1.8, dashed };
        for run in plot.runs(series.points.iter().copied()) {
            for piece in clip_polyline(&plot.area, &run) {
                drawing.polyline(&piece, stroke);
            }
        }
    };
    match &series.style {
        Style::Line => line(drawing, false),
        Style::Dashed => line(drawing, true),
        Style::Markers => draw_markers(drawing, plot, series, index),
        Style::LineAndMarkers => {
            line(drawing, false);
            draw_markers(drawing, plot, series, index);
        }
        Style::Band { low, high } => {
            draw_band(drawing, plot, series, [low, high], colour);
            line(drawing, false);
        }
        Style::ErrorBars(half) => {
            draw_bars(drawing, plot, series, half, colour);
            draw_markers(drawing, plot, series, index);
        }
    }
}

fn draw_markers(drawing: &mut Drawing, plot: &Plot, series: &Series, index: usize) {
    let size = if series.points.len() > 300 { 2.0 } else { 3.8 };
    // Half a pixel of grace: a point at the end of a given range is to be seen.
    let area = plot.area.grown(0.5);
    let spots = series.points.iter().filter_map(|&point| plot.spot(point));
    for spot in spots.filter(|&spot| area.contains(spot)) {
        legend::marker(drawing, spot, size, series, index);
    }
}

/// Bands are drawn in runs in which both edges can be shown.
fn draw_band(drawing: &mut Drawing, plot: &Plot, series: &Series, edges: [&[f64]; 2], colour: Colour) {
    let fill = Fill { colour, opacity: 0.2 };
    let mut run: Vec<[Spot; 2]> = Vec::new();
    let mut end = |run: &mut Vec<[Spot; 2]>| {
        let there = run.iter().map(|pair| pair[0]);
        let ring: Vec<Spot> = there.chain(run.iter().rev().map(|pair| pair[1])).collect();
        drawing.polygon(&clip_polygon(&plot.area, &ring), Some(fill), None);
        run.clear();
    };
    for ((&[x, _], &low), &high) in series.points.iter().zip(edges[0]).zip(edges[1]) {
        match plot.spot([x, low]).zip(plot.spot([x, high])) {
            Some((low, high)) => run.push([low, high]),
            None => end(&mut run),
        }
    }
    end(&mut run);
}

fn draw_bars(drawing: &mut Drawing, plot: &Plot, series: &Series, half: &[f64], colour: Colour) {
    let stroke = Stroke::plain(colour, 1.2);
    for (&[x, y], &half) in series.points.iter().zip(half) {
        let Some(top) = plot.spot([x, y + half.abs()]) else { continue };
        // On a logarithmic axis a bar may reach below all that can be shown.
        let bottom = plot.spot([x, y - half.abs()]).unwrap_or([top[0], plot.area.bottom + 10.0]);
        if let Some([from, to]) = clip_line(&plot.area, bottom, top) {
            drawing.line(from, to, stroke);
        }
        for end in [bottom, top].into_iter().filter(|&end| plot.area.contains(end)) {
            drawing.line([end[0] - 3.0, end[1]], [end[0] + 3.0, end[1]], stroke);
        }
    }
}
