//! What a chart holds.

use super::Figure;
use super::drawing::{Area, Drawing};
use super::plot::Prepared;

/// How values are spread along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps for equal differences.
    #[default]
    Linear,
    /// Equal steps for equal ratios; only positive values are shown.
    Log,
}

/// An axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// Quantity with its unit in brackets, such as `time [s]`.
    pub label: String,
    /// How values are spread.
    pub scale: Scale,
    /// First and last value; from the data when `None` or not usable.
    pub range: Option<[f64; 2]>,
}

impl Axis {
    /// A linear axis.
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Linear, range: None }
    }

    /// A logarithmic axis.
    pub fn log(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Log, range: None }
    }

    /// The same axis from `low` to `high`.
    pub fn range(mut self, low: f64, high: f64) -> Self {
        self.range = Some([low, high]);
        self
    }
}

/// How a series is drawn.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Style {
    /// A line through the points.
    #[default]
    Line,
    /// A sign at each point.
    Markers,
    /// Both.
    LineAndMarkers,
    /// A broken line, for references and theory.
    Dashed,
    /// A line with a shaded band around it; one `low` and `high` a point, in units of y.
    Band {
        /// Lower edge.
        low: Vec<f64>,
        /// Upper edge.
        high: Vec<f64>,
    },
    /// Signs with bars that reach so far up and down, in units of y; one a point.
    ErrorBars(Vec<f64>),
}

/// Points with a label and a style.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Text in the legend; none when empty.
    pub label: String,
    /// x and y of each point.
    pub points: Vec<[f64; 2]>,
    /// How it is drawn.
    pub style: Style,
    /// Colour as an index into the palette (0 to 6, 7 is black); the place of the series among
    /// all when `None`.
    pub colour: Option<usize>,
}

impl Series {
    /// A series in any style.
    pub fn new(label: impl Into<String>, points: Vec<[f64; 2]>, style: Style) -> Self {
        Self { label: label.into(), points, style, colour: None }
    }

    /// The same series in a colour of the palette, so that series that belong together look so.
    pub fn colour(mut self, index: usize) -> Self {
        self.colour = Some(index);
        self
    }
}

/// Series on two axes.
///
/// ```
/// use granular_io::figure::{Axis, Chart, Series, Style};
/// let chart = Chart::new("Cooling of a granular gas", Axis::log("time [s]"), Axis::log("T / T₀ [-]"))
///     .with(Series::new("run", vec![[0.1, 0.9], [1.0, 0.4], [10.0, 0.02]], Style::LineAndMarkers))
///     .with(Series::new("Haff’s law", vec![[0.1, 0.91], [10.0, 0.0206]], Style::Dashed));
/// assert!(chart.figure().svg().starts_with("<svg"));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chart {
    /// Text above.
    pub title: String,
    /// Axis below.
    pub x: Axis,
    /// Axis on the left.
    pub y: Axis,
    /// What is drawn; later ones lie above.
    pub series: Vec<Series>,
    /// Lines of small text below.
    pub notes: Vec<String>,
}

impl Chart {
    /// A chart without series.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self { title: title.into(), x, y, ..Self::default() }
    }

    /// The same chart with one more series.
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// The same chart with one more line of text below.
    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.notes.push(text.into());
        self
    }

    /// The chart as a figure of 640 by 440 pixels.
    pub fn figure(&self) -> Figure {
        self.figure_of(640.0, 440.0)
    }

    /// The chart as a figure of so many pixels, within 40 to 6000.
    pub fn figure_of(&self, width: f64, height: f64) -> Figure {
        let mut drawing = Drawing::new([width, height], &self.title);
        let [right, bottom] = drawing.size;
        let area = Area { left: 0.0, top: 0.0, right, bottom };
        let area = area.grown(-8.0);
        let prepared = Prepared::new(self, [area.width(), area.height()]);
        prepared.draw(&mut drawing, area, &prepared.margins());
        Figure { drawing }
    }
}
