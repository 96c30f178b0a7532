//! Fields on the same cells as colour maps: each source, and its difference from the first.

use super::source::Grid;
use granular_io::figure::{Figure, MapFigure, MapPanel};

/// Width over height from which maps stand above one another.
const FLAT: f64 = 3.0;

/// A quantity on the same cells of several sources.
#[derive(Clone, Debug)]
pub(super) struct Maps {
    /// Name of the field.
    pub(super) quantity: String,
    /// Labels and fields, that of reference first.
    fields: Vec<(String, Grid)>,
}

impl Maps {
    pub(super) fn new(quantity: String, fields: Vec<(String, Grid)>) -> Self {
        Self { quantity, fields }
    }

    /// All sources with the same colours; the plane, or the middle layer along y in space.
    pub(super) fn overlay(&self) -> Option<Figure> {
        let panels = self.fields.iter().map(|(label, grid)| panel(label.clone(), grid, &grid.values));
        self.figure(self.words(), panels.collect::<Option<_>>()?, false)
    }

    /// The others less the first.
    pub(super) fn differences(&self) -> Option<Figure> {
        let ((reference, first), others) = self.fields.split_first()?;
        let panels = others.iter().map(|(label, grid)| {
            let less: Vec<f64> = grid.values.iter().zip(&first.values).map(|(a, b)| a - b).collect();
            panel(format!("{label} less {reference}"), grid, &less)
        });
        self.figure(format!("difference in {}", self.words()), panels.collect::<Option<_>>()?, true)
    }

    fn words(&self) -> String {
        self.quantity.replace('_', " ")
    }

    fn figure(&self, quantity: String, panels: Vec<MapPanel>, diverging: bool) -> Option<Figure> {
        let (_, grid) = self.fields.first()?;
        let (normal, _) = seen(grid);
        let corners = grid.frame.corners(normal);
        let [width, height] = [0, 1].map(|k| corners[1][k] - corners[0][k]);
        let (scale, unit) = if width > 1.0 { (1.0, "m") } else { (1e3, "mm") };
        let mut figure = MapFigure::new("", quantity, corners.map(|end| end.map(|x| scale * x)), panels);
        figure.axes = [format!("x [{unit}]"), format!("{} [{unit}]", if normal == 1 { "z" } else { "y" })];
        figure.columns = if figure.panels.len() > 1 && width < FLAT * height { 2 } else { 1 };
        figure.diverging = diverging;
        Some(figure.figure())
    }
}

/// The plane that is drawn: its normal, and its number along it.
fn seen(grid: &Grid) -> (usize, usize) {
    if grid.frame.cells[2] == 1 { (2, 0) } else { (1, grid.frame.cells[1] / 2) }
}

fn panel(label: String, grid: &Grid, values: &[f64]) -> Option<MapPanel> {
    let (normal, index) = seen(grid);
    let (values, cells) = grid.frame.plane(values, normal, index)?;
    Some(MapPanel { label, cells, values, ..MapPanel::default() })
}
