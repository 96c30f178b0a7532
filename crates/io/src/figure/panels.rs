//! Several charts in one figure.

use super::Figure;
use super::chart::Chart;
use super::drawing::{Anchor, Area, Drawing, Lettering};
use super::plot::{Margins, Prepared};

/// Charts in a grid, filled row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Panels {
    /// Text above all; none when empty.
    pub title: String,
    /// Charts per row; at least one.
    pub columns: usize,
    /// The charts.
    pub charts: Vec<Chart>,
    /// Width and height of a chart in pixels.
    pub size: [f64; 2],
}

impl Panels {
    /// A grid of charts of 460 by 340 pixels.
    pub fn new(title: impl Into<String>, columns: usize, charts: Vec<Chart>) -> Self {
        Self { title: title.into(), columns, charts, size: [460.0, 340.0] }
    }

    /// The figure.
    pub fn figure(&self) -> Figure {
        let columns = self.columns.clamp(1, self.charts.len().max(1));
        let rows = self.charts.len().div_ceil(columns).max(1);
        let head = if self.title.is_empty() { 0.0 } else { 34.0 };
        let [width, height] = self.size;
        let whole = [width * columns as f64, height * rows as f64 + head];
        let mut drawing = Drawing::new(whole, &self.title);
        let [right, bottom] = drawing.size;
        if head > 0.0 {
            let lettering = Lettering::heading(16.0, Anchor::Middle);
            drawing.text_within(&self.title, [0.5 * right, 26.0], right - 16.0, lettering);
        }
        let [width, height] = [right / columns as f64, (bottom - head) / rows as f64];
        let inner = [width - 16.0, height - 16.0];
        let prepared: Vec<_> = self.charts.iter().map(|chart| Prepared::new(chart, inner)).collect();
        let all: Vec<Margins> = prepared.iter().map(Prepared::margins).collect();
        for (i, prepared) in prepared.iter().enumerate() {
            let in_column = all.iter().skip(i % columns).step_by(columns).copied();
            let in_row = all.iter().skip(i / columns * columns).take(columns).copied();
            let margins = in_row.fold(in_column.fold(Margins::default(), Margins::wider), Margins::taller);
            let (left, top) = (width * (i % columns) as f64, head + height * (i / columns) as f64);
            let area = Area { left, top, right: left + width, bottom: top + height };
            prepared.draw(&mut drawing, area.grown(-8.0), &margins);
        }
        Figure { drawing }
    }
}
